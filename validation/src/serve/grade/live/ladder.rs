//! A ladder: one problem with more and more steps, or with smaller and smaller tolerances.

mod climb;
mod jumps;
#[cfg(test)]
mod tests;

use super::last_time;
use super::program::{Program, Question};
use crate::methods::integrators::Setting;
use crate::serve::grade::answer::Answer;
use crate::serve::grade::compare::{Compared, compare};
use crate::serve::grade::diagnosis::diagnose;
use crate::serve::grade::files::Claim;
use crate::serve::grade::order::other;
use crate::serve::grade::{Graded, Order, Verdict};
use crate::serve::problems::LoadedProblem;
use climb::{End, climb};
use std::time::Duration;

/// The setting that a program accepts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// Equal steps.
    Steps,
    /// A tolerance.
    Tolerance,
}

/// Asks for a rod of r_e = 2 over a short time, with steps; if the program returns an error there and none with a
/// tolerance, its mode is the tolerance.
pub fn mode(program: &Program) -> Mode {
    program.during("the first request");
    let question = Question {
        gradient_per_s: [[0.0; 3], [1.0, 0.0, 0.0], [0.0; 3]],
        aspect_ratio: 2.0,
        start: vec![[1.0, 0.0, 0.0]],
        end_s: 1.0,
    };
    let refuses = |setting| matches!(program.ask(&question, setting), Err(super::program::Asked::Says(_)));
    // What breaks at the tolerance is shown by the ladder of tolerances.
    if refuses(Setting::Steps(8)) && !refuses(Setting::Tolerance(1e-3)) { Mode::Tolerance } else { Mode::Steps }
}

/// One setting with its answer.
struct Rung {
    setting: Setting,
    answer: Answer,
    compared: Compared,
    took: Duration,
}

impl Rung {
    fn of(problem: &LoadedProblem, setting: Setting, p: Vec<[f64; 3]>, took: Duration) -> Self {
        let answer = Answer {
            path: "standard output".into(),
            lines: vec![0; p.len()],
            rows: p.into_iter().map(Vec::from).collect(),
        };
        Self { setting, compared: compare(problem, &answer), answer, took }
    }

    fn error(&self) -> f64 {
        self.compared.error
    }
}

/// (steps, error) of the rungs whose setting is a number of steps.
fn errors(rungs: &[Rung]) -> Vec<(u64, f64)> {
    rungs.iter().filter_map(|rung| Some((rung.setting.steps().ok()?, rung.error()))).collect()
}

/// Grades a program on a problem about free rods, at its last time.
pub fn grade(program: &Program, problem: &LoadedProblem, mode: Mode, claim: Claim) -> Graded {
    program.during(&problem.problem.name);
    let problem = last_time(problem);
    let of = &problem.problem;
    let question = Question {
        gradient_per_s: of.gradient_per_s,
        aspect_ratio: of.aspect_ratio,
        start: problem.start.clone(),
        end_s: of.times_s[0],
    };
    let ask = |setting: Setting| {
        let (p, took) = program.ask(&question, setting)?;
        Ok(Rung::of(&problem, setting, p, took))
    };
    let (rungs, mut end) = climb(&problem, mode, program.timeout(), claim.order, ask);
    if matches!(end, End::Reached) {
        end = jumps::judged(&rungs, of.tolerance, ask);
    }
    let mut graded = Graded::without_answer(&problem);
    graded.set_orders(errors(&rungs), &problem, claim.order);
    graded.verdict = match &end {
        // Whether a mistake is named must not depend on how fast the machine is.
        End::OutOfTime(_) if stays_on_a_mistake(&problem, &rungs) => Verdict::Fail,
        End::OutOfTime(_) => Verdict::NotReached,
        End::Reached => Verdict::Pass,
        _ => Verdict::Fail,
    };
    if let Some(finest) = rungs.last() {
        graded.steps = finest.setting.steps().ok();
        graded.asked_tolerance = finest.setting.tolerance().ok();
        let compared = &finest.compared;
        let finite = |number: &f64| number.is_finite();
        graded.error = Some(compared.error).filter(finite);
        graded.length_drift = compared.length_drift.filter(finite);
        graded.orbit_drift = compared.orbit_drift.filter(finite);
        graded.phase_lost_per_period = compared.phase_lost_per_period.filter(finite);
        graded.set_diagnosis(diagnose(&problem, &finest.answer, compared.error));
    }
    graded.note = match end {
        End::Broke(words) | End::Jumps(words) => Some(words),
        End::Lower => {
            graded.order_found = Some(Order::Lower);
            claim.order.map(|claimed| other(&graded, claimed))
        }
        End::Reached => not_finite(&rungs),
        End::Wrong(words) | End::OutOfTime(words) => Some(why(&graded, rungs.last(), words)),
    };
    graded
}

/// True if the last two settings give the curve of the same mistake: other settings will not give another.
fn stays_on_a_mistake(problem: &LoadedProblem, rungs: &[Rung]) -> bool {
    let [.., before, last] = rungs else {
        return false;
    };
    let named = |rung: &Rung| {
        let found = diagnose(problem, &rung.answer, rung.error());
        found.said.map_or_else(Vec::new, |_| found.suspects)
    };
    let before = named(before);
    named(last).iter().any(|name| before.contains(name))
}

/// A message that lists the coarse settings of a passing ladder whose answers are not finite.
fn not_finite(rungs: &[Rung]) -> Option<String> {
    let names = rungs.iter().filter(|rung| !rung.error().is_finite());
    let names: Vec<_> = names.map(|rung| rung.setting.to_string()).collect();
    (!names.is_empty()).then(|| format!("with {} the answer is not finite", names.join(", ")))
}

/// The reason why an answer is not within the tolerance.
fn why(graded: &Graded, finest: Option<&Rung>, words: String) -> String {
    let Some(finest) = finest else {
        return words;
    };
    let (setting, error) = (finest.setting, finest.error());
    if !error.is_finite() {
        return format!("with {setting} the answer is not finite; {words}");
    }
    let mut said = match setting {
        Setting::Tolerance(asked) => {
            format!("it claims success at the tolerance {asked:.0e} and is off by {error:.1e}")
        }
        _ => format!("with {setting} it is off by {error:.1e}"),
    };
    if let Some(needed) = graded.steps_needed() {
        said += &format!("; {needed}");
    }
    format!("{said}; {words}")
}
