//! Findings from all problems together: one mistake that explains several of them, or one quantity that is off by an
//! unknown factor.

use super::diagnosis::shows;
use super::estimate::{self, Wrong};
use super::nearness::{CURVE, VALUES, shared};
use super::{Graded, Verdict, tensors};
use crate::serve::problems::{Kind, LoadedProblem};
use std::collections::BTreeSet;

/// The largest number of names in a finding.
const MOST_NAMES: usize = 3;

/// Sentences on what explains more than one problem. A problem that passes rules out an explanation that contradicts
/// it. A mistake that explains several stands in the diagnosis of each.
pub fn overall(problems: &[LoadedProblem], graded: &mut [Graded]) -> Vec<String> {
    let found = findings(problems, graded);
    for Finding { names, of, instead, .. } in &found {
        for graded in graded.iter_mut().filter(|graded| of.contains(&graded.name)) {
            if let Some(said) = &mut graded.diagnosis
                && !names.iter().any(|name| said.contains(name))
            {
                said.clone_from(instead);
            }
            // Two changes are more than the one over all.
            let has_two = |said: &String| [", with ", ", in "].iter().any(|second| said.contains(second));
            graded.is_said_over_all = graded.diagnosis.as_ref().is_some_and(|said| !has_two(said));
        }
    }
    contradict(problems, graded);
    found.into_iter().map(|finding| finding.said).collect()
}

/// Adds to a formula's diagnosis the other answers of the same kind in which the mistake would show, but does not.
fn contradict(problems: &[LoadedProblem], graded: &mut [Graded]) {
    let loaded = |name: &str| problems.iter().find(|loaded| loaded.problem.name == name);
    let alike = |a: &LoadedProblem, b: &LoadedProblem| a.problem.columns == b.problem.columns;
    let without = |own: &Graded| -> Option<Vec<String>> {
        let own_loaded = loaded(&own.name).filter(|_| own.kind == Kind::Formula && own.diagnosis.is_some())?;
        let others = graded.iter().filter(|other| other.name != own.name && other.error.is_some());
        let lacks = |other: &&Graded| {
            let shown = |of: &LoadedProblem| own.suspects.iter().any(|name| shows(of, name));
            let differ = own.suspects.iter().all(|name| !other.suspects.contains(name));
            differ && loaded(&other.name).is_some_and(|of| alike(of, own_loaded) && shown(of))
        };
        Some(others.filter(lacks).map(|other| other.name.clone()).collect())
    };
    let all: Vec<_> = graded.iter().map(without).collect();
    for (graded, without) in graded.iter_mut().zip(all) {
        if let (Some(said), Some(names)) = (&mut graded.diagnosis, without.filter(|names| !names.is_empty())) {
            *said += &format!(" (not in {}, where it would show)", names.join(", "));
        }
    }
}

struct Finding {
    names: Vec<String>,
    /// The problems that it explains.
    of: Vec<String>,
    /// The diagnosis of a problem that has another one.
    instead: String,
    said: String,
}

fn findings(problems: &[LoadedProblem], graded: &[Graded]) -> Vec<Finding> {
    let wrong: Vec<_> =
        graded.iter().filter(|graded| matches!(graded.verdict, Verdict::Fail | Verdict::NotReached)).collect();
    let named = by_name(problems, graded, &wrong);
    // One number that explains every wrong answer is more than a mistake that explains some.
    let law = by_law(&passing(problems, graded), problems, &wrong, !named.is_empty());
    let law = law.filter(|law| named.iter().all(|finding| finding.of.len() < law.of.len()));
    law.map_or(named, |law| vec![law])
}

fn passing<'a>(problems: &'a [LoadedProblem], graded: &[Graded]) -> Vec<&'a LoadedProblem> {
    let passes = |loaded: &&LoadedProblem| {
        let of = |graded: &&Graded| graded.name == loaded.problem.name;
        graded.iter().find(of).is_some_and(|graded| graded.verdict == Verdict::Pass)
    };
    problems.iter().filter(passes).collect()
}

