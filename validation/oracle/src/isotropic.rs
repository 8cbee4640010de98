//! Free rods that were isotropic at t = 0: exact mean projections on the axes in plane Couette flow.
//!
//! An infinite suspension, no interaction. Axes and symbols as in `closed_form`; time in turns t/T; means of |p_i| (1).

use super::closed_form::{orbit_constant_density, phase_means};
use super::quadrature::integrate;
use ellip::elliprj;
use statrs::distribution::{Continuous, ContinuousCDF, Normal};
use std::f64::consts::{PI, TAU};

/// Means of |p₁|, |p₂|, |p₃| at `turns` = t/T, for rods of one aspect ratio r_e > 0 that were isotropic at t = 0.
///
/// An isotropic p₀ may be read as a normal vector's direction, so p has the direction of a normal q = F p₀ with the
/// covariance Σ = F Fᵀ. With 1/|q| = (2/√π) ∫ exp(−u²|q|²) du the normal integrals are closed, and with x = 2u²
///   X₁ = (1/π) ∫₀^∞ (S₁₁ + x)^{1/2} [x(1 + x)]^{-1/2} [(x + λ)(x + 1/λ)]^{-1} dx,   X₂ with S₂₂,
///   X₃ = (1/π) ∫₀^∞ [x(x + λ)(x + 1/λ)]^{-1/2} (1 + x)^{-1} dx,
/// S the block of Σ in axes 1 and 2 (det S = 1), λ ≥ 1 and 1/λ its eigenvalues. Partial fractions give Carlson's R_J.
/// Measured against 40 digits for 1e-4 ≤ r_e ≤ 1e8 at any time: 2e-15 relative.
pub fn mean_projections(aspect_ratio: f64, turns: f64) -> [f64; 3] {
    let r = aspect_ratio;
    if r < 1.0 {
        // A disc of r_e moves as a rod of 1/r_e with axes 1 and 2 exchanged and time reversed.
        let [first, second, third] = mean_projections(r.recip(), turns);
        return [second, first, third];
    }
    // Only |sin ωt| and |cos ωt| matter. Whole quarter turns are removed first, so that a small rest keeps its digits.
    let quarters = (4.0 * turns).round();
    let (near, far) = (TAU * (turns - 0.25 * quarters)).sin_cos();
    let (s, c) = if quarters % 2.0 == 0.0 { (near.abs(), far) } else { (far, near.abs()) };
    // λ^½ − λ^-½ = |sin ωt|(r − 1/r): no cancellation when λ → 1.
    let half_gap = 0.5 * s * (r - r.recip());
    let lambda = (half_gap + half_gap.hypot(1.0)).powi(2);
    let (s_11, s_22) = (c * c + (s / r).powi(2), c * c + (r * s).powi(2));
    // The minor axis of S is at β from axis 1, tan 2β = 2|cos ωt|/(|sin ωt|(r + 1/r)), 0 ≤ β ≤ π/4: S₁₁ = λ sin²β +
    // cos²β/λ.
    let (x, y) = (s * (r + r.recip()), 2.0 * c);
    let h = x.hypot(y);
    let (sin_squared, cos_squared) = (0.5 * y * y / (h * (h + x)), 0.5 * (1.0 + x / h));
    let r_j = |b: f64, c: f64, p: f64| elliprj(0.0, b, c, p).expect("positive arguments");
    let small = lambda.recip();
    [
        sin_squared * r_j(1.0, s_11, small) + cos_squared * r_j(1.0, s_11, lambda),
        cos_squared * r_j(1.0, s_22, small) + sin_squared * r_j(1.0, s_22, lambda),
        r_j(small, lambda, 1.0),
    ]
    .map(|sum| sum * 2.0 / (3.0 * PI))
}

/// Means of |p₁|, |p₂|, |p₃| of rods whose aspect ratio is Gaussian (eq. 11), isotropic at t = 0.
///
/// `turns_of_mean_period` = t/T(mean); a rod of aspect ratio r has made t/T(r) turns.
/// Measured against a fine trapezoid rule: 2e-12 for means up to 1000, deviations up to 10 % and 30 turns.
pub fn mean_projections_polydisperse(mean_aspect_ratio: f64, sd_percent: f64, turns_of_mean_period: f64) -> [f64; 3] {
    if sd_percent == 0.0 {
        return mean_projections(mean_aspect_ratio, turns_of_mean_period);
    }
    mean_over_aspect_ratios(mean_aspect_ratio, sd_percent, turns_of_mean_period, mean_projections)
}

