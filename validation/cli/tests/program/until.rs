//! More replicas for an old run, and replicas until a standard error is small enough: the bits of one run.

use crate::common::{SMALL, files, folder, read, remove_left, shearbed};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// All that a run leaves, and of `run.json` what is no time, thread, command or way by which the replicas were found.
fn results(dir: &Path) -> (BTreeMap<String, Vec<u8>>, Value) {
    let mut all = files(dir);
    let mut record: Value = serde_json::from_slice(&all.remove("run.json").unwrap()).unwrap();
    // It has the inputs, and the checksum of run.json.
    all.remove("shearbed.json").unwrap();
    for key in ["seconds", "threads", "command", "until_se"] {
        record.as_object_mut().unwrap().remove(key);
    }
    (all, record)
}

/// Runs a command in `dir`, which ends well.
fn run(dir: &Path, arguments: &str) -> String {
    let ended = shearbed(dir, &format!("run {arguments}"));
    assert_eq!(ended.code, Some(0), "{arguments}: {}", ended.stderr);
    ended.stdout
}

/// Replicas are added to a finished run with a checkpoint, a part of it or none; the folder's earlier results are
/// replaced.
#[test]
fn more_replicas_of_an_old_run_are_one_run() {
    let dir = folder();
    let dir = dir.path();
    let free = SMALL.split_once("[interaction]").unwrap().0.to_owned()
        + "[time]\nperiods = 1\n[output]\nobservables = [\"projections\", \"mean_angle\"]\n";
    fs::write(dir.join("free.toml"), free).unwrap();
    let rods = SMALL.replace("[output]", "[output]\nrods_at = [0, 1]");
    fs::write(dir.join("rods.toml"), rods).unwrap();
    for scene in ["small.toml", "free.toml", "rods.toml"] {
        for (threads, numbers) in [(1, [1, 4, 11]), (2, [1, 2, 11]), (2, [3, 3, 11])] {
            let name = format!("{threads}-{}-{}-{scene}", numbers[0], numbers[1]);
            for replicas in numbers {
                let command =
                    format!("{scene} --threads {threads} --replicas {replicas} --checkpoint k-{name} --out {name}");
                run(dir, &command);
                let whole = format!("whole-{replicas}-{scene}");
                run(dir, &format!("{scene} --replicas {replicas} --out {whole}"));
                assert!(results(&dir.join(&name)) == results(&dir.join(whole)), "{command}");
            }
        }
        // A control: the comparison tells 3 replicas from 11.
        let of = |replicas: u64| results(&dir.join(format!("whole-{replicas}-{scene}")));
        assert!(of(3) != of(11));
    }
}

/// A run of the scene into `a` that is bad input, and what its message says.
fn refused(dir: &Path, arguments: &str, says: &[&str]) {
    let ended = shearbed(dir, &format!("run small.toml --out a {arguments}"));
    assert_eq!(ended.code, Some(2), "{arguments}: {}", ended.stderr);
    assert!(says.iter().all(|part| ended.stderr.contains(part)), "{arguments}: {}", ended.stderr);
}

#[test]
fn fewer_replicas_and_other_scenes_are_refused_and_change_nothing() {
    let dir = folder();
    let dir = dir.path();
    run(dir, "small.toml --replicas 5 --checkpoint kept --out a");
    let before = (files(&dir.join("a")), fs::read(dir.join("kept")).unwrap());
    for (arguments, why) in [
        ("--replicas 4", "--checkpoint kept: has the sum of 5 replicas"),
        ("--replicas 4", "--replicas 5 or more goes on from it"),
        ("--replicas 1", "--replicas 5 or more goes on from it"),
        ("--replicas 9 --seed 2", "scene.ensemble.seed was 1 and is 2 now"),
        ("--replicas 9 --set interaction.alpha=0.6", "scene.interaction.alpha was 0.5 and is 0.6 now"),
        ("--replicas 9 --set particles.count=21", "scene.particles.count was 20 and is 21 now"),
    ] {
        refused(dir, &format!("--checkpoint kept {arguments}"), &[why]);
    }
    assert!(before == (files(&dir.join("a")), fs::read(dir.join("kept")).unwrap()));
}

