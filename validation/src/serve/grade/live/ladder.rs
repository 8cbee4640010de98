//! A ladder: one problem with more and more steps, or with smaller and smaller tolerances; formulas have none.

mod climb;
mod elsewhere;
mod jumps;
mod random;
#[cfg(test)]
mod tests;

use super::last_time;
use super::program::{Asked, Program, Question};
use super::protocol::Protocol;
use super::tables;
use super::text::AFTER_ID;
use crate::methods::integrators::Setting;
use crate::serve::grade::answer::Answer;
use crate::serve::grade::compare::{Compared, compare};
use crate::serve::grade::diagnosis::{Diagnosis, diagnose};
use crate::serve::grade::digits;
use crate::serve::grade::files::{judge, place};
use crate::serve::grade::order::other;
use crate::serve::grade::report::joined;
use crate::serve::grade::{Graded, Order, Verdict, slips};
use crate::serve::problems::{Kind, LoadedProblem, Metric};
use climb::{End, climb, converges, fall_with_tolerances, fewest, is_smooth, resolving, within};
use elsewhere::others;
use std::cell::Cell;
use std::time::{Duration, Instant};

/// The setting that a program accepts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// Equal steps.
    Steps,
    /// A tolerance.
    Tolerance,
}

/// Asks for a rod of r_e = 2 over a short time, with steps; if the program returns an error there and none with a
/// tolerance, its mode is the tolerance. If `any_form` and it does not understand its form of lines, it starts again
/// with numbers.
pub fn prepared(program: Program, any_form: bool) -> (Program, Mode) {
    let ask = |program: &Program, setting| {
        program.during("the first request");
        program.ask(&Question::couette(2.0, vec![[1.0, 0.0, 0.0]], 1.0), setting)
    };
    let is_answer = |found: &Result<_, Asked>| match found {
        Ok(_) | Err(Asked::Says(_)) => true,
        Err(asked) => asked.to_string().contains(AFTER_ID),
    };
    let found = ask(&program, Setting::Steps(8));
    let text = (any_form && matches!(found, Err(Asked::Breach(_)))).then(|| program.restarted(Protocol::Text));
    let text = text.map(|text| (ask(&text, Setting::Steps(8)), text)).filter(|(found, _)| is_answer(found));
    let (found, program) = text.unwrap_or((found, program));
    let refuses = |found| matches!(found, Err(Asked::Says(_)));
    // What breaks at the tolerance is shown by the ladder of tolerances.
    let by_tolerance = refuses(found) && !refuses(ask(&program, Setting::Tolerance(1e-3)));
    (program, if by_tolerance { Mode::Tolerance } else { Mode::Steps })
}

struct Rung {
    setting: Setting,
    answer: Answer,
    compared: Compared,
    took: Duration,
}

impl Rung {
    fn of(problem: &LoadedProblem, setting: Setting, mut rows: Vec<Vec<f64>>, took: Duration) -> Self {
        if problem.problem.kind == Kind::Rods {
            headed(&mut rows, problem);
        }
        let answer = printed(rows);
        Self { setting, compared: compare(problem, &answer), answer, took }
    }

    fn error(&self) -> f64 {
        self.compared.error
    }
}

/// Turns each p by half a turn that lies against the certified one: a rod has no head, and a program may give either.
fn headed(rows: &mut [Vec<f64>], problem: &LoadedProblem) {
    let keys = problem.problem.kind.keys().len();
    for (p, due) in rows.iter_mut().zip(&problem.certified.rows) {
        if p.iter().zip(&due[keys..]).map(|(a, b)| a * b).sum::<f64>() < 0.0 {
            p.iter_mut().for_each(|x| *x = -*x);
        }
    }
}

/// An answer of a program that runs: no file, and no lines.
pub(super) fn printed(rows: Vec<Vec<f64>>) -> Answer {
    Answer { path: "standard output".into(), lines: vec![0; rows.len()], rows }
}

/// (steps, error) of the rungs whose setting is a number of steps.
fn errors(rungs: &[Rung]) -> Vec<(u64, f64)> {
    rungs.iter().filter_map(|rung| Some((rung.setting.steps().ok()?, rung.error()))).collect()
}

