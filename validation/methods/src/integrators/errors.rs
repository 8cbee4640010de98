//! The errors of a direction against the closed form.

use super::RodProblem;
use nalgebra::{UnitVector3, Vector3};
use serde::Serialize;
use std::f64::consts::{PI, TAU};

/// The errors of a direction at the end of a problem. Only `length` depends on |p|.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Errors {
    /// The angle to the reference in rad, in [0, π/2]; p and −p are the same rod.
    pub orientation_rad: f64,
    /// |C_b − C_b(0)| of C_b = C/(1 + C) (eq. 13), in [0, 1]; C itself may be infinite.
    pub orbit_constant: f64,
    /// Error of the phase in periods, in [0, ¼]: half a period gives the same rod.
    pub phase_turns: f64,
    /// The deviation of |p| from 1.
    pub length: f64,
}

impl Errors {
    /// The errors of `end`, the computed direction with its length.
    pub fn of(end: &Vector3<f64>, problem: &RodProblem, start: &UnitVector3<f64>) -> Self {
        let reference = problem.reference(start);
        let r = problem.aspect_ratio;
        let off = phase(end, r) - phase(&reference, r);
        Self {
            orientation_rad: apart_rad(end, &reference),
            orbit_constant: (bounded_orbit_constant(end, r) - bounded_orbit_constant(start, r)).abs(),
            phase_turns: (off - PI * (off / PI).round()).abs() / TAU,
            length: (end.norm() - 1.0).abs(),
        }
    }
}

/// The angle in rad between two directions of any length, p and −p being the same rod; accurate near 0 and near π/2.
pub fn apart_rad(a: &Vector3<f64>, b: &Vector3<f64>) -> f64 {
    a.cross(b).norm().atan2(a.dot(b).abs())
}

/// The phase κ in rad, with tan φ = r_e tan κ; it grows uniformly in time (A.4).
fn phase(p: &Vector3<f64>, aspect_ratio: f64) -> f64 {
    (p.y / aspect_ratio).atan2(p.x)
}

fn bounded_orbit_constant(p: &Vector3<f64>, aspect_ratio: f64) -> f64 {
    let in_plane = p.x.hypot(p.y / aspect_ratio);
    in_plane / (in_plane + p.z.abs())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    #[test]
    fn small_and_large_angles_are_exact_and_heads_are_tails() {
        let a = Vector3::new(1.0, 0.0, 0.0);
        for angle in [0.0, 1e-150, 1e-12, 0.3, 1.55, FRAC_PI_2 - 1e-9] {
            let b = Vector3::new(f64::cos(angle), f64::sin(angle), 0.0);
            for b in [b, -b, 3.0 * b] {
                assert!((apart_rad(&a, &b) - angle).abs() <= 2e-16 * angle, "{angle}");
            }
        }
    }

    /// Tests the other end of a rod, and a rod that is 0.3 turns ahead and so 0.2 turns behind its other end.
    #[test]
    fn a_phase_is_told_head_or_tail_alike() {
        let r = 4.0;
        let (problem, start) = RodProblem::mid_flip(r);
        let end = problem.reference(&start).into_inner();
        assert!(Errors::of(&-end, &problem, &start).phase_turns < 1e-15);
        for (turns, seen) in [(0.1, 0.1), (0.3, 0.2), (-0.3, 0.2), (0.7, 0.2)] {
            let ahead = phase(&end, r) + turns * TAU;
            let length = end.x.hypot(end.y / r);
            let moved = Vector3::new(length * ahead.cos(), r * length * ahead.sin(), end.z);
            let errors = Errors::of(&moved, &problem, &start);
            assert!((errors.phase_turns - seen).abs() < 1e-14, "{turns}: {errors:?}");
        }
    }

    #[test]
    fn each_error_sees_its_own_mistake() {
        let (problem, start) = RodProblem::mid_flip(11.6);
        let end = problem.reference(&start).into_inner();
        let none = Errors::of(&end, &problem, &start);
        assert!(none.orientation_rad < 1e-15 && none.phase_turns < 1e-15 && none.length < 1e-15);
        assert!(none.orbit_constant < 1e-15);
        let longer = Errors::of(&(-1.5 * end), &problem, &start);
        assert!((longer.length - 0.5).abs() < 1e-15 && longer.orientation_rad < 1e-15);
        let tilted = Errors::of(&Vector3::new(end.x, end.y, 2.0 * end.z), &problem, &start);
        assert!(tilted.orbit_constant > 0.1 && tilted.phase_turns < 1e-15);
        let later = RodProblem::new(11.6, problem.turns + 1e-3).reference(&start);
        let late = Errors::of(&later, &problem, &start);
        assert!((late.phase_turns - 1e-3).abs() < 1e-12 && late.orbit_constant < 1e-14);
    }
}
