//! Diagnosis of a wrong answer: the known mistake that produces the same curve.

use super::answer::Answer;
use super::compare;
use super::contact;
use super::estimate::Wrong;
use super::means;
use super::mistakes::{self, AXES, Mistake, Setting};
pub use super::nearness::Diagnosis;
use super::nearness::{CURVE, NEARER, Near, VALUES, apart, largest_within, said};
use super::tensors::{self, columns::indices};
use super::{Graded, Verdict};
use crate::methods::integrators::apart_rad;
use crate::serve::problems::{Kind, LoadedProblem, Metric};
use nalgebra::Vector3;

/// The diagnosis of an answer, by so many steps, whose error is `error`; empty if the error is within the tolerance or
/// NaN.
pub fn diagnose(loaded: &LoadedProblem, answer: &Answer, error: f64, steps: Option<u64>) -> Diagnosis {
    if error.is_nan() || error <= loaded.problem.tolerance {
        return Diagnosis::default();
    }
    let found = named(loaded, answer, error, steps);
    let in_time =
        matches!(loaded.problem.kind, Kind::Rods | Kind::Tensor) && loaded.problem.metric != Metric::StandardErrors;
    // Many curves meet their own values of other times.
    let off =
        (in_time && found.suspects.is_empty() && found.said.is_none()).then(|| row_off(loaded, answer, NEARER * error));
    off.flatten().map_or(found, |off| Diagnosis::named("this is the right answer", off))
}

fn named(loaded: &LoadedProblem, answer: &Answer, error: f64, steps: Option<u64>) -> Diagnosis {
    let (tolerance, nearer_than) = (loaded.problem.tolerance, NEARER * error);
    match loaded.problem.kind {
        Kind::Contact => said(VALUES, contact::near(loaded, answer, nearer_than), tolerance, ""),
        Kind::Formula => tensors::formulas::diagnose(loaded, answer, error),
        // By its standard errors an answer of random numbers fits too many curves.
        Kind::Tensor if loaded.problem.metric == Metric::StandardErrors => Diagnosis::default(),
        Kind::Ensemble => Diagnosis { said: means::ensemble(loaded, answer), ..Diagnosis::default() },
        _ if loaded.problem.aspect_ratio_sd_percent > 0.0 => {
            said(CURVE, means::unequal(loaded, answer, nearer_than), tolerance, "")
        }
        Kind::Rods if rests(loaded, answer, nearer_than) => {
            Diagnosis::sentence("every rod is where it started: nothing has moved")
        }
        Kind::Tensor if loaded.problem.is_diffusive() => tensors::diagnose(loaded, answer, error, steps),
        _ => {
            let known = mistakes::all();
            let near: Vec<_> = (known.iter())
                .filter_map(|mistake| Some(Near::new(distance(loaded, answer, mistake)?, &mistake.name)))
                .filter(|near| near.distance <= nearer_than)
                .collect();
            // In plane Couette flow alone, other axes are a transposed gradient; all problems together tell.
            let (axes, others): (Vec<_>, Vec<_>) = near.into_iter().partition(|near| near.name.starts_with(AXES));
            let also: Vec<_> = axes.iter().flat_map(|near| near.suspects.clone()).collect();
            let mut found = said(CURVE, if others.is_empty() { axes } else { others }, tolerance, "");
            found.suspects.extend(also);
            if found.suspects.is_empty() && loaded.problem.kind == Kind::Rods {
                let off = steps.and_then(|steps| {
                    steps_off(&Wrong::new(loaded.clone(), answer, error), steps)
                        .or_else(|| frozen(loaded, answer, nearer_than, steps))
                });
                if let Some(off) = off.or_else(|| reordered(loaded, answer, nearer_than)) {
                    return Diagnosis::named("this is", off);
                }
                if let Some(said) = not_unit(loaded, answer, nearer_than) {
                    return Diagnosis::sentence(&said);
                }
            }
            // A result that other mistakes reach as well is no evidence for this one.
            let mut suspected = known.iter().filter(|mistake| found.suspects.contains(&mistake.name));
            if suspected.any(|mistake| has_come_to_rest(loaded, mistake, nearer_than)) {
                found.said = None;
            }
            found
        }
    }
}

