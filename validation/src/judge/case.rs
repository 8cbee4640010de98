//! A case: one claim, the check that tests it, and the controls that the same check must fail.

mod effort;
mod judges;
mod outcome;

pub use effort::{Effort, GATE_SEED};
pub use judges::Judges;
pub use outcome::{Control, Judged, Outcome};

use crate::judge::accept::{LEVEL, Rule, Text, Verdict, kolmogorov_samples};
use crate::judge::statistics::{Sample, kolmogorov};
use outcome::{lacks_data, overall};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::time::Instant;

/// A number and the rule that judges it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Evidence {
    /// The measured quantity, in a few words.
    pub what: String,
    /// The unit of its error and of its tolerance; `–` for a number without one, as a ratio or a probability.
    pub unit: Text,
    /// The rule.
    pub rule: Rule,
}

impl Evidence {
    /// Evidence on the quantity `what`, of which the rule and its reason follow.
    pub fn on(what: impl Into<String>, unit: &'static str) -> Quantity {
        Quantity(what.into(), unit)
    }

    /// The rule `rule` for the quantity `what`.
    pub fn new(what: impl Into<String>, unit: &'static str, rule: Rule) -> Self {
        Self { what: what.into(), unit: unit.into(), rule }
    }
}

/// A measured quantity, in a few words, and its unit.
pub struct Quantity(String, &'static str);

impl Quantity {
    /// The rule that `error` is 0.
    pub fn exact(self, error: f64) -> Evidence {
        Evidence::new(self.0, self.1, Rule::exact(error))
    }

    /// The rule that `error` is at most `tolerance`.
    pub fn within(self, error: f64, tolerance: f64) -> Bound {
        Bound(self, Box::new(move |because| Rule::Within { error, tolerance, because }))
    }

    /// The rule that the mean of a sample is `reference` up to `allowance`; the sample must be large enough to show
    /// `effect` beyond it.
    pub fn is(self, sample: Sample, reference: f64, allowance: f64, effect: f64) -> Bound {
        let Sample { mean, se, samples } = sample;
        Bound(self, Box::new(move |because| Rule::Mean { mean, se, samples, reference, allowance, effect, because }))
    }

    /// The rule that the mean of a sample exceeds `bound`; the sample must be large enough to show an excess of
    /// `effect`.
    pub fn exceeds(self, sample: Sample, bound: f64, effect: f64) -> Bound {
        let Sample { mean, se, samples } = sample;
        Bound(self, Box::new(move |because| Rule::Above { mean, se, samples, bound, effect, because }))
    }

    /// The rule that p, of a test on `samples` values of which it needs `enough`, is at least `level`.
    pub fn p_value(self, p: f64, samples: u64, enough: u64, level: f64) -> Bound {
        Bound(self, Box::new(move |because| Rule::PValue { p, samples, enough, level, distance: None, because }))
    }

    /// The Kolmogorov–Smirnov test that `values` in [0, 1] are uniform; there must be enough values to show a
    /// `distance` between the two distribution functions.
    pub fn uniform(self, values: Vec<f64>, distance: f64) -> Bound {
        let (samples, enough) = (values.len() as u64, kolmogorov_samples(distance));
        let (found, p) = kolmogorov(values);
        let (level, distance) = (LEVEL, Some(found));
        Bound(self, Box::new(move |because| Rule::PValue { p, samples, enough, level, distance, because }))
    }
}

/// A quantity with its bound, which still lacks the reason for it.
#[must_use]
pub struct Bound(Quantity, Box<dyn FnOnce(Text) -> Rule>);

impl Bound {
    /// Adds the reason for the tolerance, or for the allowance and the effect.
    pub fn because(self, reason: impl Into<Text>) -> Evidence {
        Evidence::new(self.0.0, self.0.1, (self.1)(reason.into()))
    }
}

/// The result of a check: evidence, or an error, which fails the check without a number.
pub trait Findings {
    /// The result as evidence.
    fn evidence(self) -> Vec<Evidence>;
}

impl Findings for Evidence {
    fn evidence(self) -> Vec<Evidence> {
        vec![self]
    }
}

impl<T: Findings> Findings for Vec<T> {
    fn evidence(self) -> Vec<Evidence> {
        self.into_iter().flat_map(T::evidence).collect()
    }
}

impl<T: Findings, const N: usize> Findings for [T; N] {
    fn evidence(self) -> Vec<Evidence> {
        self.into_iter().flat_map(T::evidence).collect()
    }
}

impl<T: Findings, E: fmt::Display> Findings for Result<T, E> {
    fn evidence(self) -> Vec<Evidence> {
        self.map_or_else(|error| vec![Evidence::on(error.to_string(), "–").exact(f64::NAN)], T::evidence)
    }
}

type Check = Box<dyn Fn(&Effort) -> Vec<Evidence> + Send + Sync>;

/// Description of a case.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct About {
    /// Name of the case, in words joined by `-`.
    pub name: &'static str,
    /// The kind of implementation that it judges.
    pub judges: Judges,
    /// The claim, in one sentence.
    pub claim: &'static str,
    /// The equations that it tests, then figures, sections or pages in words: `eqs 4, A.7–A.9; Fig. 6`.
    pub source: &'static str,
    /// Numbers of these equations, from which the traceability table is made.
    pub equations: Vec<String>,
}

