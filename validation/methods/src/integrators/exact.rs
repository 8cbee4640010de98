//! Integrators without time steps.

use super::{Integrator, RodProblem, Theory};
use nalgebra::{UnitVector3, Vector3};
use shearbed::model::phase::Phase;
use shearbed::motion::couette;
use std::f64::consts::{PI, TAU};

/// The core's propagator: p = q/|q| with q linear in p(0).
pub fn exact_propagator() -> Integrator {
    Integrator::new("exact propagator", Theory::Exact, |problem, start, _| {
        let phase = Phase::of_turns(problem.turns);
        Ok(couette([start.x, start.y, start.z], problem.aspect_ratio, phase).into())
    })
    .keeping_length()
}

/// A.4 for φ, then A.5 for θ, as the paper has them; the exact propagator does the same without angles.
pub fn closed_form() -> Integrator {
    Integrator::new("A.4 and A.5 in angles", Theory::Exact, |problem, start, _| Ok(in_angles(problem, start)))
        .keeping_length()
}

fn in_angles(problem: &RodProblem, start: &UnitVector3<f64>) -> Vector3<f64> {
    let r = problem.aspect_ratio;
    // A.5 gives θ up to π/2: take that one of p and −p.
    let p = if start.z < 0.0 { -*start } else { *start };
    let before = (p.y / r).atan2(p.x) / TAU;
    let phi = phi_rad(r, before + problem.turns);
    let (sin_phi, cos_phi) = phi.sin_cos();
    // Eq. 13, then A.5.
    let orbit_constant = p.x.hypot(p.y / r) / p.z.abs();
    let (sin_theta, cos_theta) = (orbit_constant / cos_phi.hypot(sin_phi / r)).atan().sin_cos();
    Vector3::new(sin_theta * cos_phi, sin_theta * sin_phi, cos_theta)
}

/// φ in radians at `turns` = t/T for a rod with φ = 0 at t = 0, continuous over the branches of the arctangent (A.4).
fn phi_rad(aspect_ratio: f64, turns: f64) -> f64 {
    let half_turns = (2.0 * turns).round();
    let rest = PI * (2.0 * turns - half_turns);
    half_turns * PI + (aspect_ratio * rest.sin()).atan2(rest.cos())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_phase_is_continuous_and_gains_two_pi_a_period() {
        let mut last = phi_rad(11.6, 0.0);
        for k in 1..=20_000 {
            let now = phi_rad(11.6, f64::from(k) / 10_000.0);
            assert!(now > last && now - last < 0.02, "at {k}: {last} to {now}");
            last = now;
        }
        assert!((last - 2.0 * TAU).abs() < 1e-12);
    }

    /// Whole turns are subtracted before the factor π: a long rod flips so fast that their rounding would be visible.
    #[test]
    fn many_turns_cost_the_phase_no_digits() {
        let (k, x) = (f64::from(1 << 20), 1.0 / f64::from(1 << 20));
        let (many, few) = (phi_rad(1000.0, k + x), phi_rad(1000.0, x));
        assert!((many - TAU * k - few).abs() < 1e-8, "{}", many - TAU * k - few);
    }

    #[test]
    fn the_closed_form_in_angles_is_the_reference() {
        for r in [0.3, 2.0, 11.6] {
            for theta in [0.4, 1.3, 2.8] {
                let (problem, start) = RodProblem::into_flip(r, 0.7, theta, 1.3);
                let off = super::super::apart_rad(&in_angles(&problem, &start), &problem.reference(&start));
                // The phase is rounded to ε, and φ moves by max(r_e, 1/r_e) times that.
                assert!(off < 32.0 * f64::EPSILON * r.max(1.0 / r), "{r} {theta}");
            }
        }
    }
}
