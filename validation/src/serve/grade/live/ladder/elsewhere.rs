//! Asks a program whose answers pass at other times too: one that is right at the end alone, or answers another
//! question than it is asked, is seen there.

use super::Rung;
use super::climb::{End, FOLLOWED};
use crate::judge::statistics::worst;
use crate::methods::integrators::Setting;
use crate::serve::grade::compare::distance;
use crate::serve::grade::diagnosis::{Diagnosis, STEPS_OFF, diagnose};
use crate::serve::grade::live::at_times;
use crate::serve::grade::live::program::Asked;
use crate::serve::grade::order::FAR;
use crate::serve::problems::{Kind, LoadedProblem};
use std::time::Duration;

/// The largest ratio of errors by which one still falls with half the step, or a tenth of the tolerance.
const FALLS: f64 = 0.7;

/// The share of a tolerance by which two answers to one question may differ.
const SAME: f64 = 0.1;

/// Numbers of steps to choose from: in part of each doubling one in some ten is cut.
const CANDIDATES: u64 = 1000;

/// The problem at other times: about rods up to its first time after the start, and to that whose certified rows are
/// farthest from those at the end; about tensors, which are asked for at all times, without the first, and at the last
/// alone, with an odd number of steps.
pub(super) fn others(problem: &LoadedProblem) -> Vec<LoadedProblem> {
    let (times_s, rows, keys) = (&problem.problem.times_s, &problem.certified.rows, problem.problem.kind.keys().len());
    let (times, each) = (times_s.len(), rows.len() / times_s.len().max(1));
    if problem.problem.kind != Kind::Rods {
        let first = (1..times).take(1);
        return first.chain((times > 2).then(|| times - 1)).map(|from| at_times(problem, from..times)).collect();
    }
    let off = |time: &usize| {
        let of = |(row, last): (&Vec<f64>, &Vec<f64>)| distance(problem, &row[keys..], &last[keys..]);
        worst(rows[each * time..].iter().zip(&rows[rows.len() - each..]).map(of))
    };
    let moving = || (0..times.saturating_sub(1)).filter(|time| times_s[*time] > 0.0);
    let farthest = moving().max_by(|a, b| off(a).total_cmp(&off(b)));
    let mut chosen: Vec<_> = moving().next().into_iter().chain(farthest).collect();
    chosen.dedup();
    chosen.into_iter().map(|time| at_times(problem, 0..time + 1)).collect()
}

/// The end of a program that has given `passed` and is asked the same again, if it has time to: a right one gives the
/// same answer but for rounding.
pub(super) fn repeated(
    passed: &Rung,
    tolerance: f64,
    timeout: Duration,
    ask: impl Fn(Setting) -> Result<Rung, Asked>,
) -> End {
    if 2 * passed.took > timeout {
        return End::Reached;
    }
    match ask(passed.setting) {
        Ok(again) => {
            let change = passed.answer.largest_change(&again.answer);
            let setting = passed.setting;
            let words =
                || format!("asked the same twice, with {setting}, it gives answers that differ by {change:.1e}");
            if change > SAME * tolerance { End::Jumps(words()) } else { End::Reached }
        }
        Err(asked) => End::without_answer(asked),
    }
}

/// An odd number N of steps from `from` to twice that for which T/(T/N), rounded, is below N: a program that cuts it to
/// a whole number takes a step too few.
fn cut(time_s: f64, from: u64) -> u64 {
    let is_cut = |steps: &u64| ((time_s / (time_s / *steps as f64)) as u64) < *steps;
    (0..CANDIDATES).map(|k| (from + from * k / CANDIDATES) | 1).find(is_cut).unwrap_or(from)
}

/// The end of a program that passes with `passed`, asked once more at the times of the first of the two problems, and
/// the mistake by which it fails there. Where a rod flips then, a right program is off by more than at the end, but by
/// less with each finer setting.
pub(super) fn judged(
    passed: &Rung,
    problems: [&LoadedProblem; 2],
    timeout: Duration,
    ask: impl Fn(Setting) -> Result<Rung, Asked>,
) -> (End, Diagnosis) {
    let [other_s, end_s] = problems.map(|of| of.problem.times_s.last().copied().unwrap_or_default());
    let due = FAR * passed.error().max(problems[1].problem.tolerance);
    // Steps of equal length end at every time: with several, not every number will do.
    let alone = problems[0].problem.times_s.len() == 1;
    let finer = |k: i32| match passed.setting {
        Setting::Steps(steps) => {
            let steps = (steps as f64 * other_s / end_s).ceil() as u64 * (1 << k);
            Setting::Steps(if alone { cut(other_s, steps | 1) } else { steps })
        }
        Setting::Tolerance(asked) => Setting::Tolerance((asked * 0.1f64.powi(k)).max(1e-14)),
        Setting::Once => Setting::Once,
    };
    // Tensors do not flip.
    let mut most = if problems[1].problem.kind == Kind::Rods { FOLLOWED.max(due) } else { due };
    for setting in (0..3).map(finer) {
        let rung = match ask(setting) {
            Ok(rung) => rung,
            Err(asked) => return (End::without_answer(asked), Diagnosis::default()),
        };
        let error = rung.error();
        if error <= due {
            break;
        }
        let named = diagnose(problems[0], &rung.answer, error, setting.steps().ok());
        // A missing step is small beside a flip, and halves with the step.
        let is_off = named.suspects.iter().any(|name| STEPS_OFF.contains(&name.as_str()));
        if error.is_nan() || error > most || is_off {
            let asked = if other_s < end_s {
                format!("up to t = {other_s} s")
            } else {
                (if alone { "at the last time alone" } else { "without the first time" }).to_owned()
            };
            let before = passed.error();
            let words = format!("asked {asked}, with {setting}, it is off by {error:.1e}, before by {before:.1e}");
            return (End::Jumps(words), named);
        }
        if 4 * rung.took > timeout {
            break;
        }
        most = FALLS * error;
    }
    (End::Reached, Diagnosis::default())
}

#[test]
fn a_number_of_steps_is_found_at_which_a_cut_quotient_loses_one() {
    for (time_s, from) in [(18.51101255990904, 555), (76.13752245190567, 2087), (1.0, 49), (7.342660346907454e5, 16421)]
    {
        let steps = cut(time_s, from);
        assert!(steps % 2 == 1 && steps >= from && steps < 2 * from, "{steps}");
        assert_eq!((time_s / (time_s / steps as f64)) as u64, steps - 1);
    }
}
