//! Validation of a problem before anything is compared with it: kind, metric and columns must match, and every number
//! must be in its range. The JSON Schema (`schemas/problem.schema.json`) has the same rules.

use super::asked::SECOND;
use super::folgar_tucker::FOURTH;
use super::formula;
use super::table::LONGEST_EXCERPT;
use super::{Kind, LoadedProblem, Metric, Problem};
use crate::files::FileError;
use crate::files::text::start;
use std::path::Path;

/// The allowed lists of columns of a kind of problem, after its keys.
type Columns = &'static [&'static [&'static str]];

/// A kind's metric, its smallest and largest tolerance, and its columns.
///
/// Directions differ by at most π/2, and means and relative errors of a wrong answer are about 1: a larger tolerance
/// would let anything pass.
pub(super) fn form(kind: Kind) -> (Metric, [f64; 2], Columns) {
    const LEAST: f64 = 1e-300;
    match kind {
        Kind::Rods => (Metric::Angle, [LEAST, 0.1], &[&["p1", "p2", "p3"]]),
        Kind::Tensor => (Metric::Absolute, [LEAST, 0.1], &[&SECOND, &["x1", "x2", "x3"], &FOURTH]),
        Kind::Contact => (Metric::Relative, [LEAST, 0.1], &[&RATES, &ANGLES]),
        Kind::Formula => (Metric::Absolute, [LEAST, 0.1], &[&formula::PDOT, &formula::FOURTH, &formula::DADT]),
        Kind::Ensemble => (Metric::StandardErrors, [1.0, 10.0], &[&["x1", "x1_se", "x2", "x2_se", "x3", "x3_se"]]),
    }
}

/// The smallest and the largest tolerance of a kind.
pub fn tolerances(kind: Kind) -> [f64; 2] {
    form(kind).1
}

pub(super) const RATES: [&str; 6] =
    ["a_pdot1_per_s", "a_pdot2_per_s", "a_pdot3_per_s", "b_pdot1_per_s", "b_pdot2_per_s", "b_pdot3_per_s"];
#[rustfmt::skip]
pub(super) const ANGLES: [&str; 8] = [
    "a_phi_rate_per_s", "a_theta_rate_per_s", "a_phi_rad", "a_theta_rad",
    "b_phi_rate_per_s", "b_theta_rate_per_s", "b_phi_rad", "b_theta_rad",
];

/// The largest |L_ij| in 1/s, and the largest of lengths in mm and other numbers.
const MOST: f64 = 1e9;
/// The largest strain |L| t: the numbers of steps must stay finite over 24 doublings from a step of about 1/|L|.
const MOST_STRAIN: f64 = 1e9;
/// The range of r_e in scenes.
const RATIOS: [f64; 2] = [1e-100, 1e100];
/// The range of C_I, and of D_r in 1/s.
const DIFFUSION: [f64; 2] = [1e-9, 1e9];
/// The largest σ of r_e in percent: r_e is still positive six σ below its mean.
const MOST_SPREAD: f64 = 15.0;
const LONGEST: usize = 10_000;

/// A refused key: its name, and the reason.
pub(super) type Refused = (&'static str, String);

fn ensure<E>(holds: bool, error: impl FnOnce() -> E) -> Result<(), E> {
    if holds { Ok(()) } else { Err(error()) }
}

/// Refuses a problem whose keys do not match or are out of range.
///
/// # Errors
///
/// The key, with the value that was found and the allowed ones.
pub(super) fn check(folder: &Path, problem: &Problem) -> Result<(), Refused> {
    name(folder, problem)?;
    texts(problem)?;
    let (metric, tolerances, lists) = form(problem.kind);
    ensure(problem.metric == metric, || {
        let [found, kind, due] = [word(&problem.metric), word(&problem.kind), word(&metric)];
        ("metric", format!("{found}: a problem of the kind {kind} has the metric {due}"))
    })?;
    between("tolerance", problem.tolerance, tolerances)?;
    columns(problem, lists)?;
    problem.gradient_per_s.iter().flatten().try_for_each(|x| between("gradient_per_s", *x, [-MOST, MOST]))?;
    if let Some(rotation) = problem.rotation_rad_per_s {
        let key = "rotation_rad_per_s";
        ensure(problem.kind == Kind::Rods, || (key, "it belongs to the kind \"rods\" alone".to_owned()))?;
        rotation.iter().try_for_each(|x| between(key, *x, [-MOST, MOST]))?;
    }
    between("aspect_ratio", problem.aspect_ratio, RATIOS)?;
    let spread = if problem.columns.iter().any(|column| column == "x1") { MOST_SPREAD } else { 0.0 };
    between("aspect_ratio_sd_percent", problem.aspect_ratio_sd_percent, [0.0, spread])?;
    diffusion(problem)?;
    closed(problem)?;
    formula(problem)?;
    times(problem)?;
    ensemble(problem)
}

fn word<T: serde::Serialize>(value: &T) -> String {
    serde_json::to_string(value).unwrap_or_default()
}

fn between(key: &'static str, found: f64, [least, most]: [f64; 2]) -> Result<(), Refused> {
    ensure((least..=most).contains(&found), || {
        (key, format!("{found:e}: a number from {least:e} to {most:e} is allowed"))
    })
}

/// Refuses a name that is not plain or not the folder's: answers are sought in the folder of this name.
fn name(folder: &Path, problem: &Problem) -> Result<(), Refused> {
    let folder = folder.file_name().unwrap_or_default().to_string_lossy();
    let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || matches!(c, '.' | '-');
    let good = problem.name.chars().all(plain) && !problem.name.starts_with(['.', '-']);
    ensure(good && problem.name == folder, || {
        let found = start(&problem.name, LONGEST_EXCERPT);
        ("name", format!("{found:?}: it must be the folder's, {folder:?}, in small letters, digits, - and ."))
    })
}

fn texts(problem: &Problem) -> Result<(), Refused> {
    let texts = [
        ("title", &problem.title),
        ("summary", &problem.summary),
        ("because", &problem.because),
        ("axes", &problem.axes),
    ];
    for (key, text) in texts.into_iter().chain(problem.equations.iter().map(|text| ("equations", text))) {
        let allowed = !text.trim().is_empty() && text.chars().count() <= LONGEST;
        ensure(allowed, || (key, format!("a text of 1 to {LONGEST} characters is allowed")))?;
    }
    ensure(!problem.equations.is_empty(), || ("equations", "there must be one at least".to_owned()))
}

fn columns(problem: &Problem, lists: Columns) -> Result<(), Refused> {
    let keys = problem.kind.keys();
    let is = |list: &&&[&str]| problem.columns.iter().eq(keys.iter().chain(list.iter()));
    let Some(found) = lists.iter().find(is) else {
        let allowed: Vec<_> = lists.iter().map(|list| [keys, list].concat().join(",")).collect();
        let (found, kind) = (start(&problem.columns.join(","), LONGEST_EXCERPT), word(&problem.kind));
        return Err(("columns", format!("{found:?}: a problem of the kind {kind} has {}", allowed.join(" or "))));
    };
    // Angles need a time step, rates must have none.
    match (problem.time_step_s, *found == &ANGLES[..]) {
        (Some(step), true) => between("time_step_s", step, [1e-300, MOST]),
        (step, angles) => ensure(step.is_some() == angles, || {
            ("time_step_s", "it must be there where angles after a step are asked for, and nowhere else".to_owned())
        }),
    }
}

fn diffusion(problem: &Problem) -> Result<(), Refused> {
    let (of_tensors, both) = (problem.kind == Kind::Tensor, problem.c_i.is_some() && problem.d_r_per_s.is_some());
    for (key, found) in [("c_i", problem.c_i), ("d_r_per_s", problem.d_r_per_s)] {
        let Some(found) = found else { continue };
        ensure(of_tensors, || (key, format!("{found:e}: it belongs to the kind \"tensor\" alone")))?;
        ensure(!both, || (key, format!("{found:e}: c_i or d_r_per_s is allowed, not both")))?;
        between(key, found, DIFFUSION)?;
    }
    if let Some(period_s) = problem.oscillation_period_s {
        let key = "oscillation_period_s";
        ensure(problem.d_r_per_s.is_some(), || (key, "it belongs to rods with d_r_per_s".to_owned()))?;
        between(key, period_s, [1e-100, 1e100])?;
    }
    ensure(!problem.planar_start || problem.diffusing().is_some(), || {
        ("planar_start", "it belongs to rods with c_i or d_r_per_s".to_owned())
    })
}

fn closed(problem: &Problem) -> Result<(), Refused> {
    let Some(closed) = &problem.closed else { return Ok(()) };
    let refused = |why: &str| ("closed", why.to_owned());
    let second = problem.columns.get(1).is_some_and(|column| column == "a11");
    ensure(second && problem.diffusing().is_none(), || {
        refused("it belongs to problems of a11 to a23 without a c_i or d_r_per_s of their own")
    })?;
    // Parameters of an anisotropic diffusivity may be negative.
    closed.model.parameters().iter().try_for_each(|x| between("closed", *x, [-MOST, MOST]))?;
    let a = closed.start();
    let whole = (a.trace() - 1.0).abs() <= 1e-12 && a == a.transpose();
    ensure(whole && a.symmetric_eigenvalues().iter().all(|x| *x >= -1e-12), || {
        refused("start must be symmetric, with trace 1 and no eigenvalue below 0")
    })
}

/// Refuses a formula that is missing, of another kind, or has other columns.
fn formula(problem: &Problem) -> Result<(), Refused> {
    let refused = |why: &str| Err(("formula", why.to_owned()));
    match (&problem.formula, problem.kind) {
        (None, Kind::Formula) => refused("it must be there for the kind \"formula\""),
        (Some(_), kind) if kind != Kind::Formula => refused("it belongs to the kind \"formula\" alone"),
        (Some(formula), _) if !problem.columns[1..].iter().eq(formula.answers()) => {
            refused(&format!("its columns are {}", formula.answers().join(",")))
        }
        (Some(super::Formula::Dadt { model, .. }), _) => {
            model.parameters().iter().try_for_each(|x| between("formula", *x, [-MOST, MOST]))
        }
        _ => Ok(()),
    }
}

fn times(problem: &Problem) -> Result<(), Refused> {
    let times = &problem.times_s;
    let ascending = times.windows(2).all(|pair| pair[0] < pair[1]);
    let positive = times.first().is_none_or(|first| *first > 0.0);
    let without = matches!(problem.kind, Kind::Contact | Kind::Formula);
    ensure(ascending && positive && times.is_empty() == without, || {
        const ALLOWED: &str = "they must be above 0 and ascend, and there must be one at least, but of contacts and \
            formulas none";
        ("times_s", ALLOWED.to_owned())
    })?;
    let turning = problem.rotation_rad_per_s.unwrap_or_default();
    let rate = problem.gradient_per_s.iter().flatten().chain(&turning).fold(0.0, |a: f64, b| a.max(b.abs()));
    ensure(times.iter().all(|time| *time <= 1e300 && time * rate <= MOST_STRAIN), || {
        ("times_s", format!("a strain of at most {MOST_STRAIN:e} is allowed"))
    })
}

fn ensemble(problem: &Problem) -> Result<(), Refused> {
    const KEY: &str = "ensemble";
    let is_ensemble = problem.kind == Kind::Ensemble;
    let Some(of) = &problem.ensemble else {
        return ensure(!is_ensemble, || (KEY, "it must be there for the kind \"ensemble\"".to_owned()));
    };
    ensure(is_ensemble, || (KEY, "it belongs to the kind \"ensemble\" alone".to_owned()))?;
    let numbers = [
        ("count", of.count as f64, [1.0, MOST]),
        ("length_mm", of.length_mm, [1.0 / MOST, MOST]),
        ("concentration_per_cm3", of.concentration_per_cm3, [1.0 / MOST, 1e300]),
        ("alpha", of.alpha, [1.0 / MOST, MOST]),
        ("m", of.m, [1.0 / MOST, MOST]),
        ("steps_per_period", of.steps_per_period as f64, [1.0, MOST]),
        ("certified_replicas", of.certified_replicas as f64, [2.0, 1e15]),
        // Means of |p_i| are between 0 and 1.
        ("largest_standard_error", of.largest_standard_error, [1.0 / MOST, 0.1]),
    ];
    numbers.into_iter().try_for_each(|(name, found, range)| {
        between(KEY, found, range).map_err(|(key, message)| (key, format!("{name} = {message}")))
    })
}

/// Refuses tables with impossible numbers: directions that are not of length 1, means out of range.
pub(super) fn tables(loaded: &LoadedProblem) -> Result<(), FileError> {
    if let Some(inputs) = &loaded.inputs {
        let path = loaded.dir.join("inputs.csv");
        for (row, values) in inputs.rows.iter().enumerate() {
            let wrong =
                |column: usize, message: String| FileError::at(&path, inputs.line(row), column as u64 + 1, message);
            ensure(values[0] == row as f64, || {
                wrong(0, format!("{} = {}; {row} is next", inputs.columns[0], values[0]))
            })?;
            for (at, name) in inputs.columns.iter().enumerate() {
                if name.ends_with("p1") {
                    unit(&values[at..at + 3]).map_err(|message| wrong(at, message))?;
                } else if name.ends_with("aspect_ratio") {
                    between("aspect_ratio", values[at], RATIOS).map_err(|(_, message)| wrong(at, message))?;
                } else if name == "a11" {
                    has_trace_1(&values[at..at + 3], 1e-12).map_err(|message| wrong(at, message))?;
                }
            }
        }
    }
    let path = loaded.dir.join("certified.csv");
    let keys = loaded.problem.kind.keys().len();
    for (row, values) in loaded.certified.rows.iter().enumerate() {
        let wrong = |message: String| FileError::at(&path, loaded.certified.line(row), keys as u64 + 1, message);
        certified(&loaded.problem, &values[keys..]).map_err(wrong)?;
    }
    Ok(())
}

/// Refuses the values of a certified row if they are out of range.
fn certified(problem: &Problem, values: &[f64]) -> Result<(), String> {
    let (holds, why) = match problem.kind {
        Kind::Rods => return unit(values),
        Kind::Formula => return Ok(()),
        Kind::Tensor if values.len() == SECOND.len() => return has_trace_1(&values[..3], 1e-9),
        Kind::Tensor if values.len() == FOURTH.len() => {
            let sum = |places: [usize; 3]| places.map(|at| values[at]).iter().sum::<f64>();
            let whole = (sum([0, 10, 14]) + 2.0 * sum([3, 5, 12]) - 1.0).abs() < 1e-9;
            (whole, "a1111 + a2222 + a3333 + 2 (a1122 + a1133 + a2233) must be 1")
        }
        Kind::Contact => {
            let moves = values.chunks(values.len() / 2).all(|rod| rod.iter().any(|x| *x != 0.0));
            (moves, "all values of a rod are 0: there is no relative error")
        }
        Kind::Tensor | Kind::Ensemble => {
            let within = values.iter().all(|x| (0.0..=1.0).contains(x));
            (within, "means of |p_i| and their errors are from 0 to 1")
        }
    };
    ensure(holds, || why.to_owned())
}

fn has_trace_1(diagonal: &[f64], most: f64) -> Result<(), String> {
    ensure((diagonal.iter().sum::<f64>() - 1.0).abs() <= most, || "a11 + a22 + a33 must be 1".to_owned())
}

/// Refuses a direction whose length differs from 1 by more than the rounding of three numbers near 1.
pub(super) fn unit(p: &[f64]) -> Result<(), String> {
    let length = p.iter().map(|x| x * x).sum::<f64>().sqrt();
    ensure((length - 1.0).abs() <= 4.0 * f64::EPSILON, || format!("|p| = {length}; it must be 1"))
}
