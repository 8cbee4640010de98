//! Integrators of a free rod: the claims of `docs/src/verification/integrators.md`. Nothing here is timed.

use super::*;
use crate::methods::integrators::*;
use crate::studies::work_precision::order::{self, ORDER_TOLERANCE};
use nalgebra::Vector2;

/// A function that makes the integrators under test, for each check.
pub(super) type Integrators = fn() -> Vec<Integrator>;

pub fn cases() -> Vec<Case> {
    vec![
        Case::of(Judges::Integrator, "integrator-orders")
            .claim("The error of every fixed-step integrator falls with the order of its theory.")
            .source("A.2–A.5; Jeffery's equation in p")
            .under_test(crate::methods::integrators::own as Integrators)
            .mistake("a stage of RK4 at the wrong place", || {
                in_angles(4, |problem, y, h| {
                    let f = |y: Vector2<f64>| problem.angle_rates(&y);
                    let k1 = f(y);
                    let k2 = f(y + 0.5 * h * k1);
                    let k3 = f(y + 0.5 * h * k1);
                    let k4 = f(y + h * k3);
                    y + h / 6.0 * (k1 + 2.0 * (k2 + k3) + k4)
                })
            })
            .mistake("explicit Euler said to be of order 2", || {
                in_p(2, false, |problem, p, h| p + h * problem.rate(&p))
            })
            .mistake("RK4 on eq. A.2 with r_e for r_e²", || {
                in_angles(4, |problem, y, h| {
                    let wrong = RodProblem::new(problem.aspect_ratio.sqrt(), 1.0);
                    rk4(|y| wrong.angle_rates(&y), y, h)
                })
            })
            .mistake("an error that doubles whenever the step is halved", || {
                in_p(1, false, |problem, p, h| rk4(|y| problem.rate(&y), p, h) + Vector3::new(0.0, 0.0, 1e-9))
            })
            .check(orders),
        Case::of(Judges::Integrator, "integrator-lengths")
            .claim("Integrators that are said to keep |p| = 1 keep it to round-off at any step.")
            .source("A.1; p·ṗ = 0")
            .under_test(crate::methods::integrators::own as Integrators)
            .mistake("RK4 in p, not projected", || in_p(4, true, |problem, p, h| rk4(|y| problem.rate(&y), p, h)))
            .mistake("the implicit midpoint rule after two sweeps", || {
                in_p(2, true, |problem, p, h| {
                    let sweep = |m: Vector3<f64>| p + 0.5 * h * problem.tangent_rate(&m);
                    2.0 * sweep(sweep(p)) - p
                })
            })
            .check(lengths),
        Case::of(Judges::Integrator, "exact-propagator-round-off")
            .claim(
                "The exact propagator's error is round-off for r_e from 1.01 to 10⁶ and up to 10⁶ periods, \
                 during a flip.",
            )
            .source("eqs 20, A.4, A.5")
            .under_test((|| vec![exact_propagator()]) as Integrators)
            .mistake("whole turns are left in the phase", || vec![whole_turns()])
            .mistake("A.4 and A.5 in angles", || vec![closed_form()])
            .check(round_off),
        Case::of(Judges::Integrator, "adaptive-integrators")
            .claim(
                "At a tolerance of 10⁻¹¹ both adaptive integrators come as near as their steps, each off by \
                 the tolerance, allow.",
            )
            .source("A.4, A.5; Jeffery's equation in p")
            .under_test((|| vec![dormand_prince(), radau()]) as Integrators)
            .mistake("r_e 0.1 % too long", || {
                vec![spoiled(|problem| (RodProblem::new(1.001 * problem.aspect_ratio, problem.turns), 1.0))]
            })
            .mistake("a tolerance 10⁸ times as large", || vec![spoiled(|problem| (problem, 1e8))])
            .mistake("the last step is left out", || {
                vec![spoiled(|problem| (RodProblem::new(problem.aspect_ratio, 0.99 * problem.turns), 1.0))]
            })
            .check(adaptive),
    ]
}

fn orders(integrators: &Integrators, _: &Effort) -> Vec<Evidence> {
    let stepped = integrators().into_iter().filter(|integrator| matches!(integrator.theory, Theory::Order(_)));
    let judged = stepped.map(|integrator| {
        let off = [2.0, 11.6].map(|r| {
            let (problem, start) = RodProblem::mid_flip(r);
            let study = order::study(&integrator, &problem, &start, 8).expect("it has steps");
            // Fewer than two pairs above round-off show no order: it counts as 0.
            let theory = f64::from(study.theory);
            let enough = if study.judged.len() == 2 { 0.0 } else { theory };
            larger(enough, worst(study.judged.iter().map(|order| (order - theory).abs())))
        });
        let because = "the next power of Δt is a tenth or less of the leading one on the last two pairs above \
                       round-off";
        Evidence::on(format!("observed order against theory, {}", integrator.name), "–")
            .within(worst(off), ORDER_TOLERANCE)
            .because(because)
    });
    judged.collect()
}

