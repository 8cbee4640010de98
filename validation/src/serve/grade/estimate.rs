//! Quantities that are off by an unknown factor: the rate of time, r_e and Λ. A law such as "r_e times 1.3" is sought
//! in the answers to all problems together, as one number that explains each of them.

use super::answer::Answer;
use super::mistakes::{Setting, right_phase};
use super::nearness::{NEARER, apart};
use crate::judge::statistics::worst;
use crate::methods::turning::{Motion, moved};
use crate::serve::problems::{Kind, LoadedProblem};
use nalgebra::Vector3;
use std::f64::consts::PI;

/// The highest rate that is tried.
pub(super) const MOST: f64 = 4.0;

/// Above this number of possible half turns, some rate fits any answer.
const HALF_TURNS: f64 = 50.0;

/// A rod nearer to the vorticity axis than this has no usable phase.
const IN_PLANE: f64 = 1e-7;

/// The range of ln r_e that is tried outside plane Couette flow.
const LOGARITHMS: [f64; 2] = [-8.0, 8.0];

/// Number of values that are tried at equal distances.
const TRIED: u32 = 800;

/// A wrong answer about rods.
pub(super) struct Wrong<'a> {
    pub(super) loaded: LoadedProblem,
    answer: &'a Answer,
    nearer_than: f64,
}

/// A correct rod that may be another one than is asked for, after `rate` times the time.
#[derive(Clone, Copy)]
struct Other {
    setting: Setting,
    rate: f64,
}

