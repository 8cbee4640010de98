//! Subjects that take no steps.

use super::{Failure, Problem, Setting, Subject, Theory};
use nalgebra::{UnitVector3, Vector3};
use shearbed::phase::Phase;
use shearbed::propagator::couette;
use shearbed::{jeffery, orientation};
use std::f64::consts::TAU;

/// The core's propagator: p = q/|q| with q linear in p(0).
pub struct ExactPropagator;

impl Subject for ExactPropagator {
    fn name(&self) -> &str {
        "exact propagator"
    }

    fn theory(&self) -> Theory {
        Theory::Exact
    }

    fn keeps_length(&self) -> bool {
        true
    }

    fn advance(
        &self,
        problem: &Problem,
        start: &UnitVector3<f64>,
        _: Setting,
    ) -> Result<Vector3<f64>, Failure> {
        let phase = Phase::of_turns(problem.turns);
        Ok(couette([start.x, start.y, start.z], problem.aspect_ratio, phase).into())
    }
}

/// A.4 for φ, then A.5 for θ, as the core has them.
pub struct ClosedForm;

impl Subject for ClosedForm {
    fn name(&self) -> &str {
        "A.4 and A.5 in angles"
    }

    fn theory(&self) -> Theory {
        Theory::Exact
    }

    fn keeps_length(&self) -> bool {
        true
    }

    fn advance(
        &self,
        problem: &Problem,
        start: &UnitVector3<f64>,
        _: Setting,
    ) -> Result<Vector3<f64>, Failure> {
        let r = problem.aspect_ratio;
        // A.5 gives θ up to π/2: of p and −p, the one in that half.
        let p = if start.z < 0.0 { -*start } else { *start };
        let before = (p.y / r).atan2(p.x) / TAU;
        let phi = jeffery::phi_rad(r, before + problem.turns);
        let theta = jeffery::theta_rad(orientation::orbit_constant(&p, r), r, phi);
        Ok(orientation::from_angles(phi, theta).into_inner())
    }
}
