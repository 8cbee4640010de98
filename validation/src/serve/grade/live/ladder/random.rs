//! Programs with random numbers, which answer with standard errors.

use super::climb::{End, climb};
use super::{Mode, Rung, verdict};
use crate::methods::integrators::Setting;
use crate::serve::grade::files::judge;
use crate::serve::grade::live::program::{Asked, Program};
use crate::serve::grade::live::protocol::Rows;
use crate::serve::grade::report::joined;
use crate::serve::grade::{Graded, Verdict};
use crate::serve::problems::LoadedProblem;
use std::time::Duration;

/// Grades a code with random numbers by its standard errors, with as many steps as make it right.
pub(super) fn graded(
    program: &Program,
    problem: &LoadedProblem,
    mode: Mode,
    table: impl Fn(Setting) -> Result<((Rows, Option<Rows>), Duration), Asked>,
) -> Graded {
    let problem = &problem.with_standard_errors();
    let columns = &problem.problem.columns[1..];
    let ask = |setting: Setting| {
        let ((means, errors), took) = table(setting)?;
        let errors = errors.unwrap_or_else(|| vec![vec![f64::NAN; columns.len() / 2]; means.len()]);
        let row = |(means, errors): (&Vec<f64>, &Vec<f64>)| {
            let both: Vec<_> = means.iter().zip(errors).flat_map(|(mean, se)| [*mean, *se]).collect();
            program.axes.row_to_ours(columns, &both)
        };
        let rows = means.iter().zip(&errors).map(row).collect();
        Ok(Rung::of(problem, setting, rows, took))
    };
    let (rungs, end) = climb(problem, mode, program.timeout, None, ask);
    let mut graded = Graded::without_answer(problem);
    graded.verdict = verdict(&end, false);
    if let Some(finest) = rungs.last() {
        graded.set_setting(finest.setting);
        judge(&mut graded, problem, &finest.answer, None);
        // Out of time it is no failure, unless it is on the curve of a mistake.
        let late = matches!(end, End::NotReached(_)) && graded.diagnosis.is_none();
        if matches!(end, End::Broke(_)) {
            graded.verdict = Verdict::Fail;
        } else if late && graded.verdict == Verdict::Fail {
            graded.verdict = Verdict::NotReached;
        }
    }
    if let End::Broke(words) | End::Refused(words) | End::NotReached(words) = end {
        graded.note = Some(joined([graded.note, Some(words)]));
    }
    graded
}
