//! Free rods of unequal aspect ratios (eq. 11) that were isotropic at t = 0, in plane Couette flow.

use crate::isotropic::{mean_over_aspect_ratios, mean_projections};
use crate::reference::big::{Big, Bits, double};
use crate::reference::isotropic::Covariance;
use crate::reference::motion::{Motion, Unit};
use ellip::elliprd;
use rayon::prelude::*;
use std::f64::consts::TAU;

/// The longest time, in periods of the mean rod; the number of panels grows with time.
pub const LONGEST_TURNS: f64 = 1000.0;

/// ⟨|p₁|⟩, ⟨|p₂|⟩, ⟨|p₃|⟩ and a₁₁, a₂₂, a₃₃, a₁₂, a₁₃, a₂₃ at `turns` = t/T of the mean rod (negative: the flow is
/// reversed), by quadrature over Gaussian r_e with this mean and deviation, cut at eight deviations.
///
/// `None` if eight deviations reach r_e = 1, beyond [`LONGEST_TURNS`], and outside 10⁻⁴ ≤ r_e ≤ 10⁴.
pub fn means(aspect_ratio: f64, sd_percent: f64, turns: f64) -> Option<[f64; 9]> {
    let reach = 8.0 * 0.01 * sd_percent * aspect_ratio;
    let apart = (aspect_ratio - 1.0).abs() > reach && reach < aspect_ratio;
    let known = (1e-4..=1e4).contains(&aspect_ratio) && turns.abs() <= LONGEST_TURNS;
    if !(apart && known && sd_percent > 0.0) {
        return None;
    }
    let means = mean_over_aspect_ratios(aspect_ratio, sd_percent, turns, |r, turns| {
        let [x1, x2, x3] = mean_projections(r, turns);
        let [a11, a22, a33, a12] = second_moments(r, turns);
        [x1, x2, x3, a11, a22, a33, a12]
    });
    let [x1, x2, x3, a11, a22, a33, a12] = means.map(to_eleven_decimals);
    Some([x1, x2, x3, a11, a22, a33, a12, 0.0, 0.0])
}

/// Rounds a mean to eleven decimals: its error is half a unit of the last.
fn to_eleven_decimals(x: f64) -> f64 {
    format!("{x:.11}").parse::<f64>().unwrap_or(x) + 0.0
}

/// ⟨|p₁|⟩, ⟨|p₂|⟩, ⟨|p₃|⟩ to 22 digits at `time_s` in u_2 = G x_1, by the trapezoid rule over r_e = k·2^(−halvings)
/// within 11.5 standard deviations of the mean, beyond which 10⁻³⁰ of the Gaussian lies.
///
/// Means at one time are analytic in r_e up to |Im ωt| of about 1/r_e, so the rule converges as e^{−2πd/h} with
/// d = 1/(2π t/T): a step of d/10 leaves e^{−62}.
pub fn means_to_22_digits(
    shear_rate_per_s: f64,
    aspect_ratio: f64,
    sd_percent: f64,
    time_s: f64,
    halvings: i32,
) -> [Big; 3] {
    const BITS: Bits = Bits(160);
    let (mean, step) = (BITS.of(aspect_ratio), 0.5f64.powi(halvings));
    let sd = &mean * BITS.of(sd_percent) / BITS.of(100.0);
    let reach = 11.5 * double(&sd);
    let first = ((aspect_ratio - reach) / step).ceil() as i64;
    let last = ((aspect_ratio + reach) / step).floor() as i64;
    let node = |k: i64| {
        // Exact, because k has few bits.
        let r = k as f64 * step;
        let motion = Motion { gradient_per_s: [[0.0; 3], [shear_rate_per_s, 0.0, 0.0], [0.0; 3]], aspect_ratio: r };
        let z = (BITS.of(r) - &mean) / &sd;
        let weight = (-(z.sqr() / BITS.of(2.0))).exp();
        let covariance = Covariance::at(&motion, &BITS.of(time_s), Unit::Second);
        let means = covariance.expect("seconds have a meaning in every flow").projections();
        let [x1, x2, x3] = means.map(|mean| mean * &weight);
        [x1, x2, x3, weight]
    };
    let none = || [0; 4].map(|_| BITS.of(0.0));
    let sum = |a: [Big; 4], b: [Big; 4]| [0, 1, 2, 3].map(|i| &a[i] + &b[i]);
    let [x1, x2, x3, weights] = (first..=last).into_par_iter().map(node).reduce(none, sum);
    [x1, x2, x3].map(|sum| sum / &weights)
}

/// a₁₁, a₂₂, a₃₃, a₁₂ of rods of one r_e, in doubles.
///
/// Σ = F Fᵀ has the eigenvalues λ ≥ 1, 1/λ, 1, and in its axes ⟨p_i²⟩ = R_D(1/σ_j², 1/σ_k², 1/σ_i²)/3 (Carlson). The
/// axis of 1/λ is at β from axis 1, tan 2β = 2|cos ωt|/(|sin ωt|(r_e + 1/r_e)).
fn second_moments(r: f64, turns: f64) -> [f64; 4] {
    if r < 1.0 {
        // A disc of r_e moves as a rod of 1/r_e with axes 1 and 2 exchanged and time reversed.
        let [first, second, third, shear] = second_moments(r.recip(), -turns);
        return [second, first, third, shear];
    }
    let (s, c) = (TAU * (turns - turns.round())).sin_cos();
    let half_gap = 0.5 * s.abs() * (r - r.recip());
    let lambda = (half_gap + half_gap.hypot(1.0)).powi(2);
    let (x, y) = (s.abs() * (r + r.recip()), 2.0 * c.abs());
    let h = x.hypot(y);
    let (sin_squared, cos_squared) = (0.5 * y * y / (h * (h + x)), 0.5 * (1.0 + x / h));
    let r_d = |x: f64, y: f64, z: f64| elliprd(x, y, z).expect("positive arguments") / 3.0;
    let small = lambda.recip();
    let (long, short) = (r_d(lambda, 1.0, small), r_d(small, 1.0, lambda));
    [
        long * sin_squared + short * cos_squared,
        long * cos_squared + short * sin_squared,
        r_d(lambda, small, 1.0),
        0.5 * (s * c).signum() * (long - short) * y / h,
    ]
}
