//! Folders of results: nothing torn, nothing mixed, nothing damaged passed on.

mod stopped;

use crate::common::bounded::end;
use crate::common::{command, folder};
use std::process::Stdio;

const SWEEP: &str = "sweep small.toml --over interaction.alpha=0.1:0.4:4 --quiet --threads 1";

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
