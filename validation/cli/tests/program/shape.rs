//! `shearbed shape` as a user meets it.

use crate::common::{SMALL, folder};

#[test]
fn a_cylinder_is_given_by_its_own_aspect_ratio_and_a_formula() {
    let dir = folder();
    let cylinder = "physical_aspect_ratio = 20\nshape_correlation = \"cox\"";
    dir.write("c.toml", SMALL.replace("aspect_ratio = 11.6", cylinder));
    let plan = dir.runs("plan c.toml").stdout;
    // 24.8/√(ln 20) = 14.32850.
    assert!(plan.contains("r_e = 14.3285 (Cox 1971: 1.24 r/√(ln r))"), "{plan}");
    dir.runs("run c.toml --out a --quiet");
    let record = dir.json("a/run.json");
    let r_e = 24.8 / 20f64.ln().sqrt();
    let observed = record["facts"]["equivalent"]["aspect_ratio"].as_f64().unwrap();
    assert!((observed - r_e).abs() < 1e-14);
    let particles = &record["scene"]["particles"];
    assert_eq!(particles["physical_aspect_ratio"], 20.0);
    assert!(particles["aspect_ratio"].is_null());
    // The same scene by its r_e has the same bits, and so has that of run.json.
    dir.write("r.toml", SMALL.replace("11.6", &format!("{observed:?}")));
    dir.runs("run r.toml --out b --quiet");
    assert_eq!(dir.read("a/projections.csv"), dir.read("b/projections.csv"));
    let again: shearbed::Scene = serde_json::from_value(record["scene"].clone()).unwrap();
    assert_eq!(again.particles.aspect_ratio, observed);
}
