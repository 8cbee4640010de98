//! Jeffery's motion of a free spheroid: angular velocity in any gradient, closed forms in plane Couette flow.
//!
//! Jeffery (1922) as printed in the appendix of Lee & Springer (1982). Nothing here takes a step: the exact
//! motion over a finite time is in [`crate::propagator`].

use crate::flow::VelocityGradient;
use nalgebra::{UnitVector3, Vector3};
use std::f64::consts::{PI, TAU};

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

/// The shear strain |G|T = 2π(r_e + 1/r_e) in one period (eq. 15).
pub fn strain_per_period(aspect_ratio: f64) -> f64 {
    TAU * (aspect_ratio + 1.0 / aspect_ratio)
}

/// The angular velocity ω in 1/s of a spheroid in any velocity gradient:
/// ω = ½ curl u + Λ p × (D p), which is A.1 without its body frame.
pub fn angular_velocity_per_s(
    flow: &VelocityGradient,
    aspect_ratio: f64,
    p: &UnitVector3<f64>,
) -> Vector3<f64> {
    let l = flow.per_s();
    let curl = Vector3::new(
        l[(2, 1)] - l[(1, 2)],
        l[(0, 2)] - l[(2, 0)],
        l[(1, 0)] - l[(0, 1)],
    );
    0.5 * curl + shape_factor(aspect_ratio) * p.cross(&(flow.strain_rate() * p.as_ref()))
}

/// ṗ = ω × p in 1/s: A.1 for the direction alone, without the spin about it.
pub fn direction_rate_per_s(
    flow: &VelocityGradient,
    aspect_ratio: f64,
    p: &UnitVector3<f64>,
) -> Vector3<f64> {
    angular_velocity_per_s(flow, aspect_ratio, p).cross(p)
}

/// ṗ per unit of strain in plane Couette flow u_2 = ±x_1 (`sign` of G), for the stepped core.
pub(crate) fn couette_rate(p: &Vector3<f64>, shape_factor: f64, sign: f64) -> Vector3<f64> {
    let (half, stretch) = (0.5 * sign, shape_factor * sign * p.x * p.y);
    Vector3::new(
        half * (shape_factor - 1.0) * p.y - stretch * p.x,
        half * (shape_factor + 1.0) * p.x - stretch * p.y,
        -stretch * p.z,
    )
}

/// (φ̇, θ̇) in 1/s in plane Couette flow (A.2, A.3).
pub fn angle_rates_per_s(
    shear_rate_per_s: f64,
    aspect_ratio: f64,
    phi_rad: f64,
    theta_rad: f64,
) -> (f64, f64) {
    let r2 = aspect_ratio * aspect_ratio;
    let (sin_phi, cos_phi) = phi_rad.sin_cos();
    let phi_rate = shear_rate_per_s / (r2 + 1.0) * (r2 * cos_phi * cos_phi + sin_phi * sin_phi);
    let theta_rate = 0.25
        * shear_rate_per_s
        * shape_factor(aspect_ratio)
        * (2.0 * theta_rad).sin()
        * (2.0 * phi_rad).sin();
    (phi_rate, theta_rate)
}

/// φ in radians at `turns` = t/T for a rod with φ = 0 at t = 0, continuous over the branches of the
/// arctangent (A.4, eq. 20).
pub fn phi_rad(aspect_ratio: f64, turns: f64) -> f64 {
    let half_turns = (2.0 * turns).round();
    let rest = PI * (2.0 * turns - half_turns);
    half_turns * PI + (aspect_ratio * rest.sin()).atan2(rest.cos())
}

/// θ in radians, in [0, π/2], of a rod on the orbit `orbit_constant` where its azimuth is `phi_rad` (A.5).
pub fn theta_rad(orbit_constant: f64, aspect_ratio: f64, phi_rad: f64) -> f64 {
    let (sin_phi, cos_phi) = phi_rad.sin_cos();
    (orbit_constant / cos_phi.hypot(sin_phi / aspect_ratio)).atan()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::orientation;
    use nalgebra::Matrix3;
    use proptest::prelude::*;

    /// A.1 as printed: in the body frame with axis 1 along the rod, a and b its long and short axes.
    fn printed_angular_velocity(l: &Matrix3<f64>, r: f64, p: &UnitVector3<f64>) -> Vector3<f64> {
        let helper = if p.x.abs() < 0.5 {
            Vector3::x()
        } else {
            Vector3::y()
        };
        let e2 = p.cross(&helper).normalize();
        let frame = Matrix3::from_columns(&[p.into_inner(), e2, p.cross(&e2)]);
        let g = frame.transpose() * l * frame;
        let (a2, b2) = (r * r, 1.0);
        frame
            * Vector3::new(
                0.5 * (g[(2, 1)] - g[(1, 2)]),
                (b2 * g[(0, 2)] - a2 * g[(2, 0)]) / (a2 + b2),
                -(b2 * g[(0, 1)] - a2 * g[(1, 0)]) / (a2 + b2),
            )
    }

    proptest! {
        #![proptest_config(crate::fixed_seed(256))]

        #[test]
        fn the_coordinate_free_form_is_the_printed_one(
            l in prop::array::uniform9(-2.0f64..2.0), phi in 0.0f64..6.2, theta in 0.1f64..3.0, r in 0.1f64..50.0
        ) {
            let flow = VelocityGradient::new(Matrix3::from_row_slice(&l)).unwrap();
            let p = orientation::from_angles(phi, theta);
            let difference = angular_velocity_per_s(&flow, r, &p) - printed_angular_velocity(flow.per_s(), r, &p);
            prop_assert!(difference.norm() < 1e-13);
        }

        #[test]
        fn the_angle_rates_are_those_of_the_direction(phi in 0.0f64..6.2, theta in 0.1f64..3.0, r in 0.1f64..50.0) {
            let (g, p) = (0.7, orientation::from_angles(phi, theta));
            let rate = direction_rate_per_s(&VelocityGradient::plane_couette(g).unwrap(), r, &p);
            let (phi_rate, theta_rate) = angle_rates_per_s(g, r, phi, theta);
            let along_phi = Vector3::new(-phi.sin(), phi.cos(), 0.0);
            let along_theta = Vector3::new(theta.cos() * phi.cos(), theta.cos() * phi.sin(), -theta.sin());
            prop_assert!((rate.dot(&along_phi) - theta.sin() * phi_rate).abs() < 1e-14);
            prop_assert!((rate.dot(&along_theta) - theta_rate).abs() < 1e-14);
            prop_assert!((couette_rate(&p, shape_factor(r), 1.0) * g - rate).norm() < 1e-14);
        }
    }

    #[test]
    fn the_phase_is_continuous_and_gains_two_pi_a_period() {
        let mut last = phi_rad(11.6, 0.0);
        for k in 1..=20_000 {
            let now = phi_rad(11.6, k as f64 / 10_000.0);
            assert!(now > last && now - last < 0.02, "at {k}: {last} to {now}");
            last = now;
        }
        assert!((last - 2.0 * TAU).abs() < 1e-12);
    }
}
