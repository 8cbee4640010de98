//! Folders of results: nothing torn, nothing mixed, nothing damaged passed on.

mod stopped;

use crate::common::bounded::end;
use crate::common::{command, files, folder, shearbed};
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::Stdio;

const SWEEP: &str = "sweep small.toml --over interaction.alpha=0.1:0.4:4 --quiet --threads 1";

/// Changes bytes of a file.
fn damage(path: &Path, change: impl FnOnce(&mut Vec<u8>)) {
    let mut bytes = fs::read(path).unwrap();
    change(&mut bytes);
    fs::write(path, bytes).unwrap();
}

#[test]
fn a_damaged_point_does_not_reach_the_table() {
    let dir = folder();
    assert_eq!(shearbed(dir.path(), &format!("{SWEEP} --out good")).code, Some(0));
    let good = files(&dir.path().join("good"));
    type Change = fn(&mut Vec<u8>);
    let last_digit: Change = |bytes| {
        let at = bytes.iter().rposition(u8::is_ascii_digit).unwrap();
        bytes[at] = if bytes[at] == b'1' { b'2' } else { b'1' };
    };
    let damages: [(&str, &str, Change); 6] = [
        ("a changed digit", "projections.csv", last_digit),
        ("a flipped bit", "mean_angle.csv", |bytes| {
            let at = bytes.len() - 5;
            bytes[at] ^= 1;
        }),
        ("nan", "projections.csv", |bytes| {
            let at = bytes.iter().rposition(|byte| *byte == b',').unwrap();
            bytes.splice(at + 1.., *b"nan\n");
        }),
        ("cut at a line's end", "projections.csv", |bytes| {
            let end = bytes.len() - 1;
            let at = bytes[..end].iter().rposition(|byte| *byte == b'\n').unwrap();
            bytes.truncate(at + 1);
        }),
        ("another checksum", "shearbed.json", last_digit),
        ("empty", "shearbed.json", Vec::clear),
    ];
    for (what, name, change) in damages {
        for missing in [false, true] {
            let out = dir.path().join("damaged");
            for (name, bytes) in &good {
                let path = out.join(name);
                fs::create_dir_all(path.parent().unwrap()).unwrap();
                fs::write(path, bytes).unwrap();
            }
            damage(&out.join("points/3").join(name), change);
            if missing {
                fs::remove_dir_all(out.join("points/4")).unwrap();
            }
            let before = files(&out);
            let run = shearbed(dir.path(), &format!("{SWEEP} --out damaged"));
            assert_eq!(run.code, Some(2), "{what}: {}", run.stderr);
            assert!(run.stderr.contains("damaged/points/3"), "{what}: {}", run.stderr);
            assert!(run.stderr.contains("remove damaged/points/3 to have"), "{}", run.stderr);
            assert_eq!(files(&out), before, "{what}");
            // What the message asks for helps.
            fs::remove_dir_all(out.join("points/3")).unwrap();
            assert_eq!(shearbed(dir.path(), &format!("{SWEEP} --out damaged")).code, Some(0));
            assert_eq!(files(&out), good, "{what}");
            fs::remove_dir_all(out).unwrap();
        }
    }
    // Two points that were exchanged.
    let points = dir.path().join("good/points");
    for (from, to) in [("1", "x"), ("2", "1"), ("x", "2")] {
        fs::rename(points.join(from), points.join(to)).unwrap();
    }
    let run = shearbed(dir.path(), &format!("{SWEEP} --out good"));
    assert_eq!(run.code, Some(2), "{}", run.stderr);
    assert!(run.stderr.contains("good/points/1: not as it was written: point.1.2 was"), "{}", run.stderr);
}

#[test]
fn two_sweeps_started_together_do_not_mix() {
    let dir = folder();
    let of_seed = |seed: u32, out: &str| format!("{SWEEP} --seed {seed} --out {out}");
    for seed in [1, 2] {
        assert_eq!(shearbed(dir.path(), &of_seed(seed, &seed.to_string())).code, Some(0));
    }
    let alone = ["1", "2"].map(|name| files(&dir.path().join(name)));
    for round in 0..20 {
        let out = format!("round-{round}");
        let both = [1, 2].map(|seed| {
            let mut child = command(dir.path(), &of_seed(seed, &out));
            child.stderr(Stdio::piped()).spawn().unwrap()
        });
        let both = both.map(|child| end("a sweep", child));
        let codes = both.each_ref().map(|output| output.status.code());
        let found = files(&dir.path().join(&out));
        match codes {
            [Some(0), Some(2)] => assert_eq!(found, alone[0]),
            [Some(2), Some(0)] => assert_eq!(found, alone[1]),
            _ => panic!("round {round}: {codes:?}"),
        }
        let told = both.map(|output| String::from_utf8(output.stderr).unwrap()).concat();
        let reasons = [
            "another shearbed is at work in this folder",
            "results of `shearbed sweep` from other input are kept here",
        ];
        assert!(reasons.iter().any(|reason| told.contains(reason)), "{told}");
    }
}