/// Takes the mistake that explains the most problems, with all that explain the same ones, then continues with the
/// rest.
fn by_name(problems: &[LoadedProblem], graded: &[Graded], wrong: &[&Graded]) -> Vec<Finding> {
    let passing = passing(problems, graded);
    let mut all: BTreeSet<&String> = wrong.iter().flat_map(|graded| &graded.suspects).collect();
    // A mistake in one of a program's formulas need not be in the others.
    let formulas = wrong.iter().all(|graded| graded.kind == Kind::Formula);
    let explains_all = |name: &String| formulas && wrong.iter().all(|graded| graded.suspects.contains(name));
    all.retain(|name| explains_all(name) || !passing.iter().any(|loaded| shows(loaded, name)));
    let mut left = wrong.to_vec();
    let mut said = Vec::new();
    loop {
        let explained = |name: &String| -> Vec<&str> {
            let of = left.iter().copied().filter(|graded| graded.suspects.contains(name));
            of.map(|graded| graded.name.as_str()).collect()
        };
        let Some(most) = all.iter().map(|name| explained(name).len()).max().filter(|most| *most > 1) else {
            return said;
        };
        let best: Vec<_> = all.iter().copied().filter(|name| explained(name).len() == most).collect();
        let of = explained(best[0]);
        // Where a curve has come to rest, many share its end: some problem must tell the mistake by itself.
        let theirs: Vec<_> = left.iter().copied().filter(|graded| of.contains(&graded.name.as_str())).collect();
        let alone = theirs.iter().any(|graded| graded.diagnosis.is_some());
        // If others explain as many problems, but not the same ones, no mistake is certain.
        let alike = best.iter().all(|name| explained(name) == of);
        if alike && alone && best.len() <= MOST_NAMES {
            let names: Vec<_> = best.iter().map(|name| (*name).clone()).collect();
            let rest = match wrong.len() - of.len() {
                0 => format!("all {}", of.len()),
                _ => format!("{} of {}", of.len(), wrong.len()),
            };
            let (all, fits) = (names.join(", or "), of.join(", "));
            let without_time = theirs.iter().all(|graded| matches!(graded.kind, Kind::Formula | Kind::Contact));
            let (what, its, theirs) =
                if without_time { (VALUES, "its values fit", "values") } else { (CURVE, "its curve fits", "curves") };
            let either = if names.len() > 1 { format!(" (their {theirs} are equal here)") } else { String::new() };
            let advice = shared(names.iter().map(|name| tensors::advice(name)));
            said.push(Finding {
                of: of.iter().map(|name| (*name).to_owned()).collect(),
                instead: format!("{what} of {}", names.join(" or of ")),
                said: format!("one mistake explains {rest} that do not pass: {all}{either}; {its} {fits}{advice}"),
                names,
            });
        }
        left.retain(|graded| !of.contains(&graded.name.as_str()));
    }
}

/// The law that explains every wrong answer about rods, or unless `all`, at least every one in plane Couette flow.
fn by_law(passing: &[&LoadedProblem], problems: &[LoadedProblem], wrong: &[&Graded], all: bool) -> Option<Finding> {
    let mut own: Vec<_> = (wrong.iter().copied())
        .filter_map(|graded| {
            let of = |loaded: &&LoadedProblem| loaded.problem.name == graded.name && loaded.problem.kind == Kind::Rods;
            Some(Wrong::new(problems.iter().find(of)?.clone(), graded.answer.as_ref()?, graded.error?))
        })
        .collect();
    let mut laws = estimate::laws(&own, passing);
    if laws.is_empty() && !all {
        own.retain(|wrong| wrong.loaded.is_couette());
        laws = estimate::laws(&own, passing);
    }
    let of: Vec<_> = own.iter().map(|wrong| wrong.loaded.problem.name.clone()).collect();
    let words = laws.join(", or ");
    let said = format!("{words}, on {} of {} that do not pass: {}", of.len(), wrong.len(), of.join(", "));
    (!laws.is_empty()).then_some(Finding { names: laws, of, instead: words, said })
}

#[cfg(test)]
mod tests {
    use super::super::answer::Answer;
    use super::super::compare::compare;
    use super::super::mistakes::{self, Setting};
    use super::*;
    use crate::serve::problems::loaded;
    use nalgebra::Vector3;
    use std::f64::consts::PI;

    fn problems() -> Vec<LoadedProblem> {
        ["mid-flip-2", "mid-flip-11.6", "spiral", "sphere"].map(loaded).into()
    }

    fn graded(problems: &[LoadedProblem], of: &[(Verdict, &[&str])]) -> Vec<Graded> {
        let one = |(loaded, (verdict, suspects)): (&LoadedProblem, &(Verdict, &[&str]))| Graded {
            verdict: *verdict,
            suspects: suspects.iter().map(|name| (*name).to_owned()).collect(),
            diagnosis: suspects.first().map(|name| format!("this is the curve of {name}")),
            ..Graded::without_answer(loaded)
        };
        problems.iter().zip(of).map(one).collect()
    }

