//! How near an answer must be to a mistake's curve, and what is said of it then.

use super::mistakes::Setting;
use crate::methods::integrators::apart_rad;
use crate::serve::problems::LoadedProblem;
use nalgebra::{Matrix3, Vector3};

/// An answer belongs to a mistake's curve if it is a thousand times nearer to it than to the truth: for one direction
/// and some fifty curves this happens by chance with a probability of 10⁻⁴, for several rows far more rarely.
pub(super) const NEARER: f64 = 1e-3;

/// The diagnosis of an answer to one problem.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Diagnosis {
    /// The diagnosis in words, if it is certain.
    pub said: Option<String>,
    /// The mistakes whose curve the answer is.
    pub suspects: Vec<String>,
    /// The factors on time at which a correct rod has the answer's direction, as far as one problem determines them.
    pub rates: Vec<f64>,
}

pub(super) fn setting(loaded: &LoadedProblem) -> Setting {
    let l = &loaded.problem.gradient_per_s;
    Setting { gradient_per_s: Matrix3::from_fn(|i, j| l[i][j]), aspect_ratio: loaded.problem.aspect_ratio }
}

/// The angle between two directions or ||p| − 1|, whichever is larger; for a mistake with a length of its own, the
/// relative distance. Opposite directions are the same.
pub(super) fn apart(found: &Vector3<f64>, expected: &Vector3<f64>, has_length: bool) -> f64 {
    if has_length {
        (found - expected).norm().min((found + expected).norm()) / expected.norm()
    } else {
        apart_rad(found, expected).max((found.norm() - 1.0).abs())
    }
}