impl About {
    /// The claim, in one sentence.
    pub fn claim(self, claim: &'static str) -> Self {
        Self { claim, ..self }
    }

    /// The equations that the case tests, then figures, sections or pages in words: `eqs 4, A.7–A.9; Fig. 6`.
    pub fn source(self, source: &'static str) -> Self {
        Self { source, equations: equations(source), ..self }
    }

    /// The implementation under test: a function, a scene, a model.
    pub fn under_test<S>(self, implementation: S) -> UnderTest<S> {
        UnderTest { about: self, implementation, mistakes: Vec::new() }
    }

    /// The tags of the case: the kind that it judges, and its equations as `eq-15`.
    pub fn tags(&self) -> Vec<String> {
        let equations = self.equations.iter().map(|number| format!("eq-{number}"));
        std::iter::once(self.judges.tag().to_owned()).chain(equations).collect()
    }
}

/// Numbers of the equations before the first `;` of a source line, with ranges written out; none if words stand there.
fn equations(source: &str) -> Vec<String> {
    let list = source.split(';').next().unwrap_or_default();
    let list = list.trim_start_matches("eqs ").trim_start_matches("eq. ");
    let number = |text: &str| {
        let (appendix, digits) = text.strip_prefix("A.").map_or(("", text), |digits| ("A.", digits));
        digits.parse::<u32>().ok().map(|number| (appendix, number))
    };
    let range = |item: &str| {
        let (first, last) = item.split_once('–').unwrap_or((item, item));
        let ((appendix, first), (_, last)) = (number(first)?, number(last)?);
        Some((first..=last).map(move |number| format!("{appendix}{number}")).collect())
    };
    list.split(", ").map(range).collect::<Option<Vec<Vec<String>>>>().unwrap_or_default().concat()
}

/// One claim with its check and its controls.
pub struct Case {
    /// Description of the case.
    pub about: About,
    check: Check,
    controls: Vec<(&'static str, Check)>,
}

impl Case {
    /// A case that judges such an implementation; its claim, source and check follow.
    pub fn of(judges: Judges, name: &'static str) -> About {
        About { name, judges, claim: "", source: "", equations: Vec::new() }
    }

    /// Runs the check, then every control. Without data, controls are not run, as they could not fail.
    pub fn run(&self, effort: &Effort) -> Outcome {
        let start = Instant::now();
        let evidence: Vec<_> = (self.check)(effort).into_iter().map(Judged::new).collect();
        let no_data = lacks_data(&evidence);
        let controls: Vec<_> = self
            .controls
            .iter()
            .filter(|_| !no_data)
            .map(|(mistake, check)| Control::new(mistake, &check(effort)))
            .collect();
        let uncaught = match self.about.judges {
            Judges::Measurement => Verdict::Underpowered,
            _ => Verdict::Fail,
        };
        Outcome {
            about: self.about.clone(),
            verdict: overall(&evidence, &controls, uncaught),
            evidence,
            controls,
            seconds: start.elapsed().as_secs_f64(),
        }
    }
}

/// A case that still lacks its check.
pub struct UnderTest<S> {
    about: About,
    implementation: S,
    mistakes: Vec<(&'static str, S)>,
}

impl<S: Send + Sync + 'static> UnderTest<S> {
    /// A control: a broken implementation that the same check must fail.
    pub fn mistake(mut self, name: &'static str, broken: S) -> Self {
        self.mistakes.push((name, broken));
        self
    }