/// The distance of an answer about rods or tensors from a mistake's curve; `None` if the mistake does not apply.
fn distance(loaded: &LoadedProblem, answer: &Answer, mistake: &Mistake) -> Option<f64> {
    between(loaded, &answer.rows, &rows(loaded, mistake, 1.0)?, mistake.has_length)
}

/// An earlier time, as a share of the time asked for, at which a rotating curve is unlikely to have the same value.
const EARLIER: f64 = 0.731;

/// True if the mistake's curve had reached its end value long before.
fn has_come_to_rest(loaded: &LoadedProblem, mistake: &Mistake, nearer_than: f64) -> bool {
    let moved = || {
        let [early, late] = [EARLIER, 1.0].map(|part| rows(loaded, mistake, part));
        between(loaded, &early?, &late?, mistake.has_length)
    };
    moved().is_some_and(|moved| moved <= nearer_than)
}

/// True if a mistake is detectable on a problem: its curve is not within the tolerance of the certified answer.
pub(super) fn shows(loaded: &LoadedProblem, name: &str) -> bool {
    let (problem, certified) = (&loaded.problem, Answer::certified(loaded));
    let distance = match problem.kind {
        _ if problem.aspect_ratio_sd_percent > 0.0 => None,
        Kind::Tensor if problem.is_diffusive() => tensors::off(loaded, name),
        Kind::Formula => tensors::formulas::off(loaded, name),
        _ => (mistakes::all().iter().find(|mistake| mistake.name == name))
            .and_then(|mistake| distance(loaded, &certified, mistake)),
    };
    distance.is_some_and(|distance| distance > 2.0 * problem.tolerance)
}

/// A remark on problems that pass by a tolerance so large that rods which do not move would pass, though they should.
pub fn loose(problems: &[LoadedProblem], graded: &[Graded]) -> Option<String> {
    let at_rest = |loaded: &&LoadedProblem| {
        let rows: Vec<_> = loaded.problem.times_s.iter().flat_map(|_| &loaded.start).map(|p| p.to_vec()).collect();
        let answer = Answer { lines: vec![0; rows.len()], rows, path: "rods at rest".into() };
        let error = compare::compare(loaded, &answer).error;
        error > loaded.tolerances()[0] && error <= loaded.problem.tolerance
    };
    let is_raised = |loaded: &&LoadedProblem| loaded.problem.tolerance > loaded.own_tolerance;
    let rods = problems.iter().filter(|loaded| loaded.problem.kind == Kind::Rods).filter(is_raised);
    let passes = |name: &&str| graded.iter().any(|graded| graded.name == *name && graded.verdict == Verdict::Pass);
    let names = rods.filter(at_rest).map(|loaded| loaded.problem.name.as_str());
    let names: Vec<_> = names.filter(passes).collect();
    (!names.is_empty())
        .then(|| format!("with this tolerance rods that do not move would pass too: {}", names.join(", ")))
}

/// True if no rod has moved: then many curves are alike, and none is named.
fn rests(loaded: &LoadedProblem, answer: &Answer, nearer_than: f64) -> bool {
    let count = loaded.start.len();
    let stays = |(row, values): (usize, &Vec<f64>)| {
        let start = Vector3::from(loaded.start[row % count]);
        apart(&Vector3::from_row_slice(values), &start, false) <= nearer_than
    };
    answer.rows.iter().enumerate().all(stays)
}

