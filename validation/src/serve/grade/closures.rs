//! Diagnosis of answers about rods with diffusion: the closure from which an answer comes.

use super::answer::Answer;
use super::nearness::{Diagnosis, NEARER};
use crate::methods::tensors::fourth::PAIRS;
use crate::methods::tensors::{Closure, Equation, Model, at, isotropic, steady};
use crate::oracle::diffusion::{self, Motion, Start};
use crate::serve::problems::{Closed, LoadedProblem, Problem};
use nalgebra::Matrix3;
use rayon::prelude::*;

/// An equation that may have produced the answer.
struct Candidate {
    /// The name, to stand after "this is the curve of".
    name: String,
    equation: Equation,
    start: Matrix3<f64>,
}

/// Factors on C_I, with the words for each.
const FACTORS: [(f64, &str); 4] = [
    (1.0, ""),
    (std::f64::consts::FRAC_1_SQRT_2, ", with γ̇ = (D:D)^½"),
    (0.5, ", with half the C_I"),
    (2.0, ", with twice the C_I"),
];

fn candidates(problem: &Problem) -> Vec<Candidate> {
    let closed = match (&problem.closed, problem.c_i) {
        (Some(closed), _) => *closed,
        (None, Some(c_i)) => Closed {
            closure: Closure::Quadratic,
            model: Model::FolgarTucker { c_i },
            start: isotropic().transpose().into(),
        },
        (None, None) => return Vec::new(),
    };
    let right = closed.equation(&problem.gradient_per_s, problem.aspect_ratio);
    let of = |closure: Closure, (factor, words): (f64, &str)| {
        let model = match (closed.model, factor == 1.0) {
            (model, true) => model,
            (Model::FolgarTucker { c_i }, false) => Model::FolgarTucker { c_i: c_i * factor },
            _ => return None,
        };
        let name = format!("the {} closure{words}", closure.name());
        Some(Candidate { name, equation: Equation { closure, model, ..right }, start: closed.start() })
    };
    Closure::ALL.into_iter().flat_map(|closure| FACTORS.into_iter().filter_map(move |off| of(closure, off))).collect()
}

/// The values of the problem's columns for a, with the fourth moments by the closure; `None` for other columns.
fn values(problem: &Problem, closure: Closure, a: &Matrix3<f64>) -> Option<Vec<f64>> {
    let fourth = closure.fourth(a);
    let value = |name: &String| {
        let digits: Vec<_> = name.strip_prefix('a')?.bytes().map(|digit| usize::from(digit - b'1')).collect();
        match digits[..] {
            [i, j] => Some(a[(i, j)]),
            [i, j, k, l] => Some(fourth.at(i, j, k, l)),
            _ => None,
        }
    };
    problem.columns[1..].iter().map(value).collect()
}

fn apart(found: &[f64], expected: &[f64]) -> f64 {
    let each = found.iter().zip(expected).map(|(a, b)| (a - b).abs());
    each.fold(0.0, |a: f64, b| if b.is_nan() { f64::INFINITY } else { a.max(b) })
}

/// The distance of an answer from a candidate's curve; `None` if it is larger than `most`.
fn distance(problem: &Problem, answer: &Answer, candidate: &Candidate, most: f64) -> Option<f64> {
    let Candidate { equation, start, .. } = candidate;
    let norm = equation.gradient_per_s.norm();
    let near = |times: &[f64], all: Vec<Matrix3<f64>>| {
        let rows = answer.rows.iter().zip(all).take(times.len());
        let off = rows.map(|(row, a)| Some(apart(row, &values(problem, equation.closure, &a)?)));
        let worst = off.collect::<Option<Vec<_>>>()?.into_iter().fold(0.0, f64::max);
        (worst <= most).then_some(worst)
    };
    let times = &problem.times_s[..];
    if problem.is_steady() {
        let row = &answer.rows[0];
        if row.len() == PAIRS.len() {
            // Saves time: most candidates are far, and then a is not at rest.
            let mut a = Matrix3::zeros();
            PAIRS.iter().zip(row).for_each(|((i, j), x)| (a[(*i, *j)], a[(*j, *i)]) = (*x, *x));
            if equation.rate(&a).amax() > 100.0 * most * norm {
                return None;
            }
        }
        return near(times, vec![steady(equation, start)?]);
    }
    // Saves time: most candidates are far already at the first time.
    near(&times[..1], at(equation, start, &times[..1], 1e-11)?)?;
    near(times, at(equation, start, times, 1e-11)?)
}

/// The distance of an answer to a closed problem from the distribution itself.
fn from_exact(problem: &Problem, answer: &Answer) -> Option<f64> {
    let closed = problem.closed?;
    let Model::FolgarTucker { c_i } = closed.model else { return None };
    if closed.start() != isotropic() {
        return None;
    }
    let motion = Motion::new(problem.gradient_per_s, problem.aspect_ratio, c_i);
    let exact = diffusion::at(&motion, Start::Isotropic, &problem.times_s).ok()?;
    let rows = answer.rows.iter().zip(&exact).map(|(row, means)| apart(row, &means.second));
    Some(rows.fold(0.0, f64::max))
}

/// Names the closures whose curve the answer is, given its `error`; the diagnosis is empty if there is none.
pub(super) fn diagnose(loaded: &LoadedProblem, answer: &Answer, error: f64) -> Diagnosis {
    let problem = &loaded.problem;
    let most = NEARER * error;
    let all = candidates(problem);
    let mut near: Vec<_> = (all.par_iter())
        .filter_map(|candidate| Some((distance(problem, answer, candidate, most)?, candidate.name.clone())))
        .collect();
    if let Some(distance) = from_exact(problem, answer).filter(|distance| *distance <= most) {
        near.push((distance, "the distribution, without a closure".to_owned()));
    }
    near.sort_by(|a, b| a.0.total_cmp(&b.0));
    let Some((nearest, _)) = near.first().cloned() else { return Diagnosis::default() };
    near.retain(|(distance, _)| *distance <= (10.0 * nearest).max(problem.tolerance));
    let suspects: Vec<_> = near.into_iter().map(|(_, name)| name).collect();
    let cost = match problem.closed {
        Some(_) => String::new(),
        None => format!("; it costs {}", worst(loaded, answer)),
    };
    let nearest = nearest.max(f64::EPSILON);
    let said = format!("this is the curve of {}, to {nearest:.0e}{cost}", suspects.join(" or of "));
    Diagnosis { said: Some(said), suspects, rates: Vec::new() }
}

/// The largest error, with its column and time.
fn worst(loaded: &LoadedProblem, answer: &Answer) -> String {
    let problem = &loaded.problem;
    let rows = answer.rows.iter().zip(&loaded.certified.rows).zip(&problem.times_s);
    let errors = rows.flat_map(|((row, certified), time)| {
        let pairs = row.iter().zip(&certified[1..]).zip(&problem.columns[1..]);
        pairs.map(move |((a, b), column)| (a - b, column, *time))
    });
    let largest = errors.max_by(|a, b| a.0.abs().total_cmp(&b.0.abs()));
    largest.map_or(String::new(), |(error, column, time)| {
        let when = if problem.is_steady() { "once steady".to_owned() } else { format!("at {time} s") };
        format!("{error:+.2e} in {column} {when}")
    })
}
