//! How the program ends when it is told to, or when what it writes to has gone.
#![cfg(unix)]

use crate::common::{SMALL, command, files, folder, kill, shearbed, wait_for};
use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::Duration;

/// Points of a third of a second.
fn long(dir: &Path) {
    let scene = SMALL.replace("replicas = 3", "replicas = 100");
    fs::write(dir.join("long.toml"), scene).unwrap();
}

fn told(child: Child) -> (Option<i32>, String) {
    let output = child.wait_with_output().unwrap();
    (output.status.code(), String::from_utf8(output.stderr).unwrap())
}

#[test]
fn a_signal_ends_a_run_with_a_message_and_leaves_nothing() {
    let dir = folder();
    long(dir.path());
    for (signal, code, name) in [
        ("-INT", 130, "SIGINT"),
        ("-TERM", 143, "SIGTERM"),
        ("-HUP", 129, "SIGHUP"),
    ] {
        let mut run = command(dir.path(), "run long.toml --replicas 1000000 --threads 1 --out x");
        let child = run.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
        sleep(Duration::from_millis(300));
        kill(child.id(), signal);
        let (found, message) = told(child);
        assert_eq!(found, Some(code), "{message}");
        assert!(
            message.starts_with(&format!("error: stopped by {name}:")),
            "{message}"
        );
        let names: Vec<_> = fs::read_dir(dir.path())
            .unwrap()
            .map(|entry| entry.unwrap().file_name())
            .collect();
        assert_eq!(names.len(), 2, "{names:?}");
    }
}

#[test]
fn a_sweep_that_was_told_to_end_goes_on() {
    let dir = folder();
    long(dir.path());
    let sweep = "sweep long.toml --over interaction.alpha=0.1:2:12 --quiet --threads 1 --out x";
    let child = command(dir.path(), sweep).stderr(Stdio::piped()).spawn().unwrap();
    let points = dir.path().join("x/points");
    wait_for(|| fs::read_dir(&points).is_ok_and(|found| found.count() >= 2));
    kill(child.id(), "-TERM");
    let (code, message) = told(child);
    assert_eq!(code, Some(143));
    assert!(message.contains("the same command goes on"), "{message}");
    let left = files(&dir.path().join("x"));
    assert!(
        left.keys()
            .all(|name| !name.contains("/.") && !name.starts_with('.')),
        "{:?}",
        left.keys()
    );
    let go_on = shearbed(dir.path(), &sweep.replace("--quiet ", ""));
    assert_eq!(go_on.code, Some(0), "{}", go_on.stderr);
    assert!(
        !go_on.stdout.contains("of which 0 were finished before"),
        "{}",
        go_on.stdout
    );
}

#[test]
fn a_reader_that_goes_away_is_no_error() {
    let dir = folder();
    let program = env!("CARGO_BIN_EXE_shearbed");
    for arguments in [
        "scenes",
        "plan fig4-n50",
        "--help",
        "run small.toml",
        "scenes --show fig5",
    ] {
        // The reader is gone before the first line.
        let script = format!("{program} {arguments} | true; echo ${{PIPESTATUS[0]}}");
        let output = Command::new("bash")
            .args(["-c", &script])
            .current_dir(dir.path())
            .output()
            .unwrap();
        assert_eq!(String::from_utf8(output.stdout).unwrap(), "0\n", "{arguments}");
        assert_eq!(String::from_utf8(output.stderr).unwrap(), "", "{arguments}");
    }
    assert!(dir.path().join("out/small/run.json").exists());
}

#[cfg(target_os = "linux")]
#[test]
fn what_cannot_be_written_is_told() {
    let dir = folder();
    let full = fs::File::options().write(true).open("/dev/full").unwrap();
    let output = command(dir.path(), "scenes").stdout(full).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(
        String::from_utf8(output.stderr)
            .unwrap()
            .contains("standard output: cannot be written")
    );
    // Nobody, not even root, makes files there.
    for arguments in [
        "run small.toml",
        "sweep small.toml --over interaction.alpha=1,2",
        "validate",
        "bench",
    ] {
        for out in ["/proc", "/proc/x"] {
            let run = shearbed(dir.path(), &format!("{arguments} --out {out}"));
            assert_eq!(run.code, Some(2), "{}", run.stderr);
            assert!(
                run.stderr.contains(&format!("{out}: cannot be written")),
                "{}",
                run.stderr
            );
        }
    }
}

#[test]
fn a_folder_that_vanishes_ends_a_sweep() {
    let dir = folder();
    long(dir.path());
    let sweep = "sweep long.toml --over interaction.alpha=0.1:2:12 --quiet --threads 1 --out x";
    let child = command(dir.path(), sweep).stderr(Stdio::piped()).spawn().unwrap();
    let points = dir.path().join("x/points");
    wait_for(|| points.join("01").exists());
    fs::rename(dir.path().join("x"), dir.path().join("away")).unwrap();
    let (code, message) = told(child);
    assert_eq!(code, Some(2), "{message}");
    assert!(
        message.contains("x: cannot be written: the folder of the sweep has gone"),
        "{message}"
    );
    assert!(!dir.path().join("x").exists());
}
