//! The one flag that sets a key of a scene.

use super::Failure;

/// Checks that no two flags set the same key; a table owns every key in it. An error says which two.
pub(super) fn one_owner(flags: &[(&str, &str)]) -> Result<(), Failure> {
    for (k, (flag, key)) in flags.iter().enumerate() {
        let within = |inner: &str, outer: &str| {
            let rest = inner.strip_prefix(outer);
            rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
        };
        let clash = |(_, other): &&(&str, &str)| within(other, key) || within(key, other);
        if let Some((first, other)) = flags[..k].iter().find(clash) {
            // Other flags than these take no key.
            let takes_key = |flag: &str| ["--over", "--set"].contains(&flag);
            let given = |flag: &str, key: &str| {
                if takes_key(flag) { format!("{flag} {key}") } else { flag.to_owned() }
            };
            let both = match other == key && takes_key(flag) && takes_key(first) {
                true => "it",
                false if key.len() > other.len() => key,
                false => other,
            };
            return Err(Failure::Input(format!(
                "{} and {}: both set {both}; one of the two is allowed",
                given(flag, key),
                given(first, other)
            )));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_key_has_one_owner() {
        let over = |keys: &[&'static str]| {
            let flags: Vec<_> = keys.iter().map(|key| ("--over", *key)).collect();
            one_owner(&flags).map_err(|failure| failure.message_and_code().0)
        };
        assert_eq!(over(&["ensemble.seed", "ensemble.replicas", "ensemble_x", "e"]), Ok(()));
        for keys in [
            ["particles", "particles.count"],
            ["particles.count", "particles"],
            ["particles.orientation.phi_deg", "particles.orientation"],
            ["flow.x", "flow.x"],
        ] {
            let error = over(&keys).unwrap_err();
            assert!(error.contains("one of the two is allowed"), "{error}");
        }
        let failure = one_owner(&[("--replicas", "ensemble.replicas"), ("--over", "ensemble")]).unwrap_err();
        assert_eq!(
            failure.message_and_code().0,
            "--over ensemble and --replicas: both set ensemble.replicas; one of the two is allowed"
        );
    }
}
