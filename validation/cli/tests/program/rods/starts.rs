//! Rods that start as a file says.

use super::{asked, free, number, rows};
use crate::common::{folder, shearbed};
use std::fs;
use std::path::Path;

/// Free rods of one replica, from `start` on.
fn from(start: &str) -> String {
    let text = free(&asked()).replace("orientation = \"isotropic\"", start);
    text.replace("replicas = 3", "replicas = 1").replace("rods_at = [0, 0.5, 1]", "rods_at = [0.25, 0.75]")
}

/// The rows of one time as a file of its own.
fn one_time(from: &Path, to: &Path, first: usize) {
    let text = fs::read_to_string(from).unwrap();
    let lines: Vec<_> = text.lines().collect();
    fs::write(to, [&lines[..1], &lines[1 + first..21 + first]].concat().join("\n")).unwrap();
}

#[test]
fn rods_that_were_written_go_on_as_they_would_have() {
    for flow in ["shear_rate_per_s = 0.5", "gradient_per_s = [[0, 0, 0], [0.5, 0, 0.1], [0, 0, 0]]"] {
        let dir = folder();
        let at = |name: &str| dir.path().join(name);
        let with = |text: String| text.replace("shear_rate_per_s = 0.5", flow);
        fs::write(at("whole.toml"), with(from("orientation = \"isotropic\""))).unwrap();
        assert_eq!(shearbed(dir.path(), "run whole.toml --out whole --quiet").code, Some(0));
        one_time(&at("whole/rods.csv"), &at("start.csv"), 0);
        let rest = with(from("rods = { file = \"start.csv\" }")).replace("[0.25, 0.75]", "[0, 0.5]");
        fs::write(at("rest.toml"), &rest).unwrap();
        let done = shearbed(dir.path(), "run rest.toml --out rest --quiet");
        assert_eq!(done.code, Some(0), "{}", done.stderr);
        let (whole, rest_rows) = (rows(&at("whole/rods.csv")), rows(&at("rest/rods.csv")));
        for (a, b) in whole.iter().zip(&rest_rows) {
            for p in ["p1", "p2", "p3"] {
                // A start is rounded, and half a turn magnifies that by r_e² at most.
                assert!((number(a, p) - number(b, p)).abs() < 135.0 * 4.0 * f64::EPSILON, "{a:?} {b:?}");
            }
        }
        // What was run can be run again: run.json has the file's digest, and another file is refused.
        let record: serde_json::Value =
            serde_json::from_str(&fs::read_to_string(at("rest/run.json")).unwrap()).unwrap();
        let rods = &record["scene"]["particles"]["rods"];
        assert_eq!(rods["file"], "start.csv");
        let digest = rods["crc32"].as_str().unwrap();
        let pinned = rest.replace("\"start.csv\" }", &format!("\"start.csv\", crc32 = \"{digest}\" }}"));
        fs::write(at("rest.toml"), pinned).unwrap();
        assert_eq!(shearbed(dir.path(), "run rest.toml --out rest --quiet").code, Some(0));
        one_time(&at("whole/rods.csv"), &at("start.csv"), 20);
        let done = shearbed(dir.path(), "run rest.toml --out rest --quiet");
        assert_eq!(done.code, Some(2));
        assert!(done.stderr.contains("rest.toml: particles.rods: start.csv: has crc32 = "), "{}", done.stderr);
        // Without the digest in the scene the run says that its start is another one.
        fs::write(at("rest.toml"), &rest).unwrap();
        let done = shearbed(dir.path(), "run rest.toml --out rest");
        assert_eq!(done.code, Some(0), "{}", done.stderr);
        let said = "(replaced an earlier run: scene.particles.rods.crc32 was";
        assert!(done.stdout.contains(said), "{}", done.stdout);
    }
}