/// Grades a program on a problem: about free rods at the last time, about tensors at all times; and at other
/// times, once each.
pub fn grade(program: &Program, problem: &LoadedProblem, mode: Mode, claimed: Option<f64>) -> Graded {
    program.during(&problem.problem.name);
    let begun = Instant::now();
    let graded = timeless(program, problem, mode, claimed);
    Graded { seconds: begun.elapsed().as_secs_f64(), ..graded }
}

fn timeless(program: &Program, problem: &LoadedProblem, mode: Mode, claimed: Option<f64>) -> Graded {
    let is_line_of_numbers = problem.problem.kind == Kind::Rods && problem.problem.rotation_rad_per_s.is_none();
    if program.protocol == Protocol::Text && !is_line_of_numbers {
        let note = Some("not asked: a request about it needs lines of JSON".to_owned());
        return Graded { verdict: Verdict::Refused, note, ..Graded::without_answer(problem) };
    }
    match problem.problem.kind {
        Kind::Rods => {
            let others = others(problem).iter().map(last_time).collect();
            climbed(program, &last_time(problem), others, mode, claimed, |of, setting| {
                let (found, took) = program.ask(&Question::of(of), setting)?;
                Ok((found.p.into_iter().map(Vec::from).collect(), took))
            })
        }
        Kind::Formula => formula(program, problem),
        _ => {
            let axes = program.axes;
            let asked = |of: &LoadedProblem, setting: Setting| {
                let size = [of.problem.times_s.len(), of.problem.columns.len() - 1];
                program.ask_table(&tables::of_tensor(&of.problem, setting, axes), size)
            };
            let first = asked(problem, climb::settings(problem, mode)[0]);
            // A closed equation has no random answer.
            let is_random = problem.problem.closed.is_none() && matches!(first, Ok(((_, Some(_)), _)));
            let first = Cell::new(Some(first));
            let table = |of: &LoadedProblem, setting| first.take().unwrap_or_else(|| asked(of, setting));
            if is_random {
                return random::graded(program, problem, mode, |setting| table(problem, setting));
            }
            let columns = &problem.problem.columns[1..];
            let ask = |of: &LoadedProblem, setting: Setting| {
                let ((rows, _), took) = table(of, setting)?;
                Ok((rows.iter().map(|row| axes.row_to_ours(columns, row)).collect(), took))
            };
            let graded = climbed(program, problem, others(problem), mode, claimed, ask);
            // A program that refuses every number of steps may choose its own.
            if graded.verdict != Verdict::Refused || graded.steps.is_some() || mode == Mode::Tolerance {
                return graded;
            }
            match asked(problem, Setting::Tolerance(1e-3)) {
                Err(Asked::Says(_)) => graded,
                Ok(((_, Some(_)), _)) if problem.problem.closed.is_none() => {
                    random::graded(program, problem, Mode::Tolerance, |setting| asked(problem, setting))
                }
                _ => climbed(program, problem, others(problem), Mode::Tolerance, claimed, ask),
            }
        }
    }
}

/// Says that answers to numbers of steps that double converge to the certified one, though none may be within the
/// tolerance.
pub(in crate::serve::grade) fn converging(problem: &LoadedProblem, answers: &[(u64, Answer)]) -> Option<String> {
    let last = answers.last_chunk::<4>()?;
    let rung = |(steps, answer): &(u64, Answer)| {
        Rung::of(problem, Setting::Steps(*steps), answer.rows.clone(), Duration::ZERO)
    };
    let doubles = last.windows(2).all(|pair| pair[1].0 == 2 * pair[0].0);
    doubles.then(|| converges(problem, &last.each_ref().map(rung))).flatten()
}

/// Grades a program on a formula, which has no steps.
fn formula(program: &Program, problem: &LoadedProblem) -> Graded {
    let mut graded = Graded::without_answer(problem);
    let size = [problem.certified.rows.len(), problem.problem.columns.len() - 1];
    match program.ask_table(&tables::of_formula(problem), size) {
        Ok(((rows, _), _)) => judge(&mut graded, problem, &printed(rows), None),
        Err(asked) => {
            graded.note = Some(asked.to_string());
            graded.verdict = match asked {
                Asked::Says(_) => Verdict::Refused,
                Asked::Breach(_) => Verdict::Fail,
                Asked::Late(_) => Verdict::NotReached,
            };
        }
    }
    graded
}