/// The largest standard error of a column of a table.
fn largest(dir: &Path, column: &str) -> f64 {
    let mut table = csv::Reader::from_path(dir.join("projections.csv")).unwrap();
    let place = table.headers().unwrap().iter().position(|name| name == column).unwrap();
    let rows = table.records().map(|row| row.unwrap()[place].parse::<f64>().unwrap());
    rows.fold(0.0, f64::max)
}

fn record(dir: &Path) -> Value {
    serde_json::from_str(&read(&dir.join("run.json"))).unwrap()
}

/// With 1 and 2 threads, with a checkpoint and without, at once and after a larger value: the number of replicas at
/// which the standard error is small enough, and the bits of a run of that number.
#[test]
fn replicas_are_added_until_the_standard_error_holds() {
    let dir = folder();
    let dir = dir.path();
    for (k, options) in ["--threads 1", "--threads 2", "--threads 2 --checkpoint at-once"].iter().enumerate() {
        run(dir, &format!("small.toml --until-se x1=0.008 {options} --out until-{k}"));
    }
    run(dir, "small.toml --until-se x1=0.01 --checkpoint grows --out until-3 --threads 1");
    let first = record(&dir.join("until-3"))["scene"]["ensemble"]["replicas"].as_u64().unwrap();
    run(dir, "small.toml --until-se x1=0.008 --checkpoint grows --out until-3 --threads 2");
    let found = record(&dir.join("until-0"));
    let replicas = found["scene"]["ensemble"]["replicas"].as_u64().unwrap();
    assert!(replicas > first && first > 32, "{first} {replicas}");
    run(dir, &format!("small.toml --replicas {replicas} --out whole"));
    for k in 0..4 {
        assert!(results(&dir.join(format!("until-{k}"))) == results(&dir.join("whole")), "{k}");
    }
    let reached = &found["until_se"];
    assert_eq!((&reached["replicas"], &reached["holds"]), (&replicas.into(), &true.into()));
    let column = &reached["columns"][0];
    assert_eq!((&column["channel"], &column["asked"]), (&"x1".into(), &0.008.into()));
    assert_eq!(column["reached"].as_f64(), Some(largest(&dir.join("whole"), "x1_se")));
    assert!(largest(&dir.join("whole"), "x1_se") <= 0.008);
    // At every number that was looked at before, it did not hold.
    let mut fewer = 32;
    while fewer < replicas {
        run(dir, &format!("small.toml --replicas {fewer} --out fewer --force --quiet"));
        assert!(largest(&dir.join("fewer"), "x1_se") > 0.008, "{fewer}");
        fewer += (fewer / 8).max(8);
    }
    assert_eq!(fewer, replicas);
    // Several rules: all hold.
    run(dir, "small.toml --until-se x1=0.02 --until-se x3=0.012 --out both --threads 1");
    assert!(largest(&dir.join("both"), "x1_se") <= 0.02 && largest(&dir.join("both"), "x3_se") <= 0.012);
    assert!(largest(&dir.join("fewer"), "x3_se") > 0.0);
}

#[test]
fn a_time_limit_keeps_what_there_is_and_says_what_was_reached() {
    let dir = folder();
    let dir = dir.path();
    for (k, options) in ["", " --checkpoint kept"].iter().enumerate() {
        let command = format!("run small.toml --until-se x1=1e-9 --time-limit 0.3s --out limit-{k}{options}");
        let ended = shearbed(dir, &command);
        assert_eq!(ended.code, Some(1), "{}", ended.stderr);
        let said =
            "error: --until-se was not reached: the time limit of 0.3 s came first; largest standard error of x1: ";
        assert!(ended.stderr.contains(said), "{}", ended.stderr);
        let found = record(&dir.join(format!("limit-{k}")));
        let replicas = found["scene"]["ensemble"]["replicas"].as_u64().unwrap();
        assert!(replicas >= 2 && ended.stderr.contains(&format!(" after {replicas} replicas")), "{}", ended.stderr);
        assert_eq!((&found["until_se"]["holds"], &found["until_se"]["time_limit_s"]), (&false.into(), &0.3.into()));
        run(dir, &format!("small.toml --replicas {replicas} --out whole-{k}"));
        assert!(results(&dir.join(format!("limit-{k}"))) == results(&dir.join(format!("whole-{k}"))));
    }
    // What the limit left goes on to the same end as a run without it.
    run(dir, "small.toml --until-se x1=0.02 --out whole");
    let ended = shearbed(dir, "run small.toml --until-se x1=0.02 --time-limit 0.01s --checkpoint short --out a");
    assert!(matches!(ended.code, Some(0 | 1)), "{}", ended.stderr);
    run(dir, "small.toml --until-se x1=0.02 --checkpoint short --out a");
    assert!(results(&dir.join("a")) == results(&dir.join("whole")));
}

