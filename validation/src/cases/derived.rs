//! What a run derives from a mean against time, over many ensembles of free rods of unequal aspect ratio: their closed
//! form has the same quantities without noise.
//!
//! Deviations are in units of the standard errors that each ensemble states. These have 15 degrees of freedom (16
//! groups of replicas), so that squared deviations are 15/13 on average if the errors are right. This holds for steady
//! values too: rods differ in their average over time, so that the end of a straight line has nearly the error of the
//! average.

use super::*;
use crate::methods::derived::{Derived, Estimate as Found};
use crate::oracle::{isotropic, quadrature};
use shearbed::run::ensemble::Column;
use std::ops::Range;
use std::sync::LazyLock;

/// What derives the quantities from times, the mean and the number of replicas.
type Deriving = fn(&[f64], &Column, u64) -> Derived;

pub fn cases() -> Vec<Case> {
    vec![
        Case::of(Judges::Program, "derived-quantities")
            .claim(
                "What `shearbed run` derives from X̄₁ of free rods (a maximum's time, value and amplitude, the damping \
                 rate, the steady value) agrees with the closed form, within standard errors of the right size.",
            )
            .source("eqs 4, 11; Figs 7 and 9; docs/src/reference/files.md")
            .under_test(Derived::new as Deriving)
            .mistake("standard errors half as large", |times, column, replicas| {
                let mut column = column.clone();
                for without in &mut column.without {
                    without.iter_mut().zip(&column.mean).for_each(|(without, mean)| *without = 0.5 * (*without + mean));
                }
                Derived::new(times, &column, replicas)
            })
            .mistake("half the height as the amplitude", |times, column, replicas| {
                let mut derived = Derived::new(times, column, replicas);
                for amplitude in derived.extremes.iter_mut().filter_map(|extreme| extreme.amplitude.as_mut()) {
                    amplitude.value *= 0.5;
                }
                derived
            })
            .mistake("the largest of the steady outputs as the steady value", |times, column, replicas| {
                let mut derived = Derived::new(times, column, replicas);
                if let Some(steady) = &mut derived.steady {
                    let since = &column.mean[times.partition_point(|time| *time < steady.from)..];
                    steady.value.value = since.iter().copied().max_by(f64::total_cmp).unwrap_or(f64::NAN);
                }
                derived
            })
            .check(derives),
    ]
}

const ASPECT_RATIO: f64 = 5.0;
const SD_PERCENT: f64 = 7.2;
const PERIODS: f64 = 8.0;
const RODS: usize = 60;
const REPLICAS: u64 = 32;

/// The allowed departure of the mean square: that of standard errors wrong by a tenth.
const OFF: f64 = 0.25;
/// The mean square of two quantities of an ensemble or more; the square of one scatters by 1.84 by Student's t.
const DESIGN: Design = Design::new(1.2, 1.6);

/// The squared deviation of a missing quantity.
const MISSING: f64 = 9.0;

/// The closed form's extremes in each quarter period up to t/T = 3, beyond which noise hides them, and its average over
/// time.
struct Truth {
    extremes: Vec<(f64, f64)>,
    steady: f64,
}

fn x1(turns: f64) -> f64 {
    isotropic::mean_projections_polydisperse(ASPECT_RATIO, SD_PERCENT, turns)[0]
}

impl Truth {
    fn new() -> Self {
        // X̄₁ of rods of one aspect ratio is even in t and has the period T/2.
        let average =
            |r: f64| 4.0 * quadrature::integrate(|t| isotropic::mean_projections(r, t)[0], &[0.0, 0.25], 1e-9);
        let [steady] = isotropic::mean_over_aspect_ratios(ASPECT_RATIO, SD_PERCENT, 0.0, |r, _| [average(r)]);
        Self { extremes: (0..=12_u32).map(extreme).collect(), steady }
    }

    /// The extreme that is nearest to one that was found.
    fn near(&self, time: f64) -> Option<usize> {
        Some((4.0 * time).round() as usize).filter(|k| *k < self.extremes.len())
    }

    /// The height of maximum `k` above the mean of the minima beside it.
    fn amplitude(&self, k: usize) -> Option<f64> {
        let beside = self.extremes.get(k.checked_sub(1)?)?.1 + self.extremes.get(k + 1)?.1;
        Some(self.extremes[k].1 - 0.5 * beside)
    }

