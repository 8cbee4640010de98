//! A search for further minima of χ²: the model itself, without polynomials, is run along each range. Where the curves
//! oscillate with a parameter, χ² has several minima, and the fit finds only one of them.

use super::error::{FitError, ParameterError, Undescribed, Warning};
use super::range::Range;
use super::search::{FIRST_REPLICAS, Fit, FitProblem, Watch, search, search_from};
use crate::methods::least_squares::direct::Direct;
use crate::methods::least_squares::emulator::{Known, Prediction, Sides};
use crate::methods::least_squares::profile::rise_of;
use nalgebra::DVector;

/// Parts of each range at first; a part is halved where the curves change too much over it.
const PARTS: usize = 16;

/// The largest number of times that a part is halved.
const HALVED: u32 = 4;

/// A change beyond this number of standard errors is due to the model, not to the noise of its replicas.
const CERTAIN: f64 = 5.0;

/// The number of lowest minima that are examined.
const MINIMA: usize = 8;

/// A part is short enough if every prediction changes over it by at most this share of its change over the whole range,
/// or by at most the point's uncertainty.
const SHARE: f64 = 0.25;

/// A difference of χ² that the noise of the replicas can cause.
const NOISE: f64 = 16.0;

/// Replicas for each point that suffice for their covariance: χ² is then too large by an eighth.
const OF_A_POINT: usize = 8;

/// Steps of the golden section towards a minimum: each leaves 0.62 of the way.
const STEPS: usize = 12;

/// A place on the scale of its range, with every prediction, its standard error, and χ² there.
#[derive(Clone)]
struct Tried {
    at: f64,
    mean: DVector<f64>,
    se: DVector<f64>,
    chi_square: f64,
}

/// The number of times that a fit begins again at a lower minimum.
const AGAIN: usize = 3;

/// Half of the box in which it begins, as a share of the range.
const NEARBY: f64 = 1.0 / PARTS as f64;

/// Fits the parameters, and again from a minimum of decisively lower χ² as long as [`look_elsewhere`] finds one; with
/// warnings on what could not be searched.
///
/// # Errors
///
/// As of [`search`] and [`look_elsewhere`].
pub fn best_fit(problem: &FitProblem<'_>, watch: &Watch<'_>) -> Result<(Fit, Vec<Warning>), FitError> {
    let mut fit = match search(problem, watch) {
        Err(FitError::NotEnclosed { .. }) if problem.ranges.len() == 1 => {
            search_from(problem, around_lowest(problem, watch)?, watch)?
        }
        found => found?,
    };
    for _ in 0..AGAIN {
        let found = look_elsewhere(problem, &fit, watch);
        let Err(FitError::Parameter(label, ParameterError::TwoMinima([other, own]))) = &found else {
            return found.map(|warnings| (fit, warnings));
        };
        let axis = fit.ranges.iter().position(|range| range.label() == *label);
        let (Some(axis), true) = (axis, other.1 < own.1 - NOISE.max(0.5 * own.1)) else {
            return found.map(|warnings| (fit, warnings));
        };
        let range = &fit.ranges[axis];
        let mut sides = fit.sides.clone();
        sides[axis] = around(range, range.scaled(other.0));
        fit = search_from(problem, sides, watch)?;
    }
    look_elsewhere(problem, &fit, watch).map(|warnings| (fit, warnings))
}

/// A side of a box around a place on the scale of the range.
fn around(range: &Range, at: f64) -> (f64, f64) {
    let [from, to] = [range.from, range.to].map(|value| range.scaled(value));
    let half = NEARBY * (to - from);
    ((at - half).max(from), (at + half).min(to))
}