#[test]
fn a_sweep_starts_from_a_file_and_knows_it_again() {
    let dir = folder();
    let at = |name: &str| dir.path().join(name);
    fs::create_dir(at("below")).unwrap();
    fs::write(at("all.toml"), free(&asked())).unwrap();
    assert_eq!(shearbed(dir.path(), "run all.toml --out all --quiet").code, Some(0));
    one_time(&at("all/rods.csv"), &at("below/start.csv"), 0);
    let scene = from("rods = { file = \"start.csv\" }").replace("rods_at = [0.25, 0.75]\n", "");
    fs::write(at("below/s.toml"), &scene).unwrap();
    // The file has the r_e of each rod.
    let done = shearbed(dir.path(), "plan below/s.toml --set particles.aspect_ratio=5");
    let words = "the rods in particles.rods have a mean of 11.6000";
    assert!(done.stdout.contains(words), "{}", done.stdout);
    let sweep = "sweep below/s.toml --over flow.shear_rate_per_s=0.5,1 --out x --quiet";
    assert_eq!(shearbed(dir.path(), sweep).code, Some(0));
    assert_eq!(shearbed(dir.path(), "run below/s.toml --out one --quiet").code, Some(0));
    let one = fs::read_to_string(at("one/projections.csv")).unwrap();
    assert_eq!(fs::read_to_string(at("x/points/1/projections.csv")).unwrap(), one);
    // Another start is another sweep.
    one_time(&at("all/rods.csv"), &at("below/start.csv"), 20);
    let done = shearbed(dir.path(), sweep);
    assert!(done.code == Some(2) && done.stderr.contains("rods.crc32 was"), "{}", done.stderr);
}

#[test]
fn a_start_that_does_not_fit_is_refused_with_file_and_line() {
    let dir = folder();
    let refused = |start: &str, said: &str| {
        fs::write(dir.path().join("start.csv"), start).unwrap();
        fs::write(dir.path().join("s.toml"), from("rods = { file = \"start.csv\" }")).unwrap();
        for command in ["run s.toml", "plan s.toml", "sweep s.toml --over particles.length_mm=1,2"] {
            let done = shearbed(dir.path(), command);
            assert_eq!(done.code, Some(2), "{command}");
            assert!(done.stderr.contains(said), "{}", done.stderr);
        }
        assert!(!dir.path().join("out").exists());
    };
    let key = "s.toml: particles.rods: start.csv";
    refused("p1,p2,p3\n1,0,0\n", &format!("{key}: has 1 rows; as many as particles.count = 20"));
    refused("p1,p2,p3\n1,0,0\n1,1,0\n", &format!("{key}:3: p = (1, 1, 0) has length 1.414"));
    fs::write(dir.path().join("gone.toml"), from("rods = { file = \"gone.csv\" }")).unwrap();
    let done = shearbed(dir.path(), "plan gone.toml");
    assert!(done.code == Some(2) && done.stderr.contains("gone.csv: cannot be read"), "{}", done.stderr);
    // A whole file.
    let rods = "0,0,1\n".repeat(20);
    fs::write(dir.path().join("start.csv"), format!("p1,p2,p3\n{rods}")).unwrap();
    let planned = shearbed(dir.path(), "plan s.toml").stdout;
    assert!(planned.contains("every rod starts as in start.csv"), "{planned}");
}

