//! From coarse settings to fine ones, until the answers are within the tolerance, prove that they will not be, or time
//! is up.

use super::{Mode, Rung, errors, settled};
use crate::methods::integrators::Setting;
use crate::serve::grade::answer::Answer;
use crate::serve::grade::compare::compare;
use crate::serve::grade::diagnosis::diagnose;
use crate::serve::grade::live::program::Asked;
use crate::serve::grade::order::{Order, ROUND_OFF, orders};
use crate::serve::problems::{Kind, LoadedProblem, Metric};
use std::time::{Duration, Instant};

/// The largest number of doublings of the steps, from GΔt of about 1.
const DOUBLINGS: u32 = 24;

/// Number of rungs that allow no prediction: after them a step is at most a hundredth of a unit of strain.
const RESOLVING: usize = 7;

/// The same for tensors, which do not flip: after them a step is some sixteenth of a unit of strain.
const RESOLVING_TENSORS: usize = 3;

/// The number of coarse settings, which prove nothing: they may be unstable, or miss the motion.
pub(super) fn resolving(smooth: bool) -> usize {
    if smooth { RESOLVING_TENSORS } else { RESOLVING }
}

/// True of tensors, which do not flip, unless their answers are random.
pub(super) fn is_smooth(problem: &LoadedProblem) -> bool {
    problem.problem.kind != Kind::Rods && problem.problem.metric != Metric::StandardErrors
}

/// The largest change, as a share of the error, of an answer that has settled on a curve.
const STILL: f64 = 1e-5;

/// Said of answers that have settled.
const NO_CHANGE: &str = "finer ones no longer change the answer";

/// The number of equal answers that show that a setting is ignored.
const SAME: usize = 4;

/// Number of settings in a row that a program may refuse before any answer, by which a step is short, and after one.
const REFUSALS: [usize; 2] = [RESOLVING + 1, 2];

/// An error in rad below which a method follows the motion, so that an answer that no longer changes is a result.
pub(super) const FOLLOWED: f64 = 0.01;

/// The end of a ladder. Running out of time is not a failure.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum End {
    /// The answers came within the tolerance.
    Reached,
    /// Every answer was an error of the program's own.
    Refused(String),
    /// The program broke the protocol, even if it answered before.
    Broke(String),
    /// The error jumps from one number of steps to the next.
    Jumps(String),
    /// The errors stay or grow, as rounding does.
    Stays(String),
    /// Finer settings would not come within the tolerance, or there are no finer settings.
    Wrong(String),
    /// The program refuses finer settings.
    NoFiner(String),
    /// The errors fall with an order lower than the claimed one.
    Lower,
    /// Time ran out first, or the smallest tolerance was asked for while errors still fell.
    NotReached(String),
}

impl End {
    /// The end where a program that passes gives no answer to a further question; it may refuse one.
    pub(super) fn without_answer(asked: Asked) -> Self {
        match asked {
            Asked::Says(_) => Self::Reached,
            Asked::Late(words) => Self::NotReached(words),
            Asked::Breach(words) => Self::Broke(words),
        }
    }
}

