//! Commands that were killed.

use crate::common::bounded::end;
use crate::common::{command, folder, kill, names, remove_left, wait_for};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Dxsm;
use shearbed_validation::files::output::{RECORD, Record, Sum};
use std::fs;
use std::path::Path;
use std::process::Stdio;
use std::time::Duration;

/// Commands that make folders and files, and that replace them.
const COMMANDS: [&str; 8] = [
    "run small.toml --quiet --seed 3 --out new",
    "run small.toml --quiet --seed SEED --out old",
    "run small.toml --quiet --seed 3 --replicas 40 --checkpoint kept --every 0.01 --out checked",
    "sweep small.toml --over interaction.alpha=0.1,0.2,0.3 --quiet --out swept",
    "reference --aspect-ratio 2 --times 0:1:200 --force --out file/r.csv",
    "validate --case jeffery-period --case kick-bound --quiet --checkpoint cases --out report",
    "problems export --quiet ref",
    "man --quiet man1",
];

/// Kills commands: at a random moment, when a hidden folder appears, when the record of a folder changes. Then nothing
/// of the user's is lost, a folder is the old or the new one or says that it is incomplete, and the same command works.
/// `SHEARBED_KILLS` sets their number.
#[test]
fn a_command_killed_at_any_moment_loses_nothing_and_works_again() {
    let dir = folder();
    let kills = std::env::var("SHEARBED_KILLS").ok().map_or(40, |kills| kills.parse().unwrap());
    let mut random = Pcg64Dxsm::seed_from_u64(49);
    let own = ["old", "swept", "checked", "report", "ref"].map(|name| dir.path().join(name).join("notes.txt"));
    let mut incomplete = 0;
    for kill in 0..kills {
        let line = COMMANDS[kill % COMMANDS.len()].replace("SEED", &kill.to_string());
        let out = dir.path().join(line.rsplit(' ').next().unwrap());
        let record = || fs::read(out.join(RECORD)).unwrap_or_default();
        let hidden = |at: &Path| at.is_dir() && names(at).iter().any(|name| name.starts_with(".shearbed-"));
        let before = record();
        let mut child = command(dir.path(), &line).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        let moment = random.random_range(0..3);
        while child.try_wait().unwrap().is_none() {
            let seen = match moment {
                0 => true,
                1 => hidden(&out) || hidden(out.parent().unwrap()),
                _ => record() != before,
            };
            if seen {
                break;
            }
        }
        let most = [50_000, 5_000, 300][moment];
        std::thread::sleep(Duration::from_micros(random.random_range(0..most)));
        child.kill().unwrap();
        end(&line, child);

        if let Ok(Some(record)) = Record::read(&out) {
            let sums: Vec<_> =
                (record.files.keys()).map(|name| fs::read(out.join(name)).map(|bytes| Sum::of(&bytes)).ok()).collect();
            let whole = sums.iter().zip(record.files.values()).all(|(found, listed)| found.as_ref() == Some(listed));
            let says_so = record.files.iter().all(|(name, sum)| record.check(name, sum).is_err());
            assert!(whole || says_so, "{kill}: {line}");
            incomplete += usize::from(says_so && !record.files.is_empty());
        }
        for notes in own.iter().filter(|notes| notes.exists()) {
            assert_eq!(fs::read(notes).unwrap(), b"mine", "{kill}: {line}");
        }
        let ended = dir.runs(&line);
        assert!(ended.stderr.lines().all(|line| line.contains("that was killed left this folder")), "{}", ended.stderr);
        for place in [dir.path(), &out, out.parent().unwrap()].into_iter().filter(|place| place.is_dir()) {
            remove_left(place);
        }
        for notes in own.iter().filter(|notes| notes.parent().unwrap().exists()) {
            fs::write(notes, "mine").unwrap();
        }
        if kill % COMMANDS.len() == 0 {
            fs::remove_dir_all(out).unwrap();
        }
    }
    println!("{kills} kills, {incomplete} of them left a folder that says that it is incomplete");
}

/// A run that waits for another one in its folder has not opened its checkpoint yet; the file stays all the same.
#[cfg(target_os = "linux")]
#[test]
fn a_signal_before_the_checkpoint_is_opened_says_that_it_stays() {
    let dir = folder();
    fs::create_dir(dir.at("x")).unwrap();
    let lock = fs::File::open(dir.at("x")).unwrap();
    lock.lock().unwrap();
    for (there, said) in [
        (true, "kept stays as it is, and the same command goes on from there"),
        (false, "`shearbed run` saves nothing before it ends"),
    ] {
        if there {
            dir.write("kept", "");
        } else {
            fs::remove_file(dir.at("kept")).unwrap();
        }
        let mut run = command(dir.path(), "run small.toml --out x --checkpoint kept");
        let child = run.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
        let open = format!("/proc/{}/fd", child.id());
        wait_for("the lock is waited for", || {
            let mut open = fs::read_dir(&open).into_iter().flatten().flatten();
            open.any(|fd| fs::read_link(fd.path()).is_ok_and(|path| path.ends_with("x")))
        });
        kill(child.id(), "-TERM");
        let ended = end("a run", child);
        let message = String::from_utf8(ended.stderr).unwrap();
        assert_eq!(ended.status.code(), Some(143), "{message}");
        assert!(message.contains(said), "{message}");
    }
}

/// A signal ends a run before its results are there, and says that nothing is saved; or the run ends as without one.
#[cfg(unix)]
#[test]
fn a_signal_while_results_are_written_changes_nothing() {
    let dir = folder();
    for delay_ms in 0..60 {
        let out = format!("x{delay_ms}");
        let mut run = command(dir.path(), &format!("run small.toml --out {out}"));
        let child = run.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
        std::thread::sleep(std::time::Duration::from_millis(delay_ms));
        kill(child.id(), "-TERM");
        let ended = end("a run", child);
        let message = String::from_utf8(ended.stderr).unwrap();
        assert_eq!(ended.status.code() == Some(0), dir.at(&out).join(RECORD).exists(), "{delay_ms}: {message}");
        assert!(ended.status.code() != Some(0) || message.is_empty(), "{delay_ms}: {message}");
    }
}
