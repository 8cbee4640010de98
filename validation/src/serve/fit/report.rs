//! A fit as plain data, as JSON and CSV, and in words.

use super::budget::{self, Part, Residual, Shift};
use super::design::{Candidate, Step};
use super::digits::probability;
use super::error::Warning;
use super::hypothesis::Tested;
use super::range::Range;
use super::search::{Fit, MOST_SHARE};
use crate::files::csv;
use crate::input::experiment::{Bias, bias};
use crate::methods::least_squares::Datum;
use crate::methods::least_squares::direct::Direct;
use crate::methods::least_squares::likelihood::{CAUSES, EMULATOR, REPLICAS, Rods, correlation_of};
use crate::methods::least_squares::profile::rise_of;
use nalgebra::DMatrix;
use serde::Serialize;
use std::collections::BTreeMap;

/// The estimate of a parameter, in the unit of its key.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Parameter {
    /// The best value.
    pub estimate: f64,
    /// The 68 % interval by profile likelihood.
    pub low_68: f64,
    /// Its upper end.
    pub high_68: f64,
    /// The 95 % interval.
    pub low_95: f64,
    /// Its upper end.
    pub high_95: f64,
    /// Standard uncertainty by linear theory.
    pub standard_uncertainty: f64,
    /// The range in which it was sought.
    pub range: [f64; 2],
    /// True where the 95 % interval ends at an edge of the range, below and above: the points do not determine that
    /// end.
    pub ends_at_edge: [bool; 2],
}

/// All results of a fit.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Report {
    /// Parameters by the key of the scene, `SET:KEY` for a parameter of one set alone.
    pub parameters: BTreeMap<String, Parameter>,
    /// The least χ².
    pub chi2: f64,
    /// Points less parameters.
    pub degrees_of_freedom: usize,
    /// The probability of a larger χ² if the model were right.
    pub p_value: f64,
    /// The order of the parameters in the lists below.
    pub order: Vec<String>,
    /// The covariance of the estimates by linear theory.
    pub covariance: Vec<Vec<f64>>,
    /// The correlation of the estimates.
    pub correlation: Vec<Vec<f64>>,
    /// The causes of the standard uncertainties.
    pub budget: Vec<Part>,
    /// The uncertainties that further points would leave; none if not asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub design: Option<Vec<Step>>,
    /// The tested hypotheses, with their results.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub tests: Vec<Tested>,
    /// The standard deviation of each estimate over seeds, which is part of its uncertainty.
    pub another_seed: Vec<f64>,
    /// The change by a finer step and by more rods; not part of the intervals, which hold for the scene as written.
    pub shifts: Vec<Shift>,
    /// FDS's bias δ and scatter σ_M of the best model; none if a value is not positive.
    pub bias: Option<Bias>,
    /// The residual of each point at the best values.
    pub residuals: Vec<Residual>,
    /// Replicas at each value of the parameters in the last box.
    pub replicas: usize,
    /// Runs over all boxes.
    pub runs: u64,
    /// Number of boxes that were tried.
    pub boxes: u64,
    /// Reasons to doubt the fit; a program that was asked for it adds what to do.
    #[serde(skip)]
    pub warnings: Vec<Warning>,
}

/// Below this p-value a warning says that the model does not describe the points.
const NOT_DESCRIBED: f64 = 0.001;

/// Above this correlation a warning says that the points hardly distinguish two parameters.
const ALIKE: f64 = 0.95;