/// Climbs, and returns the rungs and the end. If an order is claimed, it goes on until that is confirmed, refuted, or
/// below round-off.
pub(super) fn climb(
    problem: &LoadedProblem,
    mode: Mode,
    timeout: Duration,
    claimed: Option<f64>,
    ask: impl Fn(Setting) -> Result<Rung, Asked>,
) -> (Vec<Rung>, End) {
    let tolerance = problem.problem.tolerance;
    // A program that chooses its steps shows no order.
    let claimed = claimed.filter(|_| mode == Mode::Steps);
    let mut rungs: Vec<Rung> = Vec::new();
    // Errors of random answers are in units of their own.
    let smooth = is_smooth(problem);
    let (mut says, mut refused) = (None, 0);
    let mut begun = Instant::now();
    for setting in settings(problem, mode) {
        let took = match ask(setting) {
            Ok(rung) => {
                // The first answer may hold the program's start.
                if rungs.is_empty() {
                    begun = Instant::now();
                }
                let took = rung.took;
                rungs.push(rung);
                refused = 0;
                took
            }
            // Shorter steps may help.
            Err(Asked::Says(words)) => {
                says.get_or_insert(format!("the program says: {words}"));
                refused += 1;
                if refused >= REFUSALS[usize::from(!rungs.is_empty())] {
                    break;
                }
                Duration::ZERO
            }
            Err(Asked::Breach(words)) => return (rungs, End::Broke(format!("asked for {setting}: {words}"))),
            Err(Asked::Late(words)) => {
                return (rungs, End::NotReached(format!("asked for {setting}: {words}")));
            }
        };
        let orders = claimed.map(|claimed| (claimed, orders(&errors(&rungs), problem.tolerances())));
        if orders.as_ref().is_some_and(|(claimed, orders)| orders.refuted_early(*claimed)) {
            let end = ignores(&rungs, tolerance).map_or(End::Lower, |words| End::Wrong(words.to_owned()));
            return (rungs, end);
        }
        let arrived = reached(&rungs, tolerance);
        match orders {
            None if arrived => return (rungs, End::Reached),
            Some((claimed, orders)) if arrived => match orders.judged(claimed) {
                Order::Lower => return (rungs, End::Lower),
                Order::Unclear if !orders.ended => {}
                _ => return (rungs, End::Reached),
            },
            _ => {}
        }
        let ended = || hopeless(&rungs, tolerance, timeout, smooth).or_else(|| on_a_mistake(problem, &rungs, smooth));
        if !arrived && let Some(end) = ended() {
            return (rungs, end);
        }
        let spent = begun.elapsed();
        let confirms = !arrived && within(&rungs, tolerance);
        let starts = rungs.len() == 1 && !confirms;
        if !starts && !affordable(spent, took, timeout, confirms) {
            if arrived {
                return (rungs, End::Reached);
            }
            if rungs.len() >= RESOLVING && !rungs.iter().any(|rung| rung.error().is_finite()) {
                return (rungs, End::Wrong("nor is it with fewer steps".to_owned()));
            }
            if let Some(words) = no_longer_falls(&rungs, smooth) {
                return (rungs, End::Stays(words.to_owned()));
            }
            let (seconds, limit) = (spent.as_secs_f64(), timeout.as_secs_f64());
            let one = if within(&rungs, tolerance) { "one answer alone is within the tolerance; " } else { "" };
            let words = format!("{one}finer ones would take longer than --timeout {limit} ({seconds:.1} s so far)");
            return (rungs, End::NotReached(words));
        }
    }
    let end = match says {
        Some(words) if rungs.is_empty() => End::Refused(words),
        // No finer setting can confirm the last one.
        _ if within(&rungs, tolerance) => End::Reached,
        Some(words) => End::NoFiner(words),
        None if fall_with_tolerances(&rungs).is_some() => End::NotReached("no smaller tolerance is asked for".into()),
        None => End::Wrong("there is no finer setting".to_owned()),
    };
    (rungs, end)
}

/// True if there is time for one more setting. A setting that would confirm an answer is allowed if it can finish
/// within the timeout.
fn affordable(spent: Duration, took: Duration, timeout: Duration, confirms: bool) -> bool {
    if confirms { 2 * took <= timeout } else { 4 * took <= timeout && spent <= timeout }
}

pub(super) fn within(rungs: &[Rung], tolerance: f64) -> bool {
    rungs.last().is_some_and(|rung| rung.error() <= tolerance)
}

/// True if two settings in a row are within the tolerance, or one to which the error fell by a steady order: a single
/// one may be an accidental crossing.
pub(super) fn reached(rungs: &[Rung], tolerance: f64) -> bool {
    let within = |rung: &&Rung| rung.error() <= tolerance;
    match rungs.iter().rev().take_while(within).count() {
        0 => false,
        1 => steady_order(rungs).is_some(),
        _ => true,
    }
}

/// The reason why finer settings would not come within the tolerance, if the settings so far prove it. A `smooth`
/// motion is that of tensors.
pub(super) fn hopeless(rungs: &[Rung], tolerance: f64, timeout: Duration, smooth: bool) -> Option<End> {
    let resolving = &rungs[resolving(smooth).min(rungs.len())..];
    let [.., third, second, first, last] = resolving else {
        return None;
    };
    let errors = [third, second, first, last].map(Rung::error);
    if !errors.iter().any(|error| error.is_finite()) {
        return Some(End::Wrong("finer ones are not finite either".to_owned()));
    }
    let changes = [(third, second), (second, first), (first, last)];
    let changes = changes.map(|(coarse, fine)| coarse.answer.largest_change(&fine.answer));
    // A method that follows the motion, with any order above 0.02, changes by more than a hundredth of its error.
    let still = if errors[3] < FOLLOWED || smooth { 0.01 * errors[3] } else { 0.01 * tolerance };
    if let Some(words) = ignores(rungs, tolerance) {
        return Some(End::Wrong(words.to_owned()));
    }
    if changes.iter().all(|change| *change <= still) && errors[3] > tolerance {
        return Some(End::Wrong(NO_CHANGE.to_owned()));
    }
    if converge_elsewhere(resolving) && errors[3] > tolerance {
        return Some(End::Wrong("the answers converge, but not to the certified one".to_owned()));
    }
    // A steady order predicts the number of steps, and two times that double predict the run time.
    let order = steady_order(resolving)?;
    let doubles = first.took > Duration::from_millis(200) && last.took < 3 * first.took;
    let more = (errors[3] / tolerance).powf(1.0 / order);
    let needed_s = last.took.as_secs_f64() * more;
    (doubles && needed_s > 4.0 * timeout.as_secs_f64()).then(|| {
        End::NotReached(format!("finer ones would take some {needed_s:.0e} s, which --timeout does not allow"))
    })
}

