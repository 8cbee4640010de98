//! Diagnosis of answers about orientation tensors: another closure, a mistake in one part of the equation, another
//! layout of the columns, or two of these.

pub(super) mod columns;
mod distribution;
mod estimate;
pub(super) mod formulas;
mod layouts;

use super::answer::{Answer, apart};
use super::nearness::{CURVE, Diagnosis, NEARER, Near, said};
use crate::judge::statistics::worst;
use crate::methods::tensors::fourth::PAIRS;
use crate::methods::tensors::wrong::closures::{CLOSURES, Stand, WITH_OTHERS};
use crate::methods::tensors::wrong::{MISTAKES, scaled};
use crate::methods::tensors::{Closure, Model, Parts, at_rate, isotropic, steady_of};
use crate::oracle::diffusion::strain_rate_per_s;
use crate::serve::problems::formula::tensor;
use crate::serve::problems::{Closed, LoadedProblem, Problem};
use columns::{fourth_of, values};
use distribution::{from_exact, of_wrong_distribution};
use layouts::{LAYOUTS, Layout, in_other_layouts, of_layout};
use nalgebra::Matrix3;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// The tolerance of a step of the integration of a curve; of a rough one, which saves time, and how far that may be
/// off.
const STEP: f64 = 1e-11;
const ROUGH: f64 = 1e-6;
const OFF: f64 = 1e-3;

/// A closed equation that a code may solve, with its curve, which is computed once for all answers.
struct Candidate<'a> {
    parts: Parts,
    closure: &'a Stand,
    /// Its names: mistakes may have the same parts.
    near: Vec<Near>,
    /// True if it keeps the trace 1; rough values at the first time; all values.
    keeps_trace: OnceLock<bool>,
    first: OnceLock<Option<Vec<f64>>>,
    whole: OnceLock<Option<Vec<Vec<f64>>>>,
}

impl<'a> Candidate<'a> {
    fn new(parts: Parts, closure: &'a Stand, near: Vec<Near>) -> Self {
        let keeps_trace = OnceLock::new();
        Self { parts, closure, near, keeps_trace, first: OnceLock::new(), whole: OnceLock::new() }
    }

    fn rate(&self, a: &Matrix3<f64>) -> Matrix3<f64> {
        self.rate_in(1.0, a)
    }

    /// The rate in `factor` times the flow, with the same diffusion.
    fn rate_in(&self, factor: f64, a: &Matrix3<f64>) -> Matrix3<f64> {
        scaled(self.parts, factor, factor, 1.0).rate(a, &self.closure.fourth(a))
    }

    /// True if the trace of a stays 1, as far as two tensors show.
    fn keeps_trace(&self) -> bool {
        let of = || {
            let other = Matrix3::new(0.5, 0.1, -0.05, 0.1, 0.3, 0.02, -0.05, 0.02, 0.2);
            let rates = [isotropic(), other].map(|a| self.rate(&a));
            rates.iter().all(|rate| rate.trace().abs() <= 1e-9 * rate.amax())
        };
        *self.keeps_trace.get_or_init(of)
    }

    /// The norm of the flow in 1/s.
    fn norm(&self) -> f64 {
        self.parts.spin.norm() + self.parts.strain.norm()
    }

    /// The values of the problem's columns at the first `count` times, with `tolerance` as that of a step; `None` if
    /// there is no solution, or for other columns.
    fn curve(&self, problem: &Problem, start: &Matrix3<f64>, count: usize, tolerance: f64) -> Option<Vec<Vec<f64>>> {
        let all = if problem.is_steady() {
            vec![steady_of(&|a| self.rate(a), self.norm(), start)?]
        } else {
            let rate = |time_s: f64, a: &Matrix3<f64>| self.rate_in(problem.flow_at(time_s), a);
            at_rate(&rate, start, &problem.times_s[..count], tolerance)?
        };
        all.iter().map(|a| values(problem, self.closure, a)).collect()
    }

    fn first(&self, problem: &Problem, start: &Matrix3<f64>) -> Option<&Vec<f64>> {
        self.first.get_or_init(|| self.curve(problem, start, 1, ROUGH)?.pop()).as_ref()
    }

    fn whole(&self, problem: &Problem, start: &Matrix3<f64>) -> Option<&Vec<Vec<f64>>> {
        self.whole.get_or_init(|| self.curve(problem, start, problem.times_s.len(), STEP)).as_ref()
    }
}

