//! Which known mistake's curve an answer is.

use super::answer::Answer;
use super::closures;
use super::contact;
use super::means;
use super::mistakes::{self, Mistake, Setting};
use super::rates;
use crate::methods::integrators::apart_rad;
use crate::serve::problems::{Kind, LoadedProblem};
use nalgebra::{Matrix3, Vector3};

/// An answer is a mistake's curve where it is a thousand times nearer to it than to the truth: a chance coincidence of one
/// direction with one of some fifty curves has a probability of 10⁻⁴, of several rows far less.
pub(super) const NEARER: f64 = 1e-3;

/// More names than these tell nothing: where a curve has come to rest, most mistakes have it.
const MOST_NAMES: usize = 4;

/// What is found of an answer on one problem.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Diagnosis {
    /// In words, where it is certain.
    pub said: Option<String>,
    /// The mistakes whose curve it is.
    pub suspects: Vec<String>,
    /// The parts of the true time after which a right rod is there, as far as one problem tells.
    pub rates: Vec<f64>,
}

/// What is to be said of an answer that is `error` from the truth.
pub fn diagnose(loaded: &LoadedProblem, answer: &Answer, error: f64) -> Diagnosis {
    if error.is_nan() || error <= loaded.problem.tolerance {
        return Diagnosis::default();
    }
    let tolerance = loaded.problem.tolerance;
    match loaded.problem.kind {
        Kind::Contact => said(contact::near(loaded, answer, NEARER * error), tolerance),
        Kind::Ensemble => Diagnosis { said: means::ensemble(loaded, answer), ..Diagnosis::default() },
        _ if loaded.problem.aspect_ratio_sd_percent > 0.0 => {
            said(means::unequal(loaded, answer, NEARER * error), tolerance)
        }
        Kind::Rods if rests(loaded, answer, NEARER * error) => {
            let said = "every rod is where it started: nothing has moved".to_owned();
            Diagnosis { said: Some(said), ..Diagnosis::default() }
        }
        Kind::Tensor if loaded.problem.c_i.is_some() || loaded.problem.closed.is_some() => {
            closures::diagnose(loaded, answer, error)
        }
        _ => {
            let near: Vec<_> = (mistakes::all().into_iter())
                .filter_map(|mistake| Some((distance(loaded, answer, &mistake)?, mistake.name)))
                .filter(|(distance, _)| *distance <= NEARER * error)
                .collect();
            let rates = rates::rates(loaded, answer, &setting(loaded), NEARER * error);
            Diagnosis { rates, ..said(near, tolerance) }
        }
    }
}

pub(super) fn setting(loaded: &LoadedProblem) -> Setting {
    let l = &loaded.problem.gradient_per_s;
    Setting { gradient_per_s: Matrix3::from_fn(|i, j| l[i][j]), aspect_ratio: loaded.problem.aspect_ratio }
}

/// How far an answer about rods or tensors is from a mistake's curve; `None` where the mistake has no meaning.
fn distance(loaded: &LoadedProblem, answer: &Answer, mistake: &Mistake) -> Option<f64> {
    match loaded.problem.kind {
        Kind::Rods => rods(loaded, answer, &setting(loaded), mistake),
        Kind::Tensor => tensor(loaded, answer, &setting(loaded), mistake),
        Kind::Contact | Kind::Ensemble => None,
    }
}

/// Whether a mistake would show on a problem: its curve is not within the tolerance of the certified answer.
pub(super) fn shows(loaded: &LoadedProblem, mistake: &Mistake) -> bool {
    if loaded.problem.aspect_ratio_sd_percent > 0.0 {
        return false;
    }
    let certified = Answer::certified(loaded);
    distance(loaded, &certified, mistake).is_some_and(|distance| distance > 2.0 * loaded.problem.tolerance)
}

