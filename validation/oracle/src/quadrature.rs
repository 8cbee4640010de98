//! Numerical integrals of the free rod's motion, as a check of `closed_form`.
//!
//! The rule is Clenshaw-Curtis (crate `quadrature`, up to 257 points) on panels that are halved until a panel and its
//! two halves agree. The crate's double-exponential rule is not used: it misses 3e-14 of ∫ 1 dx, which its own error
//! estimate cannot show.

use quadrature::clenshaw_curtis;
use std::f64::consts::TAU;

/// An integral and an estimate of its error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Integral {
    /// The integral.
    pub value: f64,
    /// Sum over the panels of |panel − its two halves|: of the order of the error of the coarser rule, so an
    /// overestimate.
    pub error_estimate: f64,
}

/// ∫ f from the first to the last of `breaks` (ascending; repeated values make empty panels and are harmless).
///
/// Put a break at every kink of f and near every narrow peak. A panel is halved until it and its halves agree within
/// `absolute_tolerance` or to a few units of round-off; after 40 halvings the difference is added to the error estimate
/// as it is. f must be finite on the closed interval: the crate would silently read a NaN as 0.
///
/// Measured: 2e-15 absolute on Lorentz peaks of unit height × width and widths down to 1e-8, next to a break.
pub fn integrate(f: impl Fn(f64) -> f64, breaks: &[f64], absolute_tolerance: f64) -> Integral {
    let finite = |x: f64| {
        let y = f(x);
        assert!(y.is_finite(), "integrand is {y} at {x}");
        y
    };
    let mut sum = Integral { value: 0.0, error_estimate: 0.0 };
    for ends in breaks.windows(2) {
        let (a, b) = (ends[0], ends[1]);
        assert!(a <= b, "breaks must ascend: {a} before {b}");
        if a < b {
            let whole = panel(&finite, a, b, absolute_tolerance);
            refine(&finite, [a, b], whole, absolute_tolerance, 40, &mut sum);
        }
    }
    sum
}

/// One panel, with a tenth of the tolerance: the crate's error estimate assumes that two successive rules differ.
fn panel(f: &impl Fn(f64) -> f64, a: f64, b: f64, tolerance: f64) -> f64 {
    clenshaw_curtis::integrate(f, a, b, 0.1 * tolerance).integral
}

fn refine(
    f: &impl Fn(f64) -> f64,
    [a, b]: [f64; 2],
    whole: f64,
    tolerance: f64,
    halvings_left: u32,
    sum: &mut Integral,
) {
    let middle = 0.5 * (a + b);
    let left = panel(f, a, middle, tolerance);
    let right = panel(f, middle, b, tolerance);
    let difference = (whole - left - right).abs();
    let round_off = 4.0 * f64::EPSILON * (left.abs() + right.abs());
    if difference <= tolerance.max(round_off) || halvings_left == 0 {
        sum.value += left + right;
        sum.error_estimate += difference;
    } else {
        refine(f, [a, middle], left, tolerance, halvings_left - 1, sum);
        refine(f, [middle, b], right, tolerance, halvings_left - 1, sum);
    }
}

/// ⟨φ⟩ in radians of eq. 19, integrated as it stands: 4 ∫₀^¼ atan(r_e tan 2πx) dx with x = t/T (eq. 20).
///
/// φ turns within x ~ 1/(2π r_e) of one end of the range, so a panel ends where r_e tan 2πx = 1.
/// Measured against 40-digit arithmetic for 1e-4 ≤ r_e ≤ 1e8: 1e-15 absolute.
pub fn mean_angle_by_quadrature(aspect_ratio: f64) -> f64 {
    let phi = |x: f64| (aspect_ratio * (TAU * x).sin()).atan2((TAU * x).cos());
    let knee = aspect_ratio.recip().atan() / TAU;
    4.0 * integrate(phi, &[0.0, knee, 0.25], 1e-15).value
}