/// A box around the lowest χ² of a few replicas along the only range.
fn around_lowest(problem: &FitProblem<'_>, watch: &Watch<'_>) -> Result<Sides, FitError> {
    let range = &problem.ranges[0];
    let values = [range.from];
    let (_, known) = at_best(problem, &values, FIRST_REPLICAS.min(problem.most_replicas), watch)?;
    let (tried, _) = Line { problem, watch, values: &values, known: &known, axis: 0, range }.scan()?;
    let lowest = tried.iter().min_by(|a, b| a.chi_square.total_cmp(&b.chi_square));
    Ok(vec![around(range, lowest.map_or(f64::NAN, |lowest| lowest.at))])
}

/// Searches along each range, with the other parameters at their best values, and returns warnings on what could not be
/// searched.
///
/// # Errors
///
/// An error if another place describes the points as well as the fit, or better.
pub fn look_elsewhere(problem: &FitProblem<'_>, fit: &Fit, watch: &Watch<'_>) -> Result<Vec<Warning>, FitError> {
    let values = fit.values(&fit.best.place);
    (watch.stage)("best values");
    let of_points = fit.emulator.behind_covariance().min(OF_A_POINT * problem.data.len());
    let replicas = of_points.max(fit.emulator.replicas());
    let (own_rows, known) = at_best(problem, &values, replicas as u64, watch)?;
    let mut warnings = Vec::new();
    for (axis, range) in fit.ranges.iter().enumerate() {
        (watch.stage)(&format!("other minima along {}", range.label()));
        let line = Line { problem, watch, values: &values, known: &known, axis, range };
        let best = range.scaled(values[axis]);
        let own = line.tried(best, &own_rows)?;
        let emulated = fit.best.chi_square;
        if own.chi_square > emulated + emulated.max(NOISE) {
            let chi_square = own.chi_square;
            let error = ParameterError::NotFollowed { value: values[axis], chi_square, emulated };
            return Err(FitError::Parameter(range.label(), error));
        }
        let few = line.tried(best, &own_rows[..line.few()])?.chi_square;
        let (tried, searched) = line.scan()?;
        if !searched {
            warnings.push(Warning::Other(format!(
                "{}: the model changes too fast along its range to rule out another minimum; give a narrower range",
                range.label()
            )));
        }
        let (low, high) = fit.sides[axis];
        let is_minimum = |k: &usize| {
            let no_less = |other: Option<&Tried>| other.is_none_or(|other| other.chi_square >= tried[*k].chi_square);
            no_less(k.checked_sub(1).map(|k| &tried[k])) && no_less(tried.get(k + 1))
        };
        let mut minima: Vec<usize> = (0..tried.len()).filter(is_minimum).collect();
        minima.sort_by(|a, b| tried[*a].chi_square.total_cmp(&tried[*b].chi_square));
        for k in minima.into_iter().take(MINIMA) {
            let ends = [k.saturating_sub(1), (k + 1).min(tried.len() - 1)].map(|k| tried[k].at);
            let found = line.least(tried[k].clone(), ends)?;
            if found.chi_square > few + NOISE {
                continue;
            }
            // Within the box, the minima of the polynomials and of the model differ by the noise of runs at different
            // values; no interval contains a place outside the box.
            let allowed = if found.at < low || found.at > high {
                own.chi_square + rise_of(0.95)
            } else {
                own.chi_square - NOISE.max(0.5 * own.chi_square)
            };
            let found = line.run(found.at, known.len())?;
            if found.chi_square < allowed {
                let places = [(range.value(found.at), found.chi_square), (values[axis], own.chi_square)];
                let least = found.chi_square.min(own.chi_square);
                let undescribed = Undescribed::check(least, problem.data.len(), fit.ranges.len());
                let error = undescribed.map_or(ParameterError::TwoMinima(places), ParameterError::from);
                return Err(FitError::Parameter(range.label(), error));
            }
        }
    }
    Ok(warnings)
}

/// Predictions of each replica at the best values, and the parts of the model behind them: a part that does not depend
/// on a parameter need not run again along that parameter's range.
fn at_best(
    problem: &FitProblem<'_>,
    values: &[f64],
    replicas: u64,
    watch: &Watch<'_>,
) -> Result<(Vec<Vec<Prediction>>, Vec<Known>), String> {
    let replica = (problem.model)(values)?;
    let one = |k: u64| {
        let mut known = Known::new();
        replica.run_beside(k, &mut known).map(|found| (found, known))
    };
    Ok(watch.replicas(replicas, one)?.into_iter().unzip())
}

