//! Mutation testing of thousands of mutants in one build: all are put into a copy of the sources, each behind a switch that the
//! environment turns on, and each is judged by the tests that reach its place, the quickest first. `validation/mutation.sh` calls it:
//!
//!     cargo mutants --list --json --package shearbed > list.json
//!     cargo run -p shearbed-suite --example mutants -- list.json [--seconds S] [--resume] [--cases]
//!
//! What became of each mutant is a line of `target/mutants/results.csv`, with which `--resume` goes on. What a switch cannot reach,
//! constants and `const fn`, is left to `cargo mutants` by its name in `left.txt`; `open.txt` has the names of those that no test caught.
//! `--cases` runs each case of the gate that reaches a mutant instead, and writes into `cases.csv` which catch it.

mod judge;
mod switches;
mod tree;

use judge::Test;
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};
use std::error::Error;
use std::fs;
use std::io::Write;
use std::path::Path;
use std::sync::Mutex;
use switches::Mutant;
use tree::Tree;

/// What is asked for.
struct Args {
    list: String,
    /// The time after which no other test of a mutant is started.
    seconds: f64,
    resume: bool,
    cases: bool,
}

fn args() -> Result<Args, Box<dyn Error>> {
    let mut args = Args {
        list: String::new(),
        seconds: f64::INFINITY,
        resume: false,
        cases: false,
    };
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        match word.as_str() {
            "--seconds" => args.seconds = words.next().ok_or("--seconds S")?.parse()?,
            "--resume" => args.resume = true,
            "--cases" => args.cases = true,
            _ => args.list = word,
        }
    }
    Ok(args)
}

fn main() -> Result<(), Box<dyn Error>> {
    let args = args()?;
    let mut mutants: Vec<Mutant> = serde_json::from_str(&fs::read_to_string(&args.list)?)?;
    for (before, mutant) in mutants.iter_mut().enumerate() {
        mutant.id = before + 1;
    }
    if mutants.is_empty() {
        return Err("no mutants in the list".into());
    }
    let here = std::env::current_dir()?;
    let out = here.join("target/mutants");
    fs::create_dir_all(&out)?;
    let tree = Tree::new(&here, &out, &mutants)?;
    let tests = judge::tests(&tree, args.cases)?;
    eprintln!(
        "{} of {} mutants behind switches; {} tests of {:.0} s reach them",
        tree.places.len(),
        mutants.len(),
        tests.len(),
        tests.iter().map(|test| test.seconds).sum::<f64>()
    );
    let path = out.join(if args.cases { "cases.csv" } else { "results.csv" });
    if !args.resume && path.exists() {
        fs::remove_file(&path)?;
    }
    work(&args, &mutants, &tree, &tests, &path)?;
    if !args.cases {
        summary(&fs::read_to_string(&path)?, &out)?;
    }
    Ok(())
}

/// Judges all mutants that the file does not have yet, on all cores.
fn work(
    args: &Args,
    mutants: &[Mutant],
    tree: &Tree,
    tests: &[Test],
    path: &Path,
) -> Result<(), Box<dyn Error>> {
    let known: BTreeSet<String> = fs::read_to_string(path)
        .unwrap_or_default()
        .lines()
        .filter_map(|line| Some(line.split_once('\t')?.0.to_string()))
        .collect();
    let file = Mutex::new(fs::OpenOptions::new().create(true).append(true).open(path)?);
    let todo: Vec<_> = mutants
        .iter()
        .filter(|mutant| !known.contains(&mutant.name))
        .collect();
    // One by one, as each takes a time of its own.
    todo.par_iter().with_max_len(1).try_for_each(|mutant| {
        let said = match tree.places.get(&mutant.id) {
            None if tree.refused.contains(&mutant.id) => "does not compile".to_string(),
            None => "left".to_string(),
            Some(place) if args.cases => judge::all(tests, mutant.id, *place),
            Some(place) => judge::judge(tests, mutant.id, *place, args.seconds),
        };
        let mut file = file.lock().map_err(|error| error.to_string())?;
        let line = format!("{}\t{said}\n", mutant.name);
        file.write_all(line.as_bytes()).map_err(|error| error.to_string())
    })?;
    Ok(())
}

/// Prints how many had which outcome, and writes the names of those that are left and of those that no test caught.
fn summary(results: &str, out: &Path) -> Result<(), Box<dyn Error>> {
    let mut of: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for line in results.lines() {
        let (name, said) = line.split_once('\t').ok_or("a line without an outcome")?;
        let outcome = said.split('\t').next().unwrap_or(said);
        of.entry(outcome).or_default().push(name);
    }
    for (outcome, names) in &of {
        println!("{} {outcome}", names.len());
    }
    let lines = |outcomes: &[&str]| -> String {
        let names = outcomes.iter().filter_map(|outcome| of.get(outcome)).flatten();
        names.map(|name| format!("{name}\n")).collect()
    };
    fs::write(out.join("left.txt"), lines(&["left"]))?;
    Ok(fs::write(
        out.join("open.txt"),
        lines(&["missed", "not reached", "unfinished"]),
    )?)
}