/// An interacting suspension of unequal rods in a box, written and begun again: every rod is what and where it was.
#[test]
fn a_suspension_of_unequal_rods_begins_again_from_its_own_table() {
    let dir = folder();
    let at = |name: &str| dir.path().join(name);
    let unequal = asked()
        .replace("length_mm = 0.72", "length_mm = 0.72\nlength_sd_percent = 20")
        .replace("concentration_per_cm3 = 50", "box_mm = [10, 8, 5]")
        .replace("aspect_ratio = 11.6", "aspect_ratio = 11.6\naspect_ratio_sd_percent = 8.5")
        .replace("replicas = 3", "replicas = 1");
    fs::write(at("all.toml"), &unequal).unwrap();
    let done = shearbed(dir.path(), "run all.toml --out all --quiet --vtk");
    assert_eq!(done.code, Some(0), "{}", done.stderr);
    // The last of three times.
    one_time(&at("all/rods.csv"), &at("start.csv"), 40);
    let again = unequal.replace("orientation = \"isotropic\"", "rods = { file = \"start.csv\" }");
    fs::write(at("again.toml"), &again).unwrap();
    let done = shearbed(dir.path(), "run again.toml --out again --quiet");
    assert_eq!(done.code, Some(0), "{}", done.stderr);
    let (all, again) = (rows(&at("all/rods.csv")), rows(&at("again/rods.csv")));
    let (ended, begun) = (&all[40..], &again[..20]);
    let mut lengths = Vec::new();
    for (ended, begun) in ended.iter().zip(begun) {
        for (name, room) in
            [("aspect_ratio", 0.0), ("length_mm", 1e-15), ("x1_mm", 1e-14), ("x2_mm", 1e-14), ("x3_mm", 1e-14)]
        {
            let (a, b) = (number(ended, name), number(begun, name));
            assert!((a - b).abs() <= room * a.abs(), "{name}: {a} {b}");
        }
        for p in ["p1", "p2", "p3"] {
            assert!((number(ended, p) - number(begun, p)).abs() < 1e-14);
        }
        for (axis, side) in ["x1_mm", "x2_mm", "x3_mm"].iter().zip([10.0, 8.0, 5.0]) {
            assert!((0.0..=side).contains(&number(begun, axis)), "{begun:?}");
        }
        lengths.push(number(begun, "length_mm"));
    }
    lengths.sort_by(f64::total_cmp);
    lengths.dedup();
    assert_eq!(lengths.len(), 20);
    // Lines for ParaView are as long as their rods.
    let vtp = fs::read_to_string(at("all/rods_0002.vtp")).unwrap();
    let (ends, own) = (super::array(&vtp, "ends_mm"), super::array(&vtp, "length_mm"));
    for (rod, length) in own.iter().enumerate() {
        let [a, b] = [0, 3].map(|end| &ends[6 * rod + end..][..3]);
        let apart = a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
        assert!((apart / length - 1.0).abs() < 1e-12, "{apart} {length}");
    }
    // A place that the box does not have, and a concentration that it contradicts.
    for (from, to, said) in [
        ("[10, 8, 5]", "[10, 8, 1]", "again.toml: particles.rods: start.csv:"),
        ("box_mm", "concentration_per_cm3 = 60\nbox_mm", "20 rods in [10.0, 8.0, 5.0] mm are 50 per cm³"),
    ] {
        let text = fs::read_to_string(at("again.toml")).unwrap();
        fs::write(at("wrong.toml"), text.replace(from, to)).unwrap();
        let done = shearbed(dir.path(), "run wrong.toml --out wrong --quiet");
        let said = said.replace("again.toml", "wrong.toml");
        assert!(done.code == Some(2) && done.stderr.contains(&said), "{}", done.stderr);
        assert!(!at("wrong").exists());
    }
}

/// The concentration stays where the number of rods is changed: a box grows with it, as a cube does.
#[test]
fn other_numbers_of_rods_have_the_concentration_of_the_box() {
    let dir = folder();
    let at = |name: &str| dir.path().join(name);
    // 20 rods in 10 × 8 × 5 mm³ are 50 per cm³.
    let cube = asked().replace("rods_at = [0, 0.5, 1]", "rods_at = [0, 0.5]");
    for (name, interaction) in [
        ("box", "box_mm = [7.368062997280773, 7.368062997280773, 7.368062997280773]"),
        ("both", "concentration_per_cm3 = 50\nbox_mm = [7.368062997280773, 7.368062997280773, 7.368062997280773]"),
        ("cube", "concentration_per_cm3 = 50"),
    ] {
        fs::write(at(&format!("{name}.toml")), cube.replace("concentration_per_cm3 = 50", interaction)).unwrap();
        let done = shearbed(dir.path(), &format!("converge {name}.toml --replicas 2 --out {name} --quiet"));
        assert_eq!(done.code, Some(0), "{name}: {}", done.stderr);
    }
    // X̄₁ of each row. Collisions magnify a rounding of the side; another concentration would be off by 0.05 and more.
    let x1 = |name: &str| -> Vec<f64> {
        let rows = rows(&at(name).join("converge.csv"));
        rows.iter().map(|row| number(row, "x1")).collect()
    };
    for name in ["box", "both"] {
        let (found, expected) = (x1(name), x1("cube"));
        assert!(found.len() == expected.len() && found.len() > 8, "{found:?}");
        for (a, b) in found.iter().zip(&expected) {
            assert!((a - b).abs() < 0.03, "{name}: {found:?} {expected:?}");
        }
    }
}

