//! A problem asked with more and more steps, or with smaller and smaller tolerances.

#[cfg(test)]
mod tests;

use super::last_time;
use super::program::{Asked, Program, Question};
use crate::grade::answer::Answer;
use crate::grade::compare::{Compared, compare};
use crate::grade::diagnosis::diagnose;
use crate::grade::files::{Claim, order_off};
use crate::grade::{Graded, Verdict, orders};
use crate::integrators::Setting;
use crate::problems::LoadedProblem;
use std::time::{Duration, Instant};

/// Doublings of the steps at most, from GΔt of about 1.
const DOUBLINGS: u32 = 24;

/// Rungs from which nothing is foretold: from here on a step is at most a hundredth of a unit of strain.
const RESOLVING: usize = 7;

/// What a program takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// Equal steps.
    Steps,
    /// A tolerance.
    Tolerance,
}

/// Asks for a rod of r_e = 2 over a short time: by steps, and where the program has an error for that, by tolerance.
pub fn mode(program: &Program) -> Mode {
    program.during("the first request");
    let question = Question {
        gradient_per_s: [[0.0; 3], [1.0, 0.0, 0.0], [0.0; 3]],
        aspect_ratio: 2.0,
        start: vec![[1.0, 0.0, 0.0]],
        end_s: 1.0,
    };
    let refused = matches!(program.ask(&question, Setting::Steps(8)), Err(Asked::Says(_)));
    match refused && program.ask(&question, Setting::Tolerance(1e-3)).is_ok() {
        true => Mode::Tolerance,
        false => Mode::Steps,
    }
}

/// One setting and what came.
struct Rung {
    setting: Setting,
    answer: Answer,
    compared: Compared,
    took: Duration,
}

/// Grades a program on a problem about free rods, at its last time.
pub fn grade(program: &Program, problem: &LoadedProblem, mode: Mode, claim: Claim) -> Graded {
    program.during(&problem.problem.name);
    let problem = last_time(problem);
    let (rungs, stopped) = climb(program, &problem, mode);
    let of = &problem.problem;
    let mut graded = Graded::without_answer(&of.name, of.kind, of.tolerance, &of.because);
    graded.verdict = Verdict::Fail;
    let errors = rungs
        .iter()
        .filter_map(|rung| Some((rung.setting.steps().ok()?, rung.compared.error)));
    let errors: Vec<_> = errors.collect();
    (graded.orders, graded.observed_order) = orders(&errors, of.tolerance);
    graded.errors = errors;
    let Some(finest) = rungs.last() else {
        graded.note = stopped.breach.or(stopped.reason);
        return graded;
    };
    graded.steps = finest.setting.steps().ok();
    graded.asked_tolerance = finest.setting.tolerance().ok();
    let compared = &finest.compared;
    graded.error = compared.error.is_finite().then_some(compared.error);
    graded.length_drift = compared.length_drift.filter(|drift| drift.is_finite());
    graded.orbit_drift = compared.orbit_drift.filter(|drift| drift.is_finite());
    graded.phase_lost_per_period = compared.phase_lost_per_period.filter(|lost| lost.is_finite());
    graded.diagnosis = diagnose(&problem, &finest.answer, compared.error);
    let within = compared.error <= of.tolerance;
    let off = order_off(graded.observed_order, claim);
    if within && off.is_none() && stopped.breach.is_none() {
        graded.verdict = Verdict::Pass;
    }
    graded.note = stopped
        .breach
        .or(off)
        .or_else(|| why(&graded, compared, finest.setting, within, stopped.reason));
    graded
}

/// What is to be said of an answer that is not within the tolerance.
fn why(
    graded: &Graded,
    compared: &Compared,
    finest: Setting,
    within: bool,
    reason: Option<String>,
) -> Option<String> {
    if within {
        return None;
    }
    if !compared.error.is_finite() {
        return Some(format!("with {finest} the answer is not finite"));
    }
    let mut words = match finest {
        Setting::Tolerance(asked) => format!(
            "it claims success at the tolerance {asked:.0e} and is off by {:.1e}",
            compared.error
        ),
        _ => format!("with {finest} it is off by {:.1e}", compared.error),
    };
    if let (Some(order @ 0.5..), Some(steps)) = (graded.observed_order, graded.steps) {
        let needed = steps as f64 * (compared.error / graded.tolerance).powf(1.0 / order);
        words += &format!("; at this order about {needed:.0e} steps would be within the tolerance");
    }
    if let Some(reason) = reason {
        words += &format!("; {reason}");
    }
    Some(words)
}

/// Why a ladder ended.
#[derive(Default)]
struct Stopped {
    /// A breach of the protocol: it fails the problem whatever was answered before.
    breach: Option<String>,
    /// Anything else.
    reason: Option<String>,
}

