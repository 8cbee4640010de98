//! Integrators with a mistake, and integrators from a step function alone.

use super::*;

pub(in crate::cases) fn in_angles(
    order: u32,
    step: fn(&RodProblem, Vector2<f64>, f64) -> Vector2<f64>,
) -> Vec<Integrator> {
    vec![Integrator::in_angles("in angles", order, step)]
}

pub(in crate::cases) fn in_p(
    order: u32,
    keeps_length: bool,
    step: fn(&RodProblem, Vector3<f64>, f64) -> Vector3<f64>,
) -> Vec<Integrator> {
    let integrator = Integrator::in_p("in p", order, step);
    vec![if keeps_length { integrator.keeping_length() } else { integrator }]
}

/// The exact propagator without removal of whole periods from the phase.
pub(in crate::cases) fn whole_turns() -> Integrator {
    Integrator::new("whole turns", Theory::Exact, |problem, p, _| {
        let (sin, cos) = (TAU * problem.turns).sin_cos();
        let r = problem.aspect_ratio;
        Ok(Vector3::new(p.x * cos - p.y / r * sin, r * p.x * sin + p.y * cos, p.z).normalize())
    })
}

/// Dormand–Prince applied to a changed problem, with a factor on its tolerance.
pub(super) fn spoiled(change: fn(RodProblem) -> (RodProblem, f64)) -> Integrator {
    Integrator::new("spoiled", Theory::Adaptive, move |problem, start, setting| {
        let (problem, factor) = change(*problem);
        dormand_prince().advance(&problem, start, Setting::Tolerance(factor * setting.tolerance()?))
    })
}

pub(in crate::cases) fn refuses() -> Integrator {
    Integrator::new("refuses", Theory::Exact, |_, _, _| Err(Failure::Gave("no".into())))
}