fn lengths(integrators: &Integrators, _: &Effort) -> Vec<Evidence> {
    let (problem, start) = RodProblem::mid_flip(11.6);
    (integrators().into_iter())
        .filter(|integrator| integrator.keeps_length)
        .map(|integrator| {
            let (setting, steps) = match integrator.theory {
                Theory::Exact => (Setting::Once, 1),
                Theory::Order(_) => (Setting::Steps(1024), 1024),
                Theory::Adaptive => (Setting::Tolerance(1e-6), 1024),
            };
            let off = grade(&integrator, &problem, &start, setting).map_or(1.0, |e| e.length);
            Evidence::on(format!("|p| − 1 at the end, {}", integrator.name), "–")
                .within(off, 4.0 * f64::from(steps) * f64::EPSILON)
                .because("each step, of 1024 or of one, rounds |p| by four roundings at most")
        })
        .collect()
}

fn round_off(integrators: &Integrators, _: &Effort) -> Evidence {
    let runs = pairs([1.01, 2.0, 11.6, 100.0, 1e4, 1e6], [0.0, 16.0, 1e6]);
    let all = integrators();
    let errors = pairs(&all, runs).map(|(integrator, (r, whole))| {
        let (problem, start) = RodProblem::mid_flip(r);
        let later = RodProblem::new(r, problem.turns + whole);
        grade(integrator, &later, &start, Setting::Once).map_or(f64::NAN, |errors| errors.orientation_rad)
    });
    Evidence::on("largest angle to the closed form", "rad").within(worst(errors), 32.0 * f64::EPSILON).because(
        "near a whole turn the phase that is left is small, and its relative error ε moves φ by ε, \
         not by r_e ε; a few dozen roundings of the propagator and the closed form",
    )
}

/// r_e, and the steps that Dormand–Prince and Radau take at a tolerance of 10⁻¹¹ (52, 78, 122 and 327, 458, 689),
/// rounded up.
const STEPS: [(f64, [f64; 2]); 3] = [(1.5, [60.0, 330.0]), (3.0, [80.0, 460.0]), (11.6, [130.0, 700.0])];

fn adaptive(integrators: &Integrators, _: &Effort) -> Vec<Evidence> {
    let all = integrators();
    let judged = pairs(&all, STEPS).map(|(integrator, (r, steps))| {
        let steps = steps[usize::from(integrator.name == radau().name)];
        let (problem, start) = RodProblem::mid_flip(r);
        let error = grade(integrator, &problem, &start, Setting::Tolerance(1e-11));
        // An integrator that gives up is off by as much as can be.
        let error = error.map_or(FRAC_PI_2, |errors| errors.orientation_rad);
        let because = "each step is off by the tolerance, in a direction of its own; their sum is a phase, which \
                       r_e magnifies";
        Evidence::on(format!("angle to the closed form at a tolerance of 10⁻¹¹, r_e = {r}, {}", integrator.name), "rad")
            .within(error, steps * 1e-11 * r)
            .because(because)
    });
    judged.collect()
}

pub(super) fn in_angles(order: u32, step: fn(&RodProblem, Vector2<f64>, f64) -> Vector2<f64>) -> Vec<Integrator> {
    vec![Integrator::in_angles("in angles", order, step)]
}

pub(super) fn in_p(
    order: u32,
    keeps_length: bool,
    step: fn(&RodProblem, Vector3<f64>, f64) -> Vector3<f64>,
) -> Vec<Integrator> {
    let integrator = Integrator::in_p("in p", order, step);
    vec![if keeps_length { integrator.keeping_length() } else { integrator }]
}

/// The exact propagator without removal of whole periods from the phase.
pub(super) fn whole_turns() -> Integrator {
    Integrator::new("whole turns", Theory::Exact, |problem, p, _| {
        let (sin, cos) = (TAU * problem.turns).sin_cos();
        let r = problem.aspect_ratio;
        Ok(Vector3::new(p.x * cos - p.y / r * sin, r * p.x * sin + p.y * cos, p.z).normalize())
    })
}

/// Dormand–Prince applied to a changed problem, with a factor on its tolerance.
fn spoiled(change: fn(RodProblem) -> (RodProblem, f64)) -> Integrator {
    Integrator::new("spoiled", Theory::Adaptive, move |problem, start, setting| {
        let (problem, factor) = change(*problem);
        dormand_prince().advance(&problem, start, Setting::Tolerance(factor * setting.tolerance()?))
    })
}

pub(super) fn refuses() -> Integrator {
    Integrator::new("refuses", Theory::Exact, |_, _, _| Err(Failure::Gave("no".into())))
}
