//! The contact of two rods and its effect on them (A.7 to A.13).

use super::mistake::{Mistake, either};
use super::motion::{matrix, vector};
use nalgebra::{Matrix3, Unit, Vector3};

/// Two rods in contact and their rates after the collision.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// Unit contact line L, along p_A x p_B.
    pub line: [f64; 3],
    /// Signed distance from A's centre to its contact point, along p_A, mm.
    pub arm_a_mm: f64,
    /// Signed distance from B's centre to its contact point, along p_B, mm.
    pub arm_b_mm: f64,
    /// From A's contact point to B's, along the contact line, signed, mm.
    pub gap_mm: f64,
    /// pdot' of A, 1/s.
    pub pdot_a_per_s: [f64; 3],
    /// pdot' of B, 1/s.
    pub pdot_b_per_s: [f64; 3],
}

/// The state of a rod before a collision: centre (mm), axis, rate of the axis (1/s).
type Rod = [Vector3<f64>; 3];

/// A.7 to A.13 for rods at `xa`, `xb` (mm) along `pa`, `pb`, turning at `pdot_a`, `pdot_b` (1/s) in u = L x (L in 1/s).
///
/// `None` if there is no contact: parallel rods, or an arm of exactly 0.
pub fn collide(
    xa: [f64; 3],
    pa: [f64; 3],
    pdot_a: [f64; 3],
    xb: [f64; 3],
    pb: [f64; 3],
    pdot_b: [f64; 3],
    gradient: [[f64; 3]; 3],
) -> Option<Contact> {
    let (a, b) = ([xa, pa, pdot_a].map(vector), [xb, pb, pdot_b].map(vector));
    contact(a, b, matrix(gradient), None)
}

pub(super) fn contact(a: Rod, b: Rod, gradient: Matrix3<f64>, made: Option<Mistake>) -> Option<Contact> {
    let ([xa, pa, _], [xb, pb, _]) = (a, b);
    let line = Unit::try_new(pa.cross(&pb), 0.0)?.into_inner();
    // x_A + r_A p_A + c l = x_B + r_B p_B
    let system = Matrix3::from_columns(&[pa, -pb, line]);
    let solution = system.lu().solve(&(xb - xa))?;
    let arms = [solution[0], solution[1]];
    if arms.contains(&0.0) {
        return None;
    }
    let arms = either(made, Mistake::ArmsSwapped, [arms[1], arms[0]], arms);
    let [arm_a, arm_b] = either(made, Mistake::ArmUnsigned, arms.map(f64::abs), arms);
    // A.7
    let velocity = |[x, p, pdot]: Rod, arm: f64| {
        let omega = either(made, Mistake::SpinIgnored, Vector3::zeros(), p.cross(&pdot));
        gradient * x + omega.cross(&(p * arm))
    };
    // A.8
    let (velocity_a, velocity_b) = (velocity(a, arm_a), velocity(b, arm_b));
    let parallel_a = line * line.dot(&velocity_a);
    let parallel_b = line * line.dot(&velocity_b);
    // A.10
    let half = either(made, Mistake::SumInsteadOfMean, 1.0, 0.5);
    let mean = (parallel_a + parallel_b) * half;
    // A.9, A.11, A.12, and the division by the arm in A.13
    let pdot_after = |[x, p, _]: Rod, arm: f64, before: Vector3<f64>, parallel: Vector3<f64>| {
        let parallel_after = either(made, Mistake::KickSign, parallel * 2.0 - mean, mean);
        let after = (before - parallel) + parallel_after;
        let relative = either(made, Mistake::TranslationKept, after, after - gradient * x);
        let normal_to_rod = relative - p * p.dot(&relative);
        normal_to_rod / arm
    };
    Some(Contact {
        line: line.into(),
        arm_a_mm: arm_a,
        arm_b_mm: arm_b,
        gap_mm: solution[2],
        pdot_a_per_s: pdot_after(a, arm_a, velocity_a, parallel_a).into(),
        pdot_b_per_s: pdot_after(b, arm_b, velocity_b, parallel_b).into(),
    })
}
