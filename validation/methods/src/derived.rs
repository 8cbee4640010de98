//! What is derived from a mean against time: its maxima and minima, the amplitude and damping of its oscillation, and
//! its steady value, each with a standard error by the jackknife over groups of replicas.

#[cfg(test)]
mod tests;

use nalgebra::{Matrix3, Vector3};
use shearbed::run::ensemble::{Column, group_sizes};
use statrs::distribution::{ChiSquared, ContinuousCDF, Normal, StudentsT};
use std::ops::RangeInclusive;

/// A value and its standard error: `None` for a single replica, or if the value is undefined without one of the groups.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The value of all replicas.
    pub value: f64,
    /// Its standard error.
    pub se: Option<f64>,
}

impl Estimate {
    /// The quotient, with the errors taken as independent; `None` for a divisor of 0.
    pub fn over(self, other: Self) -> Option<Self> {
        let value = self.value / other.value;
        let se = self.se.zip(other.se).map(|(a, b)| (a / other.value).hypot(value * b / other.value));
        value.is_finite().then_some(Self { value, se })
    }
}

/// A maximum or a minimum of a mean.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extreme {
    /// True for a maximum.
    pub is_maximum: bool,
    /// Its time, in the unit of the outputs' times.
    pub time: Estimate,
    /// The mean there.
    pub value: Estimate,
    /// For a maximum, its height above the mean of the minima beside it: the ordinate A₁ of Figs 7 to 10 of Lee &
    /// Springer (1982). Their drawing is not at hand; they give free rods "approximately 1/2", and half of this height
    /// would not.
    pub amplitude: Option<Estimate>,
}

/// The average over the last part of a run, in which no change of the mean is seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Steady {
    /// The time from which on no output differs from the average by more than its error explains, and a straight line
    /// rises by no more than its error.
    pub from: f64,
    /// The average over time from there to the end. As noise may hide a drift, its error is that of the end of the
    /// straight line, twice that of an average of independent outputs.
    pub value: Estimate,
}

/// The decay of an oscillation, from its maxima between two minima of at least a fifth of the first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Damping {
    /// The rate λ of A ∝ e^(−λt) for the amplitudes A, in 1 over the unit of time: minus the slope of ln A, with the
    /// weights e^(−2λt) of amplitudes that are equally uncertain, from the fourth on less 0.04.
    pub rate: Estimate,
    /// The times of the first and the last of the maxima.
    pub between: [f64; 2],
    /// False if ln A is off a straight line by more than the errors of A explain (χ², with the probability 0.01).
    pub is_exponential: bool,
}

/// What is derived from a mean against time.
#[derive(Clone, Debug, PartialEq)]
pub struct Derived {
    /// The maxima and minima in order of time.
    pub extremes: Vec<Extreme>,
    /// `None` for fewer than three maxima between two minima.
    pub damping: Option<Damping>,
    /// `None` if the mean changes in the second half of the run, or seems to, and for two to seven replicas.
    pub steady: Option<Steady>,
}

impl Derived {
    /// What is derived from the mean `column` of `replicas` replicas at `times`, which increase and may have any unit.
    pub fn new(times: &[f64], column: &Column, replicas: u64) -> Self {
        let mean = Mean { times, column, replicas };
        let turns = mean.turns();
        let extremes: Vec<_> = (0..turns.len()).filter_map(|k| mean.extreme(&turns, k)).collect();
        Self { damping: mean.damping(&turns, &extremes), extremes, steady: mean.steady() }
    }

    /// The same of outputs too far apart for maxima and minima.
    #[must_use]
    pub fn without_extremes(self) -> Self {
        Self { extremes: Vec::new(), damping: None, ..self }
    }

    /// Why a mean of `replicas` replicas has no damping rate; `None` if it has one, or does not oscillate.
    pub fn no_rate(&self, replicas: u64) -> Option<String> {
        match self.extremes[..] {
            _ if self.damping.is_some() => None,
            [] | [_] if replicas < FEWEST => {
                let of = if replicas == 1 { "rods" } else { "replicas" };
                Some(format!("no amplitudes: no turn is beyond the noise of so few {of}"))
            }
            [] | [_] => None,
            _ => Some(format!("no damping rate: {NO_RATE}")),
        }
    }
}

