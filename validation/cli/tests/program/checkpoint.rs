//! Runs that are stopped and gone on from: bit for bit those that are not.
#![cfg(unix)]

use crate::common::running::Running;
use crate::common::{SMALL, command, files, folder, remove_left, shearbed};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Dxsm;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// About a second: of many replicas, of one, and of free rods.
fn scenes(dir: &Path) -> [&'static str; 3] {
    let long = SMALL.replace("count = 20", "count = 300").replace("outputs_per_period = 4", "outputs_per_period = 1");
    let write = |name: &str, text: String| fs::write(dir.join(format!("{name}.toml")), text).unwrap();
    write("many", SMALL.replace("replicas = 3", "replicas = 700"));
    let one = long.replace("replicas = 3", "replicas = 1");
    let one = one.replace("[output]", "[output]\nrods_at = [0, 30, 60, 100]");
    write("one", one.replace("periods = 1", "periods = 100"));
    let (free, rest) = long.split_once("[interaction]").unwrap();
    let (_, rest) = rest.split_once("[time]").unwrap();
    let free = format!("{free}[time]{rest}").replace("steps_per_period = 200\n", "");
    let free = free
        .replace("count = 300", "count = 5000")
        .replace("replicas = 3", "replicas = 2")
        .replace("[output]", "[output]\nrods_at = [0, 1, 4000]");
    write("free", free.replace("periods = 1", "periods = 4000"));
    ["many", "one", "free"]
}

/// What a run leaves but times, threads and the words it was called by.
fn results(dir: &Path) -> (BTreeMap<String, Vec<u8>>, serde_json::Value) {
    let mut all = files(dir);
    let record = all.remove("run.json").unwrap();
    // It has the checksum of run.json.
    all.remove("shearbed.json").unwrap();
    let record: serde_json::Value = serde_json::from_slice(&record).unwrap();
    (all, serde_json::json!([record["counters"], record["scene"], record["seed"], record["files"]]))
}

/// Kills a run again and again and lets it end then: the same files. Each life is held where it first says that more of
/// the run is kept, at its end at the latest: it cannot end before it is killed, however fast or loaded the machine is,
/// unless all was kept before.
#[test]
fn a_run_that_is_killed_goes_on_to_the_same_bits() {
    const LIVES: usize = 6;
    let dir = folder();
    let mut random = Pcg64Dxsm::seed_from_u64(1982);
    for name in scenes(dir.path()) {
        let whole = format!("run {name}.toml --quiet --out {name}-whole");
        assert_eq!(shearbed(dir.path(), &whole).code, Some(0));
        let run = format!("run {name}.toml --out {name} --checkpoint kept/{name}");
        let (file, out) = (dir.path().join("kept").join(name), dir.path().join(name));
        for life in 0..LIVES {
            let every = random.random_range(0.01..0.05);
            let life_of = format!("{run} --every {every} --threads {}", 1 + life % 3);
            let before = fs::read(&file).ok();
            let mut running = Running::held_at_its_first_message(command(dir.path(), &life_of));
            // The first life is killed before anything is done. In each other one the file changes when more of the run
            // is kept.
            let held = running.reaches("more of the run is kept", || {
                fs::read(&file).is_ok_and(|found| before.as_ref() != Some(&found))
            });
            if !held {
                // The life before was killed when all was kept.
                assert!(life > 0, "{name}: it has ended before more of the run was kept");
                assert_eq!(running.end().code, Some(0));
                fs::remove_dir_all(&out).unwrap();
                break;
            }
            assert!(!out.exists(), "{name}: it has ended before it was let go");
            let signal = ["-KILL", "-KILL", "-TERM"][life % 3];
            running.signal(signal);
            // Let go, a run that was done but for its results may write them before the signal ends it: the whole set
            // or none.
            let ended = running.end();
            match ended.code {
                None if signal == "-KILL" => assert!(!out.exists()),
                Some(0 | 143) if signal == "-TERM" => {
                    assert!(ended.code == Some(143) || out.exists());
                    if out.exists() {
                        assert!(out.join("run.json").exists());
                        fs::remove_dir_all(&out).unwrap();
                    }
                }
                code => panic!("{name}, {signal}: {code:?}, {}", ended.stderr),
            }
            // Of what was left in the middle of writing the next life would warn first.
            assert!(remove_left(&dir.path().join("kept")) == 0 || signal == "-KILL");
        }
        let goes_on = format!("goes on from kept/{name}: ");
        let last = shearbed(dir.path(), &run);
        assert_eq!(last.code, Some(0), "{name}: {}", last.stderr);
        assert!(last.stdout.starts_with(&goes_on), "{}", last.stdout);
        assert_eq!(results(&dir.path().join(name)), results(&dir.path().join(format!("{name}-whole"))), "{name}");
        // What is done is kept: it need not run again.
        let again = shearbed(dir.path(), &format!("{run} --force"));
        let replicas = ["700 of 700", "1 of 1", "2 of 2"];
        assert!(
            replicas.iter().any(|done| again.stdout.contains(&format!("{done} replicas are done, 0 halfway"))),
            "{}",
            again.stdout
        );
        assert_eq!(results(&dir.path().join(name)), results(&dir.path().join(format!("{name}-whole"))), "{name}");
        let beside: Vec<_> = files(&dir.path().join("kept")).into_keys().filter(|file| file.contains('.')).collect();
        assert_eq!(beside, [""; 0], "nothing is left beside it");
    }
}