/// A change of one part: the names of the mistakes that make it, with what is right, and the parts with it.
struct Change {
    names: Vec<(&'static str, &'static str)>,
    parts: Parts,
}

/// The right parts without a name, then those with each mistake that makes a difference. Rods with a D_r diffuse as
/// they do whatever γ̇ and C_I a code has.
fn changes(parts: &Parts, has_c_i: bool) -> Vec<Change> {
    let mut all = vec![Change { names: vec![("", "")], parts: *parts }];
    for mistake in &MISTAKES {
        let Some(changed) = mistake.of(parts) else { continue };
        let Parts { speed, decay, model, .. } = *parts;
        let changed = if has_c_i { changed } else { Parts { speed, decay, model, ..changed } };
        let name = (mistake.name, mistake.advice);
        match all.iter_mut().find(|change| change.parts == changed) {
            _ if changed == *parts => {}
            Some(same) => same.names.push(name),
            None => all.push(Change { names: vec![name], parts: changed }),
        }
    }
    all
}

/// What is known of a problem before any answer.
struct Known {
    /// The index of the closure in [`CLOSURES`]; `None` if no closure is the right one.
    own: Option<usize>,
    parts: Parts,
    start: Matrix3<f64>,
    changes: Vec<Change>,
    candidates: Vec<Candidate<'static>>,
}

impl Known {
    /// The right equation, if a closure is the right one.
    fn right(&self) -> Option<Candidate<'static>> {
        Some(self.with(&CLOSURES[self.own?]))
    }

    /// The equation with this closure in place of the right one.
    fn with<'a>(&self, closure: &'a Stand) -> Candidate<'a> {
        Candidate::new(self.parts, closure, Vec::new())
    }
}

/// What is known of a problem, computed once for each; `None` if it has no closed equation that a code may solve.
fn known(problem: &Problem) -> Option<Arc<Known>> {
    static ALL: Mutex<BTreeMap<String, Option<Arc<Known>>>> = Mutex::new(BTreeMap::new());
    let of = || {
        let (closed, own) = asked(problem)?;
        let parts = closed.equation(&problem.gradient_per_s, problem.aspect_ratio).parts();
        let changes = changes(&parts, problem.d_r_per_s.is_none());
        let candidates = candidates(&changes, own);
        Some(Arc::new(Known { own, parts, start: closed.start(), changes, candidates }))
    };
    let key = serde_json::to_string(problem).ok()?;
    ALL.lock().unwrap_or_else(PoisonError::into_inner).entry(key).or_insert_with(of).clone()
}

/// The words for a change with a closure; `own` is the index of the one that is asked for, if one is.
fn near_of(name: &str, advice: &'static str, closure: usize, own: Option<usize>) -> Near {
    let other = own != Some(closure);
    let of_closure = &CLOSURES[closure].name;
    let (name, suspect) = match (name, other) {
        ("", _) => (of_closure.clone(), of_closure.as_str()),
        (_, true) => (format!("{name}, with {of_closure}"), name),
        (_, false) => (name.to_owned(), name),
    };
    let changes = u8::from(other) + u8::from(suspect != of_closure);
    Near { distance: 0.0, suspects: vec![suspect.to_owned()], name, advice, changes }
}

/// The index in [`CLOSURES`], which begins with all right ones.
fn index(closure: Closure) -> Option<usize> {
    Closure::ALL.iter().position(|other| *other == closure)
}

/// The closed equation of a problem, and the index of its closure; of a problem of the distribution no closure is the
/// right one.
fn asked(problem: &Problem) -> Option<(Closed, Option<usize>)> {
    let rate = strain_rate_per_s(problem.gradient_per_s);
    match (&problem.closed, problem.diffusing()) {
        (Some(closed), _) => Some((*closed, index(closed.closure))),
        // At rest a closure has no part in a_ij.
        (None, Some(rods)) if rate > 0.0 => {
            let (closure, model) = (Closure::Quadratic, Model::FolgarTucker { c_i: rods.diffusivity / rate });
            Some((Closed { closure, model, start: problem.start_tensor() }, None))
        }
        _ => None,
    }
}