/// The probability that noise alone makes a mean turn, or be unsteady, anywhere in a run.
const BY_CHANCE: f64 = 0.01;

/// What a mean without a damping rate lacks.
pub const NO_RATE: &str = "it needs three maxima between minima, all beyond noise";

/// The fewest replicas that can show a mean to be steady: with larger errors every mean seems so.
pub const FEWEST: u64 = 8;

/// The standard errors of its rise up to which a straight line may be level.
const DRIFT: f64 = 1.0;

/// The fewest outputs over which a mean can be steady.
const FEWEST_OUTPUTS: usize = 10;

/// Degrees of freedom beyond which Student's t is a Gaussian.
const MANY: u64 = 1000;

/// A turn of a mean: a maximum or a minimum, and the outputs between its neighbours.
struct Turn {
    is_maximum: bool,
    within: RangeInclusive<usize>,
    /// The outputs that noise does not tell from the extreme one, the same for each mean without a group; `None` if
    /// they are three or fewer.
    near: Option<RangeInclusive<usize>>,
}

struct Mean<'a> {
    times: &'a [f64],
    column: &'a Column,
    replicas: u64,
}

impl Mean<'_> {
    /// The value that `of` has for the mean over all replicas, with its error.
    fn estimate(&self, of: impl Fn(&[f64]) -> Option<f64>) -> Option<Estimate> {
        let value = of(&self.column.mean)?;
        let without: Option<Vec<f64>> = self.column.without.iter().map(|mean| of(mean)).collect();
        Some(Estimate { value, se: without.and_then(|without| jackknife(value, &without, self.replicas)) })
    }

    /// The standard error of an output; 0 if it is not known.
    fn se(&self, output: usize) -> f64 {
        Some(self.column.se[output]).filter(|se| se.is_finite()).unwrap_or(0.0)
    }

    /// The probability that the error of one output is larger than allowed, on one side.
    fn tail(&self) -> f64 {
        BY_CHANCE / 2.0 / self.times.len() as f64
    }

    /// Maxima and minima in turn. One counts if the mean moves away from it, before and after, by more than what the
    /// errors of all outputs together exceed with the probability [`BY_CHANCE`], by Student's t. Nothing is before the
    /// first output; after the last one the mean might move on.
    fn turns(&self) -> Vec<Turn> {
        let mean = &self.column.mean;
        let first = mean.first().copied().unwrap_or_default();
        let rounding = mean.iter().fold(0.0, |span: f64, x| span.max((x - first).abs())) * 1e-9;
        // The errors of a single replica are over its rods, and count as those of many.
        let freedom = if self.replicas == 1 { MANY } else { (self.replicas.max(2) - 1).min(MANY) } as f64;
        let errors = StudentsT::new(0.0, 1.0, freedom).map_or(f64::INFINITY, |t| -t.inverse_cdf(self.tail()));
        let above = |a: usize, b: usize| mean[a] - mean[b] > (errors * (self.se(a) + self.se(b))).max(rounding);
        let (mut highest, mut lowest) = (0, 0);
        let mut at: Vec<(usize, bool)> = Vec::new();
        for output in 1..mean.len() {
            highest = if mean[output] > mean[highest] { output } else { highest };
            lowest = if mean[output] < mean[lowest] { output } else { lowest };
            let last = at.last().map(|(_, is_maximum)| *is_maximum);
            if last != Some(false) && above(output, lowest) {
                at.push((lowest, false));
                highest = output;
            } else if last != Some(true) && above(highest, output) {
                at.push((highest, true));
                lowest = output;
            }
        }
        // Before an output later than the start the mean may have moved on.
        if self.times.first().is_some_and(|time| *time > 0.0) && at.first().is_some_and(|(output, _)| *output == 0) {
            at.remove(0);
        }
        let turn = |k: usize| {
            let neighbour = |k: Option<usize>, end| k.and_then(|k| at.get(k)).map_or(end, |(output, _)| *output);
            let within = match at[k].0 {
                // A run that begins at an extreme begins there in every replica.
                0 => 0..=0,
                _ => neighbour(k.checked_sub(1), 0)..=neighbour(Some(k + 1), mean.len() - 1),
            };
            let turn = Turn { is_maximum: at[k].1, within, near: None };
            Turn { near: self.near(&turn), ..turn }
        };
        (0..at.len()).map(turn).collect()
    }

    /// The time and the value of a turn: the vertex of a parabola through the outputs that noise does not tell from the
    /// extreme one, or through this and the two beside it.
    fn peak(&self, mean: &[f64], turn: &Turn) -> (f64, f64) {
        let top = extreme(mean, turn);
        if top == *turn.within.start() || top == *turn.within.end() {
            return (self.times[top], mean[top]);
        }
        let outputs = turn.near.clone().unwrap_or(top - 1..=top + 1);
        self.vertex(mean, turn, outputs).unwrap_or((self.times[top], mean[top]))
    }

    /// From the first to the last output of a turn that are less than three standard errors from the extreme one, or
    /// twice as many until they bend, but less than a quarter of the turn's height.
    fn near(&self, turn: &Turn) -> Option<RangeInclusive<usize>> {
        let mean = &self.column.mean;
        let top = extreme(mean, turn);
        let below = |k: usize| (mean[top] - mean[k]).abs();
        let height = below(*turn.within.start()).min(below(*turn.within.end()));
        [3.0, 6.0, 12.0, 24.0].into_iter().find_map(|errors| {
            let least = (errors * self.se(top)).min(0.25 * height);
            let mut near = turn.within.clone().filter(|k| below(*k) < least);
            let first = near.next()?;
            let outputs = first..=near.next_back()?;
            let bends = outputs.end() - first > 2 && self.vertex(mean, turn, outputs.clone()).is_some();
            bends.then_some(outputs)
        })
    }

    /// The vertex of the parabola through these outputs by least squares, within them; `None` if it does not bend as
    /// the turn does.
    fn vertex(&self, mean: &[f64], turn: &Turn, outputs: RangeInclusive<usize>) -> Option<(f64, f64)> {
        let (first, last) = (self.times[*outputs.start()], self.times[*outputs.end()]);
        let (centre, level) = (0.5 * (first + last), mean[*outputs.start()]);
        let (mut squares, mut sums) = (Matrix3::zeros(), Vector3::zeros());
        for k in outputs {
            let x = self.times[k] - centre;
            let powers = Vector3::new(1.0, x, x * x);
            squares += powers * powers.transpose();
            sums += powers * (mean[k] - level);
        }
        // y = a + bx + cx².
        let found = squares.cholesky()?.solve(&sums);
        let (a, b, c) = (found.x, found.y, found.z);
        let bends = if turn.is_maximum { c < 0.0 } else { c > 0.0 };
        let x = (-b / (2.0 * c)).clamp(first - centre, last - centre);
        bends.then_some((centre + x, level + a + x * (b + c * x)))
    }

    /// The height of maximum `k` above the mean of the minima beside it.
    fn height(&self, mean: &[f64], turns: &[Turn], k: usize) -> Option<f64> {
        let value = |turn: &Turn| self.peak(mean, turn).1;
        let beside = [k.checked_sub(1), Some(k + 1)].map(|k| k.and_then(|k| turns.get(k)).map(value));
        let beside: Vec<f64> = beside.into_iter().flatten().collect();
        let is_one = turns[k].is_maximum && !beside.is_empty();
        is_one.then(|| value(&turns[k]) - beside.iter().sum::<f64>() / beside.len() as f64)
    }

    fn extreme(&self, turns: &[Turn], k: usize) -> Option<Extreme> {
        Some(Extreme {
            is_maximum: turns[k].is_maximum,
            time: self.estimate(|mean| Some(self.peak(mean, &turns[k]).0))?,
            value: self.estimate(|mean| Some(self.peak(mean, &turns[k]).1))?,
            amplitude: self.estimate(|mean| self.height(mean, turns, k)),
        })
    }

    fn damping(&self, turns: &[Turn], extremes: &[Extreme]) -> Option<Damping> {
        // The first and the last extreme may have an amplitude, which is not above minima on both sides.
        let mut maxima: Vec<usize> = (1..extremes.len().saturating_sub(1)).collect();
        maxima.retain(|k| extremes[*k].amplitude.is_some());
        let times: Vec<f64> = maxima.iter().map(|k| extremes[*k].time.value).collect();
        if times.len() < 3 {
            return None;
        }
        let rate = self.estimate(|mean| {
            let logarithm = |k: &usize| Some(self.height(mean, turns, *k)?.ln());
            rate(&times, &maxima.iter().map(logarithm).collect::<Option<Vec<f64>>>()?)
        })?;
        let count = weights(rate.value, &times).iter().take_while(|weight| **weight > 0.0).count();
        let is_exponential = is_exponential(rate.value, extremes, &maxima[..count]);
        Some(Damping { rate, between: [times[0], times[count - 1]], is_exponential })
    }

    fn steady(&self) -> Option<Steady> {
        let last = self.times.len().checked_sub(1)?;
        if (2..FEWEST).contains(&self.replicas) {
            return None;
        }
        // Not Student's t, by which a few replicas would be steady from the start.
        let errors = -Normal::standard().inverse_cdf(self.tail());
        // Of 64 beginnings in the first half of the run, the first.
        let begins = (0..64).map(|k| self.times[0] + 0.5 * f64::from(k) / 64.0 * (self.times[last] - self.times[0]));
        begins.map(|begin| self.times.partition_point(|time| *time < begin)).find_map(|from| {
            let (average, _) = self.line(&self.column.mean, from);
            let rounding = 1e-9 * average.abs();
            let is_same =
                |output: usize| (self.column.mean[output] - average).abs() <= (errors * self.se(output)).max(rounding);
            let is_steady = last - from >= FEWEST_OUTPUTS - 1 && (from..=last).all(is_same);
            let rise = is_steady.then(|| self.estimate(|mean| Some(self.line(mean, from).1)))??;
            let does_not_rise = rise.se.is_none_or(|se| rise.value.abs() <= (DRIFT * se).max(rounding));
            let of_end = |mean: &[f64]| {
                let (average, rise) = self.line(mean, from);
                Some(average + rise)
            };
            let se = does_not_rise.then(|| self.estimate(of_end))??.se;
            Some(Steady { from: self.times[from], value: Estimate { value: average, se } })
        })
    }

    /// The average over time from output `from` to the last one, by the trapezoidal rule, and how far the straight line
    /// that is nearest to the outputs ends above it.
    fn line(&self, mean: &[f64], from: usize) -> (f64, f64) {
        let (times, mean) = (&self.times[from..], &mean[from..]);
        let Some(last) = times.len().checked_sub(1).filter(|last| *last > 0) else {
            return (mean.first().copied().unwrap_or(f64::NAN), 0.0);
        };
        let weight = |k: usize| times[(k + 1).min(last)] - times[k.saturating_sub(1)];
        let Straight { centre, level, slope } =
            Straight::nearest(times, mean, &(0..=last).map(weight).collect::<Vec<_>>());
        (level, slope * (times[last] - centre))
    }
}

