//! `shearbed shape` as a user meets it.

use crate::common::{SMALL, folder, shearbed};
use std::fs;
use std::path::Path;

#[test]
fn every_formula_is_listed_with_its_value_and_source_the_spread_first() {
    let done = shearbed(Path::new("."), "shape --physical 20");
    assert_eq!(done.code, Some(0), "{}", done.stderr);
    let first = done.stdout.lines().next().unwrap();
    assert_eq!(first, "a cylinder of r = 20: r_e from 14.096 to 14.328, a spread of 1.6 %");
    for text in
        ["14.160  Goldsmith", "14.328  Cox", "Harris & Pittman", "UNCHECKED", "14.096  Zhang", "J. Fluid Mech. 45"]
    {
        assert!(done.stdout.contains(text), "no {text} in {}", done.stdout);
    }
}

#[test]
fn a_formula_without_a_meaning_gives_no_number() {
    let done = shearbed(Path::new("."), "shape --physical 500");
    assert_eq!(done.code, Some(0));
    assert!(done.stdout.contains("none  Goldsmith") && done.stdout.contains("none  Zhang"), "{}", done.stdout);
}

#[test]
fn bad_input_says_what_is_allowed() {
    for bad in
        ["--physical 1", "--physical -3", "--physical nan", "--physical inf", "--physical 1001", "--physical x", ""]
    {
        let done = shearbed(Path::new("."), &format!("shape {bad}"));
        assert_eq!(done.code, Some(2), "{bad}");
        let named = if bad.is_empty() { "--physical" } else { "a number from 2 to 1000 is allowed" };
        assert!(done.stderr.contains(named), "{bad}: {}", done.stderr);
        assert!(done.stdout.is_empty());
    }
}

#[test]
fn a_cylinder_is_given_by_its_own_aspect_ratio_and_a_formula() {
    let dir = folder();
    let cylinder = "physical_aspect_ratio = 20\nshape_correlation = \"cox\"";
    let text = SMALL.replace("aspect_ratio = 11.6", cylinder);
    fs::write(dir.path().join("c.toml"), &text).unwrap();
    let planned = shearbed(dir.path(), "plan c.toml");
    // 24.8/√(ln 20) = 14.32850.
    assert!(planned.stdout.contains("r_e = 14.3285 (Cox 1971: 1.24 r/√(ln r))"), "{}", planned.stdout);
    assert_eq!(shearbed(dir.path(), "run c.toml --out a --quiet").code, Some(0));
    let read = |name: &str| fs::read_to_string(dir.path().join(name)).unwrap();
    let record: serde_json::Value = serde_json::from_str(&read("a/run.json")).unwrap();
    let r_e = 24.8 / 20f64.ln().sqrt();
    let found = record["facts"]["equivalent"]["aspect_ratio"].as_f64().unwrap();
    assert!((found - r_e).abs() < 1e-14);
    let particles = &record["scene"]["particles"];
    assert_eq!(particles["physical_aspect_ratio"], 20.0);
    assert!(particles["aspect_ratio"].is_null());
    // The same scene by its r_e has the same bits, and so has that of run.json.
    fs::write(dir.path().join("r.toml"), SMALL.replace("11.6", &format!("{found:?}"))).unwrap();
    assert_eq!(shearbed(dir.path(), "run r.toml --out b --quiet").code, Some(0));
    assert_eq!(read("a/projections.csv"), read("b/projections.csv"));
    let again: shearbed::Scene = serde_json::from_value(record["scene"].clone()).unwrap();
    assert_eq!(again.particles.aspect_ratio, found);
    for (change, said) in [
        (format!("aspect_ratio = 3\n{cylinder}"), "c.toml:7: particles.aspect_ratio = 3 is not allowed: either"),
        (String::new(), "c.toml:4: particles.aspect_ratio is missing: expected a number from"),
        (
            "physical_aspect_ratio = 20".into(),
            "particles.shape_correlation is missing: physical_aspect_ratio = 20 takes \"gold",
        ),
        ("shape_correlation = \"cox\"".into(), "particles.aspect_ratio is missing"),
        (
            "aspect_ratio = 3\nshape_correlation = \"cox\"".into(),
            "particles.shape_correlation = \"cox\" is not allowed: it goes with",
        ),
        (cylinder.replace("20", "1.5"), "particles.physical_aspect_ratio = 1.5 is not allowed: expected a number from"),
        (
            cylinder.replace("20", "3"),
            "particles.physical_aspect_ratio = 3 is not allowed: Cox 1971 (1.24 r/√(ln r)) gives no",
        ),
        (
            cylinder.replace("cox", "coxx"),
            "particles.shape_correlation = \"coxx\" is not allowed: expected \"goldsmith-mason\", \"cox\", ",
        ),
    ] {
        fs::write(dir.path().join("c.toml"), SMALL.replace("aspect_ratio = 11.6", &change)).unwrap();
        let done = shearbed(dir.path(), "plan c.toml");
        assert_eq!(done.code, Some(2), "{change}");
        assert!(done.stderr.contains(said), "{change}: {}", done.stderr);
    }
}
