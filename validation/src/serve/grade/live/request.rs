//! What a program is asked, and what it answers.

use crate::serve::problems::{LoadedProblem, Problem};
use serde::Serialize;

/// A question about free rods: their directions at `end_s`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Question {
    /// L in 1/s, row i and column j holding ∂u_i/∂x_j.
    pub gradient_per_s: [[f64; 3]; 3],
    /// ω in rad/s of a gradient that turns: L(t) = Q L Qᵀ + S, S p = ω × p, Q = exp(St).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rotation_rad_per_s: Option<[f64; 3]>,
    /// r_e.
    pub aspect_ratio: f64,
    /// The rods' directions at t = 0.
    pub start: Vec<[f64; 3]>,
    /// The time in s of the directions to return.
    pub end_s: f64,
}

impl Question {
    /// The last time of a problem about rods.
    pub(super) fn of(last: &LoadedProblem) -> Self {
        let Problem { gradient_per_s, rotation_rad_per_s, aspect_ratio, .. } = last.problem;
        let end_s = last.problem.times_s.last().copied().unwrap_or_default();
        Self { gradient_per_s, rotation_rad_per_s, aspect_ratio, start: last.start.clone(), end_s }
    }

    /// In plane Couette flow with G = 1/s.
    pub(super) fn couette(aspect_ratio: f64, start: Vec<[f64; 3]>, end_s: f64) -> Self {
        let gradient_per_s = [[0.0; 3], [1.0, 0.0, 0.0], [0.0; 3]];
        Self { gradient_per_s, rotation_rad_per_s: None, aspect_ratio, start, end_s }
    }
}

/// A request: one line to the program.
#[derive(Clone, Debug, Serialize)]
pub struct Request {
    /// The request's id, which ascends; the answer repeats it.
    pub id: u64,
    /// The question in the program's axes.
    #[serde(flatten)]
    pub question: Question,
    /// The number of equal steps.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub steps: Option<u64>,
    /// The relative and absolute tolerance, in place of steps.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tolerance: Option<f64>,
}

/// What a program answers about rods.
#[derive(Clone, Debug, PartialEq)]
pub struct Turned {
    /// The directions; components that were NaN, infinite or null are NaN.
    pub p: Vec<[f64; 3]>,
    /// The number of evaluations of ṗ for each rod, if the program counts them.
    pub evaluations: Option<u64>,
}

/// The reason why there is no answer.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Asked {
    /// The program's own error message.
    #[error("the program says: {0}")]
    Says(String),
    /// The program broke the protocol, now or too often to be asked again.
    #[error("{0}")]
    Breach(String),
    /// No answer came in time, or earlier answers were late too often.
    #[error("{0}")]
    Late(String),
}

/// What is wrong with a line.
impl From<String> for Asked {
    fn from(what: String) -> Self {
        Self::Breach(what)
    }
}