/// A quantity that a program has wrong in every problem: in words with {} for its value, the rod that has the value for
/// the setting that is asked, and the value of such a rod, NaN if it has none.
type Law = (&'static str, fn(Setting, f64) -> Other, fn(Setting, Other) -> f64);

fn shape(setting: Setting) -> f64 {
    setting.aspect_ratio.ln().tanh()
}

fn with_ratio(setting: Setting, aspect_ratio: f64) -> Other {
    Other { setting: Setting { aspect_ratio, ..setting }, rate: 1.0 }
}

const OF_TIME: &str = "your time runs at {} of the true one";

#[rustfmt::skip]
const LAWS: [Law; 5] = [
    (OF_TIME, |setting, rate| Other { setting, rate }, |_, other| other.rate),
    ("your r_e is {} times what is asked", |asked, factor| with_ratio(asked, factor * asked.aspect_ratio),
        |asked, other| other.setting.aspect_ratio / asked.aspect_ratio),
    ("your r_e is the power {} of what is asked", |asked, power| with_ratio(asked, asked.aspect_ratio.powf(power)),
        |asked, other| other.setting.aspect_ratio.ln() / asked.aspect_ratio.ln()),
    ("your Λ is {} times (r_e² − 1)/(r_e² + 1)",
        |asked, factor| with_ratio(asked, (factor * shape(asked)).atanh().exp()),
        |asked, other| shape(other.setting) / shape(asked)),
    ("your r_e is {} in every problem", with_ratio, |_, other| other.setting.aspect_ratio),
];

/// The laws that explain every one of at least two wrong answers and that no problem that passes contradicts.
pub(super) fn laws(wrong: &[Wrong<'_>], passing: &[&LoadedProblem]) -> Vec<String> {
    if wrong.len() < 2 {
        return Vec::new();
    }
    let found = |law: &Law| {
        let (words, other, _) = *law;
        let mut values = wrong.iter().flat_map(|wrong| wrong.values(law));
        let explains = |value: &f64| {
            wrong.iter().all(|wrong| wrong.fits(other(wrong.setting(), *value)))
                && !passing.iter().any(|loaded| shows(loaded, law, *value))
        };
        values.find(explains).map(|value| words.replace("{}", &digits(value, 3)) + &of_pi(law, value))
    };
    LAWS.iter().filter_map(found).collect()
}

/// A value with `least` decimals, or with as many as show three digits of its difference from 1.
pub(super) fn digits(value: f64, least: usize) -> String {
    let off = -(value - 1.0).abs().log10() - 0.1;
    let decimals = if off < 2.0 { least } else { least.max(off.min(13.0).ceil() as usize + 2) };
    format!("{value:.*}", decimals.min(15))
}

/// A hint that a rate of time is that of a π with few digits.
fn of_pi((words, ..): &Law, rate: f64) -> String {
    let is = |short: &f64| [short / PI, PI / short].iter().any(|due| (rate - due).abs() < 1e-3 * (due - 1.0).abs());
    let cut = |digits: i32| [f64::trunc, f64::round].map(|of| of(PI * 10f64.powi(digits)) / 10f64.powi(digits));
    let short = (2..=7).flat_map(cut).find(is).filter(|_| *words == OF_TIME);
    short.map_or(String::new(), |short| format!(" (π taken as {short}?)"))
}

/// True if a law is detectable on a problem: its curve is not within the tolerance of the certified answer.
fn shows(loaded: &LoadedProblem, law: &Law, value: f64) -> bool {
    let (certified, nearer_than) = (Answer::certified(loaded), 2.0 * loaded.problem.tolerance);
    let right = Wrong { loaded: loaded.clone(), answer: &certified, nearer_than };
    loaded.problem.kind == Kind::Rods && !right.fits(law.1(right.setting(), value))
}

impl<'a> Wrong<'a> {
    pub(super) fn new(loaded: LoadedProblem, answer: &'a Answer, error: f64) -> Self {
        Self { loaded, answer, nearer_than: NEARER * error }
    }

    fn setting(&self) -> Setting {
        Setting::from(&self.loaded.problem)
    }

    fn values(&self, law: &Law) -> Vec<f64> {
        let asked = self.setting();
        let others: Vec<_> = if law.0 == OF_TIME {
            self.rates().into_iter().map(|rate| Other { setting: asked, rate }).collect()
        } else {
            self.ratios().into_iter().map(|ratio| with_ratio(asked, ratio)).collect()
        };
        let values = others.into_iter().map(|other| law.2(asked, other));
        values.filter(|value| value.is_finite() && *value != 1.0).collect()
    }

    /// The rates at which all rows are those of correct rods; none for rods at rest, which fit any rate.
    pub(super) fn rates(&self) -> Vec<f64> {
        let setting = self.setting();
        let (Some(motion), Some(first)) = (Motion::of(&setting), self.loaded.problem.times_s.first()) else {
            return Vec::new();
        };
        let candidates = match right_phase(&setting, *first) {
            Some(due) => self.by_phase(due).unwrap_or_default(),
            None => nearest([0.0, MOST], |rate| self.off(&self.answer.rows, &motion, rate * first)),
        };
        let fit = |rate: f64| self.fits(Other { setting, rate });
        let rests = |rate: f64| fit(0.95 * rate) && fit(1.05 * rate);
        candidates.into_iter().filter(|rate| (0.01..=MOST).contains(rate) && fit(*rate) && !rests(*rate)).collect()
    }

    /// The rates by the phase of the first rod that turns; a correct rod has the phase `due` at the first time.
    fn by_phase(&self, due: f64) -> Option<Vec<f64>> {
        let turns = |p: &[f64; 3]| p[0].hypot(p[1]) > IN_PLANE;
        let rod = self.loaded.start.iter().position(turns)?;
        let at = |p: &[f64]| (p[1] / self.loaded.problem.aspect_ratio).atan2(p[0]);
        // The first time leaves the smallest number of possible half turns.
        let turned = (at(self.answer.rows.get(rod)?) - at(&self.loaded.start[rod])).rem_euclid(PI);
        let most = (MOST * due / PI).ceil();
        (most <= HALF_TURNS)
            .then(|| (0..=most as u32).map(|half_turns| (turned + PI * f64::from(half_turns)) / due).collect())
    }

    /// The aspect ratios of rods whose correct motion all rows are.
    fn ratios(&self) -> Vec<f64> {
        let (asked, time_s) = (self.setting(), self.loaded.problem.times_s[0]);
        let candidates = match right_phase(&asked, time_s) {
            Some(_) => self.by_orbit().into_iter().collect(),
            None => nearest(LOGARITHMS, |logarithm| {
                let motion = Motion::of(&with_ratio(asked, logarithm.exp()).setting);
                motion.map_or(f64::INFINITY, |motion| self.off(&self.answer.rows, &motion, time_s))
            }),
        };
        // Λ = 0 has a name.
        let ratios = candidates.into_iter().filter(|logarithm| logarithm.abs() > 1e-6).map(f64::exp);
        ratios.filter(|ratio| self.fits(with_ratio(asked, *ratio))).collect()
    }

    /// ln r_e of the rod that keeps its orbit constant, C² = (p_1² + p_2²/r_e²)/p_3², from the row where it is known
    /// best.
    fn by_orbit(&self) -> Option<f64> {
        let square = |p: &[f64]| [p[0], p[1]].map(|x| (x / p[2]).powi(2));
        let of_row = |(row, p): (usize, &Vec<f64>)| {
            let ([x, y], [x_0, y_0]) = (square(p), square(&self.loaded.start[row % self.loaded.start.len()]));
            let ratio = ((y_0 - y) / (x - x_0)).sqrt();
            (ratio > 0.0 && ratio.is_finite()).then(|| ((x - x_0).abs() / (x + x_0), ratio.ln()))
        };
        let all = self.answer.rows.iter().enumerate().filter_map(of_row);
        all.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, logarithm)| logarithm)
    }

    /// The largest distance of the rows at one time from correct rods after `time_s`; infinite if one is not finite.
    fn off(&self, rows: &[Vec<f64>], motion: &Motion, time_s: f64) -> f64 {
        let Some(map) = motion.map(time_s) else {
            return f64::INFINITY;
        };
        let of_rod = |(start, values): (&[f64; 3], &Vec<f64>)| {
            moved(&map, start).map_or(f64::INFINITY, |p| apart(&Vector3::from_row_slice(values), &p, false))
        };
        worst(self.loaded.start.iter().zip(rows).map(of_rod))
    }

    fn fits(&self, Other { setting, rate }: Other) -> bool {
        let times = self.answer.rows.chunks(self.loaded.start.len()).zip(&self.loaded.problem.times_s);
        let motion =
            Some(setting.aspect_ratio).filter(|r| *r > 0.0 && r.is_finite()).and_then(|_| Motion::of(&setting));
        motion.is_some_and(|motion| {
            times.map(|(rows, time_s)| self.off(rows, &motion, rate * time_s)).all(|off| off <= self.nearer_than)
        })
    }
}

/// The places of the minima of `off` in a range, by a search around each minimum of many values.
fn nearest([low, high]: [f64; 2], off: impl Fn(f64) -> f64) -> Vec<f64> {
    let at = |k: usize| low + (high - low) / f64::from(TRIED) * k as f64;
    let tried: Vec<f64> = (0..=TRIED as usize).map(|k| off(at(k))).collect();
    let least = tried.windows(3).enumerate().filter(|(_, of)| of[1] <= of[0] && of[1] <= of[2]);
    least.map(|(k, _)| golden(&off, [at(k), at(k + 2)])).collect()
}

/// The place of the minimum of `f` between two ends, by golden section.
fn golden(f: impl Fn(f64) -> f64, [mut low, mut high]: [f64; 2]) -> f64 {
    let section = 0.5 * (5f64.sqrt() - 1.0);
    let inner = |low: f64, high: f64| [high - section * (high - low), low + section * (high - low)];
    let [mut a, mut b] = inner(low, high);
    let [mut f_a, mut f_b] = [f(a), f(b)];
    for _ in 0..70 {
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
