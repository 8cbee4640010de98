//! The program under `mpirun`: the bytes of one process, and an end for every failure. Built with the feature `mpi`
//! only; needs Open MPI's `mpirun`.

#![cfg(feature = "mpi")]

#[path = "../common/mod.rs"]
mod common;
mod ended;
mod input;

use crate::common::bounded::{Bounded, end};
use common::{UNEQUAL, files, kill, wait_for};
use ended::children;
use serde_json::{Value, json};
use shearbed_validation::present::report::passed;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use tempfile::TempDir;

const PROGRAM: &str = env!("CARGO_BIN_EXE_shearbed");

/// One rod in one replica: its standard errors are NaN.
const ONE: &str = r#"title = "One rod"
[flow]
shear_rate_per_s = 0.5
[particles]
count = 1
length_mm = 0.72
aspect_ratio = 11.6
orientation = { phi_deg = 10, theta_deg = 80 }
[time]
periods = 1
"#;

/// As many replicas as no number of ranks divides.
fn seven() -> String {
    UNEQUAL.replace("replicas = 3", "replicas = 7")
}

fn folder() -> TempDir {
    let dir = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(dir.path().join(name), text).unwrap();
    write("small.toml", &seven());
    write("one.toml", ONE);
    // Hours on one core, with a warning before the work: for jobs that are to fail on the way.
    let long = seven().replace("replicas = 7", "replicas = 10000000");
    write("long.toml", &long.replace("concentration_per_cm3 = 50", "concentration_per_cm3 = 5000"));
    dir
}