    /// The decay of the amplitudes that count in `derived`: λ where Σ w (ln A + λt − c)(t − t̄) = 0, with w
    /// = e^(−2λt) from 1 on, from the fourth on less 0.04; by halves.
    fn rate(&self, derived: &Derived) -> Option<f64> {
        let [first, last] = derived.damping?.between;
        let maxima = derived.extremes.iter().filter(|extreme| extreme.is_maximum).map(|maximum| maximum.time.value);
        let point = |time: f64| {
            let k = self.near(time)?;
            Some((self.extremes[k].0, self.amplitude(k)?.ln()))
        };
        let points: Vec<_> = maxima.filter(|time| (first..=last).contains(time)).map(point).collect::<Option<_>>()?;
        let slope = |rate: f64| {
            let sum = |of: &dyn Fn(f64, f64) -> f64| {
                let weight = |k: usize, time: f64| {
                    let decayed = (-2.0 * rate * (time - points[0].0)).exp();
                    if k < 3 { decayed } else { (decayed - 0.04).max(0.0) }
                };
                points.iter().enumerate().map(|(k, (time, log))| weight(k, *time) * of(*time, *log)).sum::<f64>()
            };
            let (all, times, logs) = (sum(&|_, _| 1.0), sum(&|time, _| time), sum(&|_, log| log));
            let (squares, products) = (sum(&|time, _| time * time), sum(&|time, log| time * log));
            (all * products - times * logs) + rate * (all * squares - times * times)
        };
        let (mut low, mut high) = (0.0, 10.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if slope(middle) < 0.0 { low = middle } else { high = middle }
        }
        Some(low)
    }

    /// The deviations of what was derived, in standard errors; `None` where there is nothing.
    fn deviations(&self, derived: &Derived) -> [Option<f64>; 5] {
        let off = |found: Option<Found>, truth: Option<f64>| {
            let Found { value, se } = found?;
            Some((value - truth?) / se?)
        };
        let second = derived.extremes.iter().filter(|extreme| extreme.is_maximum).nth(1);
        let place = second.and_then(|second| self.near(second.time.value));
        [
            off(second.map(|second| second.time), place.map(|k| self.extremes[k].0)),
            off(second.map(|second| second.value), place.map(|k| self.extremes[k].1)),
            off(second.and_then(|second| second.amplitude), place.and_then(|k| self.amplitude(k))),
            off(derived.damping.map(|damping| damping.rate), self.rate(derived)),
            off(derived.steady.map(|steady| steady.value), Some(self.steady)),
        ]
    }
}

/// The time and the value of the closed form's extreme near t/T = k/4, a maximum for even k, by thirds.
fn extreme(k: u32) -> (f64, f64) {
    let sign = if k.is_multiple_of(2) { 1.0 } else { -1.0 };
    let (mut low, mut high) = ((0.25 * f64::from(k) - 0.1).max(0.0), 0.25 * f64::from(k) + 0.1);
    while high - low > 1e-6 {
        let third = (high - low) / 3.0;
        if sign * x1(low + third) > sign * x1(high - third) { high -= third } else { low += third }
    }
    (low, x1(low))
}

static TRUTH: LazyLock<Truth> = LazyLock::new(Truth::new);

/// X̄₁ at the outputs' times.
type Run = (Vec<f64>, Column);

static RUNS: Shared<(), Result<Vec<Run>, String>> = Shared::new();

fn runs(effort: &Effort) -> Result<Vec<Run>, String> {
    let run = |ensemble: u64| {
        let mut scene = lab::free_scene(effort);
        scene.ensemble.seed = effort.seed(ensemble);
        scene.ensemble.replicas = REPLICAS;
        scene.particles.count = RODS;
        scene.particles.aspect_ratio = ASPECT_RATIO;
        scene.particles.aspect_ratio_sd_percent = SD_PERCENT;
        scene.time = Time { outputs_per_unit: Some(30), ..Time::periods(PERIODS) };
        let results = ensemble::run(&lab::plan(&scene)).map_err(|error| error.to_string())?;
        let column = results.column(&Channel::X[0].name()).ok_or("no column x1")?.clone();
        Ok((results.times, column))
    };
    (0..effort.samples(DESIGN)).into_par_iter().map(run).collect()
}

fn derives(deriving: &Deriving, effort: &Effort) -> Result<[Evidence; 2], String> {
    let runs = RUNS.get(effort, (), || runs(effort));
    let runs = runs.as_ref().as_ref().map_err(Clone::clone)?;
    let one = |(times, column): &Run| TRUTH.deviations(&deriving(times, column, REPLICAS));
    let all: Vec<_> = runs.par_iter().map(one).collect();
    let due = |what: &str, quantities: Range<usize>| {
        let square = |off: &Option<f64>| off.map_or(MISSING, |off| off * off) / quantities.len() as f64;
        let squares = all.iter().map(|off| off[quantities.clone()].iter().map(square).sum::<f64>());
        Evidence::on(format!("mean squared deviation, in standard errors, of {what}"), "–")
            .is(Sample::of(squares.collect::<Vec<_>>()), 15.0 / 13.0, OFF, DESIGN.effect)
            .because("15/13 for values without bias whose standard errors are right; a tenth of these is allowed")
    };
    Ok([due("the second maximum's time, value and amplitude", 0..3), due("damping rate and steady value", 3..5)])
}
