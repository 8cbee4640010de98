//! The required accuracy of a correct code in double precision.
//!
//! Such a code evaluates ṗ in units of the strain rate with an error of about ε (the rounding of Λ and of W·p + ΛD·p,
//! which nearly cancel where a long rod lies along the flow), and a fourth-order method, whose truncation error per
//! radian turned is about h⁴, reaches ε^{4/5} where truncation and the rounding of its steps, ε/h, meet. An error made
//! at strain s is multiplied at the end by κ(s), the norm of ∂p(end)/∂p(s). So the error is at most about
//!   ∫ κ (2ε + 10 ε^{4/5} |dp/ds|) ds,
//! with 2 for two such roundings and 10 for the difference between methods of one order.

use crate::methods::turning::growths;
use crate::oracle::reference::big::{Big, Bits, double};
use crate::oracle::reference::motion::{Motion, Unit, matrix, product};
use nalgebra::Matrix3;

const ROUNDING: f64 = 2.0 * f64::EPSILON;

/// 10 ε^{4/5}.
fn truncation() -> f64 {
    10.0 * f64::EPSILON.powf(0.8)
}

/// The tolerance of angles (rad) in plane Couette flow after `strain`, rounded up to one digit.
///
/// In the shear plane κ = φ̇(end)/φ̇(s) and φ̇/G ≤ 1. The mean of G/φ̇ over a period is ½(r_e + 1/r_e)² (A.2), and that
/// of κ φ̇(s)/G is 1.
pub fn couette(aspect_ratio: f64, strain: f64) -> f64 {
    let mean = 0.5 * (aspect_ratio + aspect_ratio.recip()).powi(2);
    rounded_up(strain.abs() * (ROUNDING * mean + truncation()))
}

/// The reason for the tolerance of `couette`.
pub fn because_couette(aspect_ratio: f64) -> String {
    format!(
        "A right code in double precision evaluates ṗ/G to about ε, and a fourth-order method comes to ε^(4/5) per \
         radian turned, where its truncation (h⁴) and its rounding (ε/h) meet. An error made at strain s grows by \
         φ̇(end)/φ̇(s), on average by ½(r_e + 1/r_e)² at most. So (2ε·½(r_e + 1/r_e)² + 10 ε^(4/5))·strain is allowed, \
         with r_e = {aspect_ratio}: two roundings an evaluation, and 10 for what separates methods of one order; \
         rounded up to one digit."
    )
}

/// The tolerance of angles (rad) in any flow: the integral in this module's documentation by the midpoint rule in 400
/// steps, the largest over rods, rounded up to one digit. κ is the Frobenius norm, which bounds the spectral one. A
/// flow that turns by `rotation_rad_per_s` has that much more to evaluate and to turn: rotations leave κ alone.
pub fn general(motion: &Motion, rotation_rad_per_s: f64, start: &[[f64; 3]], end_s: f64) -> f64 {
    const STEPS: usize = 400;
    let bits = motion.bits(end_s, Unit::Second, 160);
    // The map over half a step and its powers: cheaper than one exponential per step, and 800 roundings of 160 bits are
    // negligible.
    let half_step = bits.of(end_s) / bits.of(2.0 * STEPS as f64);
    let half = (motion.map(&half_step, Unit::Second, bits)).expect("seconds have a meaning");
    let none = matrix(|i, j| bits.of(f64::from(u8::from(i == j))));
    let powers = std::iter::successors(Some(none), |map| Some(product(map, &half)));
    let rounded = |x: &Big| double(&Bits(64).round(x.clone()));
    let maps: Vec<_> = powers.take(2 * STEPS + 1).map(|m| Matrix3::from_fn(|i, j| rounded(&m[i][j]))).collect();
    let strain = motion.strain(end_s, Unit::Second) / STEPS as f64;
    let spun = rotation_rad_per_s * end_s / STEPS as f64 / strain;
    let lost = |p0: &[f64; 3]| {
        let sum = growths(&maps, p0)
            .into_iter()
            .map(|[growth, moved]| growth * (ROUNDING * (1.0 + spun) + truncation() * (moved / strain + spun)));
        sum.sum::<f64>() * strain
    };
    rounded_up(crate::oracle::worst(start.iter().map(lost)))
}

/// The reason for the tolerance of `general`.
pub const BECAUSE_GENERAL: &str = "A right code in double precision evaluates ṗ, in units of |L|, to about ε, and a \
    fourth-order method comes to ε^(4/5) per radian turned, where its truncation (h⁴) and its rounding (ε/h) meet. An \
    error made on the way reaches the end multiplied by κ = |∂p(end)/∂p|. So the integral of κ(2ε + 10 ε^(4/5)|dp/ds|) \
    over strain is allowed: two roundings an evaluation, and 10 for what separates methods of one order; rounded up to \
    one digit.";

/// `x` > 0 rounded up to one significant digit.
pub fn rounded_up(x: f64) -> f64 {
    let exponent = x.log10().floor() as i32;
    let unit = 10f64.powi(exponent);
    // Through text, so that 5e-11 is not 5.000000000000001e-11.
    format!("{}e{exponent}", (x / unit).ceil()).parse().unwrap_or(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_rounded_up_to_one_digit() {
        for (x, expected) in [(4.1e-11, 5e-11), (9.2e-3, 1e-2), (1.0, 1.0), (0.55, 0.6), (123.0, 200.0)] {
            assert_eq!(rounded_up(x), expected);
        }
    }

    #[test]
    fn the_closed_form_in_couette_flow_is_the_integral() {
        for aspect_ratio in [0.3, 1.0, 3.0] {
            let motion = Motion { gradient_per_s: [[0.0; 3], [1.0, 0.0, 0.0], [0.0; 3]], aspect_ratio };
            let period = double(&motion.strain_per_period(Bits(64)));
            // In the shear plane, at the place of fastest rotation: the bound is met up to the rounding to one digit
            // and the Frobenius norm of two directions.
            let start = if aspect_ratio < 1.0 { [0.0, 1.0, 0.0] } else { [1.0, 0.0, 0.0] };
            let ratio = general(&motion, 0.0, &[start], period) / couette(aspect_ratio, period);
            assert!((0.5..=3.0).contains(&ratio), "{aspect_ratio} {ratio}");
        }
    }
}
