//! `bench` and `converge` as a user meets them: exit codes, messages and files.

use crate::common::{Ended, FREE, names, read, shearbed};

#[test]
fn an_unknown_bench_is_refused_with_those_there_are() {
    let dir = tempfile::tempdir().unwrap();
    let Ended { code, stderr: error, .. } = shearbed(dir.path(), "bench --case re3");
    assert_eq!(code, Some(2));
    for text in ["--case re3", "re2, re11.6, re100, re10000, fig6-uniform, fig6-polydisperse, fig7-n50"] {
        assert!(error.contains(text), "{error}");
    }
    assert!(!dir.path().join("out").exists());
}

#[test]
fn a_bench_goes_on_from_its_checkpoint() {
    let dir = tempfile::tempdir().unwrap();
    let bench = |out: &str| {
        let ended = shearbed(dir.path(), &format!("bench --case re2 --checkpoint kept --out {out}"));
        assert_eq!(ended.code, Some(0), "{}", ended.stderr);
        ended.stdout
    };
    assert!(!bench("first").contains("goes on"));
    assert!(bench("again").starts_with("goes on from kept: finished studies: 1\n"));
    // Run times too: nothing was measured again.
    let files = |out: &str| -> Vec<_> {
        let dir = dir.path().join(out);
        let written = names(&dir).into_iter().filter(|name| name != "shearbed.json");
        written.map(|name| (read(&dir.join(&name)), name)).collect()
    };
    assert!(files("first") == files("again") && !files("first").is_empty());
    let other = shearbed(dir.path(), "bench --case speed --checkpoint kept");
    assert!(other.code == Some(2) && other.stderr.contains("is of other work"), "{}", other.stderr);
}

#[test]
fn a_free_scene_shows_every_order_as_theory() {
    let dir = tempfile::tempdir().unwrap();
    std::fs::write(dir.path().join("free.toml"), FREE).unwrap();
    let Ended { code, stdout: text, stderr: error } = shearbed(dir.path(), "converge free.toml");
    assert_eq!(code, Some(0), "{error}");
    assert_eq!(text.matches("as theory").count(), 7, "{text}");
    let out = dir.path().join("out/converge-free");
    let csv = std::fs::read_to_string(out.join("converge.csv")).unwrap();
    assert_eq!(csv.lines().count(), 1 + 7 * 13, "{csv}");
    assert!(out.join("converge.json").exists());
    assert!(text.replace("\n  ", " ").contains("as the scene draws its starts at random"), "{text}");
}

#[test]
fn a_free_scene_starts_where_it_says() {
    let dir = tempfile::tempdir().unwrap();
    let scene = |time: &str| {
        format!(
            "title = \"one rod\"\n[flow]\nshear_rate_per_s = 0.5\n[particles]\ncount = 1\nlength_mm = 1\n\
             aspect_ratio = 3\norientation = {{ phi_deg = 10, theta_deg = 60 }}\n[time]\n{time}\n"
        )
    };
    std::fs::write(dir.path().join("one.toml"), scene("periods = 2")).unwrap();
    let Ended { code, stdout: text, stderr: error } = shearbed(dir.path(), "converge one.toml");
    assert_eq!(code, Some(0), "{error}");
    assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
    let text = text.replace("\n  ", " ");
    for words in ["r_e = 3 from φ = 0.1745 and θ = 1.0472 rad (the scene's own start) over 2.", "as theory"] {
        assert!(text.contains(words), "{text}");
    }
    std::fs::write(dir.path().join("strain.toml"), scene("strain = 2")).unwrap();
    let Ended { code, stderr: error, .. } = shearbed(dir.path(), "converge strain.toml");
    assert_eq!(code, Some(2));
    assert!(error.contains("time: converge compares integrators of free rods over periods; give periods"), "{error}");
}

#[test]
fn a_free_scene_in_another_flow_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    let Ended { code, stderr: error, .. } = shearbed(dir.path(), "converge extension");
    assert_eq!(code, Some(2));
    assert!(error.contains("extension: flow:") && error.contains("shear_rate_per_s"), "{error}");
}

#[test]
fn an_interacting_scene_shows_steps_rods_and_replicas() {
    let dir = tempfile::tempdir().unwrap();
    let Ended { code, stdout: text, stderr: error } = shearbed(dir.path(), "converge fig4-n50 --replicas 4 --out here");
    assert_eq!(code, Some(0), "{error}");
    for head in ["steps per period", "rods", "Paths do not converge", "not readable"] {
        assert!(text.contains(head), "{text}");
    }
    // Nothing is said by an empty table.
    assert!(!text.contains("deviation √M"), "{text}");
    assert!(!text.contains("cheapest"), "four replicas are too few to judge a bias by: {text}");
    let here = dir.path().join("here");
    let csv = std::fs::read_to_string(here.join("converge.csv")).unwrap();
    assert!(
        csv.starts_with("against,steps_per_period,rods,replicas,x1,x1_se,x1_less_next,x1_less_next_se,correlation,"),
        "{csv}"
    );
    // Ten numbers of steps, and six of rods of which the scene's own is run once and listed in both.
    assert_eq!(csv.lines().count(), 1 + 10 + 6, "{csv}");
    assert!(here.join("replicas.csv").exists());
    let json: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(here.join("converge.json")).unwrap()).unwrap();
    assert_eq!(json["law"]["steps"][9]["steps_per_period"], 12_800);
    assert!(json["constants"].is_null() && json["splits"].as_array().unwrap().is_empty());
}