#[test]
fn two_runs_into_one_folder_do_not_mix_their_files() {
    let dir = folder();
    let of_seed =
        |seed: u32, out: &str| format!("run small.toml --quiet --force --threads 1 --seed {seed} --out {out}");
    let tables = |out: &str| {
        let mut all = files(&dir.path().join(out));
        all.retain(|name, _| name.ends_with(".csv"));
        all
    };
    for seed in [1, 2] {
        assert_eq!(shearbed(dir.path(), &of_seed(seed, &seed.to_string())).code, Some(0));
    }
    let alone = ["1", "2"].map(tables);
    assert_ne!(alone[0], alone[1]);
    for round in 0..40 {
        // Every other round into a folder that is there.
        let out = format!("round-{}", round / 2);
        let both = [1, 2].map(|seed| command(dir.path(), &of_seed(seed, &out)).spawn().unwrap());
        for child in both {
            assert_eq!(end("a run", child).status.code(), Some(0), "round {round}");
        }
        let found = files(&dir.path().join(&out));
        let record: serde_json::Value = serde_json::from_slice(&found["run.json"]).unwrap();
        let seed = record["seed"].as_u64().unwrap() as usize;
        assert_eq!(tables(&out), alone[seed - 1], "round {round}");
        assert!(found.keys().all(|name| !name.starts_with('.')), "{:?}", found.keys());
    }
}

#[test]
fn every_key_has_one_owner() {
    let dir = folder();
    for (arguments, named) in [
        ("--over ensemble={replicas=5} --replicas 3", "--replicas and --over ensemble: both set ensemble.replicas"),
        (
            "--over particles.count=1,2 --over \
             particles={count=7,length_mm=0.72,aspect_ratio=5,orientation=\"isotropic\"}",
            "--over particles and --over particles.count: both set particles.count",
        ),
        ("--over ensemble={seed=5} --seed 3", "both set ensemble.seed"),
    ] {
        let run = shearbed(dir.path(), &format!("sweep small.toml {arguments} --out x"));
        assert_eq!(run.code, Some(2), "{arguments}: {}", run.stderr);
        assert!(run.stderr.contains(named), "{}", run.stderr);
    }
    assert!(!dir.path().join("x").exists());
}

/// A limit on the size of files, which meets a writer as a full disk does.
#[cfg(target_os = "linux")]
/// What a folder holds besides records of which each writing differs.
fn unchanged(dir: &Path, arguments: &str, holds: &str, said: &str) {
    let before = files(&dir.join(holds));
    let done = shearbed(dir, arguments);
    assert_eq!(done.code, Some(2), "{arguments}: {}", done.stderr);
    assert!(done.stderr.contains(said), "{arguments}: {}", done.stderr);
    let way = "--force overwrites it, another --out leaves it; nothing was changed";
    assert!(done.stderr.contains(way), "{}", done.stderr);
    assert_eq!(files(&dir.join(holds)), before, "{arguments}");
}

#[test]
fn runs_and_fits_leave_each_others_folders_alone() {
    let dir = folder();
    let points = "t_over_T,x1,x1_u\n0.2,0.3,0.02\n0.5,0.3,0.02\n0.8,0.3,0.02\n";
    fs::write(dir.path().join("points.csv"), points).unwrap();
    let run = "run small.toml --quiet";
    let fit = "fit small.toml --data points.csv --over interaction.alpha=0.05:5 --replicas 20 --quiet";
    assert_eq!(shearbed(dir.path(), &format!("{run} --out run")).code, Some(0));
    let done = shearbed(dir.path(), &format!("{fit} --out fit"));
    assert_eq!(done.code, Some(0), "{}", done.stderr);

    unchanged(
        dir.path(),
        &format!("{run} --out fit"),
        "fit",
        "fit/shearbed.json: results of `shearbed fit` are kept here",
    );
    unchanged(
        dir.path(),
        &format!("{fit} --out run"),
        "run",
        "run/shearbed.json: results of `shearbed run` are kept here",
    );
    let sweep = "sweep small.toml --over interaction.alpha=0.1,0.2 --quiet --out";
    unchanged(dir.path(), &format!("{sweep} run"), "run", "run/shearbed.json: results of `shearbed run` are kept here");
    unchanged(dir.path(), &format!("{sweep} fit"), "fit", "fit/shearbed.json: results of `shearbed fit` are kept here");
    // The same fit again is no other one; another one is.
    assert_eq!(shearbed(dir.path(), &format!("{fit} --out fit")).code, Some(0));
    let another = "fit/shearbed.json: results of `shearbed fit` from other input are kept here: ";
    let wider = fit.replace("0.05:5", "0.05:6");
    unchanged(dir.path(), &format!("{wider} --out fit"), "fit", &format!("{another}over.1.to was 5.0 and is 6.0 now"));
    fs::write(dir.path().join("points.csv"), points.replace("0.5,0.3", "0.5,0.31")).unwrap();
    unchanged(dir.path(), &format!("{fit} --out fit"), "fit", &format!("{another}data.1.crc32 was"));

    // Forced, they replace files of the same names and the record; what is the other's or the user's stays.
    for (forced, out, record) in [(run, "fit", "run.json"), (fit, "run", "fit.json")] {
        fs::write(dir.path().join(out).join("notes.txt"), "the user's own").unwrap();
        let before = files(&dir.path().join(out));
        let done = shearbed(dir.path(), &format!("{forced} --force --out {out}"));
        assert_eq!(done.code, Some(0), "{}", done.stderr);
        assert_eq!(shearbed(dir.path(), &format!("{forced} --out new-{out}")).code, Some(0));
        let after = files(&dir.path().join(out));
        let new = files(&dir.path().join(format!("new-{out}")));
        let all: BTreeSet<_> = before.keys().chain(new.keys()).collect();
        assert!(after.contains_key(record) && after.keys().eq(all));
    }
}
