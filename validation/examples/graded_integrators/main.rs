//! The grader on integrators that are known to be right or wrong: Runge–Kutta methods of order 1 to 8, multistep,
//! implicit and symplectic, Lie-group, splitting and adaptive ones, in p, normalised or not, in q and in angles; and
//! each of them with one coefficient wrong. No right one may fail, no wrong one may pass.
//!
//!     cargo run --example graded_integrators -- --all [--only TEXT] [--timeout S] [--quick]
//!
//! grades all of them and prints the table; as a test it grades a sample. It is also the programs that it grades.

mod catalogue;

use catalogue::Entry;
use libtest_mimic::{Arguments, Failed, Trial};
use rayon::prelude::*;
use shearbed_validation::methods::integrators::Setting;
use shearbed_validation::methods::textbook::{Form, advance};
use shearbed_validation::serve::grade::live::{self, Mode, Program, Protocol};
use shearbed_validation::serve::grade::{Graded, Order, Verdict, settle};
use shearbed_validation::serve::problems::LoadedProblem;
use std::io::{BufRead, Write};
use std::process::ExitCode;
use std::time::Duration;

fn main() -> ExitCode {
    let words: Vec<_> = std::env::args().skip(1).collect();
    let after = |name: &str| words.iter().position(|word| word == name).and_then(|at| words.get(at + 1));
    if let Some(name) = after("--program") {
        return act(name);
    }
    if words.iter().any(|word| word == "--all") {
        let timeout_s = after("--timeout").map_or(60.0, |text| text.parse().expect("seconds"));
        let only = after("--only").cloned().unwrap_or_default();
        return all(&only, timeout_s, words.iter().any(|word| word == "--quick"));
    }
    let trials = vec![
        Trial::test("a_sample_of_right_integrators_has_no_failure", || sample(catalogue::right(), 9)),
        Trial::test("right_integrators_that_failed_before_have_no_failure", || sample(coarse(), 1)),
        Trial::test("a_sample_of_integrators_with_a_wrong_coefficient_fails", || sample(catalogue::wrong(), 23)),
    ];
    libtest_mimic::run(&Arguments::from_args(), trials).exit_code()
}

/// Acts as the program of this name: numbers in, numbers out (docs/src/user/grading.md).
fn act(name: &str) -> ExitCode {
    let entry = catalogue::all().find(|entry| entry.name == name).expect("an integrator of this name");
    let mut out = std::io::stdout();
    for line in std::io::stdin().lock().lines() {
        let line = line.expect("a line");
        let (id, rest) = line.split_once(' ').expect("an id and numbers");
        let x: Vec<f64> = rest.split(' ').map(|word| word.parse().expect("a number")).collect();
        let gradient = [0, 3, 6].map(|at| [x[at], x[at + 1], x[at + 2]]);
        let setting = if x[11] > 0.0 { Setting::Steps(x[11] as u64) } else { Setting::Tolerance(x[12]) };
        let end = |p: &[f64]| advance(&entry.method, entry.form, &gradient, x[9], &[p[0], p[1], p[2]], x[10], setting);
        let ends: Option<Vec<_>> = x[14..].chunks(3).map(end).collect();
        let answer = match ends {
            Some(ends) => ends.iter().flatten().map(|number| format!(" {number:e}")).collect(),
            None => " error it takes the other setting".to_owned(),
        };
        if writeln!(out, "{id}{answer}").and_then(|()| out.flush()).is_err() {
            break;
        }
    }
    ExitCode::SUCCESS
}

/// What a user of such a method asks for: a low order does not come to round-off.
fn tolerance(entry: &Entry) -> f64 {
    match entry.order {
        Some(1) => 1e-2,
        Some(2) => 1e-5,
        Some(3) => 1e-7,
        // At its smallest tolerance, 1e-14, a pair of order 3 takes millions of steps, and their round-off is above
        // ours.
        None if entry.name.starts_with("Bogacki") => 1e-9,
        _ => 0.0,
    }
}