fn candidates(changes: &[Change], own: Option<usize>) -> Vec<Candidate<'static>> {
    let with = |change: &Change| {
        // Without 𝔸:D a closure has no part in a_ij.
        let without = change.parts.of_fourth == 0.0 && matches!(change.parts.model, Model::FolgarTucker { .. });
        let own = if without { Some(own.unwrap_or_default()) } else { own };
        let of = |(closure, stand): (usize, &'static Stand)| {
            let near: Vec<_> = change.names.iter().map(|(name, advice)| near_of(name, advice, closure, own)).collect();
            let tried = near[0].changes == 1 || near[0].changes > 1 && closure < WITH_OTHERS;
            tried.then(|| Candidate::new(change.parts, stand, near))
        };
        let all = CLOSURES.iter().enumerate().filter(|(closure, stand)| {
            let meant = stand.of.is_none_or(|of| own.is_some() && own == index(of));
            if without { own == Some(*closure) } else { meant }
        });
        all.filter_map(of).collect::<Vec<_>>()
    };
    changes.iter().flat_map(with).collect()
}

/// False if the trace of a_ij is not 1 within what values that are off by `most` allow; true of other columns.
fn has_trace_one(rows: &[Vec<f64>], most: f64) -> bool {
    let off = |row: &Vec<f64>| (tensor(row).trace() - 1.0).abs();
    rows[0].len() != PAIRS.len() || worst(rows.iter().map(off)) <= 3.0 * most + STEP
}

/// The distance of rows from a candidate's curve; `None` if it is larger than `most`.
fn distance(
    problem: &Problem,
    rows: &[Vec<f64>],
    start: &Matrix3<f64>,
    candidate: &Candidate<'_>,
    most: f64,
) -> Option<f64> {
    let far = |off: &f64| off.is_nan() || *off > most + OFF;
    if !has_trace_one(rows, most) && candidate.keeps_trace() {
        return None;
    }
    // Saves time: most candidates are far already at the first time, or not at rest where the answer is.
    if !problem.is_steady() {
        let first = candidate.first(problem, start)?;
        if far(&apart(&rows[..1], std::slice::from_ref(first))) {
            return None;
        }
    } else {
        let a = match fourth_of(problem, &rows[0]) {
            Some(fourth) => fourth.contract(&Matrix3::identity()),
            None => tensor(&rows[0]),
        };
        if candidate.rate(&a).amax() > 100.0 * most * candidate.norm() {
            return None;
        }
    }
    Some(apart(rows, candidate.whole(problem, start)?)).filter(|off| *off <= most)
}

/// Names the closure, the mistake or the layout whose curve the answer is, given its `error`; the diagnosis is empty
/// if there is none.
pub(super) fn diagnose(loaded: &LoadedProblem, answer: &Answer, error: f64, steps: Option<u64>) -> Diagnosis {
    let problem = &loaded.problem;
    let most = NEARER * error;
    // Curves are no better known.
    if most < STEP {
        return Diagnosis::default();
    }
    let mut near = of_wrong_distribution(problem, answer, most);
    let Some(known) = known(problem) else { return said(CURVE, near, problem.tolerance, "") };
    let Known { start, candidates, .. } = &*known;
    let is_second = problem.columns.len() == PAIRS.len() + 1;
    if is_second && answer.rows.iter().all(|row| (tensor(row) - start).amax() <= most) {
        return Diagnosis::sentence("a_ij stays where it started: nothing has moved");
    }
    near.extend(in_other_layouts(&[certified(loaded)], answer, most));
    let with = |changes: u8| -> Vec<Near> {
        let near = |candidate: &Candidate<'_>| {
            let distance = distance(problem, &answer.rows, start, candidate, most)?;
            Some(candidate.near.iter().map(move |near| Near { distance, ..near.clone() }).collect::<Vec<_>>())
        };
        let of = candidates.par_iter().filter(|candidate| candidate.near[0].changes == changes);
        of.filter_map(near).flatten().collect()
    };
    near.extend(with(1));
    if problem.closed.is_none() || *start == isotropic() {
        let exact = known.changes.par_iter().filter(|change| problem.closed.is_some() == change.names[0].0.is_empty());
        near.par_extend(
            exact
                .filter_map(|Change { names, parts }| {
                    let distance = from_exact(problem, &answer.rows, parts, most)?;
                    let of = move |(name, advice): &(&str, &'static str)| {
                        let name = if name.is_empty() { "the distribution, without a closure" } else { name };
                        Near { advice, ..Near::new(distance, name) }
                    };
                    Some(names.iter().map(of).collect::<Vec<_>>())
                })
                .flatten(),
        );
    }
    // More changes are sought only where fewer explain nothing: that is what a code is likely to have, and it saves
    // time.
    if near.is_empty() {
        near = with(2);
        let has_one = |layout: &Layout| layout.rows(&answer.rows).is_some_and(|rows| has_trace_one(&rows, most));
        if is_second && LAYOUTS.iter().any(has_one) {
            near.extend(in_other_layouts(&of_closures(problem, &known), answer, most));
        }
    }
    if near.is_empty() && !problem.is_steady() {
        near = estimate::of_curve(problem, answer, &known, steps, most);
        near.extend(from_isotropic(problem, answer, &known, most));
        near.extend(steps.and_then(|steps| estimate::a_step_off(problem, answer, &known, steps, most)));
    }
    if near.is_empty() && !problem.is_steady() {
        near = estimate::of_numbers(problem, answer, &known, most);
    }
    let cost = match problem.closed {
        Some(_) => String::new(),
        None => format!("; it costs {}", cost(loaded, answer)),
    };
    said(CURVE, near, problem.tolerance, &cost)
}

