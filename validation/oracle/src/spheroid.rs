//! The stress of dilute spheroids of any aspect ratio r without Brownian motion, after Jeffery (1922):
//!   σ = 2μφ [A ⟨pppp⟩:D + B (⟨pp⟩·D + D·⟨pp⟩) + C D] + isotropic (Leal & Hinch 1971; Hinch & Leal 1972),
//! with φ their volume fraction. A, B and C come from the stress in three strains: along p k_X, across p and in its
//! plane k_Y, with the spheroid free to turn, and in the plane normal to p k_Z. Each is one of Jeffery's integrals over
//! λ, here over u = r/(r² + λ)^½:
//!   k_X = 2/(3rβ₀″), k_Y = 2/(r(r² + 1)β₀′), k_Z = 1/(rα₀′).

use crate::quadrature::integrate;
use std::f64::consts::PI;

/// A, B and C of a spheroid of length over width r, 1e-4 ≤ r ≤ 1e5. A sphere has 0, 0 and 5/2.
pub fn stress_coefficients(r: f64) -> [f64; 3] {
    let [beta1, beta2, alpha1] = integrals(r);
    let (k_x, k_y, k_z) = (2.0 / (3.0 * r * beta2), 2.0 / (r * (r * r + 1.0) * beta1), 1.0 / (r * alpha1));
    [1.5 * k_x - 2.0 * k_y + 0.5 * k_z, k_y - k_z, k_z]
}

/// Jeffery's β₀′, β₀″ and α₀′ for semi-axes r, 1, 1.
fn integrals(r: f64) -> [f64; 3] {
    let square = r * r;
    let over_u = |scale: f64, f: &dyn Fn(f64, f64) -> f64| {
        // 1 − u² is computed from 1 − u; there is a peak of width r² at 0 or r⁻² at 1.
        let by_rest = |x: f64| {
            let u = 1.0 - x;
            f(u, x * (1.0 + u))
        };
        let mut breaks = vec![0.0, 0.01, 0.1, 0.5, 1.0, 1.0 - r.min(0.9), 1.0 - (0.1 * r).min(0.9)];
        breaks.extend([1.0, 10.0, 100.0].map(|k| (k / square).min(1.0)));
        breaks.sort_by(f64::total_cmp);
        // A first integral without refinement gives the size, to which the tolerance is relative.
        let size = integrate(by_rest, &breaks, f64::INFINITY);
        scale * integrate(by_rest, &breaks, 1e-14 * size)
    };
    // u² + r²(1 − u²).
    let q = |u: f64, rest: f64| u * u + square * rest;
    [
        over_u(2.0 / r, &|u, rest| u.powi(4) / q(u, rest).powi(2)),
        over_u(2.0 * r, &|u, rest| u * u * rest / q(u, rest).powi(2)),
        over_u(2.0 * r, &|u, rest| u.powi(4) / q(u, rest).powi(3)),
    ]
}

/// The coefficients of [`stress_coefficients`] for σ/(μ n a³), with n spheroids of length a per volume.
pub fn by_number(r: f64) -> [f64; 3] {
    // 2φ/(na³), with φ = πna³/(6r²).
    stress_coefficients(r).map(|k| PI / (3.0 * r * r) * k)
}

/// Like `by_number`, for blunt cylinders of length over diameter r: along them π/(6 ln 2r) of a slender body times
/// Batchelor's series in 1/ln 2r (1970b, as quoted by others); across them 4φD of an infinite cylinder, with φ =
/// πna³/(4r²).
pub fn of_cylinder(r: f64) -> [f64; 3] {
    let log = r.ln() + 2f64.ln();
    let series = (log + 0.64) / (log - 1.5) + 1.659 / (log * log);
    [series * 2.0 * PI / log / 12.0, 0.0, 4.0 * PI / (4.0 * r * r)]
}

/// σ₁₂/(μG n a³) of spheroids of length a and aspect ratio r in plane Couette flow, from ⟨p₁²p₂²⟩ and ⟨p₁²⟩ + ⟨p₂²⟩.
pub fn shear_stress(r: f64, sheared: f64, in_plane: f64) -> f64 {
    let [a, b, c] = by_number(r);
    a * sheared + 0.5 * (b * in_plane + c)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The largest difference, relative to the larger of 1 and the value.
    fn off(found: [f64; 3], expected: [f64; 3]) -> f64 {
        crate::worst((0..3).map(|k| (found[k] - expected[k]).abs() / expected[k].abs().max(1.0)))
    }

    #[test]
    fn a_sphere_is_einsteins() {
        assert!(off(stress_coefficients(1.0), [0.0, 0.0, 2.5]) < 1e-12);
        // φ = πna³/6, and no direction matters.
        assert!((shear_stress(1.0, 0.1, 0.9) - 2.5 * PI / 6.0).abs() < 1e-12);
    }

    /// The series for r = 1 + ε. Some quote ε²/3 in C; the integrals have 47/147 ε².
    #[test]
    fn near_a_sphere_it_is_the_series() {
        let series = |e: f64| {
            [
                395.0 / 147.0 * e * e,
                15.0 / 14.0 * e - 895.0 / 588.0 * e * e,
                2.5 * (1.0 - 2.0 / 7.0 * e + 47.0 / 147.0 * e * e),
            ]
        };
        for e in [-0.002, 0.002] {
            let found = stress_coefficients(1.0 + e);
            assert!(off(found, series(e)) < 5e-8, "{e}: {found:?} {:?}", series(e));
            assert!(off(found, series(1.1 * e)) > 1e-5);
        }
    }

    /// The limit r → ∞: A = r²/(2(ln 2r − 3/2)), B = (6 ln 2r − 11)/r², C = 2.
    #[test]
    fn slender_rods_have_the_published_limit() {
        for r in [1e3f64, 1e4] {
            let [a, b, c] = stress_coefficients(r);
            let log = (2.0 * r).ln();
            let slender = |constant: f64| r * r / (2.0 * (log - constant));
            assert!((a / slender(1.5) - 1.0).abs() < 1e-4, "{r}: {a}");
            assert!((a / slender(0.5) - 1.0).abs() > 0.05, "the constant 3/2 is seen");
            assert!((c - 2.0).abs() < 1e-4 && (b * r * r - (6.0 * log - 11.0)).abs() < 0.1, "{r}: {b} {c}");
        }
    }

    /// The limit r → 0: A = 10/(3πr) + 208/(9π²) − 2, B = −8/(3πr) + 1 − 128/(9π²), C = 8/(3πr).
    #[test]
    fn thin_discs_have_the_published_limit() {
        let r = 1e-3;
        let inverse = 1.0 / (3.0 * PI * r);
        let nine = 9.0 * PI * PI;
        let [a, b, c] = stress_coefficients(r);
        assert!((a - (10.0 * inverse + 208.0 / nine - 2.0)).abs() < 0.02, "{a}");
        assert!((b - (-8.0 * inverse + 1.0 - 128.0 / nine)).abs() < 0.02, "{b}");
        assert!((c / (8.0 * inverse) - 1.0).abs() < 2e-3, "{c}");
    }
}
