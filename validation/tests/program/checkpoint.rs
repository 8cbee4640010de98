//! Runs that are stopped and gone on from: bit for bit those that are not.
#![cfg(unix)]

use crate::common::{SMALL, command, files, folder, kill, shearbed, wait_for};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Dxsm;
use std::collections::BTreeMap;
use std::fs;
use std::os::unix::fs::MetadataExt;
use std::path::Path;
use std::process::Stdio;
use std::thread::sleep;
use std::time::Duration;

/// About a second: of many replicas, of one, and of free rods.
fn scenes(dir: &Path) -> [&'static str; 3] {
    let long = SMALL
        .replace("count = 20", "count = 300")
        .replace("outputs_per_period = 4", "outputs_per_period = 1");
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

/// Which file stands there: another one after each replacement.
fn inode(path: &Path) -> Option<u64> {
    fs::metadata(path).ok().map(|found| found.ino())
}

/// What a run leaves but times, threads and the words it was called by.
fn results(dir: &Path) -> (BTreeMap<String, Vec<u8>>, serde_json::Value) {
    let mut all = files(dir);
    let record = all.remove("run.json").unwrap();
    let record: serde_json::Value = serde_json::from_slice(&record).unwrap();
    (
        all,
        serde_json::json!([
            record["counters"],
            record["scene"],
            record["seed"],
            record["files"]
        ]),
    )
}

/// Kills a run at random moments until it has been killed so often, and lets it end then: the same files.
#[test]
fn a_run_that_is_killed_goes_on_to_the_same_bits() {
    const KILLS: usize = 6;
    let dir = folder();
    let mut random = Pcg64Dxsm::seed_from_u64(1982);
    for name in scenes(dir.path()) {
        let whole = format!("run {name}.toml --quiet --out {name}-whole");
        assert_eq!(shearbed(dir.path(), &whole).code, Some(0));
        let mut killed = 0;
        let run =
            format!("run {name}.toml --quiet --out {name} --checkpoint kept/{name} --every 0.02 --threads 2");
        for life in 0..KILLS {
            let threads = format!("--threads {}", 1 + life % 3);
            let mut child = command(dir.path(), &run.replace("--threads 2", &threads))
                .spawn()
                .unwrap();
            let file = dir.path().join("kept").join(name);
            // Once or twice kept, and then at any moment.
            for _ in 0..random.random_range(1..3) {
                let before = inode(&file);
                while inode(&file) == before && child.try_wait().unwrap().is_none() {
                    sleep(Duration::from_micros(200));
                }
            }
            sleep(Duration::from_micros(random.random_range(0..15_000)));
            let signal = ["-KILL", "-KILL", "-TERM"][life % 3];
            kill(child.id(), signal);
            let code = child.wait().unwrap().code();
            assert!([None, Some(143), Some(0)].contains(&code), "{name}: {code:?}");
            killed += usize::from(code != Some(0));
            // The folder of results appears whole or not at all.
            let out = dir.path().join(name);
            assert!(!out.exists() || out.join("run.json").exists());
        }
        assert!(killed > 2, "{name}: it has ended too soon");
        let last = shearbed(dir.path(), &run);
        assert_eq!(last.code, Some(0), "{name}: {}", last.stderr);
        assert_eq!(
            results(&dir.path().join(name)),
            results(&dir.path().join(format!("{name}-whole"))),
            "{name}"
        );
        // What is done is kept: it need not run again.
        let again = shearbed(dir.path(), &run.replace("--quiet", "--force"));
        let replicas = ["700 of 700", "1 of 1", "2 of 2"];
        assert!(
            replicas.iter().any(|done| again
                .stdout
                .contains(&format!("{done} replicas are done, 0 halfway"))),
            "{}",
            again.stdout
        );
        assert_eq!(
            results(&dir.path().join(name)),
            results(&dir.path().join(format!("{name}-whole"))),
            "{name}"
        );
        let beside: Vec<_> = files(&dir.path().join("kept"))
            .into_keys()
            .filter(|file| file.contains('.'))
            .collect();
        assert_eq!(beside, [""; 0], "nothing is left beside it");
    }
}

#[test]
fn a_signal_keeps_the_run_and_says_how_to_go_on() {
    let dir = folder();
    scenes(dir.path());
    // So long that only the signal keeps it.
    let run = "run many.toml --replicas 100000 --quiet --checkpoint kept --every 3600";
    for (signal, code) in [("-INT", 130), ("-TERM", 143)] {
        let child = command(dir.path(), run).stderr(Stdio::piped()).spawn();
        let child = child.unwrap();
        wait_for(|| dir.path().join("kept").exists());
        sleep(Duration::from_millis(300));
        kill(child.id(), signal);
        let output = child.wait_with_output().unwrap();
        let told = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(code), "{told}");
        assert!(told.contains("of 100000 replicas are done and"), "{told}");
        assert!(
            told.contains("is kept in kept, and the same command goes on from there"),
            "{told}"
        );
        assert!(!told.contains(" 0 of 100000"), "{told}");
    }
    let found = files(dir.path());
    assert!(
        !found.keys().any(|name| name.starts_with('.')),
        "{:?}",
        found.keys()
    );
}