/// The report of a fit of the points `data`.
pub fn report(fit: &Fit, data: &[Datum], shifts: Vec<Shift>) -> Report {
    let freedom = data.len() - fit.ranges.len();
    let p_value = fit.best.goodness.p_value();
    let values = fit.values(&fit.best.place);
    let covariance = fit.covariance();
    let correlation = correlation_of(&fit.best.covariance());
    let parameters: BTreeMap<_, _> = (fit.ranges.iter().enumerate())
        .map(|(axis, range)| {
            let (inner, outer) = (fit.interval(axis, 0.68), fit.interval(axis, 0.95));
            let estimate = Parameter {
                estimate: values[axis],
                low_68: inner.low,
                high_68: inner.high,
                low_95: outer.low,
                high_95: outer.high,
                standard_uncertainty: covariance[(axis, axis)].sqrt(),
                range: [range.from, range.to],
                ends_at_edge: outer.open,
            };
            (range.label(), estimate)
        })
        .collect();
    let residuals = budget::residuals(fit, data);
    let rows = |matrix: &DMatrix<f64>| matrix.row_iter().map(|row| row.iter().copied().collect()).collect();
    Report {
        warnings: warnings(fit, &parameters, &correlation, p_value),
        parameters,
        chi2: fit.best.goodness.chi_square_of_points(),
        degrees_of_freedom: freedom,
        p_value,
        order: fit.ranges.iter().map(Range::label).collect(),
        covariance: rows(&covariance),
        correlation: rows(&correlation),
        budget: budget::parts(fit),
        another_seed: budget::another_seed(fit, fit.best.goodness.chi_square_of_points() / freedom.max(1) as f64),
        shifts,
        tests: Vec::new(),
        design: None,
        bias: bias_of(&residuals),
        residuals,
        replicas: fit.emulator.replicas(),
        runs: fit.runs,
        boxes: fit.rounds,
    }
}

/// The report of points beside a scene as it is: no parameter is fitted.
pub fn as_written(data: &[Datum], found: &Direct, rods: &Rods, replicas: usize) -> Result<Report, String> {
    let goodness = found.goodness(data, rods).ok_or("the covariance of the points is not positive")?;
    let u = found.u();
    let residual = |(k, datum): (usize, &Datum)| budget::residual(datum, found.mean[k], u[k]);
    let residuals: Vec<_> = data.iter().enumerate().map(residual).collect();
    let p_value = goodness.p_value();
    let warning = of_p(p_value).map(|warning| match warning {
        Warning::NotDescribed(p) => Warning::Other(format!(
            "p = {p}: the scene as it is does not describe these points, or their uncertainties are too small"
        )),
        other => other,
    });
    Ok(Report {
        chi2: goodness.chi_square_of_points(),
        degrees_of_freedom: data.len(),
        p_value,
        bias: bias_of(&residuals),
        residuals,
        replicas,
        runs: replicas as u64,
        warnings: warning.into_iter().collect(),
        ..Report::default()
    })
}

fn bias_of(residuals: &[Residual]) -> Option<Bias> {
    let pairs: Vec<_> = residuals.iter().map(|r| (r.simulated, r.measured)).collect();
    let relative = |r: &Residual| (r.u / r.measured).powi(2);
    bias(&pairs, (residuals.iter().map(relative).sum::<f64>() / residuals.len() as f64).sqrt())
}

/// A warning of points too far from the model, or too near.
fn of_p(p_value: f64) -> Option<Warning> {
    if p_value > 1.0 - NOT_DESCRIBED {
        return Some(Warning::Other(format!(
            "p = {}: the points lie nearer to the curve than their uncertainties allow; are these too large, or in \
                per cent?",
            probability(p_value)
        )));
    }
    (p_value < NOT_DESCRIBED).then(|| Warning::NotDescribed(probability(p_value)))
}

fn warnings(
    fit: &Fit,
    parameters: &BTreeMap<String, Parameter>,
    correlation: &DMatrix<f64>,
    p_value: f64,
) -> Vec<Warning> {
    let mut all = Vec::new();
    for (axis, range) in fit.ranges.iter().enumerate() {
        let found = &parameters[&range.label()];
        if let Some(k) = another_minimum(&fit.profiles[axis].rise) {
            all.push(Warning::Other(format!(
                "{}: {:.4} describes the points nearly as well as {:.4} (its χ² is {:.2} higher, with a ridge between \
                 them): give the whole interval, not the best value",
                range.label(),
                fit.value(axis, fit.profiles[axis].place[k]),
                found.estimate,
                fit.profiles[axis].rise[k]
            )));
        }
        let reaches = |side: &str, edge: f64| {
            format!("reaches the {side} end of its range, {edge}: the points do not say where it ends")
        };
        let how = match found.ends_at_edge {
            [true, true] => {
                Some(format!("is its whole range, {} to {}: the points say nothing of it there", range.from, range.to))
            }
            [true, false] => Some(reaches("lower", range.from)),
            [false, true] => Some(reaches("upper", range.to)),
            [false, false] => None,
        };
        all.extend(how.map(|how| Warning::Other(format!("{}: its 95 % interval {how}", range.label()))));
    }
    let pairs = (0..fit.ranges.len()).flat_map(|i| (0..i).map(move |j| [j, i]));
    let alike = pairs.filter(|[j, i]| correlation[(*i, *j)].abs() > ALIKE);
    let labels = |pair: [usize; 2]| pair.map(|axis| fit.ranges[axis].label());
    all.extend(alike.map(|[j, i]| Warning::Alike(labels([j, i]), correlation[(i, j)])));
    all.extend(of_p(p_value));
    // The noise of the replicas enters the curves and their slopes.
    let replicas = fit.best.share(REPLICAS).max(fit.noise_share());
    let polynomials = fit.best.share(EMULATOR);
    let own =
        [Warning::Replicas(replicas, "noise of its replicas"), Warning::Polynomials(polynomials, CAUSES[EMULATOR])];
    let large = own.into_iter().zip([replicas, polynomials]).filter(|(_, share)| *share > 1.5 * MOST_SHARE);
    all.extend(large.map(|(warning, _)| warning));
    all
}

