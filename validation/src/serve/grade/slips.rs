//! Slips of Runge and Kutta's method of order 4, as codes have them: each converges, but not at order 4, so that its
//! order is refuted and no curve is wrong. What names a slip is its own steps, to rounding.

use super::answer::Answer;
use super::mistakes::{Setting, angles_of, by_angles};
use super::nearness::{CURVE, Diagnosis, Near, largest_within, said};
use super::tensors;
use super::{Graded, Order};
use crate::judge::statistics::worst;
use crate::methods::integrators::apart_rad;
use crate::serve::problems::{Kind, LoadedProblem};
use nalgebra::{Matrix3, Vector3};
use std::ops::{Add, Mul};

/// A method of four stages: the factors of h before k1 to k3 in the arguments of k2 to k4, and those in the step.
type Stages = ([[f64; 3]; 3], [f64; 4]);

const THIRD: f64 = 1.0 / 3.0;
const SIXTH: f64 = 1.0 / 6.0;
const RIGHT: Stages = ([[0.5, 0.0, 0.0], [0.0, 0.5, 0.0], [0.0, 0.0, 1.0]], [SIXTH, THIRD, THIRD, SIXTH]);

const fn second(row: [f64; 3]) -> Stages {
    ([row, RIGHT.0[1], RIGHT.0[2]], RIGHT.1)
}

const fn third(row: [f64; 3]) -> Stages {
    ([RIGHT.0[0], row, RIGHT.0[2]], RIGHT.1)
}

const fn fourth(row: [f64; 3]) -> Stages {
    ([RIGHT.0[0], RIGHT.0[1], row], RIGHT.1)
}

const fn weighted(weights: [f64; 4]) -> Stages {
    (RIGHT.0, weights)
}

/// What a code does, and its stages.
const SLIPS: [(&str, Stages); 29] = [
    ("RK4 with k2 a whole step ahead, not half", second([1.0, 0.0, 0.0])),
    ("RK4 with k2 = k1", second([0.0; 3])),
    ("RK4 with k3 a whole step ahead, not half", third([0.0, 1.0, 0.0])),
    ("RK4 with k3 from k1, not k2", third([0.5, 0.0, 0.0])),
    ("RK4 with k3 = k1", third([0.0; 3])),
    ("RK4 with k4 half a step ahead, not a whole one", fourth([0.0, 0.0, 0.5])),
    ("RK4 with k4 from k2, not k3", fourth([0.0, 1.0, 0.0])),
    ("RK4 with k4 from k1, not k3", fourth([1.0, 0.0, 0.0])),
    ("RK4 with k4 = k1, or with k1 twice and no k4", fourth([0.0; 3])),
    ("RK4 with k2 and k3 a whole step ahead", ([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], RIGHT.1)),
    ("RK4 with the weights 1, 1, 1, 1", weighted([0.25; 4])),
    ("RK4 with the weights 1, 2, 1, 2", weighted([SIXTH, THIRD, SIXTH, THIRD])),
    ("RK4 with the weights 2, 1, 1, 2", weighted([THIRD, SIXTH, SIXTH, THIRD])),
    ("RK4 with the weights 2, 1, 2, 1", weighted([THIRD, SIXTH, THIRD, SIXTH])),
    ("RK4 with the weights 1, 3, 3, 1", weighted([0.125, 0.375, 0.375, 0.125])),
    ("RK4 with the weights 1, 1, 2, 2", weighted([SIXTH, SIXTH, THIRD, THIRD])),
    ("RK4 with the weights 1, 0, 4, 1", weighted([SIXTH, 0.0, 4.0 * SIXTH, SIXTH])),
    ("RK4 with k3 for k4 in the sum", weighted([SIXTH, THIRD, 3.0 * SIXTH, 0.0])),
    ("RK4 with k4 alone in the sum", weighted([0.0, 0.0, 0.0, 1.0])),
    ("RK4 with each stage from the one before", ([[0.5, 0.0, 0.0], [0.5, 0.5, 0.0], [0.5, 0.5, 1.0]], RIGHT.1)),
    ("RK4 with k2 a third of a step ahead", second([THIRD, 0.0, 0.0])),
    ("RK4 with the stages of the 3/8 rule", ([[THIRD, 0.0, 0.0], [-THIRD, 1.0, 0.0], [1.0, -1.0, 1.0]], RIGHT.1)),
    ("RK4 with k2 twice and k3 not at all", weighted([SIXTH, 2.0 * THIRD, 0.0, SIXTH])),
    ("Kutta's method of order 3", ([[0.5, 0.0, 0.0], [-1.0, 2.0, 0.0], [0.0; 3]], [SIXTH, 4.0 * SIXTH, SIXTH, 0.0])),
    ("Heun's method of order 3", ([[THIRD, 0.0, 0.0], [0.0, 2.0 * THIRD, 0.0], [0.0; 3]], [0.25, 0.0, 0.75, 0.0])),
    ("SSPRK3", ([[1.0, 0.0, 0.0], [0.25, 0.25, 0.0], [0.0; 3]], [SIXTH, SIXTH, 4.0 * SIXTH, 0.0])),
    ("Euler's method", weighted([1.0, 0.0, 0.0, 0.0])),
    ("the midpoint method", weighted([0.0, 1.0, 0.0, 0.0])),
    ("Heun's method of order 2", ([[1.0, 0.0, 0.0], [0.0; 3], [0.0; 3]], [0.5, 0.5, 0.0, 0.0])),
];

