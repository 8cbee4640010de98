//! A rod's direction p = (sin θ cos φ, sin θ sin φ, cos θ), with p ≡ −p, and quantities computed from it.
//!
//! θ is measured from axis 3 (vorticity), φ from axis 1 (gradient) towards axis 2 (flow).

use nalgebra::{UnitVector3, Vector3};

/// The direction with the angles `phi_rad` and `theta_rad` (Fig. 1).
pub fn from_angles(phi_rad: f64, theta_rad: f64) -> UnitVector3<f64> {
    let (sin_theta, cos_theta) = libm::sincos(theta_rad);
    let (sin_phi, cos_phi) = libm::sincos(phi_rad);
    UnitVector3::new_normalize(Vector3::new(sin_theta * cos_phi, sin_theta * sin_phi, cos_theta))
}

/// The direction with the angles `phi_deg` and `theta_deg` in degrees: exact at multiples of 90°, with a relative error
/// of a few roundings in every component.
pub fn from_degrees(phi_deg: f64, theta_deg: f64) -> UnitVector3<f64> {
    let ([cos_phi, sin_phi], [cos_theta, sin_theta]) = (of_degrees(phi_deg), of_degrees(theta_deg));
    UnitVector3::new_normalize(Vector3::new(sin_theta * cos_phi, sin_theta * sin_phi, cos_theta))
}

/// Cosine and sine of an angle in degrees.
fn of_degrees(degrees: f64) -> [f64; 2] {
    // Both remainders are exact.
    let degrees = degrees % 360.0;
    let quarters = (degrees / 90.0).round();
    let (sin, cos) = libm::sincos((degrees - 90.0 * quarters).to_radians());
    match quarters.rem_euclid(4.0) as u8 {
        0 => [cos, sin],
        1 => [-sin, cos],
        2 => [-cos, -sin],
        _ => [sin, -cos],
    }
}

/// An isotropic direction from two uniform numbers in [0, 1): φ = 2πR₄, θ = arccos(1 − 2R₅) (eq. 12).
pub fn isotropic(r4: f64, r5: f64) -> UnitVector3<f64> {
    // sin θ without the cancellation of 1 − cos²θ near the poles.
    let sin_theta = 2.0 * (r5 * (1.0 - r5)).sqrt();
    let (sin_phi, cos_phi) = libm::sincos(std::f64::consts::TAU * r4);
    UnitVector3::new_normalize(Vector3::new(sin_theta * cos_phi, sin_theta * sin_phi, 1.0 - 2.0 * r5))
}

/// The angles (φ, θ) in radians, φ in (−π, π] and θ in [0, π].
pub fn angles(p: &UnitVector3<f64>) -> (f64, f64) {
    (libm::atan2(p.y, p.x), libm::atan2(libm::hypot(p.x, p.y), p.z))
}

/// φ in radians folded into [0, π/2] by p ≡ −p and the mirror planes of the flow (eq. 18).
#[inline]
pub fn folded_phi(p1: f64, p2: f64) -> f64 {
    libm::atan2(p2.abs(), p1.abs())
}

/// C_b = C/(1 + C), in [0, 1], of the orbit constant C = tan θ (r_e² cos²φ + sin²φ)^½ / r_e (eq. 13): 0 for a rod along
/// the vorticity axis, 1 for one in the plane of shear, where C itself is infinite.
#[inline]
pub fn bounded_orbit_constant(p: [f64; 3], aspect_ratio: f64) -> f64 {
    let in_plane = libm::hypot(p[0], p[1] / aspect_ratio);
    in_plane / (in_plane + p[2].abs())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(crate::fixed_seed(256))]

        #[test]
        fn angles_come_back(phi in -3.1f64..3.1, theta in 0.01f64..3.13) {
            let (phi_back, theta_back) = angles(&from_angles(phi, theta));
            prop_assert!((phi - phi_back).abs() < 1e-13 / theta.sin());
            prop_assert!((theta - theta_back).abs() < 1e-14);
        }

        #[test]
        fn isotropic_draws_follow_equation_12(r4 in 0.0f64..1.0, r5 in 0.0f64..1.0) {
            let p = isotropic(r4, r5);
            let expected = from_angles(std::f64::consts::TAU * r4, (1.0 - 2.0 * r5).acos());
            prop_assert!((p.into_inner() - expected.into_inner()).norm() < 1e-7);
            prop_assert!((p.z - (1.0 - 2.0 * r5)).abs() < 1e-15);
        }
    }

    #[test]
    fn right_angles_are_exact_and_others_those_of_radians() {
        for quarters in -9i32..=9 {
            let [cos, sin] = of_degrees(90.0 * f64::from(quarters));
            let expected = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]][quarters.rem_euclid(4) as usize];
            assert_eq!([cos, sin], expected);
        }
        for k in 0..2000 {
            let degrees = f64::from(k).mul_add(0.7371, -600.0);
            let (sin, cos) = degrees.to_radians().sin_cos();
            let found = of_degrees(degrees);
            // The radians, up to 15, are rounded to 15 ε.
            assert!((found[0] - cos).abs() < 16.0 * f64::EPSILON && (found[1] - sin).abs() < 16.0 * f64::EPSILON);
        }
        // cos(90° − 10⁻⁹ °) to full relative precision; computed from radians it has six digits.
        let [cos, _] = of_degrees(90.0 - 2f64.powi(-30));
        assert!((cos / 2f64.powi(-30).to_radians() - 1.0).abs() < 2.0 * f64::EPSILON);
    }

    #[test]
    fn the_ends_of_the_orbit_constant() {
        assert_eq!(bounded_orbit_constant([0.0, 0.0, -1.0], 11.6), 0.0);
        assert_eq!(bounded_orbit_constant([0.0, 1.0, 0.0], 11.6), 1.0);
    }
}