struct Line<'a> {
    problem: &'a FitProblem<'a>,
    watch: &'a Watch<'a>,
    /// The best values of all parameters.
    values: &'a [f64],
    /// Parts of the model at those values, for each replica of the fit.
    known: &'a [Known],
    axis: usize,
    range: &'a Range,
}

impl Line<'_> {
    /// The number of replicas that suffices for a first look.
    fn few(&self) -> usize {
        (FIRST_REPLICAS as usize).min(self.known.len())
    }

    /// Runs the first `replicas` replicas at the place `at` of the range.
    fn run(&self, at: f64, replicas: usize) -> Result<Tried, String> {
        let mut values = self.values.to_vec();
        values[self.axis] = self.range.value(at);
        let replica = (self.problem.model)(&values)?;
        let one = |k: u64| replica.run_beside(k, &mut self.known[k as usize].clone());
        self.tried(at, &self.watch.replicas(replicas as u64, one)?)
    }

    /// χ² at the place `at` from the predictions `rows` of its replicas.
    fn tried(&self, at: f64, rows: &[Vec<Prediction>]) -> Result<Tried, String> {
        let found = Direct::of(self.problem.data, rows, self.problem.rods);
        let Direct { mean, se, chi_square, .. } = found.ok_or("the covariance of the points is not positive")?;
        Ok(Tried { at, chi_square, mean, se })
    }

    /// Places along the range, and true if they are close enough that no curve changes unseen between two of them.
    fn scan(&self) -> Result<(Vec<Tried>, bool), String> {
        let (from, to) = (self.range.scaled(self.range.from), self.range.scaled(self.range.to));
        let place = |k: usize| from + (to - from) * k as f64 / PARTS as f64;
        let mut tried: Vec<Tried> = (0..=PARTS).map(|k| self.run(place(k), self.few())).collect::<Result<_, _>>()?;
        let data = self.problem.data;
        for _ in 0..HALVED {
            let enough: Vec<f64> = (0..data.len())
                .map(|point| {
                    let all = tried.iter().map(|tried| tried.mean[point]);
                    let (least, most) = all.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, m), x| (l.min(x), m.max(x)));
                    data[point].u.max(SHARE * (most - least))
                })
                .collect();
            let far = |pair: &[Tried]| {
                (0..data.len()).any(|point| {
                    let change = (pair[1].mean[point] - pair[0].mean[point]).abs();
                    let noise = pair[0].se[point].hypot(pair[1].se[point]);
                    change > enough[point].max(CERTAIN * noise)
                })
            };
            let between: Vec<f64> =
                (tried.windows(2).filter(|pair| far(pair))).map(|pair| 0.5 * (pair[0].at + pair[1].at)).collect();
            if between.is_empty() {
                return Ok((tried, true));
            }
            for at in between {
                tried.push(self.run(at, self.few())?);
            }
            tried.sort_by(|a, b| a.at.total_cmp(&b.at));
        }
        Ok((tried, false))
    }

    /// The place of least χ² between two ends by golden section, from a place `best` between them where χ² is less.
    fn least(&self, mut best: Tried, [mut low, mut high]: [f64; 2]) -> Result<Tried, String> {
        for _ in 0..STEPS {
            let golden = 0.5 * (3.0 - 5f64.sqrt());
            let at = if high - best.at > best.at - low {
                best.at + golden * (high - best.at)
            } else {
                best.at - golden * (best.at - low)
            };
            let new = self.run(at, self.few())?;
            let worse = if new.chi_square < best.chi_square { std::mem::replace(&mut best, new) } else { new };
            // The worse place becomes an end.
            if worse.at > best.at { high = worse.at } else { low = worse.at }
        }
        Ok(best)
    }
}