#[test]
fn a_signal_keeps_the_run_and_says_how_to_go_on() {
    let dir = folder();
    scenes(dir.path());
    // Hours of work, of which the signal comes when some is done.
    let run = "run many.toml --replicas 10000000 --checkpoint kept --every 0.01";
    let done = |progress: &str| -> u64 { progress.split_once(" of 10000000 ").unwrap().0.parse().unwrap() };
    let mut kept = String::new();
    for (signal, code) in [("-INT", 130), ("-TERM", 143)] {
        let mut running = Running::start(command(dir.path(), run));
        // What the last signal said is gone on from, or more: a checkpoint that was due may follow the message.
        if !kept.is_empty() {
            let line = running.line();
            let from = line.strip_prefix("goes on from kept: ").unwrap();
            assert!(done(from) >= done(&kept), "{from} {kept}");
        }
        let first = running.message();
        assert!(first.starts_with("kept in kept: "), "{first}");
        running.signal(signal);
        let ended = running.end();
        let last = ended.stderr.lines().find(|line| line.starts_with("error: ")).unwrap();
        assert_eq!(ended.code, Some(code), "{last}");
        let (_, how) = last.split_once("files that were not complete were not written; ").unwrap();
        let way = "; the run is kept in kept, and the same command goes on from there";
        let progress = how.strip_suffix(way).unwrap_or_else(|| panic!("{last}"));
        assert!(progress.contains(" of 10000000 replicas are done, "), "{last}");
        assert!(!progress.starts_with("0 of") || !progress.ends_with(" 0 halfway"), "{last}");
        kept = progress.to_owned();
    }
    let found = files(dir.path());
    assert!(!found.keys().any(|name| name.starts_with('.')), "{:?}", found.keys());
}