/// The mean of `f(r, t/T(r))` over aspect ratios r, Gaussian with a standard deviation above 0.
///
/// The Gaussian is cut at ±8 standard deviations and at r = 0, and normalised over the rest; below a deviation of 12.5
/// % the loss is nothing (< 1e-14). Panels end where rods have made a whole number of half turns, because X₁ has its
/// peaks there.
pub fn mean_over_aspect_ratios<const N: usize>(
    mean_aspect_ratio: f64,
    sd_percent: f64,
    turns_of_mean_period: f64,
    f: impl Fn(f64, f64) -> [f64; N],
) -> [f64; N] {
    let turns_at = |r: f64| turns_of_mean_period * (mean_aspect_ratio + mean_aspect_ratio.recip()) / (r + r.recip());
    let sd = 0.01 * sd_percent * mean_aspect_ratio;
    // Deviations from the mean in units of sd: a difference of two r would have no digits where sd is as small as their
    // rounding.
    let gaussian = Normal::standard();
    let (low, high) = ((-mean_aspect_ratio / sd).max(-8.0), 8.0);

    let mut breaks = vec![low, high];
    breaks.extend((-6..=6).step_by(2).map(f64::from));
    // 2 t/T(r) = k, the two roots of r + 1/r = y; T is shortest at r = 1.
    let half_turns_at_1 = 2.0 * turns_at(1.0).abs();
    for k in 1..=half_turns_at_1 as u32 {
        let y = 2.0 * half_turns_at_1 / f64::from(k);
        let root = 0.5 * (y + (y * y - 4.0).max(0.0).sqrt());
        breaks.extend([root, root.recip()].map(|r| (r - mean_aspect_ratio) / sd));
    }
    breaks.retain(|z| (low..=high).contains(z));
    breaks.sort_by(f64::total_cmp);

    let mass = gaussian.cdf(high) - gaussian.cdf(low);
    std::array::from_fn(|axis| {
        // The rule evaluates its end points; one of them is r = 0 if the Gaussian is cut there.
        let weighted = |z: f64| {
            let r = (mean_aspect_ratio + z * sd).max(1e-12);
            gaussian.pdf(z) * f(r, turns_at(r))[axis]
        };
        integrate(weighted, &breaks, 1e-11) / mass
    })
}

/// The long-time plateau: means of |p₁|, |p₂|, |p₃| when the phases are mixed, for one aspect ratio r_e > 0.
///
/// A free rod keeps its orbit constant, so isotropic rods keep their distribution of C whatever their phases become:
/// ∫ f(C) ⟨|p_i|⟩_C dC. In ln C the integrand is smooth and falls off as C² and 1/C.
/// It is also the mean over time of `mean_projections`. Measured against that: 3e-15 relative for 1e-3 ≤ r_e ≤ 1e4.
pub fn plateau_projections(aspect_ratio: f64) -> [f64; 3] {
    // C lies between 1 and 1/r_e where p₁ and p₂ are comparable with p₃.
    let knee = -aspect_ratio.ln();
    let (low, high) = (knee.min(0.0), knee.max(0.0));
    let breaks = [low - 20.0, low - 5.0, low, high, high + 5.0, high + 38.0];
    [0, 1, 2].map(|axis| {
        let weighted = |ln_c: f64| {
            let c = ln_c.exp();
            c * orbit_constant_density(c, aspect_ratio) * phase_means(c, aspect_ratio)[axis]
        };
        integrate(weighted, &breaks, 1e-16)
    })
}

#[cfg(test)]
mod tests {
    use super::super::quadrature::spread;
    use super::*;

    fn most_apart(a: [f64; 3], b: [f64; 3]) -> f64 {
        crate::worst((0..3).map(|i| (a[i] - b[i]).abs()))
    }

    fn largest_ratio_error(a: [f64; 3], b: [f64; 3]) -> f64 {
        crate::worst((0..3).map(|i| (a[i] / b[i] - 1.0).abs()))
    }

