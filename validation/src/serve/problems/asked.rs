//! Building blocks of problems.

use crate::oracle::closed_form;
use nalgebra::Matrix3;

/// The paper's shear rate, 1/s: not 1, so that a program that forgets G fails.
pub(super) const SHEAR_RATE_PER_S: f64 = 0.5;

/// Plane Couette flow, u₂ = G x₁.
pub(super) const COUETTE: [[f64; 3]; 3] = [[0.0; 3], [SHEAR_RATE_PER_S, 0.0, 0.0], [0.0; 3]];
pub(super) const UNIAXIAL: [[f64; 3]; 3] = [[-0.25, 0.0, 0.0], [0.0, -0.25, 0.0], [0.0, 0.0, 0.5]];
/// A gradient with all nine entries.
pub(super) const ASKEW: [[f64; 3]; 3] = [[0.25, -0.5, 0.125], [0.75, 0.125, -0.25], [0.375, 0.625, -0.375]];

/// An aspect ratio at which Λ = 1 in doubles.
pub(super) const NEEDLE: f64 = 1e100;

/// Names of the axes, and conventions.
pub(super) const AXES: &str = "1 = gradient, 2 = flow, 3 = vorticity of the plane Couette flow u_2 = G x_1; \
    gradient_per_s[i][j] = du_i/dx_j; p = (sin θ cos φ, sin θ sin φ, cos θ); p and -p are the same rod";

/// The columns of a_ij.
pub(super) const SECOND: [&str; 6] = ["a11", "a22", "a33", "a12", "a13", "a23"];

/// The properties in which problems of free rods differ.
pub(super) struct Asked {
    pub gradient_per_s: [[f64; 3]; 3],
    pub rotation_rad_per_s: Option<[f64; 3]>,
    pub aspect_ratio: f64,
    pub start: Vec<[f64; 3]>,
    pub times_s: Vec<f64>,
    pub summary: String,
}

impl Asked {
    /// Rods in plane Couette flow at times in periods.
    pub fn couette(aspect_ratio: f64, start: Vec<[f64; 3]>, turns: &[f64], summary: &str) -> Self {
        let times_s = periods_s(aspect_ratio, turns);
        let summary = summary.to_owned();
        Self { gradient_per_s: COUETTE, rotation_rad_per_s: None, aspect_ratio, start, times_s, summary }
    }
}

/// The direction p at the angles `phi` and `theta` (rad).
pub(super) fn direction(phi: f64, theta: f64) -> [f64; 3] {
    let sine = theta.sin();
    [sine * phi.cos(), sine * phi.sin(), theta.cos()]
}

/// The period T of a rod, s.
pub(super) fn period_s(aspect_ratio: f64) -> f64 {
    closed_form::period_s(SHEAR_RATE_PER_S, aspect_ratio)
}

/// Times in periods of a rod, in s.
pub(super) fn periods_s(aspect_ratio: f64, turns: &[f64]) -> Vec<f64> {
    turns.iter().map(|turns| turns * period_s(aspect_ratio)).collect()
}

pub(super) fn matrix(rows: &[[f64; 3]; 3]) -> Matrix3<f64> {
    Matrix3::from_fn(|i, j| rows[i][j])
}