/// Whether no rod has moved: then many curves are alike, and none is named.
fn rests(loaded: &LoadedProblem, answer: &Answer, nearer_than: f64) -> bool {
    let count = loaded.start.len();
    let stays = |(row, values): (usize, &Vec<f64>)| {
        let start = Vector3::from(loaded.start[row % count]);
        apart(&Vector3::from_row_slice(values), &start, false) <= nearer_than
    };
    answer.rows.iter().enumerate().all(stays)
}

/// The nearest curve, and those that cannot be told from it here.
fn said(mut near: Vec<(f64, String)>, tolerance: f64) -> Diagnosis {
    near.sort_by(|a, b| a.0.total_cmp(&b.0));
    let Some((nearest, _)) = near.first() else {
        return Diagnosis::default();
    };
    let nearest = nearest.max(f64::EPSILON);
    near.retain(|(distance, _)| *distance <= (10.0 * nearest).max(tolerance));
    // Plane Couette flow is its own mirror image in axis 3: a reversal in the start is one in the answer.
    let found: Vec<_> = near.iter().map(|(_, name)| name.clone()).collect();
    near.retain(|(_, name)| {
        !name.strip_suffix(mistakes::IN_THE_START).is_some_and(|name| found.iter().any(|other| other == name))
    });
    let suspects: Vec<_> = near.into_iter().map(|(_, name)| name).collect();
    let names = suspects.join(" or of ");
    let said =
        (suspects.len() <= MOST_NAMES).then(|| format!("this is the curve of {names}, to {nearest:.0e}"));
    Diagnosis { said, suspects, rates: Vec::new() }
}

/// The largest of the distances; `None` where one is missing or not finite.
fn largest(distances: impl Iterator<Item = Option<f64>>) -> Option<f64> {
    let finite = |distance: Option<f64>| distance.filter(|distance| distance.is_finite());
    distances.map(finite).try_fold(0.0, |a: f64, b| Some(a.max(b?)))
}

fn rods(loaded: &LoadedProblem, answer: &Answer, setting: &Setting, mistake: &Mistake) -> Option<f64> {
    let count = loaded.start.len();
    let of_row = |(row, values): (usize, &Vec<f64>)| {
        let time = loaded.problem.times_s[row / count];
        let expected = mistake.direction(setting, &Vector3::from(loaded.start[row % count]), time)?;
        Some(apart(&Vector3::from_row_slice(values), &expected, mistake.has_length))
    };
    largest(answer.rows.iter().enumerate().map(of_row))
}

/// The angle, and what |p| is off by where that is more; or, of a mistake with a length of its own, the relative distance.
/// Head or tail alike.
pub(super) fn apart(found: &Vector3<f64>, expected: &Vector3<f64>, has_length: bool) -> f64 {
    match has_length {
        true => (found - expected).norm().min((found + expected).norm()) / expected.norm(),
        false => apart_rad(found, expected).max((found.norm() - 1.0).abs()),
    }
}

fn tensor(loaded: &LoadedProblem, answer: &Answer, setting: &Setting, mistake: &Mistake) -> Option<f64> {
    let columns: Vec<(usize, usize)> = (loaded.problem.columns.iter().skip(1))
        .map(|name| match name.as_bytes() {
            [b'a', i @ b'1'..=b'3', j @ b'1'..=b'3'] => Some((usize::from(i - b'1'), usize::from(j - b'1'))),
            _ => None,
        })
        .collect::<Option<_>>()?;
    let of_row = |(row, values): (usize, &Vec<f64>)| {
        let map = mistake.map(setting, loaded.problem.times_s[row])?;
        let expected = match mistake.has_length {
            // ⟨qq⟩ of isotropic p(0).
            true => map * map.transpose() / 3.0,
            false => mistakes::isotropic_tensor(&map)?,
        };
        let scale = if mistake.has_length { expected.amax() } else { 1.0 };
        largest(
            columns
                .iter()
                .zip(values)
                .map(|((i, j), value)| Some((value - expected[(*i, *j)]).abs() / scale)),
        )
    };
    largest(answer.rows.iter().enumerate().map(of_row))
}
