//! Time that runs at another rate: in plane Couette flow the phase of an answer shows for how long a correct rod has turned; in
//! other flows, the rate is sought at which a correct rod comes nearest.

use super::answer::Answer;
use super::diagnosis::{apart, setting};
use super::mistakes::{Setting, at_a_rate, phase};
use crate::serve::problems::{Kind, LoadedProblem};
use nalgebra::Vector3;
use std::f64::consts::PI;

/// The highest rate that is tried.
const MOST: f64 = 4.0;

/// Above this number of possible half turns, some rate fits any answer.
const HALF_TURNS: f64 = 50.0;

/// A rod nearer to the vorticity axis than this has no usable phase.
const IN_PLANE: f64 = 1e-3;

/// Number of rates that are tried in other flows.
const TRIED: u32 = 500;

/// The rates at which all rows of an answer are those of correct rods, to `nearer_than`; none for rods at rest, which fit any rate.
pub(super) fn rates(
    loaded: &LoadedProblem,
    answer: &Answer,
    setting: &Setting,
    nearer_than: f64,
) -> Vec<f64> {
    if loaded.problem.kind != Kind::Rods {
        return Vec::new();
    }
    let first = loaded.problem.times_s.first().copied().unwrap_or(f64::NAN);
    let candidates = match phase(setting, first) {
        Some(due) => by_phase(loaded, answer, setting, due).unwrap_or_default(),
        None => nearest(loaded, answer, setting),
    };
    let fit = |rate: f64| fits(loaded, answer, setting, rate, nearer_than);
    let rests = |rate: f64| fit(0.95 * rate) && fit(1.05 * rate);
    candidates
        .into_iter()
        .filter(|rate| (0.01..=MOST).contains(rate) && fit(*rate) && !rests(*rate))
        .collect()
}

/// The rates by the phase of the first rod that turns; a correct rod has the phase `due` at the first time.
fn by_phase(loaded: &LoadedProblem, answer: &Answer, setting: &Setting, due: f64) -> Option<Vec<f64>> {
    let turns = |p: &[f64; 3]| p[0].hypot(p[1]) > IN_PLANE;
    let rod = loaded.start.iter().position(turns)?;
    let at = |p: &[f64]| (p[1] / setting.aspect_ratio).atan2(p[0]);
    // The first time leaves the smallest number of possible half turns.
    let turned = (at(answer.rows.get(rod)?) - at(&loaded.start[rod])).rem_euclid(PI);
    let most = (MOST * due / PI).ceil();
    (most <= HALF_TURNS)
        .then(|| (0..=most as u32).map(|half_turns| (turned + PI * f64::from(half_turns)) / due).collect())
}

/// The rates at which the rods come nearest at the first time, by a search around each minimum of many tried rates.
fn nearest(loaded: &LoadedProblem, answer: &Answer, setting: &Setting) -> Vec<f64> {
    let off = |rate: f64| {
        let of_rod = |(start, values): (&[f64; 3], &Vec<f64>)| {
            let p = at_a_rate(setting, &Vector3::from(*start), loaded.problem.times_s[0], rate);
            p.map_or(f64::INFINITY, |p| apart(&Vector3::from_row_slice(values), &p, false))
        };
        loaded.start.iter().zip(&answer.rows).map(of_rod).fold(0.0, f64::max)
    };
    let step = MOST / f64::from(TRIED);
    let tried: Vec<f64> = (0..=TRIED).map(|k| off(step * f64::from(k))).collect();
    let least = tried.windows(3).enumerate().filter(|(_, of)| of[1] <= of[0] && of[1] <= of[2]);
    least.map(|(k, _)| golden(off, [step * k as f64, step * (k + 2) as f64])).collect()
}

/// The place of the minimum of `f` between two ends, by golden section.
fn golden(f: impl Fn(f64) -> f64, [mut low, mut high]: [f64; 2]) -> f64 {
    let section = 0.5 * (5f64.sqrt() - 1.0);
    for _ in 0..80 {
        let [a, b] = [high - section * (high - low), low + section * (high - low)];
        if f(a) < f(b) {
            high = b;
        } else {
            low = a;
        }
    }
    0.5 * (low + high)
}

/// True if another rate of time is detectable on a problem: its curve is not within the tolerance of the certified answer.
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
