//! Mutation testing of thousands of mutants in one build: all are put into a copy of the sources, each behind a switch that the
//! environment turns on, and each is judged by the tests that reach its place, the quickest first. `validation/mutation.sh` calls it:
//!
//!     cargo mutants --list --json --package shearbed > target/mutants.json
//!     cargo run -p shearbed-suite --example mutants -- target/mutants.json [--seconds S] [--resume] [--cases]
//!
//! What became of each mutant is a line of `target/mutants/results.csv`, with which `--resume` goes on. What a switch cannot reach,
//! constants and `const fn`, is left to `cargo mutants` by its name in `left.txt`. A mutant that no test catches and that
//! `docs/strength.md` does not explain ends it with 2. `--cases` runs each case of the gate that reaches a mutant, and writes into
//! `cases.csv` which catch it.

mod judge;
mod switches;
mod tree;

use judge::Test;
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};
use std::error::Error;
use std::fs;
use std::io::Write;
use std::process::ExitCode;
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

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let args = args()?;
    let mut mutants: Vec<Mutant> = serde_json::from_str(&fs::read_to_string(&args.list)?)?;
    for (before, mutant) in mutants.iter_mut().enumerate() {
        mutant.id = before + 1;
    }
    let Some(first) = mutants.first() else {
        println!("no mutants");
        return Ok(ExitCode::SUCCESS);
    };
    let here = std::env::current_dir()?;
    let out = here.join("target/mutants");
    fs::create_dir_all(&out)?;
    let refused = out.join("refused.txt");
    let known = match args.resume {
        true => fs::read_to_string(&refused).unwrap_or_default(),
        false => String::new(),
    };
    let known: BTreeSet<&str> = known.lines().collect();
    let known = mutants
        .iter()
        .filter(|mutant| known.contains(mutant.name.as_str()));
    let known = known.map(|mutant| mutant.id).collect();
    let tree = Tree::new(&here, out.join("tree"), &first.package, &mutants, known)?;
    let names = mutants.iter().filter(|mutant| tree.refused.contains(&mutant.id));
    let names: String = names.map(|mutant| format!("{}\n", mutant.name)).collect();
    fs::write(refused, names)?;
    let mut tests = judge::tests(&tree)?;
    if args.cases {
        tests.retain(|test| test.name.starts_with("gate "));
    }
    eprintln!(
        "{} of {} mutants behind switches; {} tests of {:.0} s reach them",
        tree.places.len(),
        mutants.len(),
        tests.len(),
        tests.iter().map(|test| test.seconds).sum::<f64>()
    );
    let path = out.join(if args.cases { "cases.csv" } else { "results.csv" });
    if !args.resume {
        let _ = fs::remove_file(&path);
    }
    work(&args, &mutants, &tree, &tests, &path)?;
    let results = fs::read_to_string(&path)?;
    let left: String = results
        .lines()
        .filter_map(|line| Some(line.strip_suffix("\tleft")?.to_owned() + "\n"))
        .collect();
    fs::write(out.join("left.txt"), left)?;
    Ok(summary(
        &results,
        &fs::read_to_string(here.join("docs/strength.md"))?,
    ))
}

/// Judges all mutants that the file does not have yet, on all cores.
fn work(
    args: &Args,
    mutants: &[Mutant],
    tree: &Tree,
    tests: &[Test],
    path: &std::path::Path,
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

/// How many had which outcome, and the names of those that no test caught and the page does not explain.
fn summary(results: &str, page: &str) -> ExitCode {
    let mut counts = BTreeMap::new();
    let mut code = ExitCode::SUCCESS;
    for line in results.lines() {
        let (name, said) = line.split_once('\t').unwrap_or((line, ""));
        let outcome = said.split('\t').next().unwrap_or("");
        *counts.entry(outcome).or_insert(0) += 1;
        // A place moves with the lines above it; the file, what is replaced and the function do not.
        let (file, what) = name.split_once(": ").unwrap_or((name, ""));
        let explained = format!("- `{}: {what}`: ", file.split(':').next().unwrap_or(""));
        if matches!(outcome, "missed" | "not reached" | "unfinished") && !page.contains(&explained) {
            println!("{outcome}: {name}");
            code = ExitCode::from(2);
        }
    }
    for (outcome, count) in counts {
        println!("{count} {outcome}");
    }
    code
}