/// The rows of a problem's columns for the states that `step` makes of its closed equation for da/dt and of its start;
/// `None` if it has none in a steady flow, or asks for its steady state.
pub(super) fn by_equation(
    problem: &Problem,
    step: impl Fn(&dyn Fn(Matrix3<f64>) -> Matrix3<f64>, Matrix3<f64>) -> Vec<Matrix3<f64>>,
) -> Option<Vec<Vec<f64>>> {
    let known = known(problem).filter(|_| !problem.is_steady() && problem.oscillation_period_s.is_none())?;
    let right = known.right()?;
    let states = step(&|a| right.rate(&a), known.start);
    states.iter().map(|a| values(problem, right.closure, a)).collect()
}

/// The right equation from random rods, where the start is another.
fn from_isotropic(problem: &Problem, answer: &Answer, known: &Known, most: f64) -> Option<Near> {
    let distance = distance(problem, &answer.rows, &isotropic(), &known.right()?, most)?;
    Some(Near::new(distance, "a_ij(0) = δ_ij/3, the start left out"))
}

/// How far the certified answer is from that of a code with this mistake, or in this layout; `None` if the mistake is
/// unknown here or makes no difference.
pub(super) fn off(loaded: &LoadedProblem, name: &str) -> Option<f64> {
    let (problem, rows) = (&loaded.problem, Answer::certified(loaded).rows);
    let known = known(problem)?;
    let change = known.changes.iter().find(|change| change.names.iter().any(|(own, _)| *own == name));
    let of_change = |change: &Change| {
        if known.own.is_none() {
            return from_exact(problem, &rows, &change.parts, f64::INFINITY);
        }
        let of = |candidate: &&Candidate<'_>| candidate.parts == change.parts && candidate.near[0].changes == 1;
        let candidate = known.candidates.iter().find(of)?;
        // An equation without a solution does not have the certified one.
        distance(problem, &rows, &known.start, candidate, f64::INFINITY).or(Some(f64::INFINITY))
    };
    change.map_or_else(|| of_layout(&rows, name), of_change)
}

/// What is right in place of a mistake or a layout; empty if it is unknown.
pub(super) fn advice(name: &str) -> &'static str {
    let mistakes = MISTAKES.iter().map(|mistake| (mistake.name, mistake.advice));
    let layouts = LAYOUTS.iter().map(|layout| (layout.name, layout.advice));
    mistakes.chain(layouts).find(|(known, _)| *known == name).map_or("", |(_, advice)| advice)
}

/// The certified values, as a curve without a name.
fn certified(loaded: &LoadedProblem) -> (Near, Vec<Vec<f64>>) {
    (Near { changes: 0, ..Near::new(0.0, "") }, Answer::certified(loaded).rows)
}

/// The curves of every closure but the problem's own.
fn of_closures(problem: &Problem, known: &Known) -> Vec<(Near, Vec<Vec<f64>>)> {
    let of = known.candidates.par_iter().filter(|candidate| candidate.parts == known.parts);
    let curve =
        |candidate: &Candidate<'_>| Some((candidate.near[0].clone(), candidate.whole(problem, &known.start)?.clone()));
    of.filter_map(curve).collect()
}

/// The largest error, with its column and time.
fn cost(loaded: &LoadedProblem, answer: &Answer) -> String {
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
