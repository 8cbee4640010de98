//! Jeffery's equations at one instant, as the paper prints them (A.1 to A.3).

use nalgebra::{Matrix3, Vector3};

/// ω in 1/s (A.1 as printed) of a spheroid with the half axes `a` along the unit vector p and `b` across it, in the
/// velocity gradient L_ij = ∂u_i/∂x_j in 1/s. In the particle's axes, 1 is along the long axis a, 2 and 3 are along the
/// short axes b.
pub fn angular_velocity_per_s(l: &Matrix3<f64>, a: f64, b: f64, p: &Vector3<f64>) -> Vector3<f64> {
    let helper = if p.x.abs() < 0.5 { Vector3::x() } else { Vector3::y() };
    let second = p.cross(&helper).normalize();
    let frame = Matrix3::from_columns(&[*p, second, p.cross(&second)]);
    let g = frame.transpose() * l * frame;
    let (a2, b2) = (a * a, b * b);
    frame
        * Vector3::new(
            0.5 * (g[(2, 1)] - g[(1, 2)]),
            (b2 * g[(0, 2)] - a2 * g[(2, 0)]) / (a2 + b2),
            -(b2 * g[(0, 1)] - a2 * g[(1, 0)]) / (a2 + b2),
        )
}

/// ṗ = ω × p in 1/s, with ω by A.1 as printed.
pub fn direction_rate_per_s(l: &Matrix3<f64>, aspect_ratio: f64, p: &Vector3<f64>) -> Vector3<f64> {
    angular_velocity_per_s(l, aspect_ratio, 1.0, p).cross(p)
}

/// (φ̇, θ̇) in 1/s at (φ, θ) in rad in plane Couette flow, by A.2 and A.3 as printed.
pub fn angle_rates_per_s(shear_rate_per_s: f64, aspect_ratio: f64, phi: f64, theta: f64) -> (f64, f64) {
    let r2 = aspect_ratio * aspect_ratio;
    (
        shear_rate_per_s / (r2 + 1.0) * (r2 * phi.cos().powi(2) + phi.sin().powi(2)),
        0.25 * shear_rate_per_s * ((r2 - 1.0) / (r2 + 1.0)) * (2.0 * theta).sin() * (2.0 * phi).sin(),
    )
}

#[cfg(test)]
mod tests {
    use super::super::closed_form::{angles_at, period_s};
    use super::*;

    fn direction(phi: f64, theta: f64) -> Vector3<f64> {
        Vector3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos())
    }

    const PLACES: [(f64, f64); 4] = [(0.2, 0.3), (0.9, 1.1), (2.4, 0.8), (-0.6, 1.5)];

    #[test]
    fn a_2_and_a_3_are_the_rates_of_the_closed_form() {
        for r in [0.3, 1.0, 11.6] {
            for (phi, theta) in PLACES {
                let h = 1e-4;
                let at = |time: f64| angles_at(phi, theta, r, time / period_s(0.5, r));
                let (ahead, behind) = (at(h), at(-h));
                let rates = angle_rates_per_s(0.5, r, phi, theta);
                // h²/6 times a third derivative of about G³, and ε r_e/h.
                assert!((rates.0 - (ahead.0 - behind.0) / (2.0 * h)).abs() < 1e-9);
                assert!((rates.1 - (ahead.1 - behind.1) / (2.0 * h)).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn a_1_in_couette_flow_is_a_2_and_a_3_and_its_spin_is_the_liquid_s() {
        let mut l = Matrix3::zeros();
        l[(1, 0)] = 0.5;
        for r in [0.3, 2.0, 11.6] {
            for (phi, theta) in PLACES {
                let p = direction(phi, theta);
                let rate = direction_rate_per_s(&l, r, &p);
                let (phi_rate, theta_rate) = angle_rates_per_s(0.5, r, phi, theta);
                let along_phi = Vector3::new(-phi.sin(), phi.cos(), 0.0);
                let along_theta = Vector3::new(theta.cos() * phi.cos(), theta.cos() * phi.sin(), -theta.sin());
                assert!((rate - along_phi * (theta.sin() * phi_rate) - along_theta * theta_rate).norm() < 1e-15);
                // Half the vorticity 0.5 along axis 3.
                let spin = angular_velocity_per_s(&l, r, 1.0, &p).dot(&p);
                assert!((spin - 0.25 * p.z).abs() < 1e-15);
                // Wrong variant: the aspect ratio upside down.
                assert!((direction_rate_per_s(&l, 1.0 / r, &p) - rate).norm() > 1e-3);
            }
        }
    }
}