/// The end where two short steps in a row give the curve of one known mistake: no other will give another.
fn on_a_mistake(problem: &LoadedProblem, rungs: &[Rung], smooth: bool) -> Option<End> {
    let [before, last] = rungs.get(resolving(smooth)..)?.last_chunk()?;
    let error = last.error();
    let stays = error > problem.problem.tolerance && before.answer.largest_change(&last.answer) <= STILL * error;
    let found = stays.then(|| diagnose(problem, &last.answer, error, last.setting.steps().ok()))?;
    let found = found.within(settled(rungs));
    found.said.map(|_| End::Wrong(NO_CHANGE.to_owned()))
}

/// A message on answers that are the same to the last digit with every setting, and wrong.
fn ignores(rungs: &[Rung], tolerance: f64) -> Option<&'static str> {
    let last = rungs.last().filter(|last| rungs.len() >= SAME && last.error() > tolerance)?;
    let same = |rung: &Rung| rung.answer.largest_change(&last.answer) == 0.0;
    match last.setting {
        _ if !rungs.iter().all(same) => None,
        Setting::Tolerance(_) => Some("the answer is the same with any tolerance: the program ignores \"tolerance\""),
        // A program that chooses its steps follows the motion.
        Setting::Steps(_) if last.error() < FOLLOWED => Some(
            "the program ignores \"steps\": the answers are the same to the last digit. If it chooses its own, let it \
             answer \"error\" to \"steps\", and it is asked by \"tolerance\"",
        ),
        Setting::Steps(_) => Some("the answer is the same with any number of steps"),
        _ => None,
    }
}

/// A message if the errors of the last four settings do not fall any more, with steps that are short.
fn no_longer_falls(rungs: &[Rung], smooth: bool) -> Option<&'static str> {
    let last = rungs.get(resolving(smooth)..)?.last_chunk::<4>()?.each_ref().map(Rung::error);
    let least = last[..3].iter().copied().fold(f64::INFINITY, f64::min);
    if last[3] > 2.0 * last[0] && last[3] >= last[2] {
        Some("the error grows with the steps, as rounding does")
    } else {
        (last[3] >= 0.9 * least).then_some("the error no longer falls with the steps")
    }
}

/// True if the last five answers converge to another answer than the certified one: the changes between them shrink
/// each time like those of a method of order 0.8 at least, and all further changes together are within a hundredth of
/// the error. Where they have shrunk to a ten-millionth of the error, they may be rounding and need not shrink any
/// more.
fn converge_elsewhere(rungs: &[Rung]) -> bool {
    let Some(last) = rungs.last_chunk::<5>() else {
        return false;
    };
    let changes = [0, 1, 2, 3].map(|k| last[k].answer.largest_change(&last[k + 1].answer));
    let (error, shrinks) = (last[4].error(), |k: usize| changes[k] >= 1.7 * changes[k + 1]);
    let settled = |k: usize| changes[k + 1] <= 1e-7 * error;
    shrinks(0) && [1, 2].into_iter().all(|k| shrinks(k) || settled(k)) && 2.0 * changes[3] <= 0.01 * error
}

/// The last error of a program that chooses its steps, if the last four fall with the tolerances, by 100 at least.
pub(super) fn fall_with_tolerances(rungs: &[Rung]) -> Option<f64> {
    let last = rungs.last_chunk::<4>()?;
    let chooses = last.iter().all(|rung| matches!(rung.setting, Setting::Tolerance(_)));
    let falls = last.windows(2).all(|pair| pair[1].error() < pair[0].error());
    let error = last[3].error();
    (chooses && falls && error < FOLLOWED && 100.0 * error <= last[0].error()).then_some(error)
}

/// The order with which the last four errors fall, if it is nearly the same for each pair.
fn steady_order(rungs: &[Rung]) -> Option<f64> {
    steady(&rungs.last_chunk::<4>()?.each_ref().map(Rung::error), 0.1)
}

/// The order with which numbers fall from one doubling of the steps to the next, if the same for each pair but for
/// `most`.
fn steady(all: &[f64], most: f64) -> Option<f64> {
    let orders: Vec<_> = all.windows(2).map(|pair| (pair[0] / pair[1]).log2()).collect();
    let last = *orders.last()?;
    orders.iter().all(|order| *order > 0.5 && (order - last).abs() < most).then_some(last)
}

