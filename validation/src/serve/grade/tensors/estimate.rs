//! A number that is off by an unknown factor: C_I, or Λ.

use super::{Candidate, Known, Near, STEP, distance, near_of};
use crate::methods::tensors::Parts;
use crate::methods::tensors::wrong::{CLOSURES, shaped, spread};
use crate::serve::grade::answer::Answer;
use crate::serve::grade::estimate::digits;
use crate::serve::problems::Problem;
use rayon::prelude::*;

/// A quantity and the parts in which it is `factor` times what is asked.
pub(super) type Quantity = (&'static str, fn(Parts, f64) -> Option<Parts>);

pub(super) const QUANTITIES: [Quantity; 2] =
    [("C_I", spread), ("Λ", |parts, factor| Some(shaped(parts, factor * parts.of_strain)))];

/// The step of the slope, and the number of steps of Newton's method.
const SLOPE: f64 = 1e-6;
const STEPS: usize = 12;

/// The words for a quantity that is `factor` times what is asked, with as many digits as tell the factor from 1.
pub(super) fn words(quantity: &str, factor: f64) -> String {
    let words = format!("{quantity} times {}", digits(factor, 4));
    // Rounding one number to single precision changes it by half of this.
    if (factor - 1.0).abs() <= f64::from(f32::EPSILON) { format!("{words} (single precision?)") } else { words }
}

/// The curves of equations with another C_I or Λ, found at the first time, that fit at all times.
pub(super) fn of_curve(problem: &Problem, answer: &Answer, known: &Known, most: f64) -> Vec<Near> {
    let all: Vec<_> = QUANTITIES.iter().flat_map(|q| (0..CLOSURES.len()).map(move |closure| (q, closure))).collect();
    let fit = |((name, change), closure): &(&Quantity, usize)| {
        let name = if problem.d_r_per_s.is_some() { name.replace("C_I", "D_r") } else { (*name).to_owned() };
        let with = |factor: f64| Some(Candidate::new(change(known.parts, factor)?, CLOSURES[*closure], Vec::new()));
        let row = |factor: f64| with(factor)?.curve(problem, &known.start, 1, STEP)?.pop();
        let factor = newton(&answer.rows[0], row)?;
        let distance = distance(problem, &answer.rows, &known.start, &with(factor)?, most)?;
        Some(Near { distance, ..near_of(&words(&name, factor), "", *closure, known.own) })
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

#[test]
fn a_factor_has_the_digits_that_tell_it_from_1() {
    assert_eq!(words("C_I", 0.73), "C_I times 0.7300");
    assert_eq!(words("Λ", 1.000_012), "Λ times 1.0000120");
    assert_eq!(words("C_I", f64::from(0.01f32) / 0.01), "C_I times 0.9999999776 (single precision?)");
}
