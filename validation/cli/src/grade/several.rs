//! Several programs on one problem: compared, not judged.

use super::{Args, asked, folder, inputs, started};
use crate::{Failure, refuse, write};
use shearbed_validation::files::output;
use shearbed_validation::files::text::{Shown, complain, line};
use shearbed_validation::present::{plot, report};
use shearbed_validation::serve::grade::live::{self, Program};
use shearbed_validation::serve::problems::{Kind, LoadedProblem};

/// The problem that is compared on unless another is asked for: the paper's rod.
const DEFAULT: &str = "mid-flip-11.6";

/// Compares the programs, and writes each run, a table, and pictures with their numbers.
pub(super) fn compare(args: &Args) -> Result<(), Failure> {
    let judging =
        [("--order", args.order.is_some()), ("--tolerance", !args.tolerances.is_empty()), ("--all", args.all)];
    refuse(judging.into_iter().find(|(_, given)| *given), |(flag, _)| {
        format!("{flag}: several programs are compared, not judged; leave it out")
    })?;
    let problem = problem(args)?;
    let inputs = inputs::of_program(args, args.reference.as_deref(), std::slice::from_ref(&problem))?;
    let names = ["work-precision", "steps", "evaluations", "tolerance"];
    let names: Vec<_> = names.iter().flat_map(|name| [".svg", ".csv"].map(|end| format!("{name}{end}"))).collect();
    output::probe(&args.out, 0, [])?;
    let folder = folder(args, inputs);
    folder.check(&names)?;
    let mut programs: Vec<(String, Program, live::Mode)> = Vec::new();
    for (name, command) in args.command.iter().map(|command| named(command)) {
        refuse(programs.iter().find(|(known, ..)| *known == name), |_| {
            format!("--command {name}: two programs have this name; NAME=PROGRAM gives one")
        })?;
        let (program, mode) = live::prepared(started(args, command)?, args.protocol.is_none());
        programs.push((name, program, mode));
    }
    let found = live::several(&programs, &problem);
    for (name, program, _) in &programs {
        let breaches = program.breaches().into_iter().chain(program.close().err());
        breaches.for_each(|breach| complain(&format!("{}\n", line(&format!("warning: {name}: {breach}")))));
    }
    let table = found.table();
    let files = || -> Result<_, String> {
        let mut files = vec![("runs.csv".to_owned(), found.csv()?), ("programs.csv".to_owned(), table.csv()?)];
        for (name, figure) in found.figures() {
            files.push((format!("{name}.svg"), plot::svg(&figure)?));
            files.push((format!("{name}.csv"), report::figure_csv(&figure)?));
        }
        Ok(files)
    };
    let replaced = write(&folder, &files().map_err(Failure::Failed)?)?;
    let picture = args.out.join("work-precision.svg");
    args.writing.print(&format!("{}picture: {}\n{replaced}", table.for_terminal(), picture.shown()))?;
    match found.silent()[..] {
        [] => Ok(()),
        ref silent => Err(Failure::Failed(format!("no finite answer from {}", silent.join(", ")))),
    }
}

/// The one problem to compare on.
fn problem(args: &Args) -> Result<LoadedProblem, Failure> {
    let all = match (&args.problems[..], &args.reference) {
        ([], None) => live::built_in(|name| name == DEFAULT),
        (_, reference) => asked(args, reference.as_deref())?,
    };
    match <[_; 1]>::try_from(all) {
        Ok([problem]) if problem.problem.kind == Kind::Rods => Ok(problem),
        _ => Err(Failure::Input("--problem: several programs are compared on one problem of rods; name it".to_owned())),
    }
}

/// The name of a program and its command: `NAME=PROGRAM ARGS`, or the command alone, which is its own name.
fn named(command: &str) -> (String, &str) {
    let plain = |name: &str| !name.is_empty() && name.chars().all(|c| c.is_alphanumeric() || "-_.".contains(c));
    match command.split_once('=') {
        Some((name, command)) if plain(name) => (name.to_owned(), command),
        _ => (command.to_owned(), command),
    }
}
