//! The steady distribution over orbits of rods with weak rotary diffusion in plane Couette flow.
//!
//! A free rod keeps its orbit constant C (eq. 13). Diffusion that is weak against the rotation, D_r → 0, changes C
//! slowly: averaged over an orbit, uniform in its phase τ, its drift is D_r B and its diffusivity D_r A with B = ⟨∇²C⟩
//! and A = ⟨|∇C|²⟩ on the sphere. The steady flux is 0: (A p)′ = B p (Leal & Hinch 1971, J. Fluid Mech. 46, 685). With
//! p ∝ (C cos τ, r C sin τ, 1), u = C² and s = r² + r⁻² the averages are polynomials in u, and
//!   p(C) ∝ C A^(−3/4) exp(−(3/32)(s − 2) ∫_u^∞ dv/A(v)),
//!   A = ½(1 + r⁻²) + (7/4 + s/8) u + ½(1 + r²) u².
//! For r → ∞: 4C/(4C² + 1)^(3/2).

use crate::closed_form::orbit_constant_density;
use crate::quadrature::integrate;

/// The density of C, not normalised.
fn weight(c: f64, aspect_ratio: f64) -> f64 {
    if aspect_ratio.is_infinite() {
        return 4.0 * c / (4.0 * c * c + 1.0).powf(1.5);
    }
    let (u, square) = (c * c, aspect_ratio * aspect_ratio);
    let s = square + square.recip();
    let [a0, a1, a2] = [0.5 * (1.0 + square.recip()), 1.75 + s / 8.0, 0.5 * (1.0 + square)];
    let a = a0 + u * (a1 + u * a2);
    // The discriminant a₁² − 4a₀a₂.
    let discriminant = (s - 2.0) * (s - 34.0) / 64.0;
    let (root, slope) = (discriminant.abs().sqrt(), 2.0 * a2 * u + a1);
    let rest = match root / slope {
        small if small < 1e-8 => 2.0 / slope,
        ratio if discriminant > 0.0 => 2.0 / root * ratio.atanh(),
        ratio => 2.0 / root * ratio.atan(),
    };
    c * a.powf(-0.75) * (-3.0 / 32.0 * (s - 2.0) * rest).exp()
}

/// ∫ f(C) p(C) dC over all orbits, for an aspect ratio r_e > 0 (∞: 4C/(4C² + 1)^(3/2)) and f bounded.
pub fn mean_over_orbits(aspect_ratio: f64, f: impl Fn(f64) -> f64) -> f64 {
    ratio(aspect_ratio, 1.0, f)
}

/// The share of rods with C/(1 + C) ≤ `c_b`.
pub fn cdf(c_b: f64, aspect_ratio: f64) -> f64 {
    ratio(aspect_ratio, c_b, |_| 1.0)
}

/// ∫ f p dC up to C/(1 + C) = `up_to`, over ∫ p dC.
fn ratio(aspect_ratio: f64, up_to: f64, f: impl Fn(f64) -> f64) -> f64 {
    let p = |c| weight(c, aspect_ratio);
    over_orbits(aspect_ratio, up_to, 1e-16, |c| f(c) * p(c)) / over_orbits(aspect_ratio, 1.0, 1e-16, p)
}

/// ∫ f dC up to C/(1 + C) = `up_to`, of a function that falls as C⁻².
pub(super) fn over_orbits(aspect_ratio: f64, up_to: f64, tolerance: f64, f: impl Fn(f64) -> f64) -> f64 {
    // Integrated over C_b; dC/dC_b = (1 − C_b)⁻² makes f finite at C_b = 1.
    let weighted = |c_b: f64| {
        let c = c_b / (1.0 - c_b).max(f64::EPSILON);
        f(c) * (1.0 + c).powi(2)
    };
    // Densities and means over orbits change most near C = 1 and C = 1/r.
    let knee = 1.0 / (1.0 + aspect_ratio);
    let mut breaks = vec![0.0, 0.1 * knee, knee, 0.5, 0.9, 1.0];
    breaks.sort_by(f64::total_cmp);
    breaks.retain(|at| *at < up_to);
    breaks.push(up_to);
    integrate(weighted, &breaks, tolerance)
}

/// a₁₁, a₂₂ and a₃₃ of rods in orbit C, uniform in phase.
pub fn second_moments_of_orbit(c: f64, aspect_ratio: f64) -> [f64; 3] {
    let (long, wide) = ((1.0 + c * c).sqrt(), (aspect_ratio * c).hypot(1.0));
    let sum = long + wide;
    [c * c / (long * sum), (aspect_ratio * c).powi(2) / (wide * sum), 1.0 / (long * wide)]
}

/// ⟨p₁²p₂²⟩ of rods in orbit C, uniform in phase: their σ₁₂ over μ_fiber G. With A = 1 + C² and B = 1 + r²C² it is r²C⁴
/// times ⟨cos²τ sin²τ/(A cos²τ + B sin²τ)²⟩, which is −∂²/∂A∂B of 2 ln(½(√A + √B)).
pub fn shear_stress_of_orbit(c: f64, aspect_ratio: f64) -> f64 {
    let (long, wide) = ((1.0 + c * c).sqrt(), (aspect_ratio * c).hypot(1.0));
    (aspect_ratio * c * c / (long + wide)).powi(2) / (2.0 * long * wide)
}

/// σ₁₂ over μ_fiber G of rods in the orbits of isotropic directions, uniform in phase: the mean over a period of
/// initially isotropic rods.
pub fn shear_stress_of_isotropic(aspect_ratio: f64) -> f64 {
    over_orbits(aspect_ratio, 1.0, 1e-14, |c| {
        orbit_constant_density(c, aspect_ratio) * shear_stress_of_orbit(c, aspect_ratio)
    })
}
