//! Rods that start as a file says.

use super::{asked, free, number, rows};
use crate::common::{folder, shearbed};
use std::fs;
use std::path::Path;

/// Free rods of one replica, from `start` on.
fn from(start: &str) -> String {
    let text = free(&asked()).replace("orientation = \"isotropic\"", &format!("orientation = {start}"));
    text.replace("replicas = 3", "replicas = 1")
        .replace("rods_at = [0, 0.5, 1]", "rods_at = [0.25, 0.75]")
}

/// The rows of one time as a file of its own.
fn one_time(from: &Path, to: &Path, first: usize) {
    let text = fs::read_to_string(from).unwrap();
    let lines: Vec<_> = text.lines().collect();
    fs::write(
        to,
        [&lines[..1], &lines[1 + first..21 + first]].concat().join("\n"),
    )
    .unwrap();
}

#[test]
fn rods_that_were_written_go_on_as_they_would_have() {
    for flow in [
        "shear_rate_per_s = 0.5",
        "gradient_per_s = [[0, 0, 0], [0.5, 0, 0.1], [0, 0, 0]]",
    ] {
        let dir = folder();
        let at = |name: &str| dir.path().join(name);
        let with = |text: String| text.replace("shear_rate_per_s = 0.5", flow);
        fs::write(at("whole.toml"), with(from("\"isotropic\""))).unwrap();
        assert_eq!(
            shearbed(dir.path(), "run whole.toml --out whole --quiet").code,
            Some(0)
        );
        one_time(&at("whole/rods.csv"), &at("start.csv"), 0);
        let rest = with(from("{ file = \"start.csv\" }")).replace("[0.25, 0.75]", "[0, 0.5]");
        fs::write(at("rest.toml"), &rest).unwrap();
        let done = shearbed(dir.path(), "run rest.toml --out rest --quiet");
        assert_eq!(done.code, Some(0), "{}", done.stderr);
        let (whole, rest_rows) = (rows(&at("whole/rods.csv")), rows(&at("rest/rods.csv")));
        for (a, b) in whole.iter().zip(&rest_rows) {
            for p in ["p1", "p2", "p3"] {
                // A start is rounded, and half a turn magnifies that by r_e² at most.
                assert!(
                    (number(a, p) - number(b, p)).abs() < 135.0 * 4.0 * f64::EPSILON,
                    "{a:?} {b:?}"
                );
            }
        }
        // What was run can be run again: run.json has the file's digest, and another file is refused.
        let record: serde_json::Value =
            serde_json::from_str(&fs::read_to_string(at("rest/run.json")).unwrap()).unwrap();
        let orientation = &record["scene"]["particles"]["orientation"];
        assert_eq!(orientation["file"], "start.csv");
        let digest = orientation["crc32"].as_str().unwrap();
        let pinned = rest.replace(
            "\"start.csv\" }",
            &format!("\"start.csv\", crc32 = \"{digest}\" }}"),
        );
        fs::write(at("rest.toml"), pinned).unwrap();
        assert_eq!(
            shearbed(dir.path(), "run rest.toml --out rest --quiet").code,
            Some(0)
        );
        one_time(&at("whole/rods.csv"), &at("start.csv"), 20);
        let done = shearbed(dir.path(), "run rest.toml --out rest --quiet");
        assert_eq!(done.code, Some(2));
        assert!(
            done.stderr
                .contains("rest.toml: particles.orientation: start.csv: has crc32 = "),
            "{}",
            done.stderr
        );
        // Without the digest in the scene the folder tells that another run is kept there.
        fs::write(at("rest.toml"), &rest).unwrap();
        let done = shearbed(dir.path(), "run rest.toml --out rest --quiet");
        assert!(
            done.code == Some(2)
                && done
                    .stderr
                    .contains("results of `shearbed run` from other input are kept here"),
            "{}",
            done.stderr
        );
    }
}

#[test]
fn a_sweep_starts_from_a_file_and_knows_it_again() {
    let dir = folder();
    let at = |name: &str| dir.path().join(name);
    fs::create_dir(at("below")).unwrap();
    fs::write(at("all.toml"), free(&asked())).unwrap();
    assert_eq!(
        shearbed(dir.path(), "run all.toml --out all --quiet").code,
        Some(0)
    );
    one_time(&at("all/rods.csv"), &at("below/start.csv"), 0);
    let scene = from("{ file = \"start.csv\" }").replace("rods_at = [0.25, 0.75]\n", "");
    fs::write(at("below/s.toml"), &scene).unwrap();
    let sweep = "sweep below/s.toml --over particles.aspect_ratio=11.6,5 --out x --quiet";
    // The file has the first r_e in a column of its own.
    let done = shearbed(dir.path(), sweep);
    assert_eq!(done.code, Some(2));
    let words =
        "(point 2 of 2): particles.orientation: below/start.csv:2: aspect_ratio = 11.6 is not allowed";
    assert!(done.stderr.contains(words), "{}", done.stderr);
    let sweep = sweep.replace("particles.aspect_ratio=11.6,5", "flow.shear_rate_per_s=0.5,1");
    assert_eq!(shearbed(dir.path(), &sweep).code, Some(0));
    assert_eq!(
        shearbed(dir.path(), "run below/s.toml --out one --quiet").code,
        Some(0)
    );
    let one = fs::read_to_string(at("one/projections.csv")).unwrap();
    assert_eq!(fs::read_to_string(at("x/points/1/projections.csv")).unwrap(), one);
    // Another start is another sweep.
    one_time(&at("all/rods.csv"), &at("below/start.csv"), 20);
    let done = shearbed(dir.path(), &sweep);
    assert!(
        done.code == Some(2) && done.stderr.contains("orientation.crc32 was"),
        "{}",
        done.stderr
    );
}

#[test]
fn a_start_that_does_not_fit_is_refused_with_file_and_line() {
    let dir = folder();
    let refused = |start: &str, said: &str| {
        fs::write(dir.path().join("start.csv"), start).unwrap();
        fs::write(dir.path().join("s.toml"), from("{ file = \"start.csv\" }")).unwrap();
        for command in [
            "run s.toml",
            "plan s.toml",
            "sweep s.toml --over particles.length_mm=1,2",
        ] {
            let done = shearbed(dir.path(), command);
            assert_eq!(done.code, Some(2), "{command}");
            assert!(done.stderr.contains(said), "{}", done.stderr);
        }
        assert!(!dir.path().join("out").exists());
    };
    let key = "s.toml: particles.orientation: start.csv";
    refused(
        "p1,p2,p3\n1,0,0\n",
        &format!("{key}: has 1 rows; as many as particles.count = 20"),
    );
    refused(
        "p1,p2,p3\n1,0,0\n1,1,0\n",
        &format!("{key}:3: p = (1, 1, 0) has length 1.414"),
    );
    fs::write(dir.path().join("gone.toml"), from("{ file = \"gone.csv\" }")).unwrap();
    let done = shearbed(dir.path(), "plan gone.toml");
    assert!(
        done.code == Some(2) && done.stderr.contains("gone.csv: cannot be read"),
        "{}",
        done.stderr
    );
    // A whole file.
    let rods = "0,0,1\n".repeat(20);
    fs::write(dir.path().join("start.csv"), format!("p1,p2,p3\n{rods}")).unwrap();
    let planned = shearbed(dir.path(), "plan s.toml").stdout;
    assert!(planned.contains("every rod starts as in start.csv"), "{planned}");
}