/// Means over one whole period of |p₁|, |p₂|, |p₃| (1) of a free rod in orbit C, from its motion.
///
/// The rod starts at φ = 0, where tan θ = C (eq. 13), and moves as p = q/|q| with
/// q = (sin β cos ωt, r_e sin β sin ωt, cos β), tan β = C. All four quarters are integrated, no symmetry is used.
/// For 0 ≤ C ≤ ∞. Measured against 40-digit arithmetic: 2e-15 absolute for 1e-4 ≤ r_e ≤ 1e4, 2e-14 up to 1e8.
pub fn phase_means_by_quadrature(orbit_constant: f64, aspect_ratio: f64) -> [f64; 3] {
    let (sin_beta, cos_beta) = orbit_constant.atan2(1.0).sin_cos();
    let cos_beta = if orbit_constant.is_infinite() { 0.0 } else { cos_beta };
    // In turns: the quarters, where a component changes sign, and the knees, where φ is 45° off an axis.
    let knee = aspect_ratio.recip().atan() / TAU;
    let mut breaks: Vec<f64> = (0..=4).map(|k| 0.25 * f64::from(k)).collect();
    breaks.extend([knee, 0.5 - knee, 0.5 + knee, 1.0 - knee]);
    breaks.sort_by(f64::total_cmp);
    [0, 1, 2].map(|axis| {
        let modulus = |turns: f64| {
            let (s, c) = (TAU * turns).sin_cos();
            let q = [sin_beta * c, aspect_ratio * sin_beta * s, cos_beta];
            let length = q[0].hypot(q[1]).hypot(q[2]);
            // A rod along the vorticity axis keeps q₃ = 1, so the length is never 0.
            (q[axis] / length).abs()
        };
        integrate(modulus, &breaks, 1e-15).value
    })
}

/// `count` points that fill the unit square uniformly (additive recurrence of the plastic number), as parameters of
/// tests.
pub fn spread(count: u32) -> impl Iterator<Item = (f64, f64)> {
    let g = 1.324_717_957_244_746;
    (1..=count).map(move |i| {
        let i = f64::from(i);
        ((i / g).fract(), (i / (g * g)).fract())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn peaks_of_known_area_are_integrated() {
        // ∫₀¹ w/(w² + x²) dx = atan(1/w): a Lorentz peak of width w at the end of the range, visible only after
        // halving.
        for (u, _) in spread(50) {
            let w = 10f64.powf(-8.0 * u);
            let lorentz = integrate(|x| w / (w * w + x * x), &[0.0, 1.0], 1e-15);
            let exact = w.recip().atan();
            // The tolerance is the round-off of about 30 panels.
            assert!((lorentz.value - exact).abs() < 4e-15, "{w} {lorentz:?}");
            assert!(lorentz.error_estimate < 1e-13);
            // A fixed rule without halving misses a narrow peak.
            let fixed = panel(&|x| w / (w * w + x * x), 0.0, 1.0, 0.0);
            assert!(w > 1e-4 || (fixed - exact).abs() > 1e-3, "{w}");
        }
    }

    #[test]
    fn a_polynomial_beyond_the_first_rules_is_exact_and_empty_panels_are_harmless() {
        let value = integrate(|x| 41.0 * x.powi(40), &[0.0, 0.3, 0.3, 1.0], 1e-16).value;
        assert!((value - 1.0).abs() < 1e-15);
        let without_the_end = integrate(|x| 41.0 * x.powi(40), &[0.0, 0.3, 0.3, 0.99], 1e-16);
        assert!((without_the_end.value - 1.0).abs() > 0.1);
    }

    #[test]
    #[should_panic(expected = "integrand is NaN")]
    fn a_nan_is_not_read_as_zero() {
        integrate(|x| (x - 0.5).sqrt(), &[0.0, 1.0], 1e-9);
    }

    #[test]
    #[should_panic(expected = "breaks must ascend")]
    fn descending_breaks_are_refused() {
        integrate(|x| x, &[1.0, 0.0], 1e-9);
    }
}
