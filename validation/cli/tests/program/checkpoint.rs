//! Runs that are stopped and gone on from: bit for bit those that are not.
#![cfg(unix)]

use crate::common::running::Running;
use crate::common::{Folder, SMALL, command, files, folder, remove_left, results, shearbed};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Dxsm;
use std::fs;

/// About a second: of many replicas, of one, and of free rods.
fn scenes(dir: &Folder) -> [&'static str; 3] {
    let long = SMALL.replace("count = 20", "count = 300").replace("outputs_per_period = 4", "outputs_per_period = 1");
    let write = |name: &str, text: String| dir.write(&format!("{name}.toml"), text);
    write("many", SMALL.replace("replicas = 3", "replicas = 700"));
    let with = |scene: &str, replicas: u64, rods_at: &str, periods: u64| {
        let scene = scene.replace("replicas = 3", &format!("replicas = {replicas}"));
        let scene = scene.replace("[output]", &format!("[output]\nrods_at = {rods_at}"));
        scene.replace("periods = 1", &format!("periods = {periods}"))
    };
    write("one", with(&long, 1, "[0, 30, 60, 100]", 100));
    let (free, rest) = long.split_once("[interaction]").unwrap();
    let (_, rest) = rest.split_once("[time]").unwrap();
    let free = format!("{free}[time]{rest}").replace("steps_per_period = 200\n", "");
    write("free", with(&free.replace("count = 300", "count = 5000"), 2, "[0, 1, 4000]", 4000));
    ["many", "one", "free"]
}

/// Kills a run again and again and lets it end then: the same files. Each life is held where it first says that more of
/// the run is kept, at its end at the latest: it cannot end before it is killed, however fast or loaded the machine is,
/// unless all was kept before.
#[test]
fn a_run_that_is_killed_goes_on_to_the_same_bits() {
    const LIVES: usize = 6;
    let dir = folder();
    let mut random = Pcg64Dxsm::seed_from_u64(1982);
    for name in scenes(&dir) {
        let whole = format!("run {name}.toml --quiet --out {name}-whole");
        dir.runs(&whole);
        let run = format!("run {name}.toml --out {name} --checkpoint kept/{name}");
        let (file, out) = (dir.at("kept").join(name), dir.path().join(name));
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
            assert!(remove_left(&dir.at("kept")) == 0 || signal == "-KILL");
        }
        let goes_on = format!("goes on from kept/{name}: ");
        let last = dir.runs(&run);
        assert!(last.stdout.starts_with(&goes_on), "{}", last.stdout);
        assert_eq!(results(&dir.path().join(name)), results(&dir.path().join(format!("{name}-whole"))), "{name}");
        // What is done is kept: it need not run again.
        let again = shearbed(dir.path(), &format!("{run} --force"));
        let replicas = ["700 of 700", "1 of 1", "2 of 2"];
        let all = replicas.map(|done| format!("{done} replicas are done, 0 halfway"));
        assert!(all.iter().any(|done| again.stdout.contains(done)), "{}", again.stdout);
        assert_eq!(results(&dir.path().join(name)), results(&dir.path().join(format!("{name}-whole"))), "{name}");
        let beside: Vec<_> = dir.files("kept").into_keys().filter(|file| file.contains('.')).collect();
        assert_eq!(beside, [""; 0], "nothing is left beside it");
    }
}

#[test]
fn a_signal_keeps_the_run_and_says_how_to_go_on() {
    let dir = folder();
    scenes(&dir);
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
        assert!(first.starts_with("saved in kept: "), "{first}");
        running.signal(signal);
        let ended = running.end();
        let last = ended.stderr.lines().find(|line| line.starts_with("error: ")).unwrap();
        assert_eq!(ended.code, Some(code), "{last}");
        let (_, how) = last.split_once("no file is half written; ").unwrap();
        let way = "; the run is saved in kept, and the same command goes on from there";
        let progress = how.strip_suffix(way).unwrap_or_else(|| panic!("{last}"));
        assert!(progress.contains(" of 10000000 replicas are done, "), "{last}");
        assert!(!progress.starts_with("0 of") || !progress.ends_with(" 0 halfway"), "{last}");
        kept = progress.to_owned();
    }
    let found = files(dir.path());
    assert!(!found.keys().any(|name| name.starts_with('.')), "{:?}", found.keys());
    // Of a long replica what is kept meanwhile is halfway, and survives a kill.
    let run = "run one.toml --set time.periods=20000 --checkpoint one --every 0.01";
    let kept = || fs::read(dir.path().join("one")).unwrap();
    let mut running = Running::start(command(dir.path(), run));
    running.message();
    let before = kept();
    running.wait_for("more of the run is kept", || kept() != before);
    running.signal("-KILL");
    running.end();
    let mut running = Running::start(command(dir.path(), run));
    let line = running.line();
    assert!(line.starts_with("goes on from one: 0 of 1 replicas are done, 1 halfway"), "{line}");
    running.signal("-KILL");
    running.end();
}

/// Killed again and again while replicas are added to a run that had finished.
#[test]
fn a_killed_extension_goes_on_to_the_same_bits() {
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

#[test]
fn a_killed_sweep_goes_on_to_the_same_bytes() {
    let sweep = "sweep small.toml --over interaction.alpha=0.1:1.2:12 --out killed --threads";
    let dir = folder();
    let killed = dir.at("killed");
    // Each life waits where it says that one more point is finished, until it is killed.
    for life in 1..4 {
        let mut running = Running::held_at_its_first_message(command(dir.path(), &format!("{sweep} 1")));
        let point = killed.join(format!("points/{life:02}"));
        running.wait_for("one more point is finished", || point.exists());
        running.signal("-KILL");
        assert_eq!(running.end().code, None);
        let names = fs::read_dir(killed.join("points")).unwrap();
        assert_eq!(names.count(), life);
    }
    assert!(!killed.join("sweep.csv").exists());
    // What a kill in the middle of a point leaves.
    let left = killed.join("points/.shearbed-0123456789abcdef");
    fs::create_dir(&left).unwrap();
    fs::write(left.join("projections.csv"), "half a ta").unwrap();

    let ended = shearbed(dir.path(), &format!("{sweep} 2"));
    let said = "killed/points/.shearbed-0123456789abcdef: a shearbed that was killed left this folder";
    assert!(ended.stderr.contains(said), "{}", ended.stderr);
    let text = ended.stdout;
    fs::remove_dir_all(left).unwrap();
    assert!(text.starts_with("goes on from killed: 3 of 12 points are finished\n"), "{text}");
    assert!(text.contains("points: 12, of which 3 were finished before"), "{text}");
    dir.runs(&format!("{sweep} 1").replace("killed", "whole"));
    assert_eq!(dir.files("killed"), dir.files("whole"));
    // Once more: nothing is left to do, and nothing changes.
    let whole = dir.files("killed");
    dir.runs(&format!("{sweep} 1"));
    assert_eq!(dir.files("killed"), whole);
}
