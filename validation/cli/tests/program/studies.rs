//! `bench` and `converge` as a user meets them: exit codes, messages and files.

use crate::common::{FREE, empty_folder};

#[test]
fn a_bench_goes_on_from_its_checkpoint() {
    let dir = empty_folder();
    let bench = |out: &str| dir.runs(&format!("bench --case re2 --checkpoint kept --out {out}")).stdout;
    assert!(!bench("first").contains("goes on"));
    assert!(bench("again").starts_with("goes on from kept: finished studies: 1\n"));
    // Run times too: nothing was measured again.
    let files = |out: &str| {
        let mut files = dir.files(out);
        assert!(files.remove("shearbed.json").is_some() && !files.is_empty());
        files
    };
    assert!(files("first") == files("again"));
    dir.refuses("bench --case speed --checkpoint kept", "is of other work");
}

#[test]
fn a_free_scene_shows_every_order_as_theory() {
    let dir = empty_folder();
    dir.write("free.toml", FREE);
    let text = dir.runs("converge free.toml").stdout;
    assert_eq!(text.matches("as theory").count(), 7, "{text}");
    let csv = dir.read("out/converge-free/converge.csv");
    assert_eq!(csv.lines().count(), 1 + 7 * 13, "{csv}");
    assert!(dir.at("out/converge-free/converge.json").exists());
    assert!(text.replace("\n  ", " ").contains("as the scene draws its starts at random"), "{text}");
}

#[test]
fn a_free_scene_starts_where_it_says() {
    let dir = empty_folder();
    let start = "{ phi_deg = 10, theta_deg = 60 }";
    dir.write("one.toml", FREE.replace("\"isotropic\"", start).replace("periods = 1", "periods = 2"));
    let text = dir.runs("converge one.toml").stdout;
    assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
    let text = text.replace("\n  ", " ");
    for words in ["r_e = 3 from φ = 0.1745 and θ = 1.0472 rad (the scene's own start) over 2.", "as theory"] {
        assert!(text.contains(words), "{text}");
    }
}

#[test]
fn an_interacting_scene_shows_steps_rods_and_replicas() {
    let dir = empty_folder();
    let text = dir.runs("converge fig4-n50 --replicas 4 --out here").stdout;
    for head in ["steps per period", "rods", "Paths do not converge", "not readable"] {
        assert!(text.contains(head), "{text}");
    }
    // Nothing is said by an empty table.
    assert!(!text.contains("deviation √M"), "{text}");
    assert!(!text.contains("cheapest"), "four replicas are too few to judge a bias by: {text}");
    let csv = dir.read("here/converge.csv");
    let columns = "against,steps_per_period,rods,replicas,x1,x1_se,x1_less_next,x1_less_next_se,correlation,";
    assert!(csv.starts_with(columns), "{csv}");
    // Ten numbers of steps, and six of rods of which the scene's own is run once and listed in both.
    assert_eq!(csv.lines().count(), 1 + 10 + 6, "{csv}");
    assert!(dir.at("here/replicas.csv").exists());
    let json = dir.json("here/converge.json");
    assert_eq!(json["law"]["steps"][9]["steps_per_period"], 12_800);
    assert!(json["constants"].is_null() && json["splits"].as_array().unwrap().is_empty());
}
