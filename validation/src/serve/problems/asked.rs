//! Building blocks of the problems of free rods.

use crate::oracle::closed_form;

/// The paper's shear rate, 1/s: not 1, so that a program that forgets G fails.
pub(super) const SHEAR_RATE_PER_S: f64 = 0.5;

/// Plane Couette flow, u₂ = G x₁.
pub(super) const COUETTE: [[f64; 3]; 3] = [[0.0; 3], [SHEAR_RATE_PER_S, 0.0, 0.0], [0.0; 3]];

/// Names of the axes, and conventions.
pub(super) const AXES: &str = "1 = gradient, 2 = flow, 3 = vorticity of the plane Couette flow u_2 = G x_1; \
    gradient_per_s[i][j] = du_i/dx_j; p = (sin θ cos φ, sin θ sin φ, cos θ); p and -p are the same rod";

/// The properties in which problems differ.
pub(super) struct Asked {
    pub gradient_per_s: [[f64; 3]; 3],
    pub aspect_ratio: f64,
    pub start: Vec<[f64; 3]>,
    pub times_s: Vec<f64>,
    pub summary: String,
    pub equations: &'static [&'static str],
}

/// The equations behind a rod in any flow.
pub(super) const ANY_FLOW: &[&str] = &[
    "Jeffery's equation (A.1 of Lee & Springer 1982), solved by p = q/|q|, q = exp((W + ΛD)t) p(0) with W and D the \
     antisymmetric and symmetric parts of the velocity gradient and Λ = (r_e² - 1)/(r_e² + 1)",
];

/// The direction p at the angles `phi` and `theta` (rad).
pub(super) fn direction(phi: f64, theta: f64) -> [f64; 3] {
    let sine = theta.sin();
    [sine * phi.cos(), sine * phi.sin(), theta.cos()]
}

/// The period T of a rod, s.
pub(super) fn period_s(aspect_ratio: f64) -> f64 {
    closed_form::period_s(SHEAR_RATE_PER_S, aspect_ratio)
}
