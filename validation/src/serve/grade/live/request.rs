//! What a program is asked, and what it answers.

use serde::Serialize;

/// A request: one line to the program.
#[derive(Clone, Debug, Serialize)]
pub struct Request<'a> {
    /// The request's id, which ascends; the answer repeats it.
    pub id: u64,
    /// L in 1/s, row i and column j holding ∂u_i/∂x_j.
    pub gradient_per_s: &'a [[f64; 3]; 3],
    /// ω in rad/s of a gradient that turns: L(t) = Q L Qᵀ + S, S p = ω × p, Q = exp(St).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rotation_rad_per_s: Option<[f64; 3]>,
    /// r_e.
    pub aspect_ratio: f64,
    /// The rods' directions at t = 0.
    pub start: &'a [[f64; 3]],
    /// The time in s of the directions to return.
    pub end_s: f64,
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

/// The answer, or the program's own error.
pub type Answer = Result<Turned, String>;
