//! The error of an answer against the certified one, and its drifts.

use super::answer::Answer;
use super::nearness::apart;
use super::trace;
use crate::judge::statistics::worst;
use crate::serve::problems::{LoadedProblem, Metric};
use nalgebra::Vector3;
use shearbed::model::{jeffery, orientation};
use std::f64::consts::{PI, TAU};

/// The result of comparing an answer with the certified one.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Compared {
    /// The largest error of a row by the problem's metric; for directions at least ||p| − 1|. NaN if a value is
    /// not finite.
    pub error: f64,
    /// The error of each row.
    pub errors: Vec<f64>,
    /// The row with the largest error.
    pub row: usize,
    /// A fault other than the error.
    pub remark: Option<String>,
    /// The largest ||p| − 1|.
    pub length_drift: Option<f64>,
    /// The largest change of C_b = C/(1 + C) from the start (eq. 13), in plane Couette flow.
    pub orbit_drift: Option<f64>,
    /// The phase lost per period, in periods, negative for a program that is ahead: of the worst rod at the last time,
    /// in plane Couette flow.
    pub phase_lost_per_period: Option<f64>,
    /// True if a standard error is too large for a verdict.
    pub too_little_data: bool,
}

/// How far the values of a row are from others, by the problem's metric.
pub(super) fn distance(loaded: &LoadedProblem, found: &[f64], due: &[f64]) -> f64 {
    let names = &loaded.problem.columns[loaded.problem.kind.keys().len()..];
    match loaded.problem.metric {
        Metric::Angle => {
            let [found, due] = [found, due].map(Vector3::from_row_slice);
            apart(&found, &due, false)
        }
        Metric::Absolute => crate::oracle::apart(found, due),
        Metric::Relative => relative(names, found, due),
        Metric::StandardErrors => standard_errors(names, found, due),
    }
}

/// The error of each row; NaN if a value is not finite, or its square.
fn row_errors(loaded: &LoadedProblem, answer: &Answer) -> Vec<f64> {
    let keys = loaded.problem.kind.keys().len();
    // Of an infinite value, or one whose square is, no distance says anything.
    let error_of = |(row, found): (usize, &Vec<f64>)| {
        let finite = found.iter().all(|value| value.is_finite());
        let error = finite.then(|| distance(loaded, found, &loaded.certified.rows[row][keys..]));
        error.filter(|error| error.is_finite()).unwrap_or(f64::NAN)
    };
    answer.rows.iter().enumerate().map(error_of).collect()
}

/// Compares an answer with the problem's certified values.
pub fn compare(loaded: &LoadedProblem, answer: &Answer) -> Compared {
    let names = &loaded.problem.columns[loaded.problem.kind.keys().len()..];
    let errors = row_errors(loaded, answer);
    let largest = errors.iter().copied().enumerate().reduce(|a, b| {
        let worse = b.1.is_nan() || b.1 > a.1;
        if worse && !a.1.is_nan() { b } else { a }
    });
    let (row, error) = largest.unwrap_or((0, f64::NAN));
    let largest_se = largest_standard_error(names, answer);
    let enough = loaded.largest_standard_error();
    let directions = loaded.problem.metric == Metric::Angle;
    let rate = loaded.problem.shear_rate_per_s().filter(|_| directions);
    Compared {
        error,
        errors,
        row,
        remark: remark(loaded, answer, row, error, largest_se),
        length_drift: directions
            .then(|| worst(answer.rows.iter().map(|p| (Vector3::from_row_slice(p).norm() - 1.0).abs()))),
        orbit_drift: rate.map(|_| orbit_drift(loaded, answer)),
        phase_lost_per_period: rate.and_then(|rate| phase_lost(loaded, answer, rate)),
        too_little_data: largest_se.is_nan() || largest_se > enough,
    }
}

/// The larger relative error of the rods a and b: the length of the difference over that of the certified columns. φ
/// is taken modulo 2π.
fn relative(names: &[String], values: &[f64], certified: &[f64]) -> f64 {
    let of_rod = |rod: &str| {
        let due = length(names, rod, |k| certified[k]).max(f64::MIN_POSITIVE);
        length(names, rod, |k| off(&names[k], values[k], certified[k])) / due
    };
    worst(["a_", "b_"].into_iter().map(of_rod))
}

/// A value less the one that is due.
fn off(name: &str, found: f64, due: f64) -> f64 {
    let off = found - due;
    if name.ends_with("phi_rad") { off - TAU * (off / TAU).round() } else { off }
}

/// The length of what `of` gives for each column of a rod, whose names begin with `rod`.
fn length(names: &[String], rod: &str, of: impl Fn(usize) -> f64) -> f64 {
    let own = (0..names.len()).filter(|k| names[*k].starts_with(rod));
    own.map(|k| of(k).powi(2)).sum::<f64>().sqrt()
}

/// Indices of the pairs of columns x and `x_se`.
fn with_errors(names: &[String]) -> impl Iterator<Item = (usize, usize)> + '_ {
    names.iter().enumerate().filter_map(|(k, name)| {
        let error = format!("{name}_se");
        Some((k, names.iter().position(|other| *other == error)?))
    })
}

/// The largest difference of means, in units of their combined standard error.
pub(super) fn standard_errors(names: &[String], values: &[f64], certified: &[f64]) -> f64 {
    worst(with_errors(names).map(|(mean, se)| {
        let se = values[se].hypot(certified[se]);
        (values[mean] - certified[mean]).abs() / se.max(f64::MIN_POSITIVE)
    }))
}