/// An answer is compared whose error is neither rounding nor that of steps that miss the motion: from so many
/// tolerances up to so much in rad or in a component, by at most so many steps.
const ROUNDING: f64 = 100.0;
const MISSED: f64 = 0.05;
const MOST: u64 = 4096;

/// The largest distance of an answer from the steps that it is made of, which round otherwise: this, and a share of its
/// error.
const EQUAL: f64 = 1e-12;
const SHARE: f64 = 1e-6;

/// Below this order a method that claims none may be RK4 with a slip.
const LOW: f64 = 3.5;

/// Sets the slip by whose steps one of the `answers` (steps, error, answer) comes as the diagnosis, if there is no
/// other and the claimed order is refuted. Without a claim a method of lower order is right, and is not named.
pub(super) fn name<'a>(
    graded: &mut Graded,
    loaded: &LoadedProblem,
    claimed: Option<f64>,
    answers: impl Iterator<Item = (u64, f64, &'a Answer)>,
) {
    let low = match claimed {
        Some(_) => graded.order_found == Some(Order::Lower),
        None => graded.observed_order.is_some_and(|order| order < LOW),
    };
    if !low || graded.diagnosis.is_some() {
        return;
    }
    let found = diagnose(loaded, answers);
    if claimed.is_some() || found.suspects.iter().all(|name| name.starts_with("RK4")) {
        (graded.diagnosis, graded.suspects) = (found.said, found.suspects);
    }
}

fn diagnose<'a>(loaded: &LoadedProblem, mut answers: impl Iterator<Item = (u64, f64, &'a Answer)>) -> Diagnosis {
    let of = &loaded.problem;
    let shows = |error: f64| ROUNDING * loaded.own_tolerance < error && error < MISSED;
    let Some((steps, error, answer)) = answers.find(|(steps, error, _)| shows(*error) && *steps <= MOST) else {
        return Diagnosis::default();
    };
    let most = EQUAL + SHARE * error;
    let times = Times::new(&of.times_s, steps);
    let near = SLIPS.iter().filter_map(|(name, stages)| {
        let distance = match of.kind {
            Kind::Rods => of_rods(loaded, &times, stages, answer, most)?,
            _ => of_tensors(loaded, &times, stages, answer)?,
        };
        (distance <= most).then(|| Near::new(distance, name))
    });
    said(CURVE, near.collect(), most, &format!(" by {steps} steps"))
}

/// The times of a problem that lie after whole numbers of equal steps, of which the last is one.
struct Times {
    /// The length of a step, s.
    step_s: f64,
    /// The place of each time among all, and the number of steps until it.
    at: Vec<(usize, u64)>,
}

impl Times {
    fn new(times_s: &[f64], steps: u64) -> Self {
        let step_s = times_s.iter().fold(0.0, |a: f64, b| a.max(*b)) / steps as f64;
        let count = |(place, time_s): (usize, &f64)| {
            let count = (time_s / step_s).round();
            ((time_s / step_s - count).abs() < 1e-6).then_some((place, count as u64))
        };
        Self { step_s, at: times_s.iter().enumerate().filter_map(count).collect() }
    }