#[test]
fn rods_at_a_face_and_results_beside_their_input() {
    let dir = folder();
    let at = |name: &str| dir.path().join(name);
    let scene = asked()
        .replace("count = 20", "count = 3")
        .replace("concentration_per_cm3 = 50", "box_mm = [3.1, 3.1, 3.1]")
        .replace("replicas = 3", "replicas = 1")
        .replace("orientation = \"isotropic\"", "rods = { file = \"rods.csv\" }");
    fs::write(at("s.toml"), &scene).unwrap();
    let first = "x1_mm,x2_mm,x3_mm\n3.1,1,1\n1,3.1,1\n2,2,3.1\n";
    fs::write(at("rods.csv"), first).unwrap();
    // 3.1/0.72 · 0.72 is more than 3.1.
    assert_eq!(shearbed(dir.path(), "run s.toml --out a --quiet").code, Some(0));
    let written = fs::read_to_string(at("a/rods.csv")).unwrap();
    let begun: Vec<_> = written.lines().take(4).collect();
    fs::write(at("rods.csv"), begun.join("\n")).unwrap();
    let again = shearbed(dir.path(), "run s.toml --out b --quiet");
    assert_eq!(again.code, Some(0), "{}", again.stderr);
    // By force too, what is read stays.
    let kept = fs::read(at("rods.csv")).unwrap();
    let done = shearbed(dir.path(), "run s.toml --out . --force --quiet");
    assert!(
        done.code == Some(2) && done.stderr.contains("rods.csv, which this command reads: choose another --out"),
        "{}",
        done.stderr
    );
    assert_eq!(fs::read(at("rods.csv")).unwrap(), kept);
    // Three rods in a corner of a large box; and keys that the file makes idle.
    let plan = |words: &str| shearbed(dir.path(), &format!("plan s.toml {words}")).stdout;
    fs::write(at("rods.csv"), "x1_mm,x2_mm,x3_mm,length_mm\n0.4,0.4,0.4,1\n".to_owned() + &"0.4,0.4,0.4,2\n".repeat(2))
        .unwrap();
    let told = plan("--set interaction.box_mm=[1000,10,10]");
    assert!(
        told.contains("reach only 0.4 of 1000 mm along axis 1: check that they belong to this control volume"),
        "{told}"
    );
    let told = plan("--set particles.length_sd_percent=5");
    assert!(told.contains("particles.length_sd_percent has no effect: particles.rods gives it for each rod"), "{told}");
    let told = plan("--set interaction.box_mm=[100,100,0.5]");
    assert!(told.contains("0.5 mm is less than a rod's length, 0.72 mm"), "{told}");
}

/// Replicas that start with the same directions: their scatter is not that of the rods.
#[test]
fn replicas_of_one_start_are_warned_of() {
    let dir = folder();
    let at = |name: &str| dir.path().join(name);
    fs::write(at("rods.csv"), "p1,p2,p3\n".to_owned() + &"1,0,0\n0,0,1\n".repeat(10)).unwrap();
    let start = ("orientation = \"isotropic\"", "rods = { file = \"rods.csv\" }");
    fs::write(at("collide.toml"), asked().replace(start.0, start.1)).unwrap();
    fs::write(at("free.toml"), free(&asked()).replace(start.0, start.1)).unwrap();
    let (scatter, alike) = ("leave out the scatter of these rods", "replicas are alike");
    for (words, said) in [
        ("collide.toml", [true, false]),
        ("free.toml --set particles.aspect_ratio_sd_percent=5", [true, false]),
        ("free.toml", [false, true]),
        ("collide.toml --set ensemble.replicas=1", [false; 2]),
        ("free.toml --set ensemble.replicas=1", [false; 2]),
    ] {
        let ended = shearbed(dir.path(), &format!("plan {words}"));
        assert_eq!(ended.code, Some(0), "{words}: {}", ended.stderr);
        let told = ended.stdout.replace("\n  ", " ");
        assert_eq!([scatter, alike].map(|words| told.contains(words)), said, "{words}: {told}");
    }
}
