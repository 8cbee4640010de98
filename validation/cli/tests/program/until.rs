//! More replicas for an old run, and replicas until a standard error is small enough: the bits of one run.

use crate::common::{SMALL, folder, remove_left, results, shearbed};
use std::fs;
use std::path::Path;

/// Replicas are added to a finished run with a checkpoint, a part of it or none; the folder's earlier results are
/// replaced.
#[test]
fn more_replicas_of_an_old_run_are_one_run() {
    let dir = folder();
    let free = SMALL.split_once("[interaction]").unwrap().0.to_owned()
        + "[time]\nperiods = 1\n[output]\nobservables = [\"projections\", \"mean_angle\"]\n";
    dir.write("free.toml", free);
    let rods = SMALL.replace("[output]", "[output]\nrods_at = [0, 1]");
    dir.write("rods.toml", rods);
    for scene in ["small.toml", "free.toml", "rods.toml"] {
        for (threads, numbers) in [(1, [1, 4, 11]), (2, [1, 2, 11]), (2, [3, 3, 11])] {
            let name = format!("{threads}-{}-{}-{scene}", numbers[0], numbers[1]);
            for replicas in numbers {
                let command =
                    format!("run {scene} --threads {threads} --replicas {replicas} --checkpoint k-{name} --out {name}");
                dir.runs(&command);
                let whole = format!("whole-{replicas}-{scene}");
                dir.runs(&format!("run {scene} --replicas {replicas} --out {whole}"));
                assert!(results(&dir.at(&name)) == results(&dir.at(&whole)), "{command}");
            }
        }
        // A control: the comparison tells 3 replicas from 11.
        let of = |replicas: u64| results(&dir.at(&format!("whole-{replicas}-{scene}")));
        assert!(of(3) != of(11));
    }
}

/// The largest standard error of a column of a table.
fn largest(dir: &Path, column: &str) -> f64 {
    let mut table = csv::Reader::from_path(dir.join("projections.csv")).unwrap();
    let place = table.headers().unwrap().iter().position(|name| name == column).unwrap();
    let rows = table.records().map(|row| row.unwrap()[place].parse::<f64>().unwrap());
    rows.fold(0.0, f64::max)
}

/// With 1 and 2 threads, with a checkpoint and without, at once and after a larger value: the number of replicas at
/// which the standard error is small enough, and the bits of a run of that number.
#[test]
fn replicas_are_added_until_the_standard_error_holds() {
    let dir = folder();
    for (k, options) in ["--threads 1", "--threads 2", "--threads 2 --checkpoint at-once"].iter().enumerate() {
        dir.runs(&format!("run small.toml --until-se x1=0.008 {options} --out until-{k}"));
    }
    dir.runs("run small.toml --until-se x1=0.01 --checkpoint grows --out until-3 --threads 1");
    let first = dir.json("until-3/run.json")["scene"]["ensemble"]["replicas"].as_u64().unwrap();
    dir.runs("run small.toml --until-se x1=0.008 --checkpoint grows --out until-3 --threads 2");
    let record = dir.json("until-0/run.json");
    let replicas = record["scene"]["ensemble"]["replicas"].as_u64().unwrap();
    assert!(replicas > first && first > 32, "{first} {replicas}");
    dir.runs(&format!("run small.toml --replicas {replicas} --out whole"));
    for k in 0..4 {
        assert!(results(&dir.at(&format!("until-{k}"))) == results(&dir.at("whole")), "{k}");
    }
    let reached = &record["until_se"];
    assert_eq!((&reached["replicas"], &reached["holds"]), (&replicas.into(), &true.into()));
    let column = &reached["columns"][0];
    assert_eq!((&column["channel"], &column["asked"]), (&"x1".into(), &0.008.into()));
    assert_eq!(column["reached"].as_f64(), Some(largest(&dir.at("whole"), "x1_se")));
    assert!(largest(&dir.at("whole"), "x1_se") <= 0.008);
    // At every number that was looked at before, it did not hold.
    let mut fewer = 32;
    while fewer < replicas {
        dir.runs(&format!("run small.toml --replicas {fewer} --out fewer --force --quiet"));
        assert!(largest(&dir.at("fewer"), "x1_se") > 0.008, "{fewer}");
        fewer += (fewer / 8).max(8);
    }
    assert_eq!(fewer, replicas);
    // Several rules: all hold.
    dir.runs("run small.toml --until-se x1=0.02 --until-se x3=0.012 --out both --threads 1");
    assert!(largest(&dir.at("both"), "x1_se") <= 0.02 && largest(&dir.at("both"), "x3_se") <= 0.012);
    assert!(largest(&dir.at("fewer"), "x3_se") > 0.0);
}

