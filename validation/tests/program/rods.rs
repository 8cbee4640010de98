//! Every rod out, and rods in, as a user meets them.

use crate::common::{SMALL, folder, shearbed};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

const COLUMNS: &str = "replica,rod,time_s,strain,aspect_ratio,x1_mm,x2_mm,x3_mm,p1,p2,p3,collided";

/// The rows of a table, by the names of its columns.
fn rows(path: &Path) -> Vec<BTreeMap<String, String>> {
    let mut reader = csv::Reader::from_path(path).unwrap();
    reader.deserialize().map(Result::unwrap).collect()
}

fn number(row: &BTreeMap<String, String>, name: &str) -> f64 {
    row[name].parse().unwrap()
}

/// The scene with every rod at three times.
fn asked() -> String {
    SMALL.replace("[output]", "[output]\nrods_at = [0, 0.5, 1]")
}

fn free(text: &str) -> String {
    text.replace("[interaction]\nconcentration_per_cm3 = 50\nalpha = 0.5\n", "")
        .replace("steps_per_period = 200\n", "")
}

#[test]
fn every_rod_has_a_row_with_its_place_in_the_volume() {
    let dir = folder();
    fs::write(dir.path().join("asked.toml"), asked()).unwrap();
    let done = shearbed(dir.path(), "run asked.toml --out a --quiet");
    assert_eq!(done.code, Some(0), "{}", done.stderr);
    let path = dir.path().join("a/rods.csv");
    assert!(
        fs::read_to_string(&path)
            .unwrap()
            .starts_with(&format!("{COLUMNS}\n"))
    );
    let rows = rows(&path);
    assert_eq!(rows.len(), 3 * 3 * 20);
    // (20/50 per cm³)^⅓ in mm, and T = 2π(r_e + 1/r_e)/G.
    let side_mm = 10.0 * 0.4f64.cbrt();
    let period_s = std::f64::consts::TAU * (11.6 + 1.0 / 11.6) / 0.5;
    for (k, row) in rows.iter().enumerate() {
        let (replica, time, rod) = (k / 60, k / 20 % 3, k % 20);
        assert_eq!(
            (number(row, "replica"), number(row, "rod")),
            (replica as f64, rod as f64)
        );
        let time_s = 0.5 * time as f64 * period_s;
        assert!((number(row, "time_s") - time_s).abs() < 1e-12 * period_s);
        assert!((number(row, "strain") - 0.5 * time_s).abs() < 1e-12 * period_s);
        assert_eq!(number(row, "aspect_ratio"), 11.6);
        for axis in ["x1_mm", "x2_mm", "x3_mm"] {
            assert!((0.0..=side_mm).contains(&number(row, axis)), "{row:?}");
        }
        let square: f64 = ["p1", "p2", "p3"].iter().map(|p| number(row, p).powi(2)).sum();
        assert!((square - 1.0).abs() < 1e-14);
        assert!(["0", "1"].contains(&row["collided"].as_str()) && (time > 0 || row["collided"] == "0"));
    }
    // The other tables have the bytes that they have without.
    assert_eq!(
        shearbed(dir.path(), "run small.toml --out b --quiet").code,
        Some(0)
    );
    for name in ["projections.csv", "mean_angle.csv"] {
        let read = |run: &str| fs::read(dir.path().join(run).join(name)).unwrap();
        assert_eq!(read("a"), read("b"));
    }
    assert!(!dir.path().join("b/rods.csv").exists());
    let plan = shearbed(dir.path(), "plan asked.toml").stdout;
    let bytes = fs::metadata(&path).unwrap().len() as f64;
    let line = plan
        .lines()
        .find(|line| line.starts_with("rods.csv: 180 rows, at most "))
        .unwrap();
    let most: f64 = line.split(' ').nth(5).unwrap().parse().unwrap();
    assert!(
        bytes <= 1e6 * most + 5e3 && bytes > 0.3e6 * most,
        "{bytes} of {line}"
    );
}

#[test]
fn free_rods_have_no_place() {
    let dir = folder();
    fs::write(dir.path().join("free.toml"), free(&asked())).unwrap();
    let done = shearbed(dir.path(), "run free.toml --out a --vtk --quiet");
    assert_eq!(done.code, Some(0), "{}", done.stderr);
    let rows = rows(&dir.path().join("a/rods.csv"));
    assert_eq!(rows.len(), 180);
    for row in &rows {
        assert!(
            ["x1_mm", "x2_mm", "x3_mm"]
                .iter()
                .all(|axis| row[*axis].is_empty())
        );
        assert_eq!(row["collided"], "0");
    }
}

