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