/// A sentence if the whole error is that of the directions' lengths.
fn not_unit(loaded: &LoadedProblem, answer: &Answer, nearer_than: f64) -> Option<String> {
    let directions =
        |answer: &Answer| -> Vec<_> { answer.rows.iter().map(|row| Vector3::from_row_slice(row)).collect() };
    let (found, right) = (directions(answer), directions(&Answer::certified(loaded)));
    let angles = found.iter().zip(&right).map(|(found, right)| apart_rad(found, right));
    let lengths = || found.iter().map(|p| p.norm());
    let (least, most) = (lengths().fold(f64::INFINITY, f64::min), crate::oracle::worst(lengths()));
    let right = least > 0.0 && crate::oracle::worst(angles) <= nearer_than;
    let digits = (-(most - 1.0).abs().max((least - 1.0).abs()).log10()).clamp(4.0, 14.0).ceil() as usize + 2;
    right.then(|| {
        format!("only the directions' length is wrong: |p| is {least:.digits$} to {most:.digits$}, where 1 is due")
    })
}

/// One step too few and one too many.
pub(super) const STEPS_OFF: [&str; 2] =
    ["one step too few: N − 1 of N, or Δt = T/(N + 1)", "one step too many: N + 1 for N, or Δt = T/(N − 1)"];

/// What a rate of time means after so many steps, if it is that of a step too few or too many.
pub(super) fn step_off(rate: f64, steps: u64) -> Option<&'static str> {
    let (steps, missing) = (steps as f64, (1.0 - rate) * steps as f64);
    let is = |due: f64| (missing - due).abs() < 0.01 || (missing - due * steps / (steps + due)).abs() < 0.01;
    STEPS_OFF.into_iter().zip([1.0, -1.0]).find(|(_, due)| is(*due)).map(|(name, _)| name)
}

/// The right motion with a step too few or too many, if the answer is that.
fn steps_off(wrong: &Wrong<'_>, steps: u64) -> Option<&'static str> {
    wrong.rates().into_iter().find_map(|rate| step_off(rate, steps))
}

/// The right rows at the times before or after their own, if the answer is that where there are such times: at least
/// two, with other right rows than their own.
fn row_off(loaded: &LoadedProblem, answer: &Answer, nearer_than: f64) -> Option<&'static str> {
    let rods = answer.rows.len() / loaded.problem.times_s.len();
    let (found, right) = (&answer.rows, Answer::certified(loaded).rows);
    let kept = right.len().checked_sub(rods).filter(|kept| *kept >= 2 * rods)?;
    let is_near = |(found, due): (&Vec<f64>, &Vec<f64>)| compare::distance(loaded, found, due) <= nearer_than;
    let are = |found: &[Vec<f64>], due: &[Vec<f64>]| found.iter().zip(due).all(is_near);
    let moves = |k: usize| !are(&right[k * rods..(k + 1) * rods], &right[(k + 1) * rods..(k + 2) * rods]);
    if !(0..kept / rods).all(moves) {
        None
    } else if are(&found[rods..], &right[..kept]) {
        Some("a row too late: each is that of the time before")
    } else {
        are(&found[..kept], &right[rods..]).then_some("a row too early: each is that of the time after")
    }
}

/// L(t) taken at the start of each step, if the answer is that.
fn frozen(loaded: &LoadedProblem, answer: &Answer, nearer_than: f64, steps: u64) -> Option<&'static str> {
    let (problem, setting) = (&loaded.problem, Setting::from(&loaded.problem));
    problem.rotation_rad_per_s?;
    let end_s = problem.times_s.last()?;
    let of_time = |time_s: &f64| {
        let share = (steps as f64 * time_s / end_s).round().max(1.0);
        let map = mistakes::frozen(&setting, *time_s, share as u32)?;
        Some(loaded.start.iter().map(move |p| (map * Vector3::from(*p)).normalize().as_slice().to_vec()))
    };
    let curve: Option<Vec<_>> = problem.times_s.iter().map(of_time).collect();
    let curve: Vec<_> = curve?.into_iter().flatten().collect();
    let near = between(loaded, &answer.rows, &curve, false)? <= nearer_than;
    near.then_some("L(t) taken at the start of each step, where any method is of order 1")
}

