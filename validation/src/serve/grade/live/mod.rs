//! Grading a running program: requests go to its standard input, answers come from its standard output.

mod bench;
mod kill;
mod ladder;
mod path;
pub mod pipe;
mod program;
mod protocol;
mod request;
mod several;
mod studies;
mod tables;
mod text;

pub use bench::{Bench, EchoError, echo, theory};
pub use kill::end_all;
pub(super) use ladder::converging;
pub use ladder::{Mode, grade, prepared};
pub use path::{Along, figure as path_figure};
pub use program::{Asked, Program, Question};
pub use protocol::Protocol;
pub use several::{Several, several};
pub use studies::{Studies, studies};
pub use tables::can_be_asked;

use crate::serve::problems::{self, LoadedProblem};
use rayon::prelude::*;

/// Problems of this build, as they would be exported, whose names `wanted` accepts.
pub fn built_in(wanted: impl Fn(&str) -> bool + Sync) -> Vec<LoadedProblem> {
    let all = problems::all().par_iter().filter(|def| wanted(def.name));
    all.map(|def| def.built().loaded(def.name.into())).collect()
}

/// The problem with only its last time, as in a request.
pub fn last_time(problem: &LoadedProblem) -> LoadedProblem {
    let mut last = problem.clone();
    let rods = problem.start.len();
    last.problem.times_s.drain(..problem.problem.times_s.len() - 1);
    last.certified.rows.drain(..problem.certified.rows.len() - rods);
    last
}