/// What a program answers to a setting, and the time that it took.
type Table = Result<(Vec<Vec<f64>>, Duration), Asked>;

fn climbed(
    program: &Program,
    problem: &LoadedProblem,
    others: Vec<LoadedProblem>,
    mode: Mode,
    claimed: Option<f64>,
    answer: impl Fn(&LoadedProblem, Setting) -> Table,
) -> Graded {
    let of = &problem.problem;
    let ask_of = |problem: &LoadedProblem, setting: Setting| {
        let (rows, took) = answer(problem, setting)?;
        Ok(Rung::of(problem, setting, rows, took))
    };
    let ask = |setting: Setting| ask_of(problem, setting);
    let (rungs, mut end) = climb(problem, mode, program.timeout, claimed, ask);
    let rounding = |rung: &Rung| digits::remark(&rung.answer, rung.error(), rung.setting.steps().ok());
    // Rounding that explains the error hides the order, and refutes none.
    let hidden = matches!(end, End::Lower) && rungs.last().and_then(rounding).is_some();
    if hidden {
        end = if within(&rungs, of.tolerance) { End::Reached } else { End::Stays(String::new()) };
    }
    if matches!(end, End::Reached) {
        end = jumps::judged(&rungs, of.tolerance, fewest(&of.times_s), ask);
    }
    // Answers that do not settle may be random.
    if let (End::Reached | End::Stays(_) | End::Wrong(_), Some(last)) = (&end, rungs.last()) {
        let again = elsewhere::repeated(last, of.tolerance, program.timeout, ask);
        if matches!((&end, &again), (End::Reached, _) | (_, End::Jumps(_))) {
            end = again;
        }
    }
    let mut named = Diagnosis::default();
    for other in &others {
        if let (End::Reached, Some(passed)) = (&end, rungs.last()) {
            (end, named) =
                elsewhere::judged(passed, [other, problem], program.timeout, |setting| ask_of(other, setting));
        }
    }
    let mut graded = Graded::without_answer(problem);
    graded.set_orders(errors(&rungs), problem, claimed);
    match end {
        End::Lower => graded.order_found = Some(Order::Lower),
        _ if hidden => graded.order_found = Some(Order::Unclear),
        _ => {}
    }
    let refuted = graded.order_found == Some(Order::Lower);
    // Whether a mistake is named must not depend on how fast the machine is; that of a step is of order 1.
    let mistaken = matches!(end, End::NotReached(_)) && claimed != Some(1.0) && stays_on_a_mistake(problem, &rungs);
    let unfinished = matches!(end, End::NotReached(_) | End::NoFiner(_) | End::Stays(_)) && !mistaken;
    let converging = unfinished.then(|| converges(problem, &rungs)).flatten().filter(|_| !refuted);
    graded.verdict = match converging {
        Some(_) => Verdict::Pass,
        None => verdict(&end, mistaken),
    };
    let finest = best(&rungs);
    if let Some(finest) = finest {
        graded.set_setting(finest.setting);
        graded.set_answer(problem, &finest.answer, &finest.compared, settled(&rungs));
    }
    if named.said.is_some() {
        (graded.diagnosis, graded.suspects) = (named.said, named.suspects);
    }
    let answers = rungs.iter().filter_map(|rung| Some((rung.setting.steps().ok()?, rung.error(), &rung.answer)));
    slips::name(&mut graded, problem, claimed, answers);
    // What converges as far as it goes is not wrong.
    let falls = || graded.steps_needed().is_some() || fall_with_tolerances(&rungs).is_some();
    // Nor is what has taken coarse steps alone, unless it lies on the curve of a mistake.
    let coarse = || rungs.len() <= resolving(is_smooth(problem)) && graded.diagnosis.is_none();
    if matches!(end, End::NoFiner(_)) && graded.verdict == Verdict::Fail && (falls() || coarse()) {
        graded.verdict = Verdict::Refused;
    }
    let may_be_reached = !matches!(end, End::Wrong(_) | End::Stays(_));
    graded.note = match end {
        _ if converging.is_some() => converging,
        End::Broke(words) | End::Jumps(words) | End::Refused(words) => Some(words),
        End::Lower => claimed.map(|claimed| other(&graded, claimed)),
        End::Reached => not_finite(&rungs),
        End::Stays(words) | End::Wrong(words) | End::NoFiner(words) | End::NotReached(words) => {
            // Of directions there is no worst component.
            let is_absolute = of.metric == Metric::Absolute;
            let finite = finest.filter(|finest| finest.error().is_finite() && is_absolute);
            let worst = finite.map(|finest| place(problem, &finest.answer, finest.compared.row));
            // Few digits are the reason why errors end.
            let few = finest.and_then(rounding);
            let words = if few.is_some() { String::new() } else { words };
            let remark = finite.and_then(|finest| finest.compared.remark.clone());
            let wrong = graded.verdict == Verdict::Fail && graded.diagnosis.is_none();
            let long = graded.length_drift.filter(|drift| wrong && *drift > 0.1);
            let long = long.map(|drift| format!("the length of p is off 1 by up to {drift:.1}: are these components?"));
            let on_axis = problem.start.iter().any(|p| p[0].hypot(p[1]) < 1e-9);
            let pole = (on_axis && finest.is_some_and(|finest| !finest.error().is_finite()))
                .then(|| "a rod lies along axis 3, where φ is undefined and p does not move".to_owned());
            let why = why(&graded, finest, words, may_be_reached);
            Some(joined([Some(why), pole, long, remark, worst, few]))
        }
    };
    graded
}

