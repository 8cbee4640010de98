//! Grading a program that runs: it is asked over its standard input and answers over its standard output.

mod bench;
mod ladder;
pub mod pipe;
mod program;
mod protocol;
mod signals;
mod studies;

pub use bench::{Bench, echo, theory};
pub use ladder::{Mode, grade, mode};
pub use program::{Asked, Program, Question};
pub use signals::end_all;
pub use studies::{Studies, studies};

use crate::problems::{self, LoadedProblem, ProblemDef, Table};
use rayon::prelude::*;
use std::path::PathBuf;

/// Problems about free rods that this build has, as they would be exported: those of the names that are wanted.
pub fn built_in(wanted: impl Fn(&str) -> bool) -> Result<Vec<LoadedProblem>, String> {
    let mut rods = problems::free_rods();
    rods.retain(|def| wanted(def.name));
    rods.par_iter().map(ProblemDef::build).map(loaded).collect()
}

fn loaded(built: problems::Built) -> Result<LoadedProblem, String> {
    let number = |text: &String| text.parse::<f64>().map_err(|error| format!("{text}: {error}"));
    let rows: Result<_, _> = built
        .certified
        .iter()
        .map(|row| row.iter().map(number).collect())
        .collect();
    Ok(LoadedProblem {
        dir: PathBuf::from(&built.problem.name),
        certified: Table {
            columns: built.problem.columns.clone(),
            rows: rows?,
        },
        problem: built.problem,
        start: built.start,
        inputs: None,
    })
}

/// The problem with its last time alone: what a request asks for.
fn last_time(problem: &LoadedProblem) -> LoadedProblem {
    let mut last = problem.clone();
    let rods = problem.start.len();
    last.problem.times_s.drain(..problem.problem.times_s.len() - 1);
    last.certified.rows.drain(..problem.certified.rows.len() - rods);
    last
}