/// A message on answers that converge to the certified one, though none is within the tolerance: their errors fall by a
/// steady order, up to where rounding may begin, and what they extrapolate to (Richardson) is right to within the
/// uncertainty of the extrapolation; or they fall with the tolerances, and two smaller ones would be enough.
pub(super) fn converges(problem: &LoadedProblem, rungs: &[Rung]) -> Option<String> {
    if let Some(error) = fall_with_tolerances(rungs).filter(|error| *error <= NEARLY * problem.problem.tolerance) {
        let setting = rungs.last()?.setting;
        return Some(format!(
            "converges to the certified answer: its errors fall with the tolerances, to {error:.1e} with {setting}"
        ));
    }
    (4..=rungs.len()).rev().take(ROUNDED).find_map(|count| last_converge(problem, &rungs[..count]))
}

/// The largest last error, in tolerances of a problem, of errors that fall with the tolerances asked for: two smaller
/// ones would bring it within, which a double does not have.
const NEARLY: f64 = 100.0;

/// The number of doublings of the steps by which rounding may have spoilt answers that converge.
const ROUNDED: usize = 8;

fn last_converge(problem: &LoadedProblem, rungs: &[Rung]) -> Option<String> {
    /// The largest uncertainty as a share of the last error: more proves nothing.
    const SHARE: f64 = 0.05;
    /// The largest difference of orders that settle.
    const SETTLES: f64 = 0.25;
    let last = rungs.last_chunk::<4>()?;
    steady(&last.each_ref().map(Rung::error), SETTLES)?;
    // The order of the answers alone: that of the errors would hide a wrong limit.
    let order = steady(&[0, 1, 2].map(|k| last[k].answer.largest_change(&last[k + 1].answer)), SETTLES)?;
    // Methods have whole orders, which answers near the limit show to many digits, but not to all.
    let whole = order.round();
    let order = if (order - whole).abs() < 0.1 { whole } else { order };
    let extrapolated = |coarse: &Rung, fine: &Rung| -> Vec<Vec<f64>> {
        let weight = 1.0 / (order.exp2() - 1.0);
        let of = |(coarse, fine): (&Vec<f64>, &Vec<f64>)| {
            fine.iter().zip(coarse).map(|(fine, coarse)| fine + weight * (fine - coarse)).collect()
        };
        coarse.answer.rows.iter().zip(&fine.answer.rows).map(of).collect()
    };
    let with = |rows: Vec<Vec<f64>>| Answer { rows, ..last[3].answer.clone() };
    let [before, best] = [with(extrapolated(&last[1], &last[2])), with(extrapolated(&last[2], &last[3]))];
    let (error, left) = (compare(problem, &best).error, last[3].error());
    // The next term of the error falls faster than the first.
    let uncertainty = best.largest_change(&before) / (order.exp2() - 1.0);
    // Over many steps a right code's rounding exceeds both terms, but not the tolerance.
    let allowed = (uncertainty + ROUND_OFF * problem.tolerances()[0]).max(problem.problem.tolerance);
    (left < FOLLOWED && uncertainty <= SHARE * left && error <= allowed).then(|| {
        format!(
            "converges to the certified answer at order {order:.2}: with {} it is off by {left:.1e}, and extrapolated \
             by {error:.0e} (uncertainty {uncertainty:.0e})",
            last[3].setting
        )
    })
}

pub(super) fn settings(problem: &LoadedProblem, mode: Mode) -> Vec<Setting> {
    let of = &problem.problem;
    let largest = of.gradient_per_s.iter().flatten().fold(0.0, |a: f64, b| a.max(b.abs()));
    let strain = largest * of.times_s.last().copied().unwrap_or_default();
    let coarsest = (strain.ceil() as u64).next_power_of_two().max(8).next_multiple_of(fewest(&of.times_s));
    match mode {
        Mode::Steps => (0..=DOUBLINGS).map(|k| Setting::Steps(coarsest << k)).collect(),
        Mode::Tolerance => (2..=14).map(|k| Setting::Tolerance(10f64.powi(-k))).collect(),
    }
}

/// The fewest equal steps that end at each of these times, of which all other such numbers are multiples; 1 if there
/// are none below a thousand.
pub(super) fn fewest(times_s: &[f64]) -> u64 {
    let last = times_s.last().copied().unwrap_or_default();
    let ends_at = |steps: u64, time: &f64| {
        let step = time / last * steps as f64;
        (step - step.round()).abs() < 1e-9
    };
    (1..1000).find(|steps| times_s.iter().all(|time| ends_at(*steps, time))).unwrap_or(1)
}
