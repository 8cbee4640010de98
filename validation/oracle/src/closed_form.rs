//! Closed forms for one free rod in plane Couette flow (Jeffery 1922; equation numbers of Lee & Springer 1982).
//!
//! u₂ = G x₁, p = (sin θ cos φ, sin θ sin φ, cos θ), r_e > 0 the aspect ratio, ω = 2π/T. Time is in turns t/T,
//! angles in radians. Nothing here is integrated numerically, and nothing is shared with the simulator.

use ellip::{cel, ellipe, elliprf};
use std::f64::consts::{FRAC_2_PI, FRAC_PI_2, FRAC_PI_4, PI, TAU};

/// The period of rotation T in seconds, eq. 15: T = (2π/G)(r_e + 1/r_e), with G in 1/s.
pub fn period_s(shear_rate_per_s: f64, aspect_ratio: f64) -> f64 {
    TAU / shear_rate_per_s * (aspect_ratio + aspect_ratio.recip())
}

/// The angles (φ, θ) of a free rod `turns` periods after (φ₀, θ₀), by A.4 and A.5, for any real φ₀ and time.
///
/// A.4 with its initial phase: tan φ = r_e tan(2πt/T + κ), tan φ₀ = r_e tan κ; φ and 2πt/T + κ agree at all multiples
/// of π/2, which fixes the branch: φ is continuous, increasing and unbounded. A.5: tan θ ∝ (r_e² cos²φ + sin²φ)^{-1/2};
/// θ stays in [0, π] and in its hemisphere.
/// Measured against p = q/|q| with the same start: 2e-15 max(r_e, 1/r_e), the conditioning of A.4.
pub fn angles_at(phi0: f64, theta0: f64, aspect_ratio: f64, turns: f64) -> (f64, f64) {
    let whole = turns.round();
    let kappa = stretch(phi0, aspect_ratio.recip());
    let phi = stretch(kappa + TAU * (turns - whole), aspect_ratio);
    let width = |phi: f64| (aspect_ratio * phi.cos()).hypot(phi.sin());
    let theta = (theta0.sin() * width(phi0)).atan2(theta0.cos() * width(phi));
    (phi + TAU * whole, theta)
}

/// The angle y with tan y = k tan x on the branch where y = x at all multiples of π/2.
fn stretch(x: f64, k: f64) -> f64 {
    let centre = PI * (x / PI).round();
    let (s, c) = (x - centre).sin_cos();
    centre + (k * s).atan2(c)
}

/// The orbit constant C ≥ 0 of eq. 13; the sign of tan θ is dropped, because p and −p are the same rod.
///
/// θ = π/2 gives about 1e16, not ∞: π/2 is no floating-point number.
pub fn orbit_constant_from_angles(phi: f64, theta: f64, aspect_ratio: f64) -> f64 {
    theta.tan().abs() * phi.cos().hypot(phi.sin() / aspect_ratio)
}

/// ⟨φ⟩ of eq. 19 in radians, for r_e > 0: π/4 + (2/π) χ₂((r_e − 1)/(r_e + 1)), χ₂(x) = Σ x^{2k+1}/(2k+1)².
///
/// Eq. 19 has d⟨φ⟩/dr_e = (2/π) ln r_e/(r_e² − 1) and ⟨φ⟩(1) = π/4; χ₂' = artanh(x)/x gives the same. Legendre's
/// χ₂ is the odd part of the dilogarithm. Beyond |x| = √2 − 1, χ₂(x) + χ₂(1/r_e) = π²/8 − ln r_e artanh(1/r_e)
/// (Lewin, Polylogarithms, 1.67) keeps the series short. Measured against 40 digits for 1e-4 ≤ r_e ≤ 1e8: 4e-16
/// relative.
pub fn mean_angle(aspect_ratio: f64) -> f64 {
    let tail = |k: f64| FRAC_2_PI * (legendre_chi_2(k) - k.ln() * k.atanh());
    let x = (aspect_ratio - 1.0) / (aspect_ratio + 1.0);
    if x.abs() <= 0.42 {
        FRAC_PI_4 + FRAC_2_PI * legendre_chi_2(x)
    } else if x > 0.0 {
        FRAC_PI_2 - tail(aspect_ratio.recip())
    } else {
        tail(aspect_ratio)
    }
}

/// χ₂(x) for |x| ≤ 0.42 by its series: the first term left out is below 1e-16 of the sum.
fn legendre_chi_2(x: f64) -> f64 {
    let term = |k: i32| x.powi(2 * k + 1) / f64::from((2 * k + 1).pow(2));
    (0..20).rev().map(term).sum()
}

