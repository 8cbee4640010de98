//! How the program ends after a signal, or when what it writes to has gone.
#![cfg(unix)]

use crate::common::bounded::end;
use crate::common::running::Running;
use crate::common::{SMALL, command, folder};
use std::fs;
use std::os::fd::OwnedFd;
use std::os::unix::net::UnixDatagram;
use std::path::Path;
use std::process::Stdio;

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
        let how = "saves nothing before it ends, but with --checkpoint FILE, from which the same command goes on\n";
        assert!(message.ends_with(&format!("`shearbed run` {how}")), "{message}");
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
            0 => assert_eq!(running.message(), "saved in x: 1 of 2 points are finished\n"),
            _ => assert_eq!(running.line(), "goes on from x: 1 of 2 points are finished\n"),
        }
        running.signal("-TERM");
        let ended = running.end();
        assert_eq!(ended.code, Some(143));
        assert!(ended.stderr.contains("the same command goes on"), "{}", ended.stderr);
        let left = dir.files("x");
        assert!(left.keys().all(|name| !name.contains("/.") && !name.starts_with('.')), "{:?}", left.keys());
    }
}

#[test]
fn a_folder_that_vanishes_ends_a_sweep() {
    let dir = folder();
    let sweep = "sweep small.toml --over interaction.alpha=0.1:2:12 --threads 1 --out x";
    // It waits where it says that its first point is finished.
    let mut running = Running::held_at_its_first_message(command(dir.path(), sweep));
    let points = dir.at("x/points");
    running.wait_for("the first point is finished", || points.join("01").exists());
    fs::rename(dir.at("x"), dir.at("away")).unwrap();
    let ended = running.end();
    let message = ended.stderr;
    assert_eq!(ended.code, Some(2), "{message}");
    assert!(message.contains("x: cannot be written: the folder of the sweep has gone"), "{message}");
    assert!(!dir.at("x").exists());
}

/// Ranks of a job write to one pipe, and what `mpirun` says may come between two writes: each line is one write, which
/// a datagram keeps.
#[test]
fn a_message_is_written_in_one_piece() {
    let dir = folder();
    let first_piece = |arguments: &str| {
        let (ours, theirs) = UnixDatagram::pair().unwrap();
        let mut program = command(dir.path(), arguments);
        let child = program.stdout(Stdio::null()).stderr(OwnedFd::from(theirs)).spawn().unwrap();
        let status = end(arguments, child).status;
        let mut piece = vec![0; 1 << 16];
        let length = ours.recv(&mut piece).unwrap();
        (status.code(), String::from_utf8(piece[..length].to_vec()).unwrap())
    };
    let warned = "run fig4-n50 --replicas 1 --set particles.aspect_ratio=5 --quiet --out x";
    for (arguments, expected, start) in
        [("run no.toml", 2, "error: no.toml: cannot be read: "), (warned, 0, "warning: fig4-n50: ")]
    {
        let (code, piece) = first_piece(arguments);
        assert!(code == Some(expected) && piece.starts_with(start) && piece.ends_with('\n'), "{piece:?}");
    }
}