    /// Adds several controls.
    pub fn mistakes(mut self, broken: impl IntoIterator<Item = (&'static str, S)>) -> Self {
        self.mistakes.extend(broken);
        self
    }

    /// Completes the case with the check of the implementation under test and of every mistake.
    pub fn check<F: Findings + 'static>(self, check: fn(&S, &Effort) -> F) -> Case {
        let bind = |implementation: S| -> Check { Box::new(move |effort| check(&implementation, effort).evidence()) };
        Case {
            about: self.about,
            check: bind(self.implementation),
            controls: (self.mistakes.into_iter()).map(|(name, broken)| (name, bind(broken))).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn is_three(value: &f64, _: &Effort) -> Result<Vec<Evidence>, &'static str> {
        match value {
            7.0 => Err("no seven"),
            _ => Ok(vec![Evidence::on("three", "–").exact(value - 3.0)]),
        }
    }

    #[test]
    fn a_case_passes_only_with_its_controls_caught() {
        let verdict = |value, broken: Vec<(&'static str, f64)>| {
            let case = Case::of(Judges::Core, "a").claim("c").under_test(value).mistakes(broken).check(is_three);
            case.run(&Effort::gate()).verdict
        };
        assert_eq!(verdict(3.0, vec![("four", 4.0)]), Verdict::Pass);
        assert_eq!(verdict(4.0, vec![("four", 4.0)]), Verdict::Fail);
        assert_eq!(verdict(3.0, vec![("four", 4.0), ("not broken", 3.0)]), Verdict::Fail);
        assert_eq!(verdict(3.0, vec![]), Verdict::Fail, "a case without a control is no case");
        assert_eq!(verdict(f64::NAN, vec![("four", 4.0)]), Verdict::Fail);
        assert_eq!(verdict(7.0, vec![("four", 4.0)]), Verdict::Fail, "an error is no result");
        assert_eq!(
            verdict(3.0, vec![("no number", f64::NAN)]),
            Verdict::Fail,
            "a check that breaks has caught nothing"
        );
        assert_eq!(verdict(3.0, vec![("an error", 7.0)]), Verdict::Fail, "nor has an error");
    }

    #[test]
    fn a_source_line_names_its_equations() {
        let of = |source| equations(source).join(" ");
        assert_eq!(of("eq. 15"), "15");
        assert_eq!(of("eqs 4, 7–9, A.13; Fig. 6, eq. 14"), "4 7 8 9 A.13");
        assert_eq!(of("A.2–A.5; Jeffery's equation in p"), "A.2 A.3 A.4 A.5");
        assert_eq!(of("Folgar & Tucker 1984; eq. 13"), "");
    }

    /// Of three conditions one has data: it is judged, and only without any the case says so.
    #[test]
    fn what_data_there_are_is_judged() {
        let check = |value: &f64, _: &Effort| {
            let none = || Evidence::new("none", "–", Rule::NoData { supply: "a file".into() });
            let judged = (*value > 0.0).then(|| Evidence::on("three", "–").exact(value - 3.0));
            [none()].into_iter().chain(judged).chain([none()]).collect::<Vec<_>>()
        };
        let verdict = |value| {
            Case::of(Judges::Core, "a").under_test(value).mistake("four", 4.0).check(check).run(&Effort::gate())
        };
        for (value, expected) in [(3.0, Verdict::Pass), (4.0, Verdict::Fail), (0.0, Verdict::NoData)] {
            let outcome = verdict(value);
            assert_eq!((outcome.verdict, outcome.controls.len()), (expected, usize::from(value > 0.0)));
        }
    }

    #[test]
    fn measured_points_that_are_too_few_are_no_fault() {
        let case = Case::of(Judges::Measurement, "a").under_test(3.0).mistake("not broken", 3.0).check(is_three);
        assert_eq!(case.run(&Effort::gate()).verdict, Verdict::Underpowered);
    }
}