#[test]
fn a_checkpoint_of_other_work_is_refused() {
    let dir = folder();
    let run = "run small.toml --checkpoint kept --out x";
    assert_eq!(shearbed(dir.path(), run).code, Some(0));
    let kept = fs::read(dir.path().join("kept")).unwrap();
    for (change, key) in [
        ("--seed 2", "scene.ensemble.seed was 1 and is 2 now"),
        ("--replicas 4", "scene.ensemble.replicas was 3 and is 4 now"),
        (
            "--set interaction.alpha=0.6",
            "scene.interaction.alpha was 0.5 and is 0.6 now",
        ),
    ] {
        let other = shearbed(dir.path(), &format!("{run}2 {change}"));
        assert_eq!(other.code, Some(2), "{}", other.stderr);
        assert!(
            other
                .stderr
                .starts_with("error: --checkpoint kept: is of other work: "),
            "{}",
            other.stderr
        );
        assert!(other.stderr.contains(key), "{}", other.stderr);
    }
    let other = shearbed(
        dir.path(),
        "validate --case jeffery-period --checkpoint kept --out x2",
    );
    assert!(other.stderr.contains("is of other work"), "{}", other.stderr);
    assert_eq!(
        (other.code, fs::read(dir.path().join("kept")).unwrap()),
        (Some(2), kept.clone())
    );
    let mut damaged = kept;
    let at = damaged.len() / 2;
    damaged[at] ^= 4;
    fs::write(dir.path().join("kept"), &damaged).unwrap();
    let other = shearbed(dir.path(), &run.replace("--out x", "--out x2"));
    assert_eq!(other.code, Some(2));
    assert!(
        other.stderr.contains("is damaged: its checksum is"),
        "{}",
        other.stderr
    );
    assert!(!dir.path().join("x2").exists());
    for (wrong, allowed) in [
        (
            "--checkpoint k --every 0",
            "seconds from 0.01 to 86400 are allowed",
        ),
        (
            "--checkpoint k --every NaN",
            "seconds from 0.01 to 86400 are allowed",
        ),
        ("--every 5", "--checkpoint <FILE>"),
        ("--checkpoint /proc/k", "/proc/k: cannot be written"),
        ("--checkpoint .", "the name of a file is allowed"),
        (
            "--checkpoint small.toml",
            "small.toml: is no checkpoint of shearbed",
        ),
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
    assert!(
        more.stdout
            .contains("goes on from kept: 2 cases and 0 studies are finished"),
        "{}",
        more.stdout
    );
    let [first, more] = ["first", "more"].map(|out| cases(&dir.path().join(out)));
    // Times too: they have not been taken again.
    assert_eq!(first.len() + 1, more.len());
    assert!(
        first.iter().all(|case| more.contains(case)),
        "{first:#?}\n{more:#?}"
    );
    let fresh = shearbed(
        dir.path(),
        "validate --case kick-bound --case jeffery-period --out fresh",
    );
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
    assert!(
        other.stderr.contains("seed was 1 and is 2 now"),
        "{}",
        other.stderr
    );
}
