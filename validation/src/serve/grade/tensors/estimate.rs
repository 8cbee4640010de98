//! A number that is off by an unknown factor: C_I, or Λ.

use super::{Candidate, Known, Near, STEP, distance, near_of};
use crate::methods::tensors::Parts;
use crate::methods::tensors::wrong::{CLOSURES, shaped, spread};
use crate::serve::grade::answer::Answer;
use crate::serve::problems::Problem;
use rayon::prelude::*;

/// A quantity and the parts in which it is `factor` times what is asked.
type Quantity = (&'static str, fn(Parts, f64) -> Option<Parts>);

const QUANTITIES: [Quantity; 2] =
    [("C_I", spread), ("Λ", |parts, factor| Some(shaped(parts, factor * parts.of_strain)))];

/// The step of the slope, and the number of steps of Newton's method.
const SLOPE: f64 = 1e-6;
const STEPS: usize = 12;

/// The words for a quantity that is `factor` times what is asked.
pub(super) fn words(quantity: &str, factor: f64) -> String {
    format!("{quantity} times {factor:.4}")
}

/// The curves of equations with another C_I or Λ, found at the first time, that fit at all times.
pub(super) fn of_curve(problem: &Problem, answer: &Answer, known: &Known, most: f64) -> Vec<Near> {
    let all: Vec<_> = QUANTITIES.iter().flat_map(|q| (0..CLOSURES.len()).map(move |closure| (q, closure))).collect();
    let fit = |((name, change), closure): &(&Quantity, usize)| {
        let name = if problem.d_r_per_s.is_some() { name.replace("C_I", "D_r") } else { (*name).to_owned() };
        let with = |factor: f64| {
            let near = near_of(&words(&name, factor), "", *closure, known.own);
            Some(Candidate::new(change(known.parts, factor)?, CLOSURES[*closure], vec![near]))
        };
        let row = |factor: f64| with(factor)?.curve(problem, &known.start, 1, STEP)?.pop();
        let mut candidate = with(newton(&answer.rows[0], row)?)?;
        let distance = distance(problem, &answer.rows, &known.start, &candidate, most)?;
        Some(Near { distance, ..candidate.near.remove(0) })
    };
    all.par_iter().filter_map(fit).collect()
}

/// The factor at which `row` is nearest to `found` by least squares, from 1.
fn newton(found: &[f64], row: impl Fn(f64) -> Option<Vec<f64>>) -> Option<f64> {
    let mut factor = 1.0;
    for _ in 0..STEPS {
        let here = row(factor)?;
        let there = row(factor + SLOPE)?;
        let slopes = there.iter().zip(&here).map(|(there, here)| (there - here) / SLOPE);
        let (mut along, mut square) = (0.0, 0.0);
        for (slope, (here, found)) in slopes.zip(here.iter().zip(found)) {
            along += slope * (found - here);
            square += slope * slope;
        }
        let step: f64 = along / square;
        factor = (factor + step.clamp(-0.5, 2.0)).clamp(-10.0, 1000.0);
        if !factor.is_finite() {
            return None;
        }
        if step.abs() < 1e-12 {
            break;
        }
    }
    Some(factor)
}
