//! How the program ends when it is told to, or when what it writes to has gone.
#![cfg(unix)]

use crate::common::bounded::Bounded;
use crate::common::running::Running;
use crate::common::{SMALL, command, files, folder, limited, shearbed};
use std::fs;
use std::path::Path;
use std::process::Command;

/// Hours of work, with a warning before it begins.
fn long(dir: &Path) {
    let scene = SMALL
        .replace("replicas = 3", "replicas = 10000000")
        .replace("concentration_per_cm3 = 50", "concentration_per_cm3 = 5000");
    fs::write(dir.join("long.toml"), scene).unwrap();
}

#[test]
fn a_signal_ends_a_run_with_a_message_and_leaves_nothing() {
    let dir = folder();
    long(dir.path());
    for (signal, code, name) in [("-INT", 130, "SIGINT"), ("-TERM", 143, "SIGTERM"), ("-HUP", 129, "SIGHUP")] {
        let mut running = Running::start(command(dir.path(), "run long.toml --threads 1 --out x"));
        let first = running.message();
        assert!(first.starts_with("warning: long.toml: "), "{first}");
        running.signal(signal);
        let ended = running.end();
        let message = ended.stderr;
        assert_eq!(ended.code, Some(code), "{message}");
        assert!(message.starts_with(&format!("error: stopped by {name}:")), "{message}");
        assert!(message.ends_with("`shearbed run` keeps nothing before it ends\n"), "{message}");
        let names: Vec<_> = fs::read_dir(dir.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
        assert_eq!(names.len(), 2, "{names:?}");
    }
}

/// Its first point is finished soon, its second one never.
const SWEEP: &str = "sweep small.toml --over ensemble.replicas=3,10000000 --threads 1 --out x";

#[test]
fn a_sweep_that_was_told_to_end_goes_on() {
    let dir = folder();
    for life in 0..2 {
        let mut running = Running::start(command(dir.path(), SWEEP));
        match life {
            0 => assert_eq!(running.message(), "kept in x: 1 of 2 points are finished\n"),
            _ => assert_eq!(running.line(), "goes on from x: 1 of 2 points are finished\n"),
        }
        running.signal("-TERM");
        let ended = running.end();
        assert_eq!(ended.code, Some(143));
        assert!(ended.stderr.contains("the same command goes on"), "{}", ended.stderr);
        let left = files(&dir.path().join("x"));
        assert!(left.keys().all(|name| !name.contains("/.") && !name.starts_with('.')), "{:?}", left.keys());
    }
}

#[test]
fn a_reader_that_goes_away_is_no_error() {
    let dir = folder();
    let program = env!("CARGO_BIN_EXE_shearbed");
    for arguments in ["scenes", "plan fig4-n50", "--help", "run small.toml", "scenes --show fig5"] {
        // The reader is gone before the first line.
        let script = format!("{program} {arguments} | true; echo ${{PIPESTATUS[0]}}");
        let output = Command::new("bash").args(["-c", &script]).current_dir(dir.path()).ended();
        assert_eq!(String::from_utf8(output.stdout).unwrap(), "0\n", "{arguments}");
        assert_eq!(String::from_utf8(output.stderr).unwrap(), "", "{arguments}");
    }
    assert!(dir.path().join("out/small/run.json").exists());
}

#[cfg(target_os = "linux")]
#[test]
fn what_cannot_be_written_is_told() {
    let dir = folder();
    for arguments in [
        "scenes",
        "cite",
        "problems",
        "problems schema",
        "plan small.toml",
        "reference --aspect-ratio 5 --times 0:1:3",
        "completions bash",
        "shape --physical 5",
        "--help",
        "--version",
        "help run",
    ] {
        // What only `clap` prints is looked for by programs that discard it.
        let closed = if arguments.contains("help") || arguments.contains("version") { None } else { Some(">&-") };
        for closed in closed.into_iter().chain(["> /dev/full"]) {
            let ended = limited(dir.path(), &format!("exec {closed}"), arguments);
            assert_eq!(ended.code, Some(2), "{arguments} {closed}: {}", ended.stderr);
            assert!(ended.stderr.contains("standard output: cannot be written"), "{}", ended.stderr);
        }
        let ended = limited(dir.path(), "exec > /dev/null", arguments);
        assert_eq!((ended.code, ended.stderr.as_str()), (Some(0), ""), "{arguments}");
    }
    // What writes files does so all the same.
    let run = limited(dir.path(), "exec >&-", "run small.toml --out closed");
    assert_eq!((run.code, run.stderr.as_str()), (Some(0), ""));
    // Nobody, not even root, makes files there.
    for arguments in ["run small.toml", "sweep small.toml --over interaction.alpha=1,2", "validate", "bench"] {
        for out in ["/proc", "/proc/x"] {
            let run = shearbed(dir.path(), &format!("{arguments} --out {out}"));
            assert_eq!(run.code, Some(2), "{}", run.stderr);
            assert!(run.stderr.contains(&format!("{out}: cannot be written")), "{}", run.stderr);
        }
    }
}

#[test]
fn a_folder_that_vanishes_ends_a_sweep() {
    let dir = folder();
    let sweep = "sweep small.toml --over interaction.alpha=0.1:2:12 --threads 1 --out x";
    // It waits where it says that its first point is finished.
    let mut running = Running::held_at_its_first_message(command(dir.path(), sweep));
    let points = dir.path().join("x/points");
    running.wait_for("the first point is finished", || points.join("01").exists());
    fs::rename(dir.path().join("x"), dir.path().join("away")).unwrap();
    let ended = running.end();
    let message = ended.stderr;
    assert_eq!(ended.code, Some(2), "{message}");
    assert!(message.contains("x: cannot be written: the folder of the sweep has gone"), "{message}");
    assert!(!dir.path().join("x").exists());
}
