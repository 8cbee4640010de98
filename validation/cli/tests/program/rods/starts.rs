//! Rods that start as a file says.

use super::{asked, free, number, rows};
use crate::common::{Folder, folder};

/// Free rods of one replica, from `start` on.
fn from(start: &str) -> String {
    let text = free(&asked()).replace("orientation = \"isotropic\"", start);
    text.replace("replicas = 3", "replicas = 1").replace("rods_at = [0, 0.5, 1]", "rods_at = [0.25, 0.75]")
}

/// The rows of one time as a file of its own.
fn one_time(dir: &Folder, from: &str, to: &str, first: usize) {
    let text = dir.read(from);
    let lines: Vec<_> = text.lines().collect();
    dir.write(to, [&lines[..1], &lines[1 + first..21 + first]].concat().join("\n"));
}

#[test]
fn rods_that_were_written_go_on_as_they_would_have() {
    for flow in ["shear_rate_per_s = 0.5", "gradient_per_s = [[0, 0, 0], [0.5, 0, 0.1], [0, 0, 0]]"] {
        let dir = folder();
        let with = |text: String| text.replace("shear_rate_per_s = 0.5", flow);
        dir.write("whole.toml", with(from("orientation = \"isotropic\"")));
        dir.runs("run whole.toml --out whole --quiet");
        one_time(&dir, "whole/rods.csv", "start.csv", 0);
        let rest = with(from("rods = { file = \"start.csv\" }")).replace("[0.25, 0.75]", "[0, 0.5]");
        dir.write("rest.toml", &rest);
        dir.runs("run rest.toml --out rest --quiet");
        let (whole, rest_rows) = (rows(&dir.at("whole/rods.csv")), rows(&dir.at("rest/rods.csv")));
        for (a, b) in whole.iter().zip(&rest_rows) {
            for p in ["p1", "p2", "p3"] {
                // A start is rounded, and half a turn magnifies that by r_e² at most.
                assert!((number(a, p) - number(b, p)).abs() < 135.0 * 4.0 * f64::EPSILON, "{a:?} {b:?}");
            }
        }
        // What was run can be run again: run.json has the file's digest, and another file is refused.
        let rods = &dir.json("rest/run.json")["scene"]["particles"]["rods"];
        assert_eq!(rods["file"], "start.csv");
        let digest = rods["crc32"].as_str().unwrap();
        let pinned = rest.replace("\"start.csv\" }", &format!("\"start.csv\", crc32 = \"{digest}\" }}"));
        dir.write("rest.toml", pinned);
        dir.runs("run rest.toml --out rest --quiet");
        one_time(&dir, "whole/rods.csv", "start.csv", 20);
        dir.refuses("run rest.toml --out rest --quiet", "rest.toml: particles.rods: start.csv: has crc32 = ");
        // Without the digest in the scene the run says that its start is another one.
        dir.write("rest.toml", &rest);
        let done = dir.runs("run rest.toml --out rest");
        let said = "(replaced an earlier run: scene.particles.rods.crc32 was";
        assert!(done.stdout.contains(said), "{}", done.stdout);
    }
}

#[test]
fn a_sweep_starts_from_a_file_and_knows_it_again() {
    let dir = folder();
    dir.write("all.toml", free(&asked()));
    dir.runs("run all.toml --out all --quiet");
    one_time(&dir, "all/rods.csv", "below/start.csv", 0);
    let scene = from("rods = { file = \"start.csv\" }").replace("rods_at = [0.25, 0.75]\n", "");
    dir.write("below/s.toml", &scene);
    // The file has the r_e of each rod.
    let plan = dir.runs("plan below/s.toml --set particles.aspect_ratio=5").stdout;
    assert!(plan.contains("the rods in particles.rods have a mean of 11.6000"), "{plan}");
    let sweep = "sweep below/s.toml --over flow.shear_rate_per_s=0.5,1 --out x --quiet";
    dir.runs(sweep);
    dir.runs("run below/s.toml --out one --quiet");
    assert_eq!(dir.read("x/points/1/projections.csv"), dir.read("one/projections.csv"));
    // Another start is another sweep.
    one_time(&dir, "all/rods.csv", "below/start.csv", 20);
    dir.refuses(sweep, "rods.crc32 was");
}