#[test]
fn a_time_limit_keeps_what_there_is_and_says_what_was_reached() {
    let dir = folder();
    for (k, options) in ["", " --checkpoint kept"].iter().enumerate() {
        let command = format!("run small.toml --until-se x1=1e-9 --time-limit 0.3s --out limit-{k}{options}");
        let ended = shearbed(dir.path(), &command);
        assert_eq!(ended.code, Some(1), "{}", ended.stderr);
        let said =
            "error: --until-se was not reached: the time limit of 0.3 s came first; largest standard error of x1: ";
        assert!(ended.stderr.contains(said), "{}", ended.stderr);
        let record = dir.json(&format!("limit-{k}/run.json"));
        let replicas = record["scene"]["ensemble"]["replicas"].as_u64().unwrap();
        assert!(replicas >= 2 && ended.stderr.contains(&format!(" after {replicas} replicas")), "{}", ended.stderr);
        assert_eq!((&record["until_se"]["holds"], &record["until_se"]["time_limit_s"]), (&false.into(), &0.3.into()));
        dir.runs(&format!("run small.toml --replicas {replicas} --out whole-{k}"));
        assert!(results(&dir.at(&format!("limit-{k}"))) == results(&dir.at(&format!("whole-{k}"))));
    }
    // What the limit left goes on to the same end as a run without it.
    dir.runs("run small.toml --until-se x1=0.02 --out whole");
    let ended = shearbed(dir.path(), "run small.toml --until-se x1=0.02 --time-limit 0.01s --checkpoint short --out a");
    assert!(matches!(ended.code, Some(0 | 1)), "{}", ended.stderr);
    dir.runs("run small.toml --until-se x1=0.02 --checkpoint short --out a");
    assert!(results(&dir.at("a")) == results(&dir.at("whole")));
}

/// Killed again and again while replicas are added to a run that had finished.
#[cfg(unix)]
#[test]
fn a_killed_extension_goes_on_to_the_same_bits() {
    use crate::common::command;
    use crate::common::running::Running;
    let dir = folder();
    for (name, until) in [("more", "--replicas 300"), ("until", "--until-se x1=0.0045")] {
        let file = dir.at(name);
        dir.runs(&format!("run small.toml --replicas 3 --checkpoint {name} --out {name}-out"));
        for life in 0..4 {
            let before = fs::read(&file).unwrap();
            let life_of = format!(
                "run small.toml {until} --checkpoint {name} --out {name}-out --every 0.01 --threads {}",
                1 + life % 2
            );
            let mut running = Running::held_at_its_first_message(command(dir.path(), &life_of));
            let more = || fs::read(&file).is_ok_and(|found| found != before);
            if !running.reaches("more of the run is kept", more) {
                break;
            }
            running.signal("-KILL");
            running.end();
            // Of what was left in the middle of writing the next life would warn first.
            remove_left(dir.path());
        }
        dir.runs(&format!("run small.toml {until} --out {name}-whole"));
        dir.runs(&format!("run small.toml {until} --checkpoint {name} --out {name}-out"));
        assert!(results(&dir.at(&format!("{name}-out"))) == results(&dir.at(&format!("{name}-whole"))), "{name}");
    }
}
