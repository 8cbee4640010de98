//! The type of all integrators, and how to make one from a step, a closed form or a library.

use super::{Failure, RodProblem, Setting, Theory};
use nalgebra::{SVector, UnitVector3, Vector2, Vector3};
use std::sync::Arc;

type Advance = dyn Fn(&RodProblem, &UnitVector3<f64>, Setting) -> Result<Vector3<f64>, Failure> + Send + Sync;
type AdvanceAll = dyn Fn(&RodProblem, &[UnitVector3<f64>], Setting) -> Result<Vec<Vector3<f64>>, Failure> + Send + Sync;

/// A method that turns a free rod.
pub struct Integrator {
    /// A short name.
    pub name: String,
    /// How the error should fall.
    pub theory: Theory,
    /// True if the method claims to keep |p| = 1.
    pub keeps_length: bool,
    advance: Box<Advance>,
    advance_all: Option<Box<AdvanceAll>>,
}

impl Integrator {
    /// An integrator from `advance`, which returns the direction at the end of a problem for a start. It does not claim
    /// to keep |p| = 1.
    pub fn new<F>(name: impl Into<String>, theory: Theory, advance: F) -> Self
    where
        F: Fn(&RodProblem, &UnitVector3<f64>, Setting) -> Result<Vector3<f64>, Failure> + Send + Sync + 'static,
    {
        let name = name.into();
        Self { name, theory, keeps_length: false, advance: Box::new(advance), advance_all: None }
    }

    /// An integrator of order `order` that steps p with equal steps: `step` returns p after a step of length h in 1/G,
    /// or NaN if the step fails.
    pub fn in_p(
        name: &str,
        order: u32,
        step: impl Fn(&RodProblem, Vector3<f64>, f64) -> Vector3<f64> + Send + Sync + 'static,
    ) -> Self {
        let step = Arc::new(step);
        let one = Arc::clone(&step);
        Self::new(name, Theory::Order(order), move |problem, start, setting| {
            last(problem, setting, start.into_inner(), &*one)
        })
        .with_many(move |problem, starts, setting| abreast(problem, setting, starts, &*step))
    }

    /// An integrator of order `order` that steps (φ, θ) in rad with equal steps of length h in 1/G. Angles have no
    /// length to lose.
    pub fn in_angles(
        name: &str,
        order: u32,
        step: impl Fn(&RodProblem, Vector2<f64>, f64) -> Vector2<f64> + Send + Sync + 'static,
    ) -> Self {
        Self::new(name, Theory::Order(order), move |problem, start, setting| {
            let first = Vector2::new(start.y.atan2(start.x), start.x.hypot(start.y).atan2(start.z));
            let angles = last(problem, setting, first, &step)?;
            let (sin_phi, cos_phi) = angles.x.sin_cos();
            let (sin_theta, cos_theta) = angles.y.sin_cos();
            Ok(Vector3::new(sin_theta * cos_phi, sin_theta * sin_phi, cos_theta))
        })
        .keeping_length()
    }

    /// The same integrator, with the claim to keep |p| = 1.
    pub fn keeping_length(self) -> Self {
        Self { keeps_length: true, ..self }
    }

    /// The same integrator with a way to turn many rods at once, so that a program in another process is called once.
    pub fn with_many(
        self,
        advance_all: impl Fn(&RodProblem, &[UnitVector3<f64>], Setting) -> Result<Vec<Vector3<f64>>, Failure>
        + Send
        + Sync
        + 'static,
    ) -> Self {
        Self { advance_all: Some(Box::new(advance_all)), ..self }
    }

    /// The direction at the end of `problem` of a rod that starts along `start`; its length is graded too.
    pub fn advance(
        &self,
        problem: &RodProblem,
        start: &UnitVector3<f64>,
        setting: Setting,
    ) -> Result<Vector3<f64>, Failure> {
        (self.advance)(problem, start, setting)
    }

    /// The directions at the end of `problem` of rods that start along `starts`.
    pub fn advance_all(
        &self,
        problem: &RodProblem,
        starts: &[UnitVector3<f64>],
        setting: Setting,
    ) -> Result<Vec<Vector3<f64>>, Failure> {
        match &self.advance_all {
            Some(advance_all) => advance_all(problem, starts, setting),
            None => starts.iter().map(|start| self.advance(problem, start, setting)).collect(),
        }
    }
}

/// Rods in p that take their steps abreast, so that the processor need not wait for one step to begin the next.
const ABREAST: usize = 8;

/// The states at the end of `problem`, by equal steps from `starts`; those that are not finite as they are.
fn abreast(
    problem: &RodProblem,
    setting: Setting,
    starts: &[UnitVector3<f64>],
    step: impl Fn(&RodProblem, Vector3<f64>, f64) -> Vector3<f64>,
) -> Result<Vec<Vector3<f64>>, Failure> {
    let steps = setting.steps()?;
    let h = problem.strain() / steps as f64;
    let mut rods: Vec<_> = starts.iter().map(|start| start.into_inner()).collect();
    for part in rods.chunks_mut(ABREAST) {
        for _ in 0..steps {
            part.iter_mut().for_each(|p| *p = step(problem, *p, h));
        }
    }
    if rods.iter().all(|p| p.sum().is_finite()) { Ok(rods) } else { Err(Failure::NotFinite) }
}

/// The state at the end of `problem`, by equal steps from `first`.
fn last<const N: usize>(
    problem: &RodProblem,
    setting: Setting,
    first: SVector<f64, N>,
    step: impl Fn(&RodProblem, SVector<f64, N>, f64) -> SVector<f64, N>,
) -> Result<SVector<f64, N>, Failure> {
    let steps = setting.steps()?;
    let h = problem.strain() / steps as f64;
    // Stops at the first state that is not finite.
    (0..steps)
        .try_fold(first, |state, _| Some(step(problem, state, h)).filter(|state| state.sum().is_finite()))
        .ok_or(Failure::NotFinite)
}
