//! Fixed-step methods from one function each: the step.

use super::{Failure, Integrator, Problem, Setting, Theory};
use nalgebra::{SVector, UnitVector3, Vector2, Vector3};

/// A method that steps p with equal steps. A step that cannot be taken gives NaN.
pub struct FixedStep<F> {
    /// Its name, in a few words.
    pub name: &'static str,
    /// p in error ∝ Δtᵖ.
    pub order: u32,
    /// Whether it is said to keep |p| = 1.
    pub keeps_length: bool,
    /// p after one step of length h in 1/G.
    pub step: F,
}

impl<F> Integrator for FixedStep<F>
where
    F: Fn(&Problem, Vector3<f64>, f64) -> Vector3<f64> + Send + Sync,
{
    fn name(&self) -> &str {
        self.name
    }

    fn theory(&self) -> Theory {
        Theory::Order(self.order)
    }

    fn keeps_length(&self) -> bool {
        self.keeps_length
    }

    fn advance(
        &self,
        problem: &Problem,
        start: &UnitVector3<f64>,
        setting: Setting,
    ) -> Result<Vector3<f64>, Failure> {
        last(problem, setting, start.into_inner(), &self.step)
    }
}

/// A method that steps (φ, θ) in rad with equal steps.
pub struct InAngles<F> {
    /// Its name, in a few words.
    pub name: &'static str,
    /// p in error ∝ Δtᵖ.
    pub order: u32,
    /// (φ, θ) after one step of length h in 1/G.
    pub step: F,
}

impl<F> Integrator for InAngles<F>
where
    F: Fn(&Problem, Vector2<f64>, f64) -> Vector2<f64> + Send + Sync,
{
    fn name(&self) -> &str {
        self.name
    }

    fn theory(&self) -> Theory {
        Theory::Order(self.order)
    }

    // There is no length to lose.
    fn keeps_length(&self) -> bool {
        true
    }

    fn advance(
        &self,
        problem: &Problem,
        start: &UnitVector3<f64>,
        setting: Setting,
    ) -> Result<Vector3<f64>, Failure> {
        let first = Vector2::new(start.y.atan2(start.x), start.x.hypot(start.y).atan2(start.z));
        let angles = last(problem, setting, first, &self.step)?;
        let (sin_phi, cos_phi) = angles.x.sin_cos();
        let (sin_theta, cos_theta) = angles.y.sin_cos();
        Ok(Vector3::new(sin_theta * cos_phi, sin_theta * sin_phi, cos_theta))
    }
}

/// The state at the end of `problem`, by equal steps from `first`.
fn last<const N: usize>(
    problem: &Problem,
    setting: Setting,
    first: SVector<f64, N>,
    step: impl Fn(&Problem, SVector<f64, N>, f64) -> SVector<f64, N>,
) -> Result<SVector<f64, N>, Failure> {
    let steps = setting.steps()?;
    let h = problem.strain() / steps as f64;
    // A rod that is lost stays lost: no more steps are spent on it.
    (0..steps)
        .try_fold(first, |state, _| Some(step(problem, state, h)).filter(|state| state.sum().is_finite()))
        .ok_or(Failure::NotFinite)
}