    /// Deviations down to those that no double shows: at the start every mean is 1/2, later that of the mean rod.
    #[test]
    fn tiny_deviations_are_no_deviations() {
        for sd_percent in [1e-300, 1e-15, 1e-14, 1e-11, 1e-6] {
            for r in [0.02, 11.6, 100.0] {
                let start = mean_projections_polydisperse(r, sd_percent, 0.0);
                assert!(most_apart(start, [0.5; 3]) < 1e-11, "{r} {sd_percent}: {start:?}");
                let apart = most_apart(mean_projections_polydisperse(r, sd_percent, 0.3), mean_projections(r, 0.3));
                assert!(apart < 1e-11, "{r} {sd_percent}: {apart}");
            }
        }
        // Deviations that reach r = 0 are cut there, and the means stay normalised; at t = 0 nothing else can show.
        for (r, sd_percent, within) in [(1.5, 5.0, 1e-13), (21.5, 5.0, 1e-13), (1.5, 30.0, 1e-11), (21.5, 30.0, 1e-11)]
        {
            assert!(most_apart(mean_projections_polydisperse(r, sd_percent, 0.0), [0.5; 3]) < within);
        }
    }

    #[test]
    fn mean_projections_have_their_known_limits_and_symmetries() {
        for (u, v) in spread(200) {
            let (r, turns) = (1e8f64.powf(2.0 * u - 1.0), 6.0 * (v - 0.5));
            let now = mean_projections(r, turns);
            assert!(most_apart(mean_projections(1.0, turns), [0.5; 3]) < 1e-15);
            // At whole half turns the suspension is isotropic again, exactly.
            assert!(most_apart(mean_projections(r, 1.5), [0.5; 3]) < 1e-15);
            assert_eq!(now, mean_projections(r, -turns));
            // |p₁| + |p₂| + |p₃| lies between 1 and √3.
            let sum: f64 = now.iter().sum();
            assert!((1.0..3f64.sqrt()).contains(&sum), "{r} {turns} {sum}");
            // r_e → 1: continuous through the exchange of axes.
            let near = [1.0 - 1e-9, 1.0 + 1e-9].map(|r| mean_projections(r, turns));
            assert!(most_apart(near[0], near[1]) < 2e-9 && most_apart(near[0], [0.5; 3]) < 2e-9);
        }
    }

    #[test]
    fn polydisperse_means_agree_with_a_fine_trapezoid_rule() {
        for (u, v) in spread(12) {
            let (mean, sd_percent, turns) = (3.0 + 20.0 * u, 1.0 + 9.0 * v, 6.0 * (u + v).fract());
            let (sd, n) = (0.01 * sd_percent * mean, 8000);
            let trapezoid = |common_period: bool| {
                let mut sum = [0.0; 3];
                for k in -n..=n {
                    let x = 8.0 * f64::from(k) / f64::from(n);
                    let r = mean + sd * x;
                    let period_ratio = (mean + 1.0 / mean) / (r + 1.0 / r);
                    let own = if common_period { turns } else { turns * period_ratio };
                    let weight = (-0.5 * x * x).exp() / TAU.sqrt() * 8.0 / f64::from(n);
                    let means = mean_projections(r, own);
                    (0..3).for_each(|i| sum[i] += weight * means[i]);
                }
                sum
            };
            let exact = mean_projections_polydisperse(mean, sd_percent, turns);
            // Both rules converge geometrically; the tolerance per panel is 1e-11.
            let error = most_apart(exact, trapezoid(false));
            assert!(error < 1e-10, "{mean} {sd_percent} {turns} {error:e}");
            // Wrong variant: all rods with the period of the mean rod.
            assert!(most_apart(exact, trapezoid(true)) > 1e-6, "{mean} {sd_percent} {turns}");
        }
    }

    #[test]
    fn plateau_is_the_mean_over_time() {
        for (u, _) in spread(30) {
            let r = 1e4f64.powf(1.75 * u - 0.75);
            let knee = r.max(1.0 / r).recip() / TAU;
            let quarter = |i: usize| integrate(|t| mean_projections(r, t)[i], &[0.0, knee, 0.25], 1e-15);
            let (plateau, over_time) = (plateau_projections(r), [0, 1, 2].map(|i| 4.0 * quarter(i)));
            // The tolerance is the round-off of about ten panels on either side.
            let error = largest_ratio_error(plateau, over_time);
            assert!(error < 1e-14, "{r} {error:e}");
            // Wrong variant: all rods in a single orbit with mixed phases, the median one of a sphere, C = √3.
            assert!(most_apart(phase_means(3f64.sqrt(), r), over_time) > 1e-4);
        }
        assert!(most_apart(plateau_projections(1.0), [0.5; 3]) < 1e-15);
    }
}