/// Rods in another order, if the answer is that: the same one at all times.
fn reordered(loaded: &LoadedProblem, answer: &Answer, nearer_than: f64) -> Option<&'static str> {
    let right = Answer::certified(loaded).rows;
    let is = |row: &Vec<f64>, other: &Vec<f64>| {
        let near = between(loaded, std::slice::from_ref(row), std::slice::from_ref(other), false);
        near.is_some_and(|near| near <= nearer_than)
    };
    let order = |(found, right): (&[Vec<f64>], &[Vec<f64>])| -> Option<Vec<usize>> {
        let mut left: Vec<_> = (0..right.len()).collect();
        let mut place = |row: &Vec<f64>| Some(left.remove(left.iter().position(|k| is(row, &right[*k]))?));
        found.iter().map(&mut place).collect()
    };
    let times = answer.rows.chunks(loaded.start.len()).zip(right.chunks(loaded.start.len()));
    let orders: Option<Vec<_>> = times.map(order).collect();
    let same = orders?.windows(2).all(|orders| orders[0] == orders[1]);
    same.then_some("the right answer with the rods in another order")
}

/// The rows of an answer with this mistake, at times multiplied by `part`; `None` if the mistake does not apply.
fn rows(loaded: &LoadedProblem, mistake: &Mistake, part: f64) -> Option<Vec<Vec<f64>>> {
    let (problem, setting) = (&loaded.problem, Setting::from(&loaded.problem));
    match problem.kind {
        Kind::Rods => {
            let starts = |time: &f64| {
                let time = part * time;
                loaded.start.iter().map(move |start| (Vector3::from(*start), time))
            };
            let all = problem.times_s.iter().flat_map(starts);
            all.map(|(start, time)| Some(mistake.direction(&setting, &start, time)?.as_slice().to_vec())).collect()
        }
        Kind::Tensor => {
            let columns = second_moments(&problem.columns)?;
            let of_time = |time: &f64| {
                let map = mistake.map(&setting, part * time)?;
                // With its length: ⟨qq⟩ of isotropic p(0).
                let a =
                    if mistake.has_length { map * map.transpose() / 3.0 } else { mistakes::isotropic_tensor(&map)? };
                let scale = if mistake.has_length { a.amax() } else { 1.0 };
                Some(columns.iter().map(|place| a[*place]).chain([scale]).collect())
            };
            problem.times_s.iter().map(of_time).collect()
        }
        Kind::Contact | Kind::Formula | Kind::Ensemble => None,
    }
}

/// Indices of the components of a_ij that a problem asks for; `None` if it asks for other columns.
fn second_moments(columns: &[String]) -> Option<Vec<(usize, usize)>> {
    columns.iter().skip(1).map(|name| indices(name)?.try_into().ok().map(|[i, j]: [usize; 2]| (i, j))).collect()
}