/// The straight line that is nearest to weighted points by least squares.
struct Straight {
    /// The mean abscissa.
    centre: f64,
    /// The mean ordinate, which it has there.
    level: f64,
    slope: f64,
}

impl Straight {
    fn nearest(x: &[f64], y: &[f64], weights: &[f64]) -> Self {
        let all: f64 = weights.iter().sum();
        let average = |of: &dyn Fn(usize) -> f64| (0..x.len()).map(|k| weights[k] * of(k)).sum::<f64>() / all;
        let (centre, level) = (average(&|k| x[k]), average(&|k| y[k]));
        let moment = average(&|k| (x[k] - centre) * (y[k] - level));
        Self { centre, level, slope: moment / average(&|k| (x[k] - centre).powi(2)) }
    }
}

/// The extreme output of a turn.
fn extreme(mean: &[f64], turn: &Turn) -> usize {
    let sign = if turn.is_maximum { 1.0 } else { -1.0 };
    turn.within.clone().max_by(|a, b| (sign * mean[*a]).total_cmp(&(sign * mean[*b]))).unwrap_or(0)
}

/// The fraction of the first amplitude below which later ones do not count: more replicas show smaller amplitudes, and
/// a decay that is not exponential has another rate there.
const CLEAR: f64 = 0.2;

