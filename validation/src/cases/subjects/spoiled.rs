//! Integrators with a mistake, and subjects made from a step alone.

use crate::studies::integrators::*;
use nalgebra::{UnitVector3, Vector2, Vector3};
use std::f64::consts::TAU;

/// A method of this step in (φ, θ).
pub(in crate::cases) fn in_angles(
    order: u32,
    step: fn(&Problem, Vector2<f64>, f64) -> Vector2<f64>,
) -> Vec<Box<dyn Integrator>> {
    let name = "in angles";
    vec![Box::new(InAngles { name, order, step })]
}

/// A method of this step in p.
pub(in crate::cases) fn in_p(
    order: u32,
    keeps_length: bool,
    step: fn(&Problem, Vector3<f64>, f64) -> Vector3<f64>,
) -> Vec<Box<dyn Integrator>> {
    vec![Box::new(FixedStep { name: "in p", order, keeps_length, step })]
}

/// The exact propagator with the phase as it comes.
pub(in crate::cases) struct WholeTurns;

impl Integrator for WholeTurns {
    fn name(&self) -> &str {
        "whole turns"
    }

    fn theory(&self) -> Theory {
        Theory::Exact
    }

    fn advance(&self, problem: &Problem, p: &UnitVector3<f64>, _: Setting) -> Result<Vector3<f64>, Failure> {
        let (sin, cos) = (TAU * problem.turns).sin_cos();
        let r = problem.aspect_ratio;
        Ok(Vector3::new(p.x * cos - p.y / r * sin, r * p.x * sin + p.y * cos, p.z).normalize())
    }
}

/// Dormand–Prince on another problem, with another factor on its tolerance.
pub(in crate::cases) struct Spoiled(pub(super) fn(Problem) -> (Problem, f64));

impl Integrator for Spoiled {
    fn name(&self) -> &str {
        "spoiled"
    }

    fn theory(&self) -> Theory {
        Theory::Adaptive
    }

    fn advance(
        &self,
        problem: &Problem,
        start: &UnitVector3<f64>,
        setting: Setting,
    ) -> Result<Vector3<f64>, Failure> {
        let (problem, factor) = self.0(*problem);
        DormandPrince.advance(&problem, start, Setting::Tolerance(factor * setting.tolerance()?))
    }
}

/// Gives an error, whatever it is asked.
pub(in crate::cases) struct Refuses;

impl Integrator for Refuses {
    fn name(&self) -> &str {
        "refuses"
    }

    fn theory(&self) -> Theory {
        Theory::Exact
    }

    fn advance(&self, _: &Problem, _: &UnitVector3<f64>, _: Setting) -> Result<Vector3<f64>, Failure> {
        Err(Failure::Gave("no".into()))
    }
}