/// What stands between the tags of an array.
fn array(text: &str, name: &str) -> Vec<f64> {
    let start = text.find(&format!("Name=\"{name}\"")).unwrap();
    let values = text[start..]
        .split_once('>')
        .unwrap()
        .1
        .split_once('<')
        .unwrap()
        .0;
    values
        .split_whitespace()
        .map(|value| value.parse().unwrap())
        .collect()
}

#[test]
fn lines_for_paraview_are_the_rows_of_the_table() {
    let dir = folder();
    fs::write(dir.path().join("asked.toml"), asked()).unwrap();
    assert_eq!(
        shearbed(dir.path(), "run asked.toml --out a --vtk --quiet").code,
        Some(0)
    );
    let read = |name: &str| fs::read_to_string(dir.path().join("a").join(name)).unwrap();
    let rows = rows(&dir.path().join("a/rods.csv"));
    let collection = read("rods.pvd");
    for time in 0..3 {
        let name = format!("rods_{time:04}.vtp");
        let own: Vec<_> = (0..180)
            .filter(|k| k / 20 % 3 == time)
            .map(|k| &rows[k])
            .collect();
        let listed = format!(
            "<DataSet timestep=\"{}\" part=\"0\" file=\"{name}\"/>",
            own[0]["time_s"]
        );
        assert!(collection.contains(&listed), "{collection}");
        let text = read(&name);
        assert!(text.contains("NumberOfPoints=\"120\"") && text.contains("NumberOfLines=\"60\""));
        let (ends, p) = (array(&text, "ends_mm"), array(&text, "p"));
        let (collided, r) = (array(&text, "collided"), array(&text, "aspect_ratio"));
        let counting: Vec<f64> = (0..120).map(f64::from).collect();
        assert_eq!(array(&text, "connectivity"), counting);
        assert_eq!(
            array(&text, "offsets"),
            (1..=60).map(|k| 2.0 * f64::from(k)).collect::<Vec<_>>()
        );
        for (k, row) in own.iter().enumerate() {
            for (axis, (x, p_name)) in [("x1_mm", "p1"), ("x2_mm", "p2"), ("x3_mm", "p3")]
                .iter()
                .enumerate()
            {
                let (tail, head) = (ends[6 * k + axis], ends[6 * k + 3 + axis]);
                assert!((0.5 * (tail + head) - number(row, x)).abs() < 1e-14 * 10.0);
                assert!((head - tail - 0.72 * number(row, p_name)).abs() < 1e-14 * 10.0);
                assert_eq!(p[3 * k + axis], number(row, p_name));
            }
            assert_eq!((collided[k], r[k]), (number(row, "collided"), 11.6));
        }
    }
    assert!(!dir.path().join("a/rods_0003.vtp").exists());
    // A run without them leaves none that would pass for its own.
    assert_eq!(
        shearbed(dir.path(), "run asked.toml --out a --quiet --force").code,
        Some(0)
    );
    assert!(!dir.path().join("a/rods.pvd").exists());
}

#[test]
fn what_cannot_be_written_is_refused_by_its_key() {
    let dir = folder();
    let refused = |text: &str, arguments: &str, said: &str| {
        fs::write(dir.path().join("s.toml"), text).unwrap();
        let done = shearbed(dir.path(), arguments);
        assert_eq!(done.code, Some(2), "{arguments}: {}", done.stdout);
        assert!(done.stderr.contains(said), "{}", done.stderr);
    };
    refused(
        SMALL,
        "run s.toml --vtk",
        "s.toml: --vtk: output.rods_at is missing",
    );
    refused(
        &asked(),
        "sweep s.toml --over particles.count=2,3",
        "s.toml: output.rods_at: a sweep keeps no rods",
    );
    let many = asked()
        .replace("count = 20", "count = 100000")
        .replace("replicas = 3", "replicas = 10000000");
    refused(
        &many,
        "run s.toml",
        "output.rods_at = [0.0, 0.5, 1.0]: 3 times of 100000 rods in each of 10000000",
    );
    refused(&many, "plan s.toml", "output.rods_at = ");
    assert!(!dir.path().join("out").exists());
}

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
            done.code == Some(2) && done.stderr.contains("another run is kept here"),
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
