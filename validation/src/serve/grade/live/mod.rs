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
use std::ops::Range;

/// Problems of this build, as they would be exported, whose names `wanted` accepts.
pub fn built_in(wanted: impl Fn(&str) -> bool + Sync) -> Vec<LoadedProblem> {
    let all = problems::all().par_iter().filter(|def| wanted(def.name));
    all.map(|def| def.built().loaded(def.name.into())).collect()
}

/// The problem with only its last time, as in a request.
pub fn last_time(problem: &LoadedProblem) -> LoadedProblem {
    let times = problem.problem.times_s.len();
    at_times(problem, times - 1..times)
}

/// The problem with only these of its times.
fn at_times(problem: &LoadedProblem, times: Range<usize>) -> LoadedProblem {
    let mut other = problem.clone();
    let each = problem.certified.rows.len() / problem.problem.times_s.len().max(1);
    other.certified.rows = problem.certified.rows[each * times.start..each * times.end].to_vec();
    other.problem.times_s = problem.problem.times_s[times].to_vec();
    other
}
