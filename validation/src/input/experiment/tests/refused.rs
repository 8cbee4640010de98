use super::{EXPORT, POINTS, PROVENANCE, refusal};
use serde::de::DeserializeOwned;
use std::collections::BTreeMap;

/// Rows of `refused.toml`: what is wrong, and how the message begins.
fn rows<T: DeserializeOwned>(name: &str) -> Vec<T> {
    let tables: BTreeMap<String, toml::Value> = toml::from_str(include_str!("refused.toml")).unwrap();
    tables[name].clone().try_into().unwrap()
}

#[test]
fn bad_points_are_refused_with_their_line() {
    for [points, expected] in &rows::<[String; 2]>("points") {
        let found = refusal(PROVENANCE, points);
        assert!(found.starts_with(expected), "{points:?}: {found}");
    }
    let found = refusal(PROVENANCE, b"t_over_T,x1\n0.5,0.4\n0.6,\xff\n");
    assert!(found.starts_with("a.csv: cannot be read: it is not UTF-8 text (line 3)"), "{found}");
}

#[test]
fn what_would_run_for_long_is_refused() {
    // In t/T, a quarter of a period is 0.25.
    let own = |u: &str| format!("t_over_T,x1,t_over_T_u\n0.4,0.3,0.25\n0.5,0.4,{u}\n");
    let found = refusal(PROVENANCE, own("0.26"));
    let expected =
        "a.csv:3: column t_over_T_u: `0.26` is not allowed: expected one standard deviation of at most a quarter";
    assert!(found.starts_with(expected), "{found}");
    let vague = PROVENANCE.replace("standard_uncertainty = 0.01", "standard_uncertainty = 1");
    let found = refusal(&vague, super::POINTS);
    assert!(found.starts_with("a.toml: x.standard_uncertainty = 1 is not allowed"), "{found}");
    let many: String = (0..20_000).map(|k| format!("{},0.3\n", f64::from(k) * 1e-4)).collect();
    let found = refusal(PROVENANCE, format!("t_over_T,x1\n{many}"));
    assert!(found.starts_with("a.csv:20001: more than 20000 lines"), "{found}");
}

#[test]
fn bad_exports_are_refused_with_their_line() {
    let one = PROVENANCE.replace("csv = \"columns\"", EXPORT);
    for [points, expected] in &rows::<[String; 2]>("exports") {
        let found = refusal(&one, points);
        assert!(found.starts_with(expected), "{points:?}: {found}");
    }
    let named = one + "dataset = \"c\"\n";
    let found = refusal(&named, "a,\nX,Y\n0.5,0.4\n");
    assert!(found.starts_with("a.toml:17: curve.dataset = c is not allowed"), "{found}");
}

#[test]
fn bad_provenance_is_refused_with_its_line() {
    for [before, after, expected] in &rows::<[String; 3]>("provenance") {
        assert!(PROVENANCE.contains(before), "{before}");
        let found = refusal(&PROVENANCE.replacen(before, after, 1), POINTS);
        assert!(found.starts_with(expected), "{after:?}: {found}");
    }
    let none = PROVENANCE.split("[[curve]]").next().unwrap();
    assert!(refusal(none, POINTS).starts_with("a.toml:1: curve is missing"));
}