/// Means over a period of |p₁|, |p₂|, |p₃| (1) of a free rod in orbit C, for 0 ≤ C ≤ ∞ and r_e > 0.
///
/// From φ = 0 the rod is p ∝ (sin β cos ωt, r_e sin β sin ωt, cos β), tan β = C. With s² = r_e² − 1 the quarter-period
/// integrals in sin ωt, cos ωt and ωt give asinh(s sin β)/s, (r_e/s) atan(s sin β) and cos β R_F(0, 1, 1 + s² sin²β),
/// times 2/π; for r_e < 1, s is imaginary. Measured against 40 digits for 1e-4 ≤ r_e ≤ 1e8: 6e-16 relative.
pub fn phase_means(orbit_constant: f64, aspect_ratio: f64) -> [f64; 3] {
    let r = aspect_ratio;
    let sin_beta = orbit_constant.recip().hypot(1.0).recip();
    let cos_beta = orbit_constant.hypot(1.0).recip();
    // |q|² at ωt = π/2, relative to 1 at ωt = 0.
    let far = cos_beta * cos_beta + (r * sin_beta).powi(2);
    let s = ((r - 1.0) * (r + 1.0)).abs().sqrt();
    let x = s * sin_beta;
    let (first, second) = if x == 0.0 {
        (sin_beta, sin_beta)
    } else if r > 1.0 {
        (x.asinh() / s, x.atan() / s)
    } else {
        (x.atan2(far.sqrt()) / s, (x / far.sqrt()).asinh() / s)
    };
    let third = cos_beta * elliprf(0.0, 1.0, far).expect("far > 0");
    [first, r * second, third].map(|mean| FRAC_2_PI * mean)
}

/// The probability density (1) of the orbit constant C of isotropic rods, for 0 ≤ C ≤ 1e150 and r_e > 0.
///
/// y = (p₁, p₂/r_e, p₃) has C = tan β with β its angle from axis 3, and the directions of y have the density
/// (r_e/4π)(y₁² + r_e² y₂² + y₃²)^{-3/2}, |y| = 1. Its integral round axis 3 is
/// f(C) = (2r_e/π) C E(m)/((1 + C²)^{1/2}(1 + r_e²C²)), m = (1 − r_e²)C²/(1 + C²) (parameter, not modulus).
/// At r_e = 1: C/(1 + C²)^{3/2}. Measured against 40 digits for 1e-4 ≤ r_e ≤ 1e8: 2e-15 relative.
pub fn orbit_constant_density(orbit_constant: f64, aspect_ratio: f64) -> f64 {
    let (c, r) = (orbit_constant, aspect_ratio);
    let cos_squared = (1.0 + c * c).recip();
    // m → 1 only for thin discs, and E is flat there.
    let m = (1.0 - r) * (1.0 + r) * c * c * cos_squared;
    let e = ellipe(m).expect("m < 1");
    FRAC_2_PI * r * c * e * cos_squared.sqrt() / (1.0 + (r * c).powi(2))
}

/// The probability (1) that an isotropic rod's C/(1 + C) is below `c_b`, for 0 ≤ c_b ≤ 1 and r_e > 0.
///
/// C > c where |tan θ| > c/h with h² = cos²φ + sin²φ/r_e², so P(C > c) is the mean over φ of h/(h² + c²)^{1/2}. With
/// tan φ = A tan χ this is (2/π)(k² + c²)^{-1/2} cel(κ, A², 1, κ²), k = 1/r_e, A² = (1 + c²)/(k² + c²), κ = kA
/// (Bulirsch's complete elliptic integral), here with c = c_b/(1 − c_b). Measured: 6e-16 absolute, 1e-4 ≤ r_e ≤ 1e8.
pub fn orbit_constant_cdf(c_b: f64, aspect_ratio: f64) -> f64 {
    if c_b <= 0.0 {
        return 0.0;
    }
    let k = aspect_ratio.recip();
    let rest = 1.0 - c_b;
    let scale = (k * rest).hypot(c_b);
    let a = rest.hypot(c_b) / scale;
    let kappa = k * a;
    let integral = cel(kappa, a * a, 1.0, kappa * kappa).expect("κ and A are positive");
    1.0 - FRAC_2_PI * rest / scale * integral
}

#[cfg(test)]
mod tests {
    use super::super::jeffery::angle_rates_per_s;
    use super::super::quadrature::{integrate, spread};
    use super::*;

    /// True if r_e is far enough from 1 for a wrong use of r_e to show.
    fn is_rod_or_disc(aspect_ratio: f64) -> bool {
        aspect_ratio.ln().abs() > 0.1
    }

    #[test]
    fn period_is_the_time_of_one_turn_by_a_2() {
        for (u, v) in spread(30) {
            let (r, g) = (100f64.powf(2.0 * u - 1.0), 0.1 + v);
            let knee = r.atan();
            let breaks = [-FRAC_PI_2, -knee, 0.0, knee, FRAC_PI_2];
            let half = integrate(|phi| 1.0 / (g * angle_rates_per_s(1.0, r, phi, 1.0).0), &breaks, 1e-12);
            let ratio = 2.0 * half / period_s(g, r);
            assert!((ratio - 1.0).abs() < 1e-13, "{r} {ratio}");
            // Wrong variant: r_e alone for r_e + 1/r_e.
            assert!((ratio * period_s(g, r) * g / (TAU * r) - 1.0).abs() > 1e-5);
        }
    }