/// Climbs until the answer is within the tolerance, or time is up.
fn climb(program: &Program, problem: &LoadedProblem, mode: Mode) -> (Vec<Rung>, Stopped) {
    let mut rungs: Vec<Rung> = Vec::new();
    let mut stopped = Stopped::default();
    let begun = Instant::now();
    let question = Question {
        gradient_per_s: problem.problem.gradient_per_s,
        aspect_ratio: problem.problem.aspect_ratio,
        start: problem.start.clone(),
        end_s: problem.problem.times_s[0],
    };
    for setting in settings(problem, mode) {
        let took = match program.ask(&question, setting) {
            Ok((p, took)) => {
                let answer = answer(p);
                let compared = compare(problem, &answer);
                rungs.push(Rung {
                    setting,
                    answer,
                    compared,
                    took,
                });
                took
            }
            // It may do better with shorter steps.
            Err(Asked::Says(words)) => {
                stopped.reason = Some(format!("with {setting} the program says: {words}"));
                Duration::ZERO
            }
            Err(Asked::Breach(words)) => {
                stopped.breach = Some(format!("asked for {setting}: {words}"));
                break;
            }
            Err(Asked::Not(words)) => {
                stopped.breach = Some(format!("not asked: {words}"));
                break;
            }
        };
        let tolerance = problem.problem.tolerance;
        if reached(&rungs, tolerance) {
            break;
        }
        if let Some(reason) = hopeless(&rungs, tolerance, program.timeout()) {
            stopped.reason = Some(reason);
            break;
        }
        if 4 * took > program.timeout() || begun.elapsed() > program.timeout() {
            let seconds = begun.elapsed().as_secs_f64();
            stopped.reason = Some(format!(
                "finer ones would take too long (--timeout): {seconds:.1} s so far"
            ));
            break;
        }
    }
    (rungs, stopped)
}

/// Whether two settings in a row are within the tolerance, or one to which the error fell by a steady order: one alone may be a
/// chance crossing.
fn reached(rungs: &[Rung], tolerance: f64) -> bool {
    let within = |rung: &&Rung| rung.compared.error <= tolerance;
    match rungs.iter().rev().take_while(within).count() {
        0 => false,
        1 => steady_order(rungs).is_some(),
        _ => true,
    }
}

/// Why finer settings would not come within the tolerance, where that can be told from those that were tried.
fn hopeless(rungs: &[Rung], tolerance: f64, timeout: Duration) -> Option<String> {
    // From coarse steps nothing follows: they may be unstable, or miss the motion.
    let resolving = &rungs[RESOLVING.min(rungs.len())..];
    let [.., third, second, first, last] = resolving else {
        return None;
    };
    let errors = [third, second, first, last].map(|rung| rung.compared.error);
    if !errors.iter().any(|error| error.is_finite()) {
        return Some("finer ones are not finite either".to_owned());
    }
    let changes = [(third, second), (second, first), (first, last)];
    let changes = changes.map(|(coarse, fine)| coarse.answer.largest_change(&fine.answer));
    if changes.iter().all(|change| *change <= 0.01 * tolerance) && errors[3] > tolerance {
        return Some("finer ones no longer change the answer".to_owned());
    }
    // A steady order foretells the steps, and two times that double what they take.
    let order = steady_order(resolving)?;
    let doubles = first.took > Duration::from_millis(200) && last.took < 3 * first.took;
    let more = (errors[3] / tolerance).powf(1.0 / order);
    let needed_s = last.took.as_secs_f64() * more;
    (doubles && needed_s > 4.0 * timeout.as_secs_f64())
        .then(|| format!("those would take some {needed_s:.0e} s, which --timeout does not allow"))
}

/// The order by which the last four errors fall, where it is nearly the same from each to the next.
fn steady_order(rungs: &[Rung]) -> Option<f64> {
    let last = rungs
        .last_chunk::<4>()?
        .each_ref()
        .map(|rung| rung.compared.error);
    let orders = [0, 1, 2].map(|k| (last[k] / last[k + 1]).log2());
    let steady = |order: &f64| *order > 0.5 && (order - orders[2]).abs() < 0.1;
    orders.iter().all(steady).then_some(orders[2])
}

fn settings(problem: &LoadedProblem, mode: Mode) -> Vec<Setting> {
    let of = &problem.problem;
    let largest = of
        .gradient_per_s
        .iter()
        .flatten()
        .fold(0.0, |a: f64, b| a.max(b.abs()));
    let strain = largest * of.times_s[0];
    let coarsest = (strain.ceil() as u64).next_power_of_two().max(8);
    match mode {
        Mode::Steps => (0..=DOUBLINGS).map(|k| Setting::Steps(coarsest << k)).collect(),
        Mode::Tolerance => (2..=14).map(|k| Setting::Tolerance(10f64.powi(-k))).collect(),
    }
}

fn answer(p: Vec<[f64; 3]>) -> Answer {
    Answer {
        path: "standard output".into(),
        lines: vec![0; p.len()],
        rows: p.into_iter().map(Vec::from).collect(),
    }
}
