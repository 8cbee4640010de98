//! Free rods that were isotropic at t = 0: exact second and fourth moments of p in plane Couette flow.
//!
//! As in `isotropic`, p has the direction of a normal q = F p₀ with the covariance Σ = F Fᵀ. With
//! 1/|q|² = ∫ exp(−s|q|²) ds and 1/|q|⁴ = ∫ s exp(−s|q|²) ds the normal integrals are closed. With x = 2s and
//! M = (Σ⁻¹ + x)⁻¹
//!   ⟨p_i p_j⟩ = ½ ∫ det(1 + xΣ)^-½ M_ij dx,
//!   ⟨p_i p_j p_k p_l⟩ = ¼ ∫ x det(1 + xΣ)^-½ (M_ij M_kl + M_ik M_jl + M_il M_jk) dx.

use super::quadrature::integrate;
use std::f64::consts::TAU;

/// The covariance Σ of q at `turns` = t/T: its block of axes 1 and 2 as S₁₁, S₂₂, S₁₂ (det S = 1); S₃₃ = 1.
fn covariance(aspect_ratio: f64, turns: f64) -> [f64; 3] {
    let r = aspect_ratio;
    let (s, c) = (TAU * turns).sin_cos();
    // q₁ = p₁ c − p₂ s/r, q₂ = r p₁ s + p₂ c.
    [c * c + (s / r).powi(2), c * c + (r * s).powi(2), s * c * (r - 1.0 / r)]
}

/// ⟨p_i p_j p_k p_l⟩ at `turns` = t/T of rods of one aspect ratio r_e > 0; indices 0, 1 and 2 for the axes 1, 2 and 3.
pub fn fourth(aspect_ratio: f64, turns: f64, indices: [usize; 4]) -> f64 {
    let sigma = covariance(aspect_ratio, turns);
    let [i, j, k, l] = indices;
    over_x(|x| {
        let (root, m) = (root(sigma, x), inverse(sigma, x));
        0.25 * x / root * (m[i][j] * m[k][l] + m[i][k] * m[j][l] + m[i][l] * m[j][k])
    })
}

/// ⟨p_i p_j⟩ at `turns` = t/T of rods of one aspect ratio r_e > 0.
pub fn second(aspect_ratio: f64, turns: f64, [i, j]: [usize; 2]) -> f64 {
    let sigma = covariance(aspect_ratio, turns);
    over_x(|x| 0.5 / root(sigma, x) * inverse(sigma, x)[i][j])
}

/// det(1 + xΣ)^½.
fn root([s11, s22, _]: [f64; 3], x: f64) -> f64 {
    ((1.0 + x * (s11 + s22) + x * x) * (1.0 + x)).sqrt()
}

/// (Σ⁻¹ + x)⁻¹ = (S + x)/(1 + x tr S + x²) in axes 1 and 2, for det S = 1; 1/(1 + x) in axis 3.
fn inverse([s11, s22, s12]: [f64; 3], x: f64) -> [[f64; 3]; 3] {
    let det = 1.0 + x * (s11 + s22) + x * x;
    let off = s12 / det;
    [[(s11 + x) / det, off, 0.0], [off, (s22 + x) / det, 0.0], [0.0, 0.0, 1.0 / (1.0 + x)]]
}

/// ∫₀^∞ f dx with x = (y/(1 − y))²; f falls as x^-5/2, so the integrand in y falls as (1 − y)².
fn over_x(f: impl Fn(f64) -> f64) -> f64 {
    let mapped = |y: f64| match y {
        y if y >= 1.0 => 0.0,
        y => {
            let x = (y / (1.0 - y)).powi(2);
            f(x) * 2.0 * y / (1.0 - y).powi(3)
        }
    };
    let ends = [0.0, 0.5, 0.9, 0.99, 1.0];
    integrate(mapped, &ends, 1e-15)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reference::big::{Bits, double};
    use crate::reference::isotropic::{Covariance, PAIRS, QUADRUPLES};
    use crate::reference::motion::{Motion, Unit};

    /// The integrals in many digits, from the covariance of any flow.
    #[test]
    fn moments_are_those_of_many_digits() {
        for (r, turns) in [(0.2, 0.0), (1.0, 0.4), (3.0, 0.17), (11.6, 0.0), (11.6, 0.1), (11.6, 0.25), (11.6, 0.4)] {
            let motion = Motion { gradient_per_s: [[0.0; 3], [1.0, 0.0, 0.0], [0.0; 3]], aspect_ratio: r };
            let exact = Covariance::at(&motion, &Bits(64).of(turns), Unit::Period).unwrap();
            for (due, (i, j)) in exact.second().iter().zip(PAIRS) {
                assert!((second(r, turns, [i, j]) - double(due)).abs() < 1e-12, "{r} {turns} {i}{j}");
            }
            for (due, q) in exact.fourth().iter().zip(QUADRUPLES) {
                assert!((fourth(r, turns, q.map(|i| i - 1)) - double(due)).abs() < 1e-12, "{r} {turns} {q:?}");
            }
        }
        assert!((fourth(3.0, 0.17, [0, 0, 1, 1]) - fourth(3.0, 0.18, [0, 0, 1, 1])).abs() > 1e-3);
    }
}