    /// The states at the times, by equal steps with these stages.
    fn states<V: Copy + Add<Output = V> + Mul<f64, Output = V>>(
        &self,
        (rows, weights): &Stages,
        start: V,
        rate: &dyn Fn(V) -> V,
        ended: &dyn Fn(V) -> V,
    ) -> Vec<V> {
        let h = self.step_s;
        let mut state = start;
        let mut found = Vec::with_capacity(self.at.len());
        for step in 0..self.at.last().map_or(0, |(_, count)| *count) {
            let mut k = [rate(state); 4];
            for (stage, row) in rows.iter().enumerate() {
                k[stage + 1] = rate(state + (k[0] * row[0] + k[1] * row[1] + k[2] * row[2]) * h);
            }
            state = ended(state + (k[0] * weights[0] + k[1] * weights[1] + k[2] * weights[2] + k[3] * weights[3]) * h);
            found.extend(self.at.iter().filter(|(_, count)| *count == step + 1).map(|_| state));
        }
        found
    }

    /// The rows of an answer at the times, of which each has so many.
    fn rows<'a>(&self, answer: &'a Answer, each: usize, row: usize) -> impl Iterator<Item = &'a Vec<f64>> {
        self.at.iter().map(move |(place, _)| &answer.rows[place * each + row])
    }
}

/// The variable in which a code turns a rod.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Form {
    /// p.
    Raw,
    /// p, divided by |p| after each step.
    Normalised,
    /// q with q̇ = Aq.
    Linear,
    /// φ and θ, and 0.
    Angles,
}

const FORMS: [Form; 4] = [Form::Raw, Form::Normalised, Form::Linear, Form::Angles];

/// The directions of a rod at the times, which turns by ṗ = Ap − p(p·Ap).
fn directions(form: Form, a: &Matrix3<f64>, stages: &Stages, times: &Times, start: Vector3<f64>) -> Vec<Vector3<f64>> {
    let rate = |state: Vector3<f64>| match form {
        Form::Linear => a * state,
        Form::Angles => {
            let ((sin, cos), (sin_phi, cos_phi)) = (state.y.sin_cos(), state.x.sin_cos());
            let pull = a * by_angles([state.x, state.y]);
            let phi = Vector3::new(-sin_phi, cos_phi, 0.0);
            let theta = Vector3::new(cos * cos_phi, cos * sin_phi, -sin);
            Vector3::new(phi.dot(&pull) / sin, theta.dot(&pull), 0.0)
        }
        Form::Raw | Form::Normalised => {
            let pull = a * state;
            pull - state * state.dot(&pull)
        }
    };
    let ended = |state: Vector3<f64>| if form == Form::Normalised { state.normalize() } else { state };
    if form != Form::Angles {
        return times.states(stages, start, &rate, &ended);
    }
    let [phi, theta] = angles_of(&start);
    let found = times.states(stages, Vector3::new(phi, theta, 0.0), &rate, &ended);
    found.iter().map(|state| by_angles([state.x, state.y])).collect()
}

/// The distance in rad of an answer about rods from these steps in one of the variables; none if it exceeds `most`.
fn of_rods(loaded: &LoadedProblem, times: &Times, stages: &Stages, answer: &Answer, most: f64) -> Option<f64> {
    let setting = Setting::from(&loaded.problem);
    if loaded.problem.rotation_rad_per_s.is_some() {
        return None;
    }
    let a = setting.rates_per_s();
    let count = loaded.start.len();
    let of_rod = |form: Form, rod: usize| {
        let found = directions(form, &a, stages, times, loaded.start[rod].into());
        let rows = times.rows(answer, count, rod).map(|row| Vector3::from_row_slice(row));
        worst(found.iter().zip(rows).map(|(due, found)| apart_rad(&found, due)))
    };
    FORMS.iter().find_map(|form| largest_within(most, (0..count).map(|rod| Some(of_rod(*form, rod)))))
}

/// The distance of an answer about tensors from these steps of the closed equation.
fn of_tensors(loaded: &LoadedProblem, times: &Times, stages: &Stages, answer: &Answer) -> Option<f64> {
    let states = |rate: &dyn Fn(Matrix3<f64>) -> Matrix3<f64>, start| times.states(stages, start, rate, &|a| a);
    let rows = tensors::by_equation(&loaded.problem, states)?;
    Some(worst(rows.iter().zip(times.rows(answer, 1, 0)).map(|(due, found)| crate::oracle::apart(found, due))))
}

#[cfg(test)]
mod tests;