/// How far an answer that has settled may be from the curve of its mistake: what the last steps still change, and few
/// printed digits.
fn settled(rungs: &[Rung]) -> f64 {
    match rungs {
        [.., before, last] => before.answer.largest_change(&last.answer).max(PRINTED),
        _ => f64::INFINITY,
    }
}

const PRINTED: f64 = 1e-4;

/// The finest answer, or where its error is rounding that grows, the best one.
fn best(rungs: &[Rung]) -> Option<&Rung> {
    match rungs {
        [.., before, _, last] if last.error() > 1.5 * before.error() => {
            let finite = rungs.iter().filter(|rung| rung.error().is_finite());
            finite.min_by(|a, b| a.error().total_cmp(&b.error()))
        }
        _ => rungs.last(),
    }
}

/// The verdict of an end, at answers that lie on the curve of a known mistake or not.
fn verdict(end: &End, mistaken: bool) -> Verdict {
    match end {
        // Whether a mistake is named must not depend on how fast the machine is.
        End::NotReached(_) if mistaken => Verdict::Fail,
        End::NotReached(_) => Verdict::NotReached,
        End::Reached => Verdict::Pass,
        End::Refused(_) => Verdict::Refused,
        _ => Verdict::Fail,
    }
}

/// True if the last two settings give the curve of the same mistake: other settings will not give another.
fn stays_on_a_mistake(problem: &LoadedProblem, rungs: &[Rung]) -> bool {
    let [.., before, last] = rungs else {
        return false;
    };
    let named = |rung: &Rung| {
        let found = diagnose(problem, &rung.answer, rung.error(), rung.setting.steps().ok());
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

/// The reason why an answer is not within the tolerance, which more steps may reach or not.
fn why(graded: &Graded, finest: Option<&Rung>, words: String, may_be_reached: bool) -> String {
    let Some(finest) = finest else {
        return words;
    };
    let (setting, error) = (finest.setting, finest.error());
    if !error.is_finite() {
        let finite = finest.answer.rows.iter().flatten().all(|x| x.is_finite());
        let what = if finite { "too large to judge" } else { "not finite" };
        return format!("with {setting} the answer is {what}; {words}");
    }
    let said = match setting {
        Setting::Tolerance(asked) => {
            format!("asked for the tolerance {asked:.0e} it is off by {error:.1e}")
        }
        _ => format!("with {setting} it is off by {error:.1e}"),
    };
    let words = Some(words).filter(|words| !words.is_empty());
    joined([Some(said), graded.steps_needed().filter(|_| may_be_reached), words])
}
