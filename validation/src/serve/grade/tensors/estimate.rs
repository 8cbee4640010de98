//! A number that is off by an unknown factor: C_I, Λ, or time.

use super::formulas::{along, with_numbers};
use super::{Candidate, Known, Near, OFF, ROUGH, STEP, apart, distance, near_of};
use crate::methods::tensors::wrong::closures::{CLOSURES, WITH_OTHERS, numbered};
use crate::methods::tensors::wrong::{drifting, is_isotropic, scaled, shaped, slowed, spread, with};
use crate::methods::tensors::{Closure, Model, Parts};
use crate::serve::grade::answer::Answer;
use crate::serve::grade::diagnosis::{STEPS_OFF, step_off};
use crate::serve::grade::digits::printed;
use crate::serve::grade::estimate::{MOST, digits};
use crate::serve::problems::Problem;
use nalgebra::DVector;
use rayon::prelude::*;

/// A quantity and the parts in which it is `factor` times what is asked.
pub(super) type Quantity = (&'static str, fn(Parts, f64) -> Option<Parts>);

const QUANTITIES: [Quantity; 25] = [
    ("C_I", spread),
    ("Λ", |parts, factor| Some(shaped(parts, factor * parts.of_strain))),
    (TIME, |parts, factor| Some(scaled(parts, factor, factor, factor))),
    ("W", |parts, factor| Some(scaled(parts, factor, 1.0, 1.0))),
    ("D", |parts, factor| Some(scaled(parts, 1.0, factor, 1.0))),
    ("Wa", |parts, factor| Some(Parts { spun: [factor, -1.0], ..parts })),
    ("aW", |parts, factor| Some(Parts { spun: [1.0, -factor], ..parts })),
    ("Da", |parts, factor| Some(Parts { stretched: [factor, 1.0], ..parts })),
    ("aD", |parts, factor| Some(Parts { stretched: [1.0, factor], ..parts })),
    ("Da + aD", |parts, factor| Some(Parts { of_strain: factor * parts.of_strain, ..parts })),
    ("𝔸:D", |parts, factor| Some(Parts { of_fourth: factor * parts.of_fourth, ..parts })),
    ("the 3 of δ − 3a", |parts, factor| is_isotropic(&parts).then_some(Parts { decay: 3.0 * factor, ..parts })),
    ("5(Ca + aC)", |parts, factor| drifting(parts, [5.0 * factor, 10.0])),
    ("10𝔸:C", |parts, factor| drifting(parts, [5.0, 10.0 * factor])),
    ("κ", |parts, factor| slowed(parts, |kappas| kappas.map(|kappa| factor * kappa))),
    ("C_M", |parts, factor| with(parts, "C_M", |x| factor * x)),
    ("Ω", |parts, factor| with(parts, "Ω", |x| factor * x)),
    ("D1", |parts, factor| with(parts, "D1", |x| factor * x)),
    ("D2", |parts, factor| with(parts, "D2", |x| factor * x)),
    ("D3", |parts, factor| with(parts, "D3", |x| factor * x)),
    ("b1", |parts, factor| with(parts, "b1", |x| factor * x)),
    ("b2", |parts, factor| with(parts, "b2", |x| factor * x)),
    ("b3", |parts, factor| with(parts, "b3", |x| factor * x)),
    ("b4", |parts, factor| with(parts, "b4", |x| factor * x)),
    ("b5", |parts, factor| with(parts, "b5", |x| factor * x)),
];

/// The number of quantities that are sought with every closure; those after them only with the right one.
const WITH_CLOSURES: usize = 3;

/// Each quantity with the closures with which it is sought.
pub(super) fn tried(own: Option<usize>) -> impl Iterator<Item = (&'static Quantity, usize)> {
    QUANTITIES.iter().enumerate().flat_map(move |(n, quantity)| {
        (0..WITH_OTHERS).filter(move |k| n < WITH_CLOSURES || own == Some(*k)).map(move |k| (quantity, k))
    })
}

const TIME: &str = "every rate (or time, or the sum of a method's weights)";

/// The step of the slope, that of a rough one, and the number of steps of Newton's method.
const SLOPE: f64 = 1e-6;
const ROUGH_SLOPE: f64 = 1e-2;
const STEPS: usize = 12;

/// The least cosine between a change and the change with a small part of what makes it.
const ALIKE: f64 = 0.5;

/// The words for a quantity that is `factor` times what is asked, with as many digits as tell the factor from 1.
fn words(quantity: &str, factor: f64) -> String {
    // What is left of a term that is left out is rounding.
    let factor = if factor.abs() < 1e-12 { 0.0 } else { factor };
    let words = format!("{quantity} times {}", digits(factor, 4));
    // Rounding one number to single precision changes it by half of this.
    if (factor - 1.0).abs() <= f64::from(f32::EPSILON) { format!("{words} (single precision?)") } else { words }
}

/// A quantity that is `factor` times what is asked, with the value of C_I in the name: other problems share the factor.
pub(super) fn near(quantity: &str, factor: f64, model: Model, closure: usize, own: Option<usize>) -> Near {
    let words = words(quantity, factor);
    let c_i = match model {
        Model::PhelpsTucker { .. } => None,
        model => model.parameters().first().copied().filter(|_| quantity == "C_I"),
    };
    let mut near = near_of(&words, "", closure, own);
    if let Some(c_i) = c_i {
        let value = factor * c_i;
        near.name = near.name.replacen(&words, &format!("{words} ({value:.4} for {c_i})"), 1);
        // One number in every problem, to the digits that a code has it with.
        near.suspects.push(format!("C_I = {} in every problem", format!("{value:.6e}").parse().unwrap_or(value)));
    }
    near
}

/// The curves of equations with another C_I or Λ, found at the first time, that fit at all times.
pub(super) fn of_curve(problem: &Problem, answer: &Answer, known: &Known, steps: Option<u64>, most: f64) -> Vec<Near> {
    let (first, others): (Vec<_>, Vec<_>) = tried(known.own).partition(|(_, closure)| known.own == Some(*closure));
    let fit = |((name, change), closure): &(&Quantity, usize)| {
        let name = if problem.d_r_per_s.is_some() { name.replace("C_I", "D_r") } else { (*name).to_owned() };
        let with = |factor: f64| Some(Candidate::new(change(known.parts, factor)?, &CLOSURES[*closure], Vec::new()));
        let row = |factor: f64| with(factor)?.curve(problem, &known.start, 1, STEP)?.pop();
        // At higher rates any steady state is reached, and no code has a larger Λ by mistake.
        let factor =
            newton(&answer.rows[0], [1.0, SLOPE], row).filter(|factor| name == "C_I" || factor.abs() <= MOST)?;
        let apart = |factor: f64| distance(problem, &answer.rows, &known.start, &with(factor)?, most);
        // An answer of few steps fits a round number less well than another, but well enough.
        let round = [1, 2].map(|digits| printed(factor, digits)).into_iter();
        let mut round = round.filter(|round| *round != 1.0 && (round / factor - 1.0).abs() < 0.02);
        let factor = round.find(|round| apart(*round).is_some()).unwrap_or(factor);
        let distance = apart(factor)?;
        let of_step = steps.filter(|_| name == TIME).and_then(|steps| step_off(factor, steps));
        let near = match of_step {
            Some(name) => near_of(name, "", *closure, known.own),
            None => near(&name, factor, known.parts.model, *closure, known.own),
        };
        Some(Near { distance, ..near })
    };
    // Another closure is sought only where a number of the right equation explains nothing, which saves time.
    let near: Vec<_> = first.par_iter().filter_map(fit).collect();
    if near.is_empty() { others.par_iter().filter_map(fit).collect() } else { near }
}

/// The right curve at the times one step before or after those asked for, where the answer is that: every time is
/// late, as with a result that is written before its step.
pub(super) fn a_step_off(problem: &Problem, answer: &Answer, known: &Known, steps: u64, most: f64) -> Option<Near> {
    let step_s = problem.times_s.last()? / steps as f64;
    let of = |(name, off_s): (&str, f64)| {
        let times_s = problem.times_s.iter().map(|time_s| time_s + off_s).collect();
        let other = Problem { times_s, ..problem.clone() };
        Some(Near::new(distance(&other, &answer.rows, &known.start, &known.right()?, most)?, name))
    };
    STEPS_OFF.into_iter().zip([-step_s, step_s]).find_map(of)
}

/// The curves of the closure that is asked for with one wrong number in it, found at the first time, that fit at all
/// times.
pub(super) fn of_numbers(problem: &Problem, answer: &Answer, known: &Known, most: f64) -> Vec<Near> {
    let Some(closure) = known.own.map(|own| Closure::ALL[own]) else { return Vec::new() };
    let numbered = numbered(closure);
    let right = known.right().and_then(|right| right.curve(problem, &known.start, 1, ROUGH)?.pop());
    let Some(right_row) = right else { return Vec::new() };
    let off = DVector::from_vec(answer.rows[0].iter().zip(&right_row).map(|(found, due)| found - due).collect());
    let fit = |(k, (_, right)): (usize, &(String, f64))| {
        // A number that is 0 has no factor.
        let value = |factor: f64| right + (factor - 1.0) * right.abs().max(1.0);
        let stand = |factor: f64| numbered.stand(closure, k, value(factor));
        let row =
            |tolerance: f64, factor: f64| known.with(&stand(factor)).curve(problem, &known.start, 1, tolerance)?.pop();
        // Saves time: most numbers explain nothing at the first time already, and most not even its direction.
        let moved = row(ROUGH, 1.0 + ROUGH_SLOPE)?.iter().zip(&right_row).map(|(there, here)| there - here).collect();
        let moved: DVector<f64> = DVector::from_vec(moved);
        if moved.dot(&off).abs() < ALIKE * moved.norm() * off.norm() {
            return None;
        }
        let rough = newton(&answer.rows[0], [1.0, ROUGH_SLOPE], |factor| row(ROUGH, factor))?;
        let left = apart(&answer.rows[..1], &[row(ROUGH, rough)?]);
        let factor = (left <= OFF).then(|| newton(&answer.rows[0], [rough, SLOPE], |factor| row(STEP, factor)))??;
        let distance = distance(problem, &answer.rows, &known.start, &known.with(&stand(factor)), most)?;
        Some(Near::new(distance, &with_numbers(closure, &numbered, &[(k, value(factor))])))
    };
    let numbers: Vec<_> = numbered.numbers.iter().enumerate().collect();
    numbers.into_par_iter().filter_map(fit).collect()
}

/// The factor at which `row` is nearest to `found` by least squares, from a first one, by slopes over a step.
fn newton(found: &[f64], [first, slope]: [f64; 2], row: impl Fn(f64) -> Option<Vec<f64>>) -> Option<f64> {
    let mut factor = first;
    for _ in 0..STEPS {
        let here = row(factor)?;
        let there = row(factor + slope)?;
        let step = slope * along(&here, &there, found)?;
        factor = (factor + step.clamp(-0.5, 2.0)).clamp(-10.0, 1000.0);
        if !factor.is_finite() {
            return None;
        }
        if step.abs() < 1e-6 * slope {
            break;
        }
    }
    Some(factor)
}

/// A right code that is a step behind everywhere, one whose steps are too short by one in N, and one that has too many.
#[test]
fn a_step_too_few_or_too_many_is_named() {
    use crate::serve::grade::diagnosis::diagnose;
    use crate::serve::problems::loaded;
    let whole = loaded("closed-ft-quadratic-0.01");
    let known = super::known(&whole.problem).unwrap();
    let curve = |of: &dyn Fn(f64) -> f64| {
        let times_s = whole.problem.times_s.iter().map(|time_s| of(*time_s)).collect();
        let problem = Problem { times_s, ..whole.problem.clone() };
        let rows = known.right().unwrap().curve(&problem, &known.start, problem.times_s.len(), STEP).unwrap();
        Answer { rows, ..Answer::certified(&whole) }
    };
    let end_s = whole.problem.times_s.last().unwrap();
    let said = |answer| diagnose(&whole, &answer, 1e-3, Some(160)).said.unwrap_or_default();
    let behind = said(curve(&|time_s| time_s - end_s / 160.0));
    let few = [said(curve(&|time_s| time_s * 159.0 / 160.0)), said(curve(&|time_s| time_s * 160.0 / 161.0))];
    let many = said(curve(&|time_s| time_s * 160.0 / 159.0));
    assert!([&behind, &few[0], &few[1]].iter().all(|said| said.contains(STEPS_OFF[0])), "{behind} {few:?}");
    assert!(many.contains(STEPS_OFF[1]), "{many}");
    // Another share of a step is a rate and nothing else.
    let half = said(curve(&|time_s| time_s * 159.5 / 160.0));
    assert!(half.contains("weights) times 0.99687,"), "{half}");
}

#[test]
fn a_factor_has_the_digits_that_tell_it_from_1() {
    assert_eq!(words("C_I", 0.73), "C_I times 0.7300");
    assert_eq!(words("Λ", 1.000_012), "Λ times 1.0000120");
    assert_eq!(words("C_I", f64::from(0.01f32) / 0.01), "C_I times 0.9999999776 (single precision?)");
    let near = near("C_I", 0.73, Model::FolgarTucker { c_i: 0.1 }, 1, Some(0));
    assert_eq!(near.name, "C_I times 0.7300 (0.0730 for 0.1), with the quadratic closure");
    assert_eq!(near.suspects, ["C_I times 0.7300", "C_I = 0.073 in every problem"]);
}

/// Any number of a closure, in any problem with it; two wrong numbers have no name.
#[test]
fn a_wrong_number_in_a_closure_is_named_by_its_curve() {
    use crate::serve::grade::diagnosis::diagnose;
    use crate::serve::problems::loaded;
    let said = |name: &str, others: &[(usize, f64)]| {
        let whole = loaded(name);
        let known = super::known(&whole.problem).unwrap();
        let closure = Closure::ALL[known.own.unwrap()];
        let numbered = numbered(closure);
        let others: Vec<_> = others.iter().map(|(k, factor)| (*k, factor * numbered.numbers[*k].1)).collect();
        let fourth = |a: &nalgebra::Matrix3<f64>| numbered.fourth(&others, a);
        let rate = |_: f64, a: &nalgebra::Matrix3<f64>| known.parts.rate(a, &fourth(a));
        let all = crate::methods::tensors::at_rate(&rate, &known.start, &whole.problem.times_s, STEP).unwrap();
        let rows =
            all.iter().map(|a| super::values(&whole.problem, &CLOSURES[known.own.unwrap()], a).unwrap()).collect();
        diagnose(&whole, &Answer { rows, ..Answer::certified(&whole) }, 1e-3, None).said.unwrap_or_default()
    };
    for (name, others, words) in [
        ("closed-ft-hybrid-0.01", (13, 20.0 / 27.0), "the hybrid closure with -20 for -27 before det a in f"),
        ("closed-ft-ore-0.01", (5, 0.9), "the ORE closure with 3.46 for 3.845 before "),
        ("closed-ft-ibof-0.01", (9, 1.02), "the IBOF closure with "),
    ] {
        let found = said(name, &[others]);
        assert!(found.starts_with(&format!("this is the curve of {words}")), "{name}: {found}");
    }
    assert_eq!(said("closed-ft-hybrid-0.01", &[(12, 0.9), (13, 0.7), (3, 1.3)]), "");
}
