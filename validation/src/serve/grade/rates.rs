//! Time that runs at another rate: in plane Couette flow the phase of an answer shows for how long a correct rod has
//! turned; in other flows, the rate is sought at which a correct rod comes nearest.

use super::answer::Answer;
use super::mistakes::{Motion, Setting, right_phase};
use super::nearness::apart;
use crate::judge::statistics::worst;
use crate::serve::problems::{Kind, LoadedProblem};
use nalgebra::{Matrix3, Vector3};
use std::f64::consts::PI;

/// The highest rate that is tried.
const MOST: f64 = 4.0;

/// Above this number of possible half turns, some rate fits any answer.
const HALF_TURNS: f64 = 50.0;

/// A rod nearer to the vorticity axis than this has no usable phase.
const IN_PLANE: f64 = 1e-3;

/// Number of rates that are tried in other flows.
const TRIED: u32 = 500;

/// The rates at which all rows of an answer are those of correct rods, to `nearer_than`; none for rods at rest, which
/// fit any rate.
pub(super) fn rates(loaded: &LoadedProblem, answer: &Answer, setting: &Setting, nearer_than: f64) -> Vec<f64> {
    if loaded.problem.kind != Kind::Rods {
        return Vec::new();
    }
    let (Some(motion), Some(first)) = (Motion::of(setting), loaded.problem.times_s.first()) else {
        return Vec::new();
    };
    let candidates = match right_phase(setting, *first) {
        Some(due) => by_phase(loaded, answer, setting, due).unwrap_or_default(),
        None => nearest(loaded, answer, &motion),
    };
    let fit = |rate: f64| fits(loaded, answer, &motion, rate, nearer_than);
    let rests = |rate: f64| fit(0.95 * rate) && fit(1.05 * rate);
    candidates.into_iter().filter(|rate| (0.01..=MOST).contains(rate) && fit(*rate) && !rests(*rate)).collect()
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

/// The largest distance of the rows at one time from correct rods after `time_s`; NaN if one of them is.
fn off(loaded: &LoadedProblem, rows: &[Vec<f64>], motion: &Motion, time_s: f64) -> f64 {
    let Some(map) = motion.map(time_s) else {
        return f64::INFINITY;
    };
    let of_rod = |(start, values): (&[f64; 3], &Vec<f64>)| {
        moved(&map, start).map_or(f64::INFINITY, |p| apart(&Vector3::from_row_slice(values), &p, false))
    };
    worst(loaded.start.iter().zip(rows).map(of_rod))
}

/// The direction of a rod that starts along `start`; `None` if it is not finite.
fn moved(map: &Matrix3<f64>, start: &[f64; 3]) -> Option<Vector3<f64>> {
    let p = (map * Vector3::from(*start)).normalize();
    p.iter().all(|component| component.is_finite()).then_some(p)
}

/// The rates at which the rods come nearest at the first time, by a search around each minimum of many tried rates.
fn nearest(loaded: &LoadedProblem, answer: &Answer, motion: &Motion) -> Vec<f64> {
    let off = |rate: f64| off(loaded, &answer.rows, motion, rate * loaded.problem.times_s[0]);
    let step = MOST / f64::from(TRIED);
    let tried: Vec<f64> = (0..=TRIED).map(|k| off(step * f64::from(k))).collect();
    let least = tried.windows(3).enumerate().filter(|(_, of)| of[1] <= of[0] && of[1] <= of[2]);
    least.map(|(k, _)| golden(off, [step * k as f64, step * (k + 2) as f64])).collect()
}

/// The place of the minimum of `f` between two ends, by golden section.
fn golden(f: impl Fn(f64) -> f64, [mut low, mut high]: [f64; 2]) -> f64 {
    let section = 0.5 * (5f64.sqrt() - 1.0);
    let inner = |low: f64, high: f64| [high - section * (high - low), low + section * (high - low)];
    let [mut a, mut b] = inner(low, high);
    let [mut f_a, mut f_b] = [f(a), f(b)];
    for _ in 0..60 {
        // One of the two places inside is one of the next two.
        if f_a < f_b {
            (high, b, f_b) = (b, a, f_a);
            a = inner(low, high)[0];
            f_a = f(a);
        } else {
            (low, a, f_a) = (a, b, f_b);
            b = inner(low, high)[1];
            f_b = f(b);
        }
    }
    0.5 * (low + high)
}

/// True if another rate of time is detectable on a problem: its curve is not within the tolerance of the certified
/// answer.
pub(super) fn shows(loaded: &LoadedProblem, rate: f64) -> bool {
    let certified = Answer::certified(loaded);
    let nearer_than = 2.0 * loaded.problem.tolerance;
    let fits = |motion: Motion| fits(loaded, &certified, &motion, rate, nearer_than);
    loaded.problem.kind == Kind::Rods && !Motion::of(&Setting::from(&loaded.problem)).is_some_and(fits)
}

fn fits(loaded: &LoadedProblem, answer: &Answer, motion: &Motion, rate: f64, nearer_than: f64) -> bool {
    let times = answer.rows.chunks(loaded.start.len()).zip(&loaded.problem.times_s);
    times.map(|(rows, time_s)| off(loaded, rows, motion, rate * time_s)).all(|off| off <= nearer_than)
}
