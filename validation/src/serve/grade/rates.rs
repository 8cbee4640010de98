//! Time that runs at another rate: in plane Couette flow the phase of an answer says for how long a right rod has turned.

use super::answer::Answer;
use super::diagnosis::{apart, setting};
use super::mistakes::{Setting, at_a_rate, phase};
use crate::serve::problems::{Kind, LoadedProblem};
use nalgebra::Vector3;
use std::f64::consts::PI;

/// The highest rate that is looked for.
const MOST: f64 = 4.0;

/// With more half turns than these to choose from, some rate fits anything.
const HALF_TURNS: f64 = 50.0;

/// A rod nearer to the vorticity axis than this has no phase to read.
const IN_PLANE: f64 = 1e-3;

/// The rates at which all rows of an answer are those of right rods, to `nearer_than`; none but in plane Couette flow.
pub(super) fn rates(
    loaded: &LoadedProblem,
    answer: &Answer,
    setting: &Setting,
    nearer_than: f64,
) -> Vec<f64> {
    let found = || {
        let turns = |p: &[f64; 3]| p[0].hypot(p[1]) > IN_PLANE;
        let rod = loaded.start.iter().position(turns)?;
        let at = |p: &[f64]| (p[1] / setting.aspect_ratio).atan2(p[0]);
        // The first time leaves the fewest half turns to choose from.
        let turned = (at(answer.rows.get(rod)?) - at(&loaded.start[rod])).rem_euclid(PI);
        let due = phase(setting, *loaded.problem.times_s.first()?)?;
        let most = (MOST * due / PI).ceil();
        (most <= HALF_TURNS).then_some((turned, due, most as u32))
    };
    let Some((turned, due, most)) = found().filter(|_| loaded.problem.kind == Kind::Rods) else {
        return Vec::new();
    };
    let rates = (0..=most).map(|half_turns| (turned + PI * f64::from(half_turns)) / due);
    rates
        .filter(|rate| (0.01..=MOST).contains(rate) && fits(loaded, answer, setting, *rate, nearer_than))
        .collect()
}

/// Whether time at another rate would show on a problem: its curve is not within the tolerance of the certified answer.
pub(super) fn shows(loaded: &LoadedProblem, rate: f64) -> bool {
    let certified = Answer::certified(loaded);
    let nearer_than = 2.0 * loaded.problem.tolerance;
    loaded.problem.kind == Kind::Rods && !fits(loaded, &certified, &setting(loaded), rate, nearer_than)
}

fn fits(loaded: &LoadedProblem, answer: &Answer, setting: &Setting, rate: f64, nearer_than: f64) -> bool {
    let count = loaded.start.len();
    answer.rows.iter().enumerate().all(|(row, values)| {
        let (start, time) = (Vector3::from(loaded.start[row % count]), loaded.problem.times_s[row / count]);
        let expected = at_a_rate(setting, &start, time, rate);
        expected.is_some_and(|p| apart(&Vector3::from_row_slice(values), &p, false) <= nearer_than)
    })
}
