//! Ranks that were given different things: refused before anything runs, with the rank and the key.

use super::ended::shearbed;
use crate::common::{SMALL, folder};
use std::fs;
use std::path::Path;

/// A job whose ranks run these commands; its exit code and messages.
fn job(dir: &Path, ranks: &[&str]) -> (Option<i32>, String) {
    let ranks: Vec<_> = ranks.iter().map(|command| format!("-n 1 shearbed {command}")).collect();
    shearbed(dir, &ranks.join(" : "))
}

#[test]
fn another_input_is_told_before_anything_runs() {
    let dir = folder();
    let other = SMALL.replace("[\"projections\", \"mean_angle\"]", "[\"orbit_constant\"]");
    fs::write(dir.path().join("observables.toml"), other).unwrap();
    fs::write(dir.path().join("count.toml"), SMALL.replace("count = 20", "count = 21")).unwrap();
    let run = "run small.toml --out x";
    let sweep = "sweep small.toml --over interaction.alpha=1,2 --out x";
    for (root, other, key) in [
        (run, "run small.toml --out x --seed 2", "scene.ensemble.seed is 2 there and 1"),
        (run, "run small.toml --out x --replicas 7", "scene.ensemble.replicas is 7 there and 3"),
        (run, "run count.toml --out x", "scene.particles.count is 21 there and 20"),
        (run, "run observables.toml --out x", "scene.output.observables is [\"orbit_constant\"] there"),
        (run, "plan small.toml", "command is \"plan\" there and \"run\""),
        (run, "scenes", "command is \"scenes\" there and \"run\""),
        (run, sweep, "command is \"sweep\" there and \"run\""),
        ("plan small.toml", run, "command is \"run\" there and \"plan\""),
        (sweep, "sweep small.toml --over interaction.alpha=1,3 --out x", "over.1.values.2 is 3 there"),
        (sweep, "sweep small.toml --over interaction.m=1,2 --out x", "over.1.key is \"interaction.m\" there"),
        (sweep, "sweep small.toml --over interaction.alpha=1,2 --seed 9 --out x", "scene.ensemble.seed is 9 there"),
        (
            "converge small.toml --replicas 4 --out x",
            "converge small.toml --replicas 5 --out x",
            "replicas is 5 there and 4",
        ),
        (
            "validate --case jeffery-period --out x",
            "validate --case jeffery-period --full --out x",
            "full is true there and false",
        ),
        (
            "validate --case jeffery-period --out x",
            "validate --case contact-rule --out x",
            "cases.1 is \"contact-rule\" there",
        ),
    ] {
        let (code, message) = job(dir.path(), &[root, root, other]);
        assert_eq!(code, Some(2), "{root} / {other}: {message}");
        let expected = format!("error: rank 0 of 3: rank 2 has another input: {key}");
        assert!(message.contains(&expected), "{expected}: {message}");
        assert_eq!(message.matches("error: rank").count(), 1, "{message}");
        assert!(!dir.path().join("x").exists(), "{root} / {other}");
    }
}

#[test]
fn what_results_do_not_depend_on_may_differ() {
    let dir = folder();
    let (code, message) = job(dir.path(), &["run small.toml --out x", "run small.toml --out y --threads 1 --quiet"]);
    assert_eq!(code, Some(0), "{message}");
    assert!(dir.path().join("x/run.json").exists() && !dir.path().join("y").exists());
}
