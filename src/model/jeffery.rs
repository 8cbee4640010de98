//! Jeffery's motion of a free spheroid: shape factor, period, and the rate at which a direction turns.
//!
//! After Jeffery (1922) as printed in the appendix of Lee & Springer (1982). Time steps are elsewhere: the exact
//! motion over a finite time is in [`crate::motion`].

use nalgebra::{Matrix3, Vector3};
use std::f64::consts::TAU;

/// Λ = (r_e² − 1)/(r_e² + 1): 1 for a thread, 0 for a sphere, −1 for a disc.
pub fn shape_factor(aspect_ratio: f64) -> f64 {
    // Written in r and 1/r, which do not overflow; their difference keeps its digits near r = 1.
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

/// The aspect ratio r_e ≥ 1 of a rod whose period is the shear strain `strain` = |G|T (eq. 15, A.6): the larger root of
/// r_e + 1/r_e = |G|T/2π. A disc of 1/r_e has the same period. `None` below 4π, the period of a sphere.
///
/// ```
/// use shearbed::model::jeffery::{aspect_ratio_of_period, strain_per_period};
/// let found = aspect_ratio_of_period(strain_per_period(11.6)).expect("above 4π");
/// assert!((found - 11.6).abs() < 1e-13);
/// ```
pub fn aspect_ratio_of_period(strain: f64) -> Option<f64> {
    let half = strain / (2.0 * TAU);
    // The root of a difference of squares keeps its digits near r_e = 1.
    (half >= 1.0).then(|| half + (half - 1.0).sqrt() * (half + 1.0).sqrt())
}

/// ṗ = ω × p per unit of strain in plane Couette flow u_2 = ±x_1 (`sign` of G) at Λ = `shape_factor`: A.1 for the
/// direction, without the spin about it. A.2 and A.3 follow as the rates of its angles.
pub fn couette_rate(p: &Vector3<f64>, shape_factor: f64, sign: f64) -> Vector3<f64> {
    let (half, stretch) = (0.5 * sign, shape_factor * sign * p.x * p.y);
    Vector3::new(
        half * (shape_factor - 1.0) * p.y - stretch * p.x,
        half * (shape_factor + 1.0) * p.x - stretch * p.y,
        -stretch * p.z,
    )
}

/// ṗ = W·p + Λ(D·p − p p·D·p) in a liquid with the velocity gradient `gradient`, per its unit of time.
pub fn rate(gradient: &Matrix3<f64>, p: &Vector3<f64>, shape_factor: f64) -> Vector3<f64> {
    let (along, across) = (gradient * p, gradient.tr_mul(p));
    let stretch = 0.5 * shape_factor * (along + across);
    0.5 * (along - across) + stretch - p * p.dot(&stretch)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::flow::VelocityGradient;
    use crate::model::orientation;
    use proptest::prelude::*;

    #[test]
    fn a_period_gives_the_rod_that_has_it() {
        for r in [1.0, 1.5, 11.6, 1e6] {
            // Near 1 the period hardly depends on r: its rounding ε is one of √ε in r.
            let within = 1e-14 * r + if r == 1.0 { 1e-7 } else { 0.0 };
            let found = aspect_ratio_of_period(strain_per_period(r)).unwrap();
            assert!((found - r).abs() < within, "{r}: {found}");
        }
        assert_eq!(aspect_ratio_of_period(2.0 * TAU), Some(1.0));
        assert_eq!([2.0 * TAU.next_down(), 0.0, f64::NAN].map(aspect_ratio_of_period), [None; 3]);
    }

    proptest! {
        #![proptest_config(crate::fixed_seed(256))]

        #[test]
        fn the_rates_are_those_of_the_tensors(
            phi in 0.0f64..6.2, theta in 0.1f64..3.0, r in 0.1f64..50.0, rows in prop::array::uniform9(-1.0f64..1.0)
        ) {
            let (p, factor) = (orientation::from_angles(phi, theta).into_inner(), shape_factor(r));
            for flow in [
                VelocityGradient::plane_couette(1.0).unwrap(),
                VelocityGradient::plane_couette(-1.0).unwrap(),
                VelocityGradient::new(Matrix3::from_row_slice(&rows)).unwrap(),
            ] {
                let stretch = flow.strain_rate() * p;
                let expected = flow.vorticity() * p + factor * (stretch - p * p.dot(&stretch));
                let found = rate(flow.per_s(), &p, factor);
                prop_assert!((found - expected).norm() < 3e-15 && found.dot(&p).abs() < 3e-15);
                if let Some(sign) = flow.shear_rate_per_s() {
                    prop_assert!((couette_rate(&p, factor, sign) - expected).norm() < 1e-15);
                }
            }
        }
    }
}
