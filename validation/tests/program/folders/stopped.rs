//! A full disk, and runs that were killed.

use crate::common::{SMALL, command, files, folder, kill, limited, shearbed, wait_for};
use std::fs;
use std::process::Stdio;

#[test]
fn a_full_disk_is_found_before_the_work() {
    let dir = folder();
    // Hours of work.
    let long = SMALL
        .replace("replicas = 3", "replicas = 1000000")
        .replace("steps_per_period = 20", "steps_per_period = 2000");
    fs::write(dir.path().join("long.toml"), long).unwrap();
    for arguments in [
        "run long.toml --out x",
        "sweep long.toml --over interaction.alpha=1,2 --out x",
        "converge long.toml --out x",
        "validate --out x",
        "bench --out x",
    ] {
        let ended = limited(dir.path(), "trap '' XFSZ; ulimit -f 100", arguments);
        let message = ended.stderr;
        assert_eq!(ended.code, Some(2), "{arguments}: {message}");
        assert!(message.contains("x: cannot be written: File too large"), "{message}");
        assert!(message.contains("MB are to be written there"), "{message}");
        assert!(!dir.path().join("x").exists(), "{arguments}");
    }
}

#[test]
fn what_a_killed_run_left_is_put_right_by_the_next() {
    let dir = folder();
    let run = "run small.toml --quiet --out x";
    assert_eq!(shearbed(dir.path(), run).code, Some(0));
    let x = dir.path().join("x");
    let whole = files(&x);
    // Killed as it wrote: half a set under a hidden name, and the temporary files of an older version.
    for name in ["x/.shearbed-part/curves", ".y.shearbed-part"] {
        fs::create_dir_all(dir.path().join(name)).unwrap();
        fs::write(dir.path().join(name).join("half.csv"), "half a ta").unwrap();
    }
    fs::write(dir.path().join(".y.shearbed-part/.shearbed-lock"), "").unwrap();
    fs::write(x.join(".shearbed-Ab3dE6"), "half a ta").unwrap();
    fs::write(x.join("notes.txt"), "the user's own").unwrap();
    assert_eq!(shearbed(dir.path(), run).code, Some(0));
    let mut found = files(&x);
    assert_eq!(found.remove("notes.txt").unwrap(), b"the user's own");
    assert_eq!(found.keys().collect::<Vec<_>>(), whole.keys().collect::<Vec<_>>());
    assert_eq!(shearbed(dir.path(), &run.replace("out x", "out y")).code, Some(0));
    assert!(!dir.path().join(".y.shearbed-part").exists());
    assert_eq!(files(&dir.path().join("y")).len(), whole.len());

    // Killed between two moves: the set is whole under its hidden name. It is moved before anything else happens, even
    // by a command that then fails.
    let ready = x.join(".shearbed-ready");
    fs::create_dir(&ready).unwrap();
    for name in ["projections.csv", "run.json"] {
        fs::rename(x.join(name), ready.join(name)).unwrap();
    }
    let limited = shearbed(dir.path(), "sweep small.toml --over interaction.alpha=1,2 --out x/points/no");
    assert_eq!(limited.code, Some(0), "{}", limited.stderr);
    fs::remove_dir_all(x.join("points")).unwrap();
    assert!(ready.exists());
    fs::write(x.join("sweep.json"), "no record").unwrap();
    assert_eq!(shearbed(dir.path(), "sweep small.toml --over interaction.alpha=1,2 --out x").code, Some(2));
    assert!(!ready.exists());
    assert_eq!(fs::read(x.join("projections.csv")).unwrap(), whole["projections.csv"]);
    assert!(x.join("run.json").exists());
}

/// Killed when some of its files are written under their hidden names. A loaded machine may miss that moment; whatever the moment
/// is, the set is whole or not there.
#[test]
fn a_run_killed_at_any_moment_leaves_a_whole_set_or_none() {
    let dir = folder();
    let run = |seed: usize| format!("run small.toml --quiet --threads 1 --seed {seed} --out x");
    assert_eq!(shearbed(dir.path(), &run(0)).code, Some(0));
    let x = dir.path().join("x");
    let names: Vec<_> = files(&x).into_keys().collect();
    fs::remove_dir_all(&x).unwrap();
    let written = || {
        let hidden = fs::read_dir(dir.path().join(".x.shearbed-part"));
        hidden.map_or(0, |hidden| 1 + hidden.count())
    };
    // The hidden folder, its lock and the files, several times each; and the whole set.
    for round in 0..8 * (names.len() + 4) {
        let mut child = command(dir.path(), &run(round)).spawn().unwrap();
        let least = 1 + round % (names.len() + 4);
        while written() < least && !x.exists() && child.try_wait().unwrap().is_none() {
            std::thread::yield_now();
        }
        child.kill().unwrap();
        child.wait().unwrap();
        if x.exists() {
            let found: Vec<_> = files(&x).into_keys().filter(|name| !name.starts_with('.')).collect();
            assert_eq!(found, names, "round {round}");
            fs::remove_dir_all(&x).unwrap();
        }
    }
}

/// A run that waits for another one in its folder has not opened its checkpoint yet; the file stays all the same.
#[cfg(target_os = "linux")]
#[test]
fn a_signal_before_the_checkpoint_is_opened_says_that_it_stays() {
    let dir = folder();
    fs::create_dir(dir.path().join("x")).unwrap();
    let lock = fs::File::create(dir.path().join("x/.shearbed-lock")).unwrap();
    lock.lock().unwrap();
    for (there, said) in [
        (true, "kept stays as it is, and the same command goes on from there"),
        (false, "`shearbed run` keeps nothing before it ends"),
    ] {
        if there {
            fs::write(dir.path().join("kept"), "").unwrap();
        } else {
            fs::remove_file(dir.path().join("kept")).unwrap();
        }
        let mut run = command(dir.path(), "run small.toml --out x --checkpoint kept");
        let child = run.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
        let open = format!("/proc/{}/fd", child.id());
        wait_for("the lock is waited for", || {
            let mut open = fs::read_dir(&open).into_iter().flatten().flatten();
            open.any(|fd| fs::read_link(fd.path()).is_ok_and(|path| path.ends_with(".shearbed-lock")))
        });
        kill(child.id(), "-TERM");
        let ended = child.wait_with_output().unwrap();
        let message = String::from_utf8(ended.stderr).unwrap();
        assert_eq!(ended.status.code(), Some(143), "{message}");
        assert!(message.contains(said), "{message}");
    }
}
