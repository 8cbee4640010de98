//! The exact natural closure: a_ijkl of the directions M p/|M p| for isotropic p that have this a_ij.
//!
//! In the axes of a, with z_i the logarithms of the eigenvalues of M Mᵀ and b_i = e^(−z_i), Σz = 0:
//! a_i = ½∫ds/((b_i + s)R) and a_iijj = ¼∫s ds/((b_i + s)(b_j + s)R), R = ((b_1 + s)(b_2 + s)(b_3 + s))^½ (Verleye &
//! Dupret 1993; Montgomery-Smith, He, Jack & Smith 2011). a is the gradient of the convex function ⟨ln Σ e^(z_i) p_i²⟩
//! of z, with the derivatives ∂a_i/∂z_j = a_i δ_ij − a_iijj: Newton's method finds z from a with only the fourth
//! moments.

use super::fourth::{Fourth, principal};
use nalgebra::{Matrix3, Vector3};
use std::sync::LazyLock;

/// The smallest eigenvalue distinguished from 0.
const LEAST: f64 = 1e-12;

/// An eigenvalue below 0 by more than this is no rounding.
const OUTSIDE: f64 = 1e-6;

pub(super) fn fourth(a: &Matrix3<f64>) -> Fourth {
    let (values, axes) = principal(a);
    // Of no distribution of rods: there is no z to be found.
    let rounds = if values.min() < -OUTSIDE { 0 } else { 60 };
    let values = values.map(|value| value.max(LEAST));
    // The result is homogeneous of degree 1 in a, so that a rounding error of the trace is kept.
    let trace = values.sum();
    let values = values / trace;
    let mut z = values.map(|value| 2.0 * value.ln());
    let mut now = moments(&mut z);
    for _ in 0..rounds {
        let residual = values - now.0;
        // Where a is none of rods, or nearly, a whole step would lead to exponents of millions.
        let step = slope(&now.1).lu().solve(&residual).unwrap_or_default().map(|step| step.clamp(-MOST, MOST));
        let mut part = 1.0;
        let mut next = (z + step, now);
        while part > 1e-3 {
            next.0 = z + step * part;
            next.1 = moments(&mut next.0);
            // Convergence is quadratic: after a small step the residual is below a rounding, and cannot fall any more.
            if step.amax() < 1e-8 || (values - next.1.0).norm() < residual.norm() {
                break;
            }
            part *= 0.5;
        }
        (z, now) = next;
        if step.amax() < 1e-8 {
            break;
        }
    }
    let (values, mixed) = (values * trace, now.1 * trace);
    // a_iiii by a_iikk = a_ii.
    let own = |i: usize| values[i] - mixed[(i + 1) % 3] - mixed[(i + 2) % 3];
    Fourth::in_axes(&axes, |i, j| if i == j { own(i) } else { mixed[3 - i - j] })
}

/// The largest step of an exponent.
const MOST: f64 = 20.0;

/// The distance of the nodes in ln s.
const STEP: f64 = 0.5;

/// The node s of a whole number; those within the exponents of tensors down to [`LEAST`] are computed once.
fn node(k: i32) -> f64 {
    const LAST: i32 = 256;
    fn at(k: i32) -> f64 {
        (STEP * f64::from(k)).exp()
    }
    static NODES: LazyLock<Vec<f64>> = LazyLock::new(|| (-LAST..=LAST).map(at).collect());
    NODES.get((k + LAST) as usize).copied().unwrap_or_else(|| at(k))
}

/// a_i, and a_2233, a_3311, a_1122, by the trapezoid rule in ln s with an error of e^(−2π²/h). Shifts `z` to sum to 0.
fn moments(z: &mut Vector3<f64>) -> (Vector3<f64>, Vector3<f64>) {
    z.add_scalar_mut(-z.mean());
    let b = z.map(|z| (-z).exp());
    let (from, to) = ((-z.max() - 40.0) / STEP, (-z.min() + 28.0) / STEP);
    let (mut second, mut mixed) = (Vector3::zeros(), Vector3::zeros());
    for k in from.floor() as i32..=to.ceil() as i32 {
        let s = node(k);
        let over = b.map(|b| 1.0 / (b + s));
        let weight = STEP * s * over.product().sqrt();
        second += over * (0.5 * weight);
        mixed += Vector3::new(over.y * over.z, over.z * over.x, over.x * over.y) * (0.25 * weight * s);
    }
    (second, mixed)
}

/// The matrix ∂a_i/∂z_j, made regular in the direction in which a does not change.
fn slope(mixed: &Vector3<f64>) -> Matrix3<f64> {
    Matrix3::from_fn(|i, j| if i == j { mixed[(i + 1) % 3] + mixed[(i + 2) % 3] + 1.0 } else { 1.0 - mixed[3 - i - j] })
}