/// An interacting suspension of unequal rods in a box, written and begun again: every rod is what and where it was.
#[test]
fn a_suspension_of_unequal_rods_begins_again_from_its_own_table() {
    let dir = folder();
    let unequal = asked()
        .replace("length_mm = 0.72", "length_mm = 0.72\nlength_sd_percent = 20")
        .replace("concentration_per_cm3 = 50", "box_mm = [10, 8, 5]")
        .replace("aspect_ratio = 11.6", "aspect_ratio = 11.6\naspect_ratio_sd_percent = 8.5")
        .replace("replicas = 3", "replicas = 1");
    dir.write("all.toml", &unequal);
    dir.runs("run all.toml --out all --quiet --vtk");
    // The last of three times.
    one_time(&dir, "all/rods.csv", "start.csv", 40);
    let again = unequal.replace("orientation = \"isotropic\"", "rods = { file = \"start.csv\" }");
    dir.write("again.toml", &again);
    dir.runs("run again.toml --out again --quiet");
    let (all, again) = (rows(&dir.at("all/rods.csv")), rows(&dir.at("again/rods.csv")));
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
    let vtp = dir.read("all/rods_0002.vtp");
    let (ends, own) = (super::array(&vtp, "ends_mm"), super::array(&vtp, "length_mm"));
    for (rod, length) in own.iter().enumerate() {
        let [a, b] = [0, 3].map(|end| &ends[6 * rod + end..][..3]);
        let apart = a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
        assert!((apart / length - 1.0).abs() < 1e-12, "{apart} {length}");
    }
    // A place that the box does not have, and a concentration that it contradicts.
    for (from, to, said) in [
        ("[10, 8, 5]", "[10, 8, 1]", "wrong.toml: particles.rods: start.csv:"),
        ("box_mm", "concentration_per_cm3 = 60\nbox_mm", "20 rods in [10.0, 8.0, 5.0] mm are 50 per cm³"),
    ] {
        dir.write("wrong.toml", dir.read("again.toml").replace(from, to));
        dir.refuses("run wrong.toml --out wrong --quiet", said);
    }
}

/// The concentration stays where the number of rods is changed: a box grows with it, as a cube does.
#[test]
fn other_numbers_of_rods_have_the_concentration_of_the_box() {
    let dir = folder();
    // 20 rods in 10 × 8 × 5 mm³ are 50 per cm³.
    let cube = asked().replace("rods_at = [0, 0.5, 1]", "rods_at = [0, 0.5]");
    for (name, interaction) in [
        ("box", "box_mm = [7.368062997280773, 7.368062997280773, 7.368062997280773]"),
        ("both", "concentration_per_cm3 = 50\nbox_mm = [7.368062997280773, 7.368062997280773, 7.368062997280773]"),
        ("cube", "concentration_per_cm3 = 50"),
    ] {
        dir.write(&format!("{name}.toml"), cube.replace("concentration_per_cm3 = 50", interaction));
        dir.runs(&format!("converge {name}.toml --replicas 2 --out {name} --quiet"));
    }
    // X̄₁ of each row. Collisions magnify a rounding of the side; another concentration would be off by 0.05 and more.
    let x1 = |name: &str| -> Vec<f64> {
        let rows = rows(&dir.at(name).join("converge.csv"));
        rows.iter().map(|row| number(row, "x1")).collect()
    };
    for name in ["box", "both"] {
        let (observed, expected) = (x1(name), x1("cube"));
        assert!(observed.len() == expected.len() && observed.len() > 8, "{observed:?}");
        for (a, b) in observed.iter().zip(&expected) {
            assert!((a - b).abs() < 0.03, "{name}: {observed:?} {expected:?}");
        }
    }
}

#[test]
fn rods_at_a_face_and_results_beside_their_input() {
    let dir = folder();
    let scene = asked()
        .replace("count = 20", "count = 3")
        .replace("concentration_per_cm3 = 50", "box_mm = [3.1, 3.1, 3.1]")
        .replace("replicas = 3", "replicas = 1")
        .replace("orientation = \"isotropic\"", "rods = { file = \"rods.csv\" }");
    dir.write("s.toml", &scene);
    let first = "x1_mm,x2_mm,x3_mm\n3.1,1,1\n1,3.1,1\n2,2,3.1\n";
    dir.write("rods.csv", first);
    // 3.1/0.72 · 0.72 is more than 3.1.
    dir.runs("run s.toml --out a --quiet");
    let written = dir.read("a/rods.csv");
    let begun: Vec<_> = written.lines().take(4).collect();
    dir.write("rods.csv", begun.join("\n"));
    dir.runs("run s.toml --out b --quiet");
    // By force too, what is read stays.
    dir.refuses("run s.toml --out . --force --quiet", "rods.csv, which this command reads: choose another --out");
    // Three rods in a corner of a large box; and keys that the file makes idle.
    let rows = "0.4,0.4,0.4,1\n0.4,0.4,0.4,2\n0.4,0.4,0.4,2\n";
    dir.write("rods.csv", format!("x1_mm,x2_mm,x3_mm,length_mm\n{rows}"));
    for (set, warning) in [
        (
            "interaction.box_mm=[1000,10,10]",
            "reach only 0.4 of 1000 mm along axis 1: check that they belong to this control volume",
        ),
        (
            "particles.length_sd_percent=5",
            "particles.length_sd_percent has no effect: particles.rods gives it for each rod",
        ),
        ("interaction.box_mm=[100,100,0.5]", "0.5 mm is less than a rod's length, 0.72 mm"),
    ] {
        let plan = dir.runs(&format!("plan s.toml --set {set}")).stdout;
        assert!(plan.contains(warning), "{plan}");
    }
}
