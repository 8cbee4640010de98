//! Every rod out, and rods in, as a user meets them.

mod starts;

use crate::common::{SMALL, folder, shearbed};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

const COLUMNS: &str = "replica,rod,time_s,strain,aspect_ratio,length_mm,x1_mm,x2_mm,x3_mm,p1,p2,p3,collided";

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
    text.replace("[interaction]\nconcentration_per_cm3 = 50\nalpha = 0.5\n", "").replace("steps_per_period = 200\n", "")
}

#[test]
fn every_rod_has_a_row_with_its_place_in_the_volume() {
    let dir = folder();
    dir.write("asked.toml", asked());
    dir.runs("run asked.toml --out a --quiet");
    let path = dir.at("a/rods.csv");
    assert!(fs::read_to_string(&path).unwrap().starts_with(&format!("{COLUMNS}\n")));
    let rows = rows(&path);
    assert_eq!(rows.len(), 3 * 3 * 20);
    // (20/50 per cm³)^⅓ in mm, and T = 2π(r_e + 1/r_e)/G.
    let side_mm = 10.0 * 0.4f64.cbrt();
    let period_s = std::f64::consts::TAU * (11.6 + 1.0 / 11.6) / 0.5;
    for (k, row) in rows.iter().enumerate() {
        let (replica, time, rod) = (k / 60, k / 20 % 3, k % 20);
        assert_eq!((number(row, "replica"), number(row, "rod")), (replica as f64, rod as f64));
        let time_s = 0.5 * time as f64 * period_s;
        assert!((number(row, "time_s") - time_s).abs() < 1e-12 * period_s);
        assert!((number(row, "strain") - 0.5 * time_s).abs() < 1e-12 * period_s);
        assert_eq!((number(row, "aspect_ratio"), number(row, "length_mm")), (11.6, 0.72));
        for axis in ["x1_mm", "x2_mm", "x3_mm"] {
            assert!((0.0..=side_mm).contains(&number(row, axis)), "{row:?}");
        }
        let square: f64 = ["p1", "p2", "p3"].iter().map(|p| number(row, p).powi(2)).sum();
        assert!((square - 1.0).abs() < 1e-14);
        assert!(["0", "1"].contains(&row["collided"].as_str()) && (time > 0 || row["collided"] == "0"));
    }
    // The other tables have the bytes that they have without.
    dir.runs("run small.toml --out b --quiet");
    for name in ["projections.csv", "mean_angle.csv"] {
        let read = |run: &str| fs::read(dir.path().join(run).join(name)).unwrap();
        assert_eq!(read("a"), read("b"));
    }
    assert!(!dir.at("b/rods.csv").exists());
    let plan = shearbed(dir.path(), "plan asked.toml").stdout;
    let bytes = fs::metadata(&path).unwrap().len() as f64;
    let line = plan.lines().find(|line| line.starts_with("rods.csv: 180 rows, at most ")).unwrap();
    let most: f64 = line.split(' ').nth(5).unwrap().parse().unwrap();
    assert!(bytes <= 1e6 * most + 5e3 && bytes > 0.3e6 * most, "{bytes} of {line}");
}

#[test]
fn free_rods_have_no_place() {
    let dir = folder();
    dir.write("free.toml", free(&asked()));
    dir.runs("run free.toml --out a --vtk --quiet");
    let rows = rows(&dir.at("a/rods.csv"));
    assert_eq!(rows.len(), 180);
    for row in &rows {
        assert!(["x1_mm", "x2_mm", "x3_mm"].iter().all(|axis| row[*axis].is_empty()));
        assert_eq!(row["collided"], "0");
    }
}

/// What stands between the tags of an array.
fn array(text: &str, name: &str) -> Vec<f64> {
    let start = text.find(&format!("Name=\"{name}\"")).unwrap();
    let values = text[start..].split_once('>').unwrap().1.split_once('<').unwrap().0;
    values.split_whitespace().map(|value| value.parse().unwrap()).collect()
}

#[test]
fn lines_for_paraview_are_the_rows_of_the_table() {
    let dir = folder();
    dir.write("asked.toml", asked());
    dir.runs("run asked.toml --out a --vtk --quiet");
    let read = |name: &str| fs::read_to_string(dir.at("a").join(name)).unwrap();
    let rows = rows(&dir.at("a/rods.csv"));
    let collection = read("rods.pvd");
    assert_eq!(collection.matches("<DataSet").count(), 9);
    for (time, replica) in (0..9).map(|k| (k / 3, k % 3)) {
        let name = format!("rods_{time:04}_replica_{replica}.vtp");
        let own = |k: &usize| k / 20 % 3 == time && k / 60 == replica;
        let own: Vec<_> = (0..180).filter(own).map(|k| &rows[k]).collect();
        let listed = format!("<DataSet timestep=\"{}\" part=\"{replica}\" file=\"{name}\"/>", own[0]["time_s"]);
        assert!(collection.contains(&listed), "{collection}");
        let text = read(&name);
        assert!(text.contains("NumberOfPoints=\"40\"") && text.contains("NumberOfLines=\"20\""));
        let (ends, p) = (array(&text, "ends_mm"), array(&text, "p"));
        let (collided, r) = (array(&text, "collided"), array(&text, "aspect_ratio"));
        let counting: Vec<f64> = (0..40).map(f64::from).collect();
        assert_eq!(array(&text, "connectivity"), counting);
        assert_eq!(array(&text, "offsets"), (1..=20).map(|k| 2.0 * f64::from(k)).collect::<Vec<_>>());
        for (k, row) in own.iter().enumerate() {
            for (axis, (x, p_name)) in [("x1_mm", "p1"), ("x2_mm", "p2"), ("x3_mm", "p3")].iter().enumerate() {
                let (tail, head) = (ends[6 * k + axis], ends[6 * k + 3 + axis]);
                assert!((0.5 * (tail + head) - number(row, x)).abs() < 1e-14 * 10.0);
                assert!((head - tail - 0.72 * number(row, p_name)).abs() < 1e-14 * 10.0);
                assert_eq!(p[3 * k + axis], number(row, p_name));
            }
            assert_eq!((collided[k], r[k]), (number(row, "collided"), 11.6));
        }
    }
    assert!(!dir.at("a/rods_0003_replica_0.vtp").exists());
    // Of one replica the files have no number of it.
    let one = "run asked.toml --out a --vtk --quiet --force --replicas 1";
    dir.runs(one);
    assert!(dir.at("a/rods_0002.vtp").exists());
    assert!(!dir.at("a/rods_0002_replica_0.vtp").exists());
    // A run without them leaves none that would pass for its own.
    dir.runs("run asked.toml --out a --quiet --force");
    assert!(!dir.at("a/rods.pvd").exists());
}

/// `rods_every` makes the rows that `rods_at` makes with the same times, and both together write a time once.
#[test]
fn every_kth_output_is_the_list_of_their_times() {
    let dir = folder();
    let table = |keys: &str| {
        dir.write("s.toml", SMALL.replace("[output]", &format!("[output]\n{keys}")));
        dir.runs("run s.toml --out a --quiet --force");
        fs::read(dir.at("a/rods.csv")).unwrap()
    };
    let listed = table("rods_at = [0, 0.5, 1]");
    assert_eq!(table("rods_every = 2"), listed);
    assert_eq!(table("rods_at = [0.5]\nrods_every = 2"), listed);
    assert_ne!(table("rods_at = [0.25]\nrods_every = 2"), listed);
    assert_ne!(table("rods_every = 3"), listed);
}