/// A job, on any number of cores, by root too.
fn mpirun(dir: &Path, arguments: &str) -> Command {
    let mut command = Command::new("mpirun");
    (command.args(arguments.split_whitespace().map(|word| if word == "shearbed" { PROGRAM } else { word })))
        .envs(["OMPI_ALLOW_RUN_AS_ROOT", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM"].map(|name| (name, "1")))
        .env("OMPI_MCA_rmaps_base_oversubscribe", "1")
        .current_dir(dir);
    command
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// Runs a command in one process, and on several ranks, each with `--out`; the folders' files.
fn both(dir: &Path, ranks: usize, arguments: &str) -> [BTreeMap<String, Vec<u8>>; 2] {
    let [alone, shared] = [in_one_process(dir, arguments), on_ranks(dir, ranks, arguments)];
    assert_eq!(shared.0, alone.0);
    [alone.1, shared.1]
}

fn in_one_process(dir: &Path, arguments: &str) -> (Vec<String>, BTreeMap<String, Vec<u8>>) {
    written(&mut common::command(dir, &format!("{arguments} --out alone --threads 2")), &dir.join("alone"))
}

fn on_ranks(dir: &Path, ranks: usize, arguments: &str) -> (Vec<String>, BTreeMap<String, Vec<u8>>) {
    let mut job = mpirun(dir, &format!("-n {ranks} shearbed {arguments} --out shared --threads 1"));
    written(&mut job, &dir.join("shared"))
}

/// What a command prints to its end without times, in order of the alphabet, as cases are printed as they end; and its
/// folder's files.
fn written(command: &mut Command, out: &Path) -> (Vec<String>, BTreeMap<String, Vec<u8>>) {
    let output = command.ended();
    assert!(output.status.success(), "{}", text(&output.stderr));
    let printed = text(&output.stdout).replace("shared", "alone");
    let mut lines: Vec<_> = printed.lines().filter(|line| !line.ends_with(" s")).map(str::to_owned).collect();
    lines.sort();
    (lines, files(out))
}

/// A record without what tells one run from another: times, threads and ranks.
fn record(files: &mut BTreeMap<String, Vec<u8>>, name: &str, without: &[&str]) -> Value {
    let mut record = serde_json::from_slice(&files.remove(name).unwrap()).unwrap();
    strip(&mut record, without);
    record
}

fn strip(value: &mut Value, without: &[&str]) {
    match value {
        Value::Object(fields) => {
            fields.retain(|key, _| !without.contains(&key.as_str()));
            fields.values_mut().for_each(|value| strip(value, without));
        }
        Value::Array(values) => values.iter_mut().for_each(|value| strip(value, without)),
        _ => (),
    }
}

#[test]
fn a_run_has_the_bytes_of_one_process() {
    for (scene, ranks) in [("small.toml", 4), ("small.toml", 3), ("small.toml --replicas 2", 4), ("one.toml", 2)] {
        let dir = folder();
        let [mut alone, mut shared] = both(dir.path(), ranks, &format!("run {scene}"));
        let without = ["seconds", "threads", "ranks", "command"];
        assert_eq!(record(&mut shared, "run.json", &without), record(&mut alone, "run.json", &without));
        // It has the checksum of run.json.
        assert!([&mut alone, &mut shared].map(|files| files.remove("shearbed.json")).iter().all(Option::is_some));
        assert!(alone.len() >= 2, "{:?}", alone.keys());
        assert_eq!(shared, alone, "{scene} on {ranks} ranks");
    }
}

#[test]
fn a_sweep_has_the_bytes_of_one_process() {
    let dir = folder();
    let over = "sweep small.toml --over interaction.alpha=0.1:0.3:3 --over interaction.update=rotation,angles";
    let [alone, shared] = both(dir.path(), 4, over);
    assert!(alone.contains_key("points/6/orbit_constant.csv"));
    assert_eq!(shared, alone);
}

#[test]
fn a_killed_job_is_gone_on_with_by_one_process() {
    let dir = folder();
    let scene = seven().replace("count = 20", "count = 100");
    fs::write(dir.path().join("small.toml"), scene).unwrap();
    let over = "sweep small.toml --over interaction.alpha=0.1:2:20 --replicas 100";
    let points = dir.path().join("shared/points");
    let job = mpirun(dir.path(), &format!("-n 4 shearbed {over} --out shared --threads 1"))
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    wait_for("a point is finished", || fs::read_dir(&points).is_ok_and(|points| points.count() > 1));
    // A job that has ended by now, which it has only on a machine that keeps this test waiting, was not killed.
    if let Some(rank) = children(job.id()).get(2) {
        kill(*rank, "-9");
    }
    let ended = end("the killed job", job).status.success();
    assert_eq!(dir.path().join("shared/sweep.csv").exists(), ended);
    for out in ["shared", "alone"] {
        assert!(common::command(dir.path(), &format!("{over} --out {out}")).ended().status.success());
    }
    assert_eq!(files(&dir.path().join("shared")), files(&dir.path().join("alone")));
}

#[test]
fn other_ranks_need_the_scene_and_write_nothing() {
    let [root, others] = [folder(), folder()];
    let folder = others.path().display().to_string();
    for (command, written) in [
        ("run small.toml", "run.json"),
        ("sweep small.toml --over interaction.alpha=1,2,3", "sweep.csv"),
        ("converge small.toml", "converge.csv"),
    ] {
        let rank = format!("shearbed {command} --out {written}-x --threads 1");
        let job = mpirun(root.path(), &format!("-n 1 {rank} : -n 2 -wdir {folder} {rank}")).ended();
        assert!(job.status.success(), "{}", text(&job.stderr));
        let written = root.path().join(format!("{written}-x")).join(written);
        assert!(written.exists(), "{}", written.display());
    }
    let names: Vec<_> = files(others.path()).into_keys().collect();
    assert_eq!(names, ["long.toml", "one.toml", "small.toml"]);
}

#[test]
fn converge_has_the_bytes_of_one_process() {
    for (scene, files) in [("small.toml --replicas 8", 6), ("one.toml", 4)] {
        let dir = folder();
        let [alone, shared] = both(dir.path(), 4, &format!("converge {scene}"));
        assert_eq!(alone.len(), files);
        assert_eq!(shared, alone);
    }
}

/// Tables and figures of the report that hold times.
const TIMED: [&str; 6] =
    ["work-precision", "exact-against-adaptive", "speed", "suspension-starts", "suspension-splits", "cost-of-accuracy"];

/// The files of `out/report` if plain `validate` of these very sources made it, in one process: it would make the same.
fn made() -> Option<BTreeMap<String, Vec<u8>>> {
    let out = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../out/report");
    let report = fs::read_to_string(out.join("report.json")).ok()?;
    // With `--case` it has no studies.
    let whole = serde_json::from_str::<Value>(&report).ok()?["studies"] != json!([]);
    (whole && !passed(&report).is_empty()).then(|| files(&out))
}

/// All of the report but times, and what is measured in times.
#[test]
fn validate_has_the_numbers_of_one_process() {
    let without = ["seconds", "origin", "command", "crc32"];
    let dir = folder();
    let cases = "validate --case jeffery-period --case contact-rule --case collision-frequency --case \
        okagawa-mason-1973 --case free-amplitude";
    let [mut alone, mut shared] = both(dir.path(), 4, cases);
    assert_eq!(record(&mut shared, "report.json", &without), record(&mut alone, "report.json", &without));

    // Everything: cases, figures, readings. What error against run time shows is a matter of times.
    let dir = folder();
    let mut alone = made().unwrap_or_else(|| in_one_process(dir.path(), "validate").1);
    let mut shared = on_ranks(dir.path(), 4, "validate").1;
    let timed = |record: &mut Value| {
        for study in record["studies"].as_array_mut().unwrap() {
            // What error costs in seconds is in some answers.
            assert!(study.as_object_mut().unwrap().remove("answer").is_some());
        }
        for list in ["tables", "figures"] {
            let kept = record[list].as_array_mut().unwrap();
            kept.retain(|item| !TIMED.iter().any(|name| item["name"].as_str().unwrap().contains(name)));
            assert!(!kept.is_empty());
        }
    };
    let [mut a, mut b] = [&mut alone, &mut shared].map(|files| record(files, "report.json", &without));
    timed(&mut a);
    timed(&mut b);
    assert!(a == b, "the reports differ");
    let curves = |files: BTreeMap<String, Vec<u8>>| -> BTreeMap<_, _> {
        files.into_iter().filter(|(name, _)| name.starts_with("curves/figure")).collect()
    };
    assert_eq!(curves(shared), curves(alone));
}
