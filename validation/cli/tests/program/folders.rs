//! Folders of results: nothing torn, nothing mixed, nothing damaged passed on.

mod stopped;

use crate::common::bounded::end;
use crate::common::{command, folder};
use std::collections::BTreeSet;
use std::fs;
use std::process::Stdio;

const SWEEP: &str = "sweep small.toml --over interaction.alpha=0.1:0.4:4 --quiet --threads 1";

#[test]
fn a_damaged_point_does_not_reach_the_table() {
    let dir = folder();
    dir.runs(&format!("{SWEEP} --out good"));
    let good = dir.files("good");
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
            for (name, bytes) in &good {
                dir.write(&format!("damaged/{name}"), bytes);
            }
            let mut bytes = good[&format!("points/3/{name}")].clone();
            change(&mut bytes);
            dir.write(&format!("damaged/points/3/{name}"), bytes);
            if missing {
                fs::remove_dir_all(dir.at("damaged/points/4")).unwrap();
            }
            let sweep = format!("{SWEEP} --out damaged");
            dir.refuses(&sweep, "remove damaged/points/3 to have");
            // What the message asks for helps.
            fs::remove_dir_all(dir.at("damaged/points/3")).unwrap();
            dir.runs(&sweep);
            assert_eq!(dir.files("damaged"), good, "{what}");
            fs::remove_dir_all(dir.at("damaged")).unwrap();
        }
    }
    // Two points that were exchanged.
    let points = dir.at("good/points");
    for (from, to) in [("1", "x"), ("2", "1"), ("x", "2")] {
        fs::rename(points.join(from), points.join(to)).unwrap();
    }
    dir.refuses(&format!("{SWEEP} --out good"), "good/points/1: not as it was written: point.1.2 was");
}

#[test]
fn two_sweeps_started_together_do_not_mix() {
    let dir = folder();
    let of_seed = |seed: u32, out: &str| format!("{SWEEP} --seed {seed} --out {out}");
    for seed in [1, 2] {
        dir.runs(&of_seed(seed, &seed.to_string()));
    }
    let alone = ["1", "2"].map(|name| dir.files(name));
    for round in 0..20 {
        let out = format!("round-{round}");
        let both = [1, 2].map(|seed| {
            let mut child = command(dir.path(), &of_seed(seed, &out));
            child.stderr(Stdio::piped()).spawn().unwrap()
        });
        let both = both.map(|child| end("a sweep", child));
        let codes = both.each_ref().map(|output| output.status.code());
        let written = dir.files(&out);
        match codes {
            [Some(0), Some(2)] => assert_eq!(written, alone[0]),
            [Some(2), Some(0)] => assert_eq!(written, alone[1]),
            _ => panic!("round {round}: {codes:?}"),
        }
        let said = both.map(|output| String::from_utf8(output.stderr).unwrap()).concat();
        let reasons = [
            "another shearbed is at work in this folder",
            "results of `shearbed sweep` from other input are kept here",
        ];
        assert!(reasons.iter().any(|reason| said.contains(reason)), "{said}");
    }
}

#[test]
fn two_runs_into_one_folder_do_not_mix_their_files() {
    let dir = folder();
    let of_seed =
        |seed: u32, out: &str| format!("run small.toml --quiet --force --threads 1 --seed {seed} --out {out}");
    let tables = |out: &str| {
        let mut all = dir.files(out);
        all.retain(|name, _| name.ends_with(".csv"));
        all
    };
    for seed in [1, 2] {
        dir.runs(&of_seed(seed, &seed.to_string()));
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
        let written = dir.files(&out);
        let record: serde_json::Value = serde_json::from_slice(&written["run.json"]).unwrap();
        let seed = record["seed"].as_u64().unwrap() as usize;
        assert_eq!(tables(&out), alone[seed - 1], "round {round}");
        assert!(written.keys().all(|name| !name.starts_with('.')), "{:?}", written.keys());
    }
}

#[test]
fn runs_and_fits_leave_each_others_folders_alone() {
    let dir = folder();
    let points = "t_over_T,x1,x1_u\n0.2,0.3,0.02\n0.5,0.3,0.02\n0.8,0.3,0.02\n";
    dir.write("points.csv", points);
    let run = "run small.toml --quiet";
    let fit = "fit small.toml --data points.csv --over interaction.alpha=0.05:5 --replicas 20 --quiet";
    dir.runs(&format!("{run} --out run"));
    dir.runs(&format!("{fit} --out fit"));

    // Whose results they are is said, and what to do.
    let others = |command: &str, out: &str, why: &str| {
        let way = "; --force overwrites it, another --out leaves it; nothing was changed";
        let end = if why.ends_with("was") { "" } else { way };
        let said = format!("{out}/shearbed.json: results of `shearbed {out}` {why}{end}");
        dir.refuses(&format!("{command} --out {out}"), &said);
    };
    let sweep = "sweep small.toml --over interaction.alpha=0.1,0.2 --quiet";
    for (command, out) in [(run, "fit"), (fit, "run"), (sweep, "run"), (sweep, "fit")] {
        others(command, out, "are kept here");
    }
    // The same fit again is no other one; another one is.
    dir.runs(&format!("{fit} --out fit"));
    let another = "from other input are kept here: ";
    others(&fit.replace("0.05:5", "0.05:6"), "fit", &format!("{another}over.1.to was 5.0 and is 6.0 now"));
    dir.write("points.csv", points.replace("0.5,0.3", "0.5,0.31"));
    others(fit, "fit", &format!("{another}data.1.crc32 was"));

    // Forced, they replace files of the same names and the record; what is the other's or the user's stays.
    for (forced, out, record) in [(run, "fit", "run.json"), (fit, "run", "fit.json")] {
        dir.write(&format!("{out}/notes.txt"), "the user's own");
        let before = dir.files(out);
        dir.runs(&format!("{forced} --force --out {out}"));
        dir.runs(&format!("{forced} --out new-{out}"));
        let after = dir.files(out);
        let new = dir.files(&format!("new-{out}"));
        let all: BTreeSet<_> = before.keys().chain(new.keys()).collect();
        assert!(after.contains_key(record) && after.keys().eq(all));
    }
}