/// The distance of rows from a mistake's curve: directions by angle, tensor components relative to the last entry of
/// the curve's row.
fn between(loaded: &LoadedProblem, found: &[Vec<f64>], curve: &[Vec<f64>], has_length: bool) -> Option<f64> {
    let of_row = |(found, curve): (&Vec<f64>, &Vec<f64>)| match loaded.problem.kind {
        Kind::Rods => {
            let [found, curve] = [found, curve].map(|row| Vector3::from_row_slice(row));
            Some(apart(&found, &curve, has_length))
        }
        _ => {
            let (scale, components) = curve.split_last()?;
            Some(crate::oracle::apart(found, components) / scale)
        }
    };
    largest_within(f64::MAX, found.iter().zip(curve).map(of_row))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::serve::problems::loaded;

    /// The answer of a program that has this mistake and is correct otherwise.
    fn answer(loaded: &LoadedProblem, name: &str) -> Answer {
        let mistake = mistakes::all().into_iter().find(|mistake| mistake.name == name).unwrap();
        Answer { rows: rows(loaded, &mistake, 1.0).unwrap(), ..Answer::certified(loaded) }
    }

    #[test]
    fn curves_are_apart_by_angle_and_length_and_opposite_directions_are_the_same() {
        let (long, aside) = (Vector3::new(2.0, 0.0, 0.0), Vector3::new(2.0, 0.2, 0.0));
        for found in [aside, -aside] {
            assert!((apart(&found, &long, true) - 0.1).abs() < 1e-15);
            assert!((apart(&found, &long, false) - (aside.norm() - 1.0)).abs() < 1e-15);
            assert!((apart(&found.normalize(), &long, false) - 0.1f64.atan()).abs() < 1e-15);
        }
    }

    #[test]
    fn a_tolerance_that_lets_rods_at_rest_pass_is_named() {
        let said = |name: &str, tolerance: f64| {
            let loaded = loaded(name).with_tolerance(tolerance, "");
            let graded = Graded { verdict: Verdict::Pass, ..Graded::without_answer(&loaded) };
            loose(&[loaded], &[graded])
        };
        // Rods beside the poles move by less than 1e-4 rad, and those along the vorticity axis not at all.
        assert!(said("poles", 1e-4).is_some_and(|said| said.ends_with("too: poles")));
        assert_eq!(
            [("poles", 6e-6), ("log-rolling", 0.1), ("spiral", 0.1), ("closure-ibof", 0.1)]
                .map(|(name, x)| said(name, x)),
            [None, None, None, None]
        );
    }

    #[test]
    fn rows_of_the_time_before_or_after_are_named() {
        for name in ["mid-flip-11.6", "closed-ft-hybrid-mixed"] {
            let loaded = loaded(name);
            let (right, rods) = (Answer::certified(&loaded).rows, loaded.start.len().max(1));
            let said = |rows: Vec<Vec<f64>>| {
                diagnose(&loaded, &Answer { rows, ..Answer::certified(&loaded) }, 0.1, None).said.unwrap_or_default()
            };
            let late = [&right[..rods], &right[..right.len() - rods]].concat();
            let early = [&right[rods..], &right[right.len() - rods..]].concat();
            assert_eq!(
                said(late),
                "this is the right answer a row too late: each is that of the time before",
                "{name}"
            );
            assert_eq!(said(early), "this is the right answer a row too early: each is that of the time after");
            assert!(!said(right.into_iter().rev().collect()).contains("a row too"), "{name}");
        }
    }

    /// A = W/2 + ΛD and A = W + 2ΛD come to rest in the same direction: they can be distinguished at 2.7 s, but not at
    /// 150 s.
    #[test]
    fn a_mistake_is_not_named_by_where_it_has_come_to_rest() {
        let whole = loaded("mid-flip-11.6");
        let found = diagnose(&whole, &answer(&whole, "W halved twice"), 0.35, None);
        assert_eq!(found.suspects, ["W halved twice"]);
        assert!(found.said.is_some());
        let rows = (0..whole.certified.rows.len()).map(|row| whole.start[row % whole.start.len()].to_vec()).collect();
        let said = diagnose(&whole, &Answer { rows, ..Answer::certified(&whole) }, 0.35, None).said.unwrap();
        assert!(said.ends_with("nothing has moved"), "{said}");
        // A live program is asked only for the last time.
        let mut loaded = whole;
        loaded.problem.times_s.drain(..2);
        loaded.certified.rows.drain(..2);
        for (name, is_named) in [("W halved twice", false), ("D without its ½", false), ("half the shear rate", true)]
        {
            let found = diagnose(&loaded, &answer(&loaded, name), 0.35, None);
            assert_eq!(found.said.is_some(), is_named, "{name}: {found:?}");
            assert!(found.suspects.iter().any(|suspect| suspect == name), "{name}: {found:?}");
        }
        let at_rest = diagnose(&loaded, &answer(&loaded, "W halved twice"), 0.35, None).suspects;
        assert!(at_rest.iter().any(|suspect| suspect == "D without its ½"), "{at_rest:?}");
    }
}