#[test]
fn a_checkpoint_of_other_work_is_refused() {
    let dir = folder();
    let run = "run small.toml --checkpoint kept --out x";
    assert_eq!(shearbed(dir.path(), run).code, Some(0));
    let kept = fs::read(dir.path().join("kept")).unwrap();
    for (change, key) in [
        ("--seed 2", "scene.ensemble.seed was 1 and is 2 now"),
        ("--set interaction.alpha=0.6", "scene.interaction.alpha was 0.5 and is 0.6 now"),
    ] {
        let other = shearbed(dir.path(), &format!("{run}2 {change}"));
        assert_eq!(other.code, Some(2), "{}", other.stderr);
        assert!(other.stderr.starts_with("error: --checkpoint kept: is of other work: "), "{}", other.stderr);
        assert!(other.stderr.contains(key), "{}", other.stderr);
    }
    let other = shearbed(dir.path(), "validate --case jeffery-period --checkpoint kept --out x2");
    assert!(other.stderr.contains("is of other work"), "{}", other.stderr);
    assert_eq!((other.code, fs::read(dir.path().join("kept")).unwrap()), (Some(2), kept.clone()));
    let mut damaged = kept;
    let at = damaged.len() / 2;
    damaged[at] ^= 4;
    fs::write(dir.path().join("kept"), &damaged).unwrap();
    let other = shearbed(dir.path(), &run.replace("--out x", "--out x2"));
    assert_eq!(other.code, Some(2));
    assert!(other.stderr.contains("is damaged: its checksum is"), "{}", other.stderr);
    assert!(!dir.path().join("x2").exists());
    for (wrong, allowed) in [
        ("--checkpoint k --every 0", "a number of seconds from 0.01 to 86400 is allowed"),
        ("--checkpoint k --every NaN", "a number of seconds from 0.01 to 86400 is allowed"),
        ("--every 5", "--checkpoint <FILE>"),
        ("--checkpoint /proc/k", "/proc/k: cannot be written"),
        ("--checkpoint .", "is --out x2, or a folder above it"),
        ("--checkpoint x2", "is --out x2, or a folder above it"),
        ("--checkpoint x2/run.json", "a result may have that name"),
        ("--checkpoint no/../x2/a.csv", "a result may have that name"),
        ("--checkpoint small.toml", "small.toml: is no checkpoint of shearbed"),
    ] {
        let refused = shearbed(dir.path(), &format!("run small.toml --out x2 {wrong}"));
        assert_eq!(refused.code, Some(2), "{wrong}: {}", refused.stderr);
        assert!(refused.stderr.contains(allowed), "{wrong}: {}", refused.stderr);
    }
    assert!(!dir.path().join("x2").exists() && !dir.path().join("k").exists());
}

/// Cases of a report without what differs from run to run.
fn cases(dir: &Path) -> Vec<serde_json::Value> {
    let report = fs::read(dir.join("report.json")).unwrap();
    let report: serde_json::Value = serde_json::from_slice(&report).unwrap();
    report["cases"].as_array().unwrap().clone()
}

#[test]
fn finished_cases_are_not_run_again() {
    let dir = folder();
    let two = "validate --case jeffery-period --case gradient-of-eq-2 --checkpoint kept";
    let first = shearbed(dir.path(), &format!("{two} --out first"));
    assert_eq!(first.code, Some(0), "{}", first.stderr);
    let more = shearbed(dir.path(), &format!("{two} --case kick-bound --out more"));
    assert!(more.stdout.contains("goes on from kept: finished cases: 2\n"), "{}", more.stdout);
    let [first, more] = ["first", "more"].map(|out| cases(&dir.path().join(out)));
    // Times too: they have not been taken again.
    assert_eq!(first.len() + 1, more.len());
    assert!(first.iter().all(|case| more.contains(case)), "{first:#?}\n{more:#?}");
    let fresh = shearbed(dir.path(), "validate --case kick-bound --case jeffery-period --out fresh");
    assert_eq!(fresh.code, Some(0));
    for mut case in cases(&dir.path().join("fresh")) {
        let same = |other: &&serde_json::Value| other["name"] == case["name"];
        let mut kept = more.iter().find(same).unwrap().clone();
        kept["seconds"] = 0.into();
        case["seconds"] = 0.into();
        assert_eq!(kept, case);
    }
    let other = shearbed(dir.path(), &format!("{two} --seed 2"));
    assert_eq!(other.code, Some(2));
    assert!(other.stderr.contains("seed was 1 and is 2 now"), "{}", other.stderr);
}
