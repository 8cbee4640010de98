//! Jeffery's motion of a free spheroid: shape factor, period, and the rate at which a direction turns.
//!
//! Jeffery (1922) as printed in the appendix of Lee & Springer (1982). Nothing here takes a step: the exact
//! motion over a finite time is in [`crate::propagator`].

use nalgebra::Vector3;
use std::f64::consts::TAU;

/// Λ = (r_e² − 1)/(r_e² + 1): 1 for a thread, 0 for a sphere, −1 for a disc.
pub fn shape_factor(aspect_ratio: f64) -> f64 {
    // In r and 1/r, which do not overflow; the difference of squares keeps the digits near r = 1.
    let inverse = 1.0 / aspect_ratio;
    (aspect_ratio - inverse) / (aspect_ratio + inverse)
}

/// The period T = 2π(r_e + 1/r_e)/|G| of a rod in plane Couette flow, in s (eq. 15, A.6).
pub fn period_s(shear_rate_per_s: f64, aspect_ratio: f64) -> f64 {
    strain_per_period(aspect_ratio) / shear_rate_per_s.abs()
}

/// The shear strain |G|T = 2π(r_e + 1/r_e) in one period of a rod in plane Couette flow (eq. 15, A.6).
pub fn strain_per_period(aspect_ratio: f64) -> f64 {
    TAU * (aspect_ratio + 1.0 / aspect_ratio)
}

/// ṗ = ω × p per unit of strain in plane Couette flow u_2 = ±x_1 (`sign` of G) at Λ = `shape_factor`: A.1 for the
/// direction alone, without the spin about it, and with A.2 and A.3 the rates of its angles.
pub fn couette_rate(p: &Vector3<f64>, shape_factor: f64, sign: f64) -> Vector3<f64> {
    let (half, stretch) = (0.5 * sign, shape_factor * sign * p.x * p.y);
    Vector3::new(
        half * (shape_factor - 1.0) * p.y - stretch * p.x,
        half * (shape_factor + 1.0) * p.x - stretch * p.y,
        -stretch * p.z,
    )
}

/// ṗ = W·p + Λ(D·p − p p·D·p) in 1/s in any gradient, for tests of what runs.
#[cfg(test)]
pub(crate) fn direction_rate_per_s(
    flow: &crate::flow::VelocityGradient,
    aspect_ratio: f64,
    p: &Vector3<f64>,
) -> Vector3<f64> {
    let stretch = flow.strain_rate() * p;
    flow.vorticity() * p + shape_factor(aspect_ratio) * (stretch - p * p.dot(&stretch))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flow::VelocityGradient;
    use crate::orientation;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(crate::fixed_seed(256))]

        #[test]
        fn the_rate_is_that_of_the_tensors(phi in 0.0f64..6.2, theta in 0.1f64..3.0, r in 0.1f64..50.0) {
            let p = orientation::from_angles(phi, theta);
            for sign in [1.0, -1.0] {
                let flow = VelocityGradient::plane_couette(sign).unwrap();
                let rate = direction_rate_per_s(&flow, r, &p);
                prop_assert!((couette_rate(&p, shape_factor(r), sign) - rate).norm() < 1e-15);
                prop_assert!(rate.dot(&p).abs() < 1e-15);
            }
        }
    }
}