/// The deepest other minimum of a profile that is within its 95 % interval, with a ridge between it and the best place:
/// of a tenth of the rise at the ends of the 68 % interval, so that an estimate that hangs on so little is not given
/// without a word.
fn another_minimum(rise: &[f64]) -> Option<usize> {
    let best = rise.iter().position(|rise| *rise == 0.0)?;
    let ridge = |k: usize| crate::oracle::worst(rise[k.min(best)..=k.max(best)].iter().copied());
    let apart = (0..rise.len()).filter(|k| rise[*k] <= rise_of(0.95) && ridge(*k) > rise[*k] + 0.1);
    apart.min_by(|a, b| rise[*a].total_cmp(&rise[*b]))
}

/// `residuals.csv`: each point with the best model; sets count from 1.
pub fn residuals_csv(report: &Report, times: &[&str]) -> Result<String, String> {
    let head = ["set", "time_unit", "time", "column", "measured", "simulated", "residual", "u"];
    let row = |r: &Residual| {
        let numbers = [r.measured, r.simulated, r.residual, r.u].map(|number| number.to_string());
        let place = [(r.set + 1).to_string(), times[r.set].to_owned(), r.time.to_string(), r.column.clone()];
        [place, numbers].concat()
    };
    let rows: Vec<_> = [head.map(String::from).to_vec()].into_iter().chain(report.residuals.iter().map(row)).collect();
    csv::text(&rows)
}

/// `profiles.csv`: χ² − χ²_min along each parameter, corrected for the noise of the replicas.
pub fn profiles_csv(fit: &Fit) -> Result<String, String> {
    let mut rows = vec![["parameter", "value", "rise_of_chi2"].map(String::from).to_vec()];
    for (axis, profile) in fit.profiles.iter().enumerate() {
        rows.extend(profile.place.iter().zip(&profile.rise).map(|(place, rise)| {
            vec![fit.ranges[axis].label(), fit.value(axis, *place).to_string(), rise.to_string()]
        }));
    }
    csv::text(&rows)
}

/// `design.csv`: each point that could be measured, its standard deviation given the measured points, and the
/// uncertainties of the parameters that it would leave; sets count from 1.
pub fn design_csv(fit: &Fit, candidates: &[Candidate], times: &[&str]) -> Result<String, String> {
    let head = ["set", "time_unit", "time", "column", "concentration_per_cm3", "u", "spread"];
    let own = (fit.ranges.iter()).map(|range| format!("u_{}_with_it", range.name()));
    let mut rows: Vec<Vec<String>> = vec![head.into_iter().map(String::from).chain(own).collect()];
    rows.extend(candidates.iter().map(|one| {
        let place = [
            (one.set + 1).to_string(),
            times[one.set].to_owned(),
            one.time.to_string(),
            one.column.clone(),
            one.concentration_per_cm3.map_or(String::new(), |n| n.to_string()),
        ];
        let numbers = [one.u, one.spread].into_iter().chain(one.leaves.iter().copied());
        place.into_iter().chain(numbers.map(|number| number.to_string())).collect()
    }));
    csv::text(&rows)
}

/// The confidence levels of the drawn profiles, each with its rise of χ².
pub fn levels() -> [(f64, f64); 2] {
    [0.68, 0.95].map(|confidence| (confidence, rise_of(confidence)))
}