#[test]
fn messages_name_what_is_allowed() {
    let dir = folder();
    let dir = dir.path();
    fs::write(dir.join("rods.toml"), SMALL.replace("[output]", "[output]\nrods_at = [0, 1]")).unwrap();
    for (arguments, allowed) in [
        ("small.toml --until-se y=0.1", "y=0.1: this scene has no such column; allowed: x1, x2, x3, phi"),
        ("small.toml --until-se a11=0.1", "output.observables adds others"),
        ("small.toml --until-se x1", "a column and a number above 0 are allowed, as x1=0.001"),
        ("small.toml --until-se x1=0", "a column and a number above 0 are allowed"),
        ("small.toml --until-se x1=-1", "a column and a number above 0 are allowed"),
        ("small.toml --until-se x1=NaN", "a column and a number above 0 are allowed"),
        ("small.toml --until-se x1=inf", "a column and a number above 0 are allowed"),
        ("small.toml --until-se x1=0.1 --until-se x1=0.2", "the column is named twice; once is allowed"),
        ("small.toml --until-se x1=0.1 --replicas 9", "--until-se finds the number; one of the two is allowed"),
        ("small.toml --until-se x1=0.1 --set ensemble.replicas=9", "one of the two is allowed"),
        ("small.toml --until-se x1=0.1 --time-limit 10", "as 90s, 10min or 1.5h"),
        ("small.toml --until-se x1=0.1 --time-limit=-1s", "a time from 0.01s to 8760h is allowed"),
        ("small.toml --time-limit 10s", "--until-se <CHANNEL=VALUE>"),
        (
            "rods.toml --until-se x1=0.1",
            "and output.rods_at: how many rods rods.csv would list is not known before the run",
        ),
    ] {
        let ended = shearbed(dir, &format!("run {arguments} --out x"));
        assert_eq!(ended.code, Some(2), "{arguments}: {}", ended.stderr);
        assert!(ended.stderr.contains(allowed), "{arguments}: {}", ended.stderr);
        assert!(!dir.join("x").exists());
    }
    let plan = shearbed(dir, "plan small.toml --until-se x1=0.001");
    assert!(plan.stdout.contains(", 32 replicas, ") && plan.stdout.contains("x1 ≤ 0.001"), "{}", plan.stdout);
    let plan = shearbed(dir, "plan small.toml --until-se y=0.001");
    assert!(plan.code == Some(2) && plan.stderr.contains("allowed: x1"), "{}", plan.stderr);
}

/// Killed again and again while replicas are added to a run that had finished.
#[cfg(unix)]
#[test]
fn a_killed_extension_goes_on_to_the_same_bits() {
    use crate::common::command;
    use crate::common::running::Running;
    let dir = folder();
    let dir = dir.path();
    run(dir, "small.toml --replicas 300 --out whole");
    for (name, until) in [("more", "--replicas 300"), ("until", "--until-se x1=0.0045")] {
        let file = dir.join(name);
        run(dir, &format!("small.toml --replicas 3 --checkpoint {name} --out {name}-out"));
        for life in 0..4 {
            let before = fs::read(&file).unwrap();
            let life_of = format!(
                "run small.toml {until} --checkpoint {name} --out {name}-out --every 0.01 --threads {}",
                1 + life % 2
            );
            let mut running = Running::held_at_its_first_message(command(dir, &life_of));
            let more = || fs::read(&file).is_ok_and(|found| found != before);
            if !running.reaches("more of the run is kept", more) {
                break;
            }
            running.signal("-KILL");
            running.end();
            // Of what was left in the middle of writing the next life would warn first.
            remove_left(dir);
        }
        let wanted = match name {
            "more" => "whole".to_owned(),
            _ => {
                run(dir, &format!("small.toml {until} --out at-once"));
                "at-once".to_owned()
            }
        };
        run(dir, &format!("small.toml {until} --checkpoint {name} --out {name}-out"));
        assert!(results(&dir.join(format!("{name}-out"))) == results(&dir.join(wanted)), "{name}");
    }
}