/// The weights of logarithms of amplitudes that decay at `rate`: e^(−2λt), those of equal errors of the amplitudes.
/// From the fourth on they are reduced by the weight at [`CLEAR`], so that noise does not decide which count.
///
/// Weights from estimated errors would favour errors that are too small, and underestimate the error of the rate.
fn weights(rate: f64, times: &[f64]) -> Vec<f64> {
    let weight = |(k, time): (usize, &f64)| {
        let decayed = (-2.0 * rate * (time - times[0])).exp();
        if k < 3 { decayed } else { (decayed - CLEAR * CLEAR).max(0.0) }
    };
    times.iter().enumerate().map(weight).collect()
}

/// The rate at which amplitudes decay that have these logarithms: minus the slope of a straight line through them, by
/// least squares with its own [`weights`].
fn rate(times: &[f64], logarithms: &[f64]) -> Option<f64> {
    let next = |rate: f64| -Straight::nearest(times, logarithms, &weights(rate, times)).slope;
    // Half a step each time: steeper slopes have earlier weights, which may find less steep ones.
    let found = (0..60).fold(0.0, |rate, _| 0.5 * (rate + next(rate)));
    found.is_finite().then_some(found)
}

/// The relative error of an amplitude that peaks between outputs may cause.
const PEAK: f64 = 0.01;

