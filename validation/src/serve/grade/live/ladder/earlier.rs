//! Asks a program whose answers pass once more, up to an earlier time: one that is right at the end alone, or answers
//! another question than it is asked, is seen there.

use super::Rung;
use super::climb::{End, FOLLOWED};
use crate::judge::statistics::worst;
use crate::methods::integrators::Setting;
use crate::serve::grade::compare::distance;
use crate::serve::grade::live::program::Asked;
use crate::serve::grade::order::FAR;
use crate::serve::problems::LoadedProblem;
use std::time::Duration;

/// The largest ratio of errors by which one still falls with half the step, or a tenth of the tolerance.
const FALLS: f64 = 0.7;

/// The problem up to the time after the start whose certified rows are farthest from those at the end, if there is one.
pub(super) fn earlier(problem: &LoadedProblem) -> Option<LoadedProblem> {
    let (times, keys) = (problem.problem.times_s.len(), problem.problem.kind.keys().len());
    let each = problem.certified.rows.len() / times.max(1);
    let last = problem.certified.rows.rchunks(each.max(1)).next()?;
    let off = |time: &usize| {
        let rows = &problem.certified.rows[each * time..];
        let of = |(row, last): (&Vec<f64>, &Vec<f64>)| distance(problem, &row[keys..], &last[keys..]);
        worst(rows.iter().zip(last).map(of))
    };
    let moving = (0..times.saturating_sub(1)).filter(|time| problem.problem.times_s[*time] > 0.0);
    let farthest = moving.max_by(|a, b| off(a).total_cmp(&off(b)))?;
    let mut earlier = problem.clone();
    earlier.problem.times_s.truncate(farthest + 1);
    earlier.certified.rows.truncate(each * (farthest + 1));
    Some(earlier)
}

/// The end of a program that passes with `passed`, asked once more up to the earlier time of the two problems. Where a
/// rod flips then, a right program is off by more than at the end, but by less with each finer setting.
pub(super) fn judged(
    passed: &Rung,
    problems: [&LoadedProblem; 2],
    timeout: Duration,
    ask: impl Fn(Setting) -> Result<Rung, Asked>,
) -> End {
    let [earlier_s, end_s] = problems.map(|of| of.problem.times_s.last().copied().unwrap_or_default());
    let due = FAR * passed.error().max(problems[1].problem.tolerance);
    let finer = |k: i32| match passed.setting {
        Setting::Steps(steps) => Setting::Steps((steps as f64 * earlier_s / end_s).ceil() as u64 * (1 << k)),
        Setting::Tolerance(asked) => Setting::Tolerance((asked * 0.1f64.powi(k)).max(1e-14)),
        Setting::Once => Setting::Once,
    };
    let mut most = FOLLOWED.max(due);
    for setting in (0..3).map(finer) {
        let rung = match ask(setting) {
            Ok(rung) => rung,
            Err(Asked::Says(_)) => break,
            Err(Asked::Late(words)) => return End::OutOfTime(words),
            Err(Asked::Breach(words)) => return End::Broke(words),
        };
        let error = rung.error();
        if error <= due {
            break;
        }
        if error.is_nan() || error > most {
            let at_end = passed.error();
            return End::Jumps(format!(
                "up to t = {earlier_s} s, with {setting}, it is off by {error:.1e}, at the last time by {at_end:.1e}"
            ));
        }
        if 4 * rung.took > timeout {
            break;
        }
        most = FALLS * error;
    }
    End::Reached
}