/// The largest standard error; NaN if one is not above 0, as the mean of a random sample has an error.
fn largest_standard_error(names: &[String], answer: &Answer) -> f64 {
    let of_row =
        |row: &Vec<f64>| worst(with_errors(names).map(|(_, se)| if row[se] > 0.0 { row[se] } else { f64::NAN }));
    worst(answer.rows.iter().map(of_row))
}

/// A message about a standard error that is not above 0, if there is one.
fn without_error(loaded: &LoadedProblem, answer: &Answer) -> Option<String> {
    let names = &loaded.problem.columns[loaded.problem.kind.keys().len()..];
    let none = |(row, values): (usize, &Vec<f64>)| {
        let (_, se) = with_errors(names).find(|(_, se)| values[*se] <= 0.0)?;
        let place = answer.place(row);
        let (name, found) = (&names[se], values[se]);
        Some(format!("{place}: {name} = {found}; the mean of a random sample has a standard error above 0"))
    };
    answer.rows.iter().enumerate().find_map(none)
}

fn remark(loaded: &LoadedProblem, answer: &Answer, row: usize, error: f64, largest_se: f64) -> Option<String> {
    let place = || answer.place(row);
    if error.is_nan() {
        let names = &loaded.problem.columns[loaded.problem.kind.keys().len()..];
        // Of a value whose square is infinite, no distance says anything; NaN comes last.
        let (name, value) = names.iter().zip(&answer.rows[row]).max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))?;
        let why = if value.is_finite() { "too large to judge" } else { "not finite" };
        return Some(format!("{}: {name} = {value:?} is {why}", place()));
    }
    if let Some(none) = without_error(loaded, answer) {
        return Some(none);
    }
    let enough = loaded.largest_standard_error();
    if largest_se.is_nan() || largest_se > enough {
        return Some(format!(
            "too little data to judge: the largest standard error is {largest_se:.2e}, {enough:.2e} is allowed"
        ));
    }
    trace::remark(loaded, answer, row).map(|words| format!("{}: {words}", place()))
}

/// The component of a row that is farthest from what is due, with both values; `None` of directions, which have one
/// error for all components.
pub(super) fn worst_entry(loaded: &LoadedProblem, answer: &Answer, row: usize) -> Option<String> {
    let keys = loaded.problem.kind.keys().len();
    let (names, values) = (&loaded.problem.columns[keys..], &answer.rows[row]);
    let certified = &loaded.certified.rows[row][keys..];
    let off = |k: usize| off(&names[k], values[k], certified[k]);
    let errors: Vec<_> = match loaded.problem.metric {
        Metric::Absolute => (0..names.len()).map(|k| (k, off(k).abs())).collect(),
        Metric::StandardErrors => {
            with_errors(names).map(|(k, se)| (k, off(k).abs() / values[se].hypot(certified[se]))).collect()
        }
        // Each rod has an error of its own.
        Metric::Relative => {
            let due = |k: usize| length(names, &names[k][..2], |k| certified[k]).max(f64::MIN_POSITIVE);
            let relative = |k: usize| off(k).abs() / due(k);
            (0..names.len()).map(|k| (k, relative(k))).collect()
        }
        Metric::Angle => return None,
    };
    let (k, _) = errors.into_iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
    // Three digits of the difference, where a double has them.
    let decimals = (2.0 - off(k).abs().log10().floor()).clamp(4.0, 15.0) as usize;
    let digits = |x: f64| if x.abs() < 1e6 { format!("{x:.decimals$}") } else { format!("{x:.3e}") };
    let [found, due] = [values[k], certified[k]].map(digits);
    Some(format!("{} is {found}, {due} is due", names[k]))
}

fn orbit_drift(loaded: &LoadedProblem, answer: &Answer) -> f64 {
    let rods = loaded.start.len();
    let r = loaded.problem.aspect_ratio;
    let c_b = |p: [f64; 3]| orientation::bounded_orbit_constant(p, r);
    worst(
        (answer.rows.iter().enumerate())
            .map(|(row, p)| (c_b([p[0], p[1], p[2]]) - c_b(loaded.start[row % rods])).abs()),
    )
}

fn phase_lost(loaded: &LoadedProblem, answer: &Answer, shear_rate_per_s: f64) -> Option<f64> {
    let r = loaded.problem.aspect_ratio;
    let time_s = *loaded.problem.times_s.last()?;
    let periods = time_s * shear_rate_per_s.abs() / jeffery::strain_per_period(r);
    let last = answer.rows.len() - loaded.start.len();
    let lost = |row: usize| {
        let (p, q) = (&answer.rows[row], &loaded.certified.rows[row][2..]);
        let phase = |p: &[f64]| (p[1] / r).atan2(p[0]) * shear_rate_per_s.signum();
        let off = phase(q) - phase(p);
        // Half a turn is the same rod.
        (off - PI * (off / PI).round()) / TAU / periods
    };
    // A rod along the vorticity axis has no phase.
    let turning = (last..answer.rows.len()).filter(|row| {
        let q = &loaded.certified.rows[*row][2..];
        q[0].hypot(q[1]) > 1e-6
    });
    turning.map(lost).reduce(|a, b| if b.abs() > a.abs() { b } else { a })
}