    #[test]
    fn one_mistake_is_named_over_all_that_it_explains_and_equal_ones_together() {
        use Verdict::{Fail, Pass};
        let problems = problems();
        let said = |of: &[(Verdict, &[&str])]| overall(&problems, &mut graded(&problems, of));
        let (half, twice) = ("half the shear rate", "twice the shear rate");
        let found = said(&[(Fail, &[half]), (Fail, &[half]), (Fail, &[half, twice]), (Fail, &[])]);
        assert_eq!(
            found,
            ["one mistake explains 3 of 4 that do not pass: half the shear rate; its curve fits mid-flip-2, \
                mid-flip-11.6, spiral; L_ij = ∂u_i/∂x_j, W = (L − Lᵀ)/2, D = (L + Lᵀ)/2"]
        );
        // Curves that have come to rest name it in no problem.
        let mut resting = graded(&problems, &[(Fail, &[half]), (Fail, &[half])]);
        resting.iter_mut().for_each(|graded| graded.diagnosis = None);
        assert_eq!(overall(&problems, &mut resting), [""; 0]);
        let both = said(&[(Fail, &[half, twice]), (Fail, &[twice, half]), (Pass, &[]), (Pass, &[])]);
        // Both mistakes would show on a problem that passes.
        assert_eq!(both, [""; 0]);
        let both = said(&[(Fail, &[half, twice]), (Fail, &[twice, half])]);
        assert!(
            both[0].contains("half the shear rate, or twice the shear rate (their curves are equal here)"),
            "{both:?}"
        );
        // One that can be made in plane Couette flow alone is not ruled out by another flow.
        let period = "T without 1/r_e";
        let found = said(&[(Fail, &[period]), (Fail, &[period]), (Pass, &[])]);
        assert!(found[0].contains(period), "{found:?}");
        // One problem is not enough, nor are two with different mistakes.
        assert_eq!(said(&[(Fail, &[half]), (Fail, &[twice])]), [""; 0]);
    }

    #[test]
    fn a_formulas_mistake_is_not_said_to_be_where_it_is_not() {
        use Verdict::{Fail, Pass};
        let problems = ["dadt-ft-quadratic", "dadt-ft-linear", "closure-ore"].map(loaded);
        let name = "a transposed gradient";
        let said = |other: &[&str], verdict: Verdict| {
            let mut found = graded(&problems, &[(Fail, &[name]), (verdict, other), (Fail, &[])]);
            found.iter_mut().for_each(|graded| graded.error = Some(1.0));
            overall(&problems, &mut found);
            found[0].diagnosis.clone().unwrap()
        };
        // Of a closure it says nothing.
        assert!(said(&[], Fail).ends_with("gradient (not in dadt-ft-linear, where it would show)"));
        assert!(said(&["half the shear rate"], Fail).contains("(not in dadt-ft-linear"));
        assert!(said(&[], Pass).contains("(not in dadt-ft-linear"));
        assert!(said(&[name], Fail).ends_with("gradient"));
    }

    /// Problems with their answers and verdicts, of a program that turns a rod as `other` does in each.
    fn turning(other: impl Fn(Setting) -> (Setting, f64)) -> Vec<String> {
        let problems = problems();
        let of = |loaded: &LoadedProblem| {
            let (setting, rate) = other(Setting::from(&loaded.problem));
            let row = |time: &f64| {
                let map = mistakes::right_map(&setting, rate * time).unwrap();
                loaded.start.iter().map(move |p| (map * Vector3::from(*p)).normalize().as_slice().to_vec())
            };
            let answer =
                Answer { rows: loaded.problem.times_s.iter().flat_map(row).collect(), ..Answer::certified(loaded) };
            let error = compare(loaded, &answer).error;
            let verdict = if error <= loaded.problem.tolerance { Verdict::Pass } else { Verdict::Fail };
            Graded { verdict, error: Some(error), answer: Some(answer), ..Graded::without_answer(loaded) }
        };
        overall(&problems, &mut problems.iter().map(of).collect::<Vec<_>>())
    }

    #[test]
    fn a_factor_is_said_that_explains_every_problem() {
        let ratio = |s: Setting, aspect_ratio: f64| (Setting { aspect_ratio, ..s }, 1.0);
        let shape = |s: Setting, of: fn(f64) -> f64| ratio(s, of(s.aspect_ratio.ln().tanh()).atanh().exp());
        for (found, due) in [
            (turning(|s| (s, 0.8333)), "your time runs at 0.833 of the true one, on 4 of 4 that do not pass: mid"),
            (
                turning(|s| (s, PI / ((1e6 * PI).trunc() / 1e6))),
                "your time runs at 1.000000208 of the true one (π taken as 3.141592?), ",
            ),
            (turning(|s| ratio(s, 1.3 * s.aspect_ratio)), "your r_e is 1.300 times what is asked, on 4 of 4"),
            (
                turning(|s| ratio(s, s.aspect_ratio.powf(0.8))),
                "your r_e is the power 0.800 of what is asked, on 3 of 3",
            ),
            (turning(|s| shape(s, |x| 0.9 * x)), "your Λ is 0.900 times (r_e² − 1)/(r_e² + 1), on 3 of 3 that"),
            (
                turning(|s| ratio(s, 7.0)),
                "your r_e is 7.000 in every problem, on 4 of 4 that do not pass: mid-flip-2, ",
            ),
        ] {
            assert!(found.len() == 1 && found[0].starts_with(due), "{due}: {found:?}");
        }
        // A right program, and one with a rate of its own in one of the problems.
        assert_eq!(turning(|s| (s, 1.0)), [""; 0]);
        assert_eq!(turning(|s| (s, if s.aspect_ratio == 2.0 { 0.9 } else { 0.8 })), [""; 0]);
    }
}