/// Grades one on those of the problems that it applies to, with its order claimed. A wrong one is done with its first
/// failure.
fn graded(entry: &Entry, problems: &[LoadedProblem], timeout_s: f64) -> Vec<Graded> {
    let own = std::env::current_exe().expect("this program's path");
    let command = format!("'{}' --program '{}'", own.display(), entry.name);
    let start = || Program::start(&command, Protocol::Text, Duration::from_secs_f64(timeout_s)).expect("it starts");
    let mode = if entry.order.is_some() { Mode::Steps } else { Mode::Tolerance };
    let claimed = entry.order.map(f64::from);
    let mut program = start();
    let mut all = Vec::new();
    let mut wanted = Vec::new();
    for problem in problems {
        // φ has no value at the poles.
        if entry.form == Form::Angles && ["log-rolling", "poles"].contains(&problem.problem.name.as_str()) {
            continue;
        }
        // Two problems for which there was no time say nothing about the next one.
        if program.given_up().is_some() {
            program = start();
        }
        let problem = problem.clone().with_tolerance(tolerance(entry), "--tolerance");
        all.push(live::grade(&program, &problem, mode, claimed));
        wanted.push(problem);
        if !entry.right && all.last().is_some_and(|graded| graded.verdict == Verdict::Fail) {
            break;
        }
    }
    settle(&wanted, &mut all, claimed);
    all
}

/// Problems that show what is wrong in moments.
const QUICK: [&str; 6] = ["mid-flip-2", "spiral", "disc-0.1", "planar-extension", "couette-turned", "poles"];

/// Right, on the problems that show whether answers jump where steps are long.
fn coarse() -> Vec<Entry> {
    let known = ["AB3 from Kutta 3 in angles", "Bogacki-Shampine 3(2) in angles"];
    catalogue::right().into_iter().filter(|entry| known.contains(&entry.name.as_str())).collect()
}

/// Every n-th of them on the quick problems, without a clock.
fn sample(entries: Vec<Entry>, every: usize) -> Result<(), Failed> {
    const NO_LIMIT_S: f64 = 1e5;
    let problems = live::built_in(|name| QUICK.contains(&name));
    let chosen: Vec<_> = entries.iter().step_by(every).collect();
    let lines: Vec<String> =
        (chosen.par_iter()).filter_map(|entry| complaint(entry, &graded(entry, &problems, NO_LIMIT_S))).collect();
    if lines.is_empty() { Ok(()) } else { Err(lines.join("\n").into()) }
}

/// What is wrong with the verdicts on an integrator.
fn complaint(entry: &Entry, graded: &[Graded]) -> Option<String> {
    let failed: Vec<_> = graded.iter().filter(|graded| graded.verdict == Verdict::Fail).collect();
    match (entry.right, failed.first()) {
        (true, Some(failed)) => Some(format!("{} fails {}: {:?}", entry.name, failed.name, failed.note)),
        (false, None) => Some(format!("{} fails nothing", entry.name)),
        _ => None,
    }
}

fn all(only: &str, timeout_s: f64, quick: bool) -> ExitCode {
    let rods = shearbed_validation::serve::problems::free_rods();
    let problems = live::built_in(|name| if quick { QUICK.contains(&name) } else { rods.contains(&name) });
    let entries: Vec<_> = catalogue::all().filter(|entry| entry.name.contains(only)).collect();
    let results: Vec<_> = (entries.par_iter())
        .map(|entry| {
            let graded = graded(entry, &problems, timeout_s);
            let late = graded.iter().filter(|graded| graded.verdict == Verdict::NotReached);
            let late: Vec<_> = late.map(|graded| graded.name.as_str()).collect();
            if !late.is_empty() {
                eprintln!("not reached: {} on {}", entry.name, late.join(", "));
            }
            if let Some(complaint) = complaint(entry, &graded) {
                eprintln!("WRONG VERDICT: {complaint}");
            }
            graded
        })
        .collect();
    let mut families: Vec<(&str, bool)> = Vec::new();
    for entry in &entries {
        let family = (entry.family, entry.right);
        if !families.contains(&family) {
            families.push(family);
        }
    }
    println!("| integrators | how many | graded | PASS | NOT REACHED | FAIL | order seen | verdict right |");
    println!("| --- | --- | --- | --- | --- | --- | --- | --- |");
    for (family, right) in families {
        let own = || entries.iter().zip(&results).filter(|(entry, _)| (entry.family, entry.right) == (family, right));
        let count = |is: &dyn Fn(&Graded) -> bool| own().flat_map(|(_, all)| all).filter(|one| is(one)).count();
        let [pass, late, fail] = [Verdict::Pass, Verdict::NotReached, Verdict::Fail]
            .map(|verdict| count(&|graded| graded.verdict == verdict));
        let seen = count(&|graded| graded.order_found == Some(Order::Seen));
        let good = own().filter(|(entry, graded)| complaint(entry, graded).is_none()).count();
        let kind = if right { "" } else { ", one coefficient wrong" };
        let (all, gradings) = (own().count(), count(&|_| true));
        println!("| {family}{kind} | {all} | {gradings} | {pass} | {late} | {fail} | {seen} | {good} of {all} |");
    }
    let good = entries.iter().zip(&results).all(|(entry, graded)| complaint(entry, graded).is_none());
    if good { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