/// True if the amplitudes of these maxima fall by e^(−λt) to within their errors, so far as these are known.
fn is_exponential(rate: f64, extremes: &[Extreme], maxima: &[usize]) -> bool {
    let point = |k: &usize| {
        let Estimate { value, se } = extremes[*k].amplitude?;
        Some((value.ln() + rate * extremes[*k].time.value, 1.0 / ((se? / value).powi(2) + PEAK * PEAK)))
    };
    let Some(points) = maxima.iter().map(point).collect::<Option<Vec<_>>>() else { return true };
    let all: f64 = points.iter().map(|(_, weight)| weight).sum();
    let level = points.iter().map(|(log, weight)| weight * log).sum::<f64>() / all;
    let square: f64 = points.iter().map(|(log, weight)| weight * (log - level).powi(2)).sum();
    let freedom = points.len().saturating_sub(2).max(1) as f64;
    ChiSquared::new(freedom).is_ok_and(|law| !square.is_finite() || law.sf(square) >= BY_CHANCE)
}

/// The standard error of a value from its values without one group of replicas each, for groups of unequal sizes
/// (Busing, Meijer & van der Leeden, Statistics and Computing 9 (1999) 3, eq. 10). `None` if there are fewer than two.
pub(crate) fn jackknife(value: f64, without: &[f64], replicas: u64) -> Option<f64> {
    let groups = without.len() as f64;
    let shares: Vec<f64> = group_sizes(replicas).map(|size| size as f64 / replicas as f64).collect();
    let rest: f64 = without.iter().zip(&shares).map(|(without, share)| (1.0 - share) * without).sum();
    let centre = groups * value - rest;
    let term = |(without, share): (&f64, &f64)| {
        let pseudo = (value - (1.0 - share) * without) / share;
        (pseudo - centre).powi(2) * share / (1.0 - share)
    };
    (without.len() > 1).then(|| (without.iter().zip(&shares).map(term).sum::<f64>() / groups).sqrt())
}