    #[test]
    fn angles_are_those_of_the_linear_form() {
        let mut caught = 0;
        for (i, (u, v)) in spread(300).enumerate() {
            let r = 1e3f64.powf(2.0 * u - 1.0);
            let (phi0, theta0) = (20.0 * (v - 0.5), PI * (7.0 * u + 3.0 * v).fract());
            let turns = 4.0 * (i as f64 / 300.0 - 0.5);
            let p = [theta0.sin() * phi0.cos(), theta0.sin() * phi0.sin(), theta0.cos()];
            let (s, c) = (TAU * turns).sin_cos();
            let q = [p[0] * c - p[1] / r * s, r * p[0] * s + p[1] * c, p[2]];
            let length = q[0].hypot(q[1]).hypot(q[2]);
            let apart = |(phi, theta): (f64, f64)| {
                let p = [theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos()];
                crate::worst((0..3).map(|i| (p[i] - q[i] / length).abs()))
            };
            let (phi, theta) = angles_at(phi0, theta0, r, turns);
            // Conditioning: the round-off of ωt is stretched by r_e or 1/r_e.
            let tolerance = 5e-15 * r.max(1.0 / r);
            assert!(apart((phi, theta)) < tolerance, "{r} {phi0} {theta0} {turns}");
            // The branch: φ and phase agree to within a quarter turn, so φ − φ₀ is right to within half a turn.
            assert!((phi - phi0 - TAU * turns).abs() < PI);
            assert!((0.0..=PI).contains(&theta) && (theta > FRAC_PI_2) == (theta0 > FRAC_PI_2));
            // Wrong variant: A.4 without the initial phase, φ − φ₀ = atan(r_e tan ωt).
            let wrong = apart((phi0 + stretch(TAU * turns, r), theta));
            caught += usize::from(wrong > tolerance);
        }
        // A few slender rods lie along the flow before and after, where the phase is invisible.
        assert!(caught > 285, "{caught}");
    }

    #[test]
    fn phase_means_have_their_limits() {
        for r in [0.2, 1.0, 1.0 + 1e-15, 11.6] {
            assert_eq!(phase_means(0.0, r), [0.0, 0.0, FRAC_2_PI * FRAC_PI_2]);
            let (plane, near) = (phase_means(f64::INFINITY, r), phase_means(1e17, r));
            assert!((0..3).all(|i| (plane[i] - near[i]).abs() < 1e-15));
        }
        // A sphere turns uniformly: its means are sin β · 2/π twice, and cos β.
        let sphere = phase_means(0.75, 1.0);
        let exact = [0.6 * FRAC_2_PI, 0.6 * FRAC_2_PI, 0.8];
        assert!((0..3).all(|i| (sphere[i] - exact[i]).abs() < 2e-16));
    }

    #[test]
    fn orbit_constants_are_distributed_as_those_of_isotropic_rods() {
        for (u, v) in spread(100) {
            let (r, c_b) = (20f64.powf(2.0 * u - 1.0), v);
            let c = c_b / (1.0 - c_b);
            // At fixed φ: P(C > c) = h/(h² + c²)^½. The trapezoid rule in φ converges geometrically here.
            let n = 4000;
            let (mut above, mut density) = (0.0, 0.0);
            for k in 0..n {
                let (s, co) = (PI * f64::from(k) / f64::from(n)).sin_cos();
                let h = co.hypot(s / r);
                above += h / h.hypot(c) / f64::from(n);
                density += c * h / h.hypot(c).powi(3) / f64::from(n);
            }
            assert!((orbit_constant_cdf(c_b, r) - (1.0 - above)).abs() < 1e-13);
            assert!((orbit_constant_density(c, r) / density - 1.0).abs() < 1e-12, "{r} {c}");
            // Wrong variants: the distribution of a sphere's orbits, and C for C/(1 + C).
            let of_sphere = 1.0 - 1.0 / c.hypot(1.0);
            assert!(!is_rod_or_disc(r) || (of_sphere - (1.0 - above)).abs() > 1e-7);
            assert!((orbit_constant_cdf(0.5 * c_b, r) - (1.0 - above)).abs() > 1e-7);
            let of_sphere = c / (1.0 + c * c).powf(1.5);
            assert!(!is_rod_or_disc(r) || (of_sphere / density - 1.0).abs() > 1e-3);
        }
        assert_eq!((orbit_constant_cdf(0.0, 9.0), orbit_constant_cdf(1.0, 9.0)), (0.0, 1.0));
    }
}
