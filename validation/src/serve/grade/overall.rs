//! Findings from all problems together: one mistake that explains several of them, or time that runs at another rate.

use super::diagnosis::shows;
use super::mistakes::{self, Mistake};
use super::rates;
use super::{Graded, Verdict};
use crate::serve::problems::LoadedProblem;

/// The largest number of names in a finding.
const MOST_NAMES: usize = 3;

/// The largest relative difference of two problems' rates that count as equal: a method with long steps adds its own
/// error.
const SAME_RATE: f64 = 1e-3;

/// Sentences on what explains more than one problem. A problem that passes rules out an explanation that contradicts
/// it.
pub fn overall(problems: &[LoadedProblem], graded: &[Graded]) -> Vec<String> {
    let wrong: Vec<_> =
        graded.iter().filter(|graded| matches!(graded.verdict, Verdict::Fail | Verdict::NotReached)).collect();
    let named = by_name(problems, graded, &wrong);
    if named.is_empty() { by_rate(&passing(problems, graded), &wrong).into_iter().collect() } else { named }
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
fn by_name(problems: &[LoadedProblem], graded: &[Graded], wrong: &[&Graded]) -> Vec<String> {
    let passing = passing(problems, graded);
    let contradicted = |mistake: &Mistake| passing.iter().any(|loaded| shows(loaded, mistake));
    let known: Vec<_> = mistakes::all().into_iter().map(|mistake| (contradicted(&mistake), mistake.name)).collect();
    let allowed = |name: &String| !known.iter().any(|(contradicted, known)| *contradicted && known == name);
    let mut left: Vec<&Graded> = wrong.to_vec();
    let mut said = Vec::new();
    loop {
        let explained = |name: &String| -> Vec<&str> {
            let of = left.iter().filter(|graded| graded.suspects.contains(name));
            of.map(|graded| graded.name.as_str()).collect()
        };
        let mut names: Vec<&String> = left.iter().flat_map(|graded| &graded.suspects).collect();
        names.sort();
        names.dedup();
        names.retain(|name| allowed(name));
        let Some(most) = names.iter().map(|name| explained(name).len()).max().filter(|most| *most > 1) else {
            return said;
        };
        let best: Vec<_> = names.into_iter().filter(|name| explained(name).len() == most).collect();
        let of = explained(best[0]);
        // Where a curve has come to rest, many share its end: some problem must tell the mistake by itself.
        let alone = left.iter().any(|graded| of.contains(&graded.name.as_str()) && graded.diagnosis.is_some());
        // If others explain as many problems, but not the same ones, no mistake is certain.
        let alike = best.iter().all(|name| explained(name) == of);
        if alike && alone && best.len() <= MOST_NAMES {
            let names: Vec<_> = best.iter().map(|name| name.as_str()).collect();
            let either = if names.len() > 1 { " (their curves are equal here)" } else { "" };
            let rest = match wrong.len() - of.len() {
                0 => format!("all {}", of.len()),
                _ => format!("{} of {}", of.len(), wrong.len()),
            };
            let (names, of) = (names.join(", or "), of.join(", "));
            said.push(format!("one mistake explains {rest} that do not pass: {names}{either}; its curve fits {of}"));
        }
        let done: Vec<String> = explained(best[0]).iter().map(|name| (*name).to_owned()).collect();
        left.retain(|graded| !done.contains(&graded.name));
    }
}

/// The rate on which more problems agree than on any other.
fn by_rate(passing: &[&LoadedProblem], wrong: &[&Graded]) -> Option<String> {
    let same = |a: f64, b: f64| (a / b - 1.0).abs() < SAME_RATE;
    let agree = |rate: f64| -> Vec<&str> {
        let of = wrong.iter().filter(|graded| graded.rates.iter().any(|other| same(*other, rate)));
        of.map(|graded| graded.name.as_str()).collect()
    };
    let all: Vec<f64> = wrong.iter().flat_map(|graded| graded.rates.iter().copied()).collect();
    let most = all.iter().map(|rate| agree(*rate).len()).max().filter(|most| *most > 1)?;
    let best: Vec<f64> = all.into_iter().filter(|rate| agree(*rate).len() == most).collect();
    let rate = best.iter().sum::<f64>() / best.len() as f64;
    let contradicted = passing.iter().any(|loaded| rates::shows(loaded, rate));
    (!contradicted && best.iter().all(|other| same(*other, rate))).then(|| {
        let of = agree(rate);
        let (count, names) = (of.len(), of.join(", "));
        format!("your time runs at {rate:.3} of the true one, on {count} of {} that do not pass: {names}", wrong.len())
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::serve::problems::loaded;

    fn problems() -> Vec<LoadedProblem> {
        ["mid-flip-2", "mid-flip-11.6", "spiral", "sphere"].map(loaded).into()
    }

    fn graded(problems: &[LoadedProblem], of: &[(Verdict, &[&str], &[f64])]) -> Vec<Graded> {
        let one = |(loaded, (verdict, suspects, rates)): (&LoadedProblem, &(Verdict, &[&str], &[f64]))| Graded {
            verdict: *verdict,
            suspects: suspects.iter().map(|name| (*name).to_owned()).collect(),
            diagnosis: suspects.first().map(|name| format!("this is the curve of {name}")),
            rates: rates.to_vec(),
            ..Graded::without_answer(loaded)
        };
        problems.iter().zip(of).map(one).collect()
    }

    #[test]
    fn one_mistake_is_named_over_all_that_it_explains_and_equal_ones_together() {
        use Verdict::{Fail, Pass};
        let problems = problems();
        let said = |of: &[(Verdict, &[&str], &[f64])]| overall(&problems, &graded(&problems, of));
        let (half, twice) = ("half the shear rate", "twice the shear rate");
        let found = said(&[(Fail, &[half], &[]), (Fail, &[half], &[]), (Fail, &[half, twice], &[]), (Fail, &[], &[])]);
        assert_eq!(
            found,
            ["one mistake explains 3 of 4 that do not pass: half the shear rate; its curve fits mid-flip-2, \
                mid-flip-11.6, spiral"]
        );
        // Curves that have come to rest name it in no problem.
        let mut resting = graded(&problems, &[(Fail, &[half], &[]), (Fail, &[half], &[])]);
        resting.iter_mut().for_each(|graded| graded.diagnosis = None);
        assert_eq!(overall(&problems, &resting), [""; 0]);
        let both =
            said(&[(Fail, &[half, twice], &[]), (Fail, &[twice, half], &[]), (Pass, &[], &[]), (Pass, &[], &[])]);
        // Both mistakes would show on a problem that passes.
        assert_eq!(both, [""; 0]);
        let both = said(&[(Fail, &[half, twice], &[]), (Fail, &[twice, half], &[])]);
        assert!(
            both[0].contains("half the shear rate, or twice the shear rate (their curves are equal here)"),
            "{both:?}"
        );
        // One that can be made in plane Couette flow alone is not ruled out by another flow.
        let period = "T without 1/r_e";
        let found = said(&[(Fail, &[period], &[]), (Fail, &[period], &[]), (Pass, &[], &[])]);
        assert!(found[0].contains(period), "{found:?}");
        // One problem is not enough, nor are two with different mistakes.
        assert_eq!(said(&[(Fail, &[half], &[]), (Fail, &[twice], &[])]), [""; 0]);
    }

    #[test]
    fn a_rate_is_said_where_several_problems_have_it_and_no_other() {
        use Verdict::Fail;
        let problems = problems();
        let said = |of: &[(Verdict, &[&str], &[f64])]| overall(&problems, &graded(&problems, of));
        let found = said(&[(Fail, &[], &[0.8333, 1.9]), (Fail, &[], &[0.8334]), (Fail, &[], &[2.7, 0.8333])]);
        assert!(found[0].starts_with("your time runs at 0.833 of the true one, on 3 of 3"), "{found:?}");
        assert_eq!(said(&[(Fail, &[], &[0.8333]), (Fail, &[], &[0.9])]), [""; 0]);
        assert_eq!(said(&[(Fail, &[], &[0.8, 0.9]), (Fail, &[], &[0.8, 0.9])]), [""; 0], "which of the two?");
    }
}
