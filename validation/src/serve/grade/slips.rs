//! Slips of Runge and Kutta's method of order 4, as codes have them: each converges, but not at order 4, so that its
//! order is refuted and no curve is wrong. What names a slip is its own steps, to rounding.

use super::answer::Answer;
use super::mistakes::Setting;
use super::nearness::{CURVE, Diagnosis, Near, largest_within, said};
use super::tensors;
use super::{Graded, Order};
use crate::judge::statistics::worst;
use crate::methods::integrators::apart_rad;
use crate::methods::stages::{FORMS, Form, Stages, Times, directions};
use crate::serve::problems::{Kind, LoadedProblem};
use nalgebra::Vector3;

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

/// The rows of an answer at the times, of which each has so many.
fn rows<'a>(times: &Times, answer: &'a Answer, each: usize, row: usize) -> impl Iterator<Item = &'a Vec<f64>> {
    times.at.iter().map(move |(place, _)| &answer.rows[place * each + row])
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
        let rows = rows(times, answer, count, rod).map(|row| Vector3::from_row_slice(row));
        worst(found.iter().zip(rows).map(|(due, found)| apart_rad(&found, due)))
    };
    FORMS.iter().find_map(|form| largest_within(most, (0..count).map(|rod| Some(of_rod(*form, rod)))))
}

/// The distance of an answer about tensors from these steps of the closed equation.
fn of_tensors(loaded: &LoadedProblem, times: &Times, stages: &Stages, answer: &Answer) -> Option<f64> {
    let states = |rate: &dyn Fn(_) -> _, start| times.tensors(stages, start, rate);
    let found = tensors::by_equation(&loaded.problem, states)?;
    Some(worst(found.iter().zip(rows(times, answer, 1, 0)).map(|(due, found)| crate::oracle::apart(found, due))))
}

#[cfg(test)]
mod tests;
