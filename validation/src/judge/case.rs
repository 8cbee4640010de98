//! A case: one claim, the check that tests it, and the controls that the same check must fail.

mod effort;
mod judges;
mod outcome;

pub use effort::{Effort, GATE_SEED};
pub use judges::Judges;
pub use outcome::{Control, Judged, Outcome};

use crate::judge::accept::{Rule, Text, Verdict};
use outcome::overall;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::time::Instant;

/// One number and the rule it is judged by.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Evidence {
    /// What was measured, in a few words.
    pub what: String,
    /// How it is judged.
    pub rule: Rule,
}

impl Evidence {
    /// `error` is at most `tolerance`, and why.
    pub fn within(what: impl Into<String>, error: f64, tolerance: f64, because: impl Into<Text>) -> Self {
        Self::new(what, Rule::within(error, tolerance, because))
    }

    /// Nothing is off at all.
    pub fn exact(what: impl Into<String>, error: f64) -> Self {
        Self::new(what, Rule::exact(error))
    }

    /// `rule` applied to what `what` says.
    pub fn new(what: impl Into<String>, rule: Rule) -> Self {
        Self { what: what.into(), rule }
    }
}

/// What a check brings home: evidence, or the error that kept it from any, which fails it without a number.
pub trait Findings {
    /// As evidence.
    fn evidence(self) -> Vec<Evidence>;
}

impl Findings for Vec<Evidence> {
    fn evidence(self) -> Vec<Evidence> {
        self
    }
}

impl<E: fmt::Display> Findings for Result<Vec<Evidence>, E> {
    fn evidence(self) -> Vec<Evidence> {
        self.unwrap_or_else(|error| vec![Evidence::exact(error.to_string(), f64::NAN)])
    }
}

type Check = Box<dyn Fn(&Effort) -> Vec<Evidence> + Send + Sync>;

/// What a case says of itself.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct About {
    /// Its name, in words joined by `-`.
    pub name: &'static str,
    /// What it judges.
    pub judges: Judges,
    /// The claim, in one sentence.
    pub claim: &'static str,
    /// Equations, figures or sections of the paper, in words.
    pub source: &'static str,
    /// The equations it tests, by their numbers: the traceability table is made from these.
    pub equations: &'static [&'static str],
}

impl About {
    /// What it can be chosen by: what it judges, and its equations as `eq-15`.
    pub fn tags(&self) -> Vec<String> {
        let equations = self.equations.iter().map(|number| format!("eq-{number}"));
        std::iter::once(self.judges.tag().to_owned()).chain(equations).collect()
    }
}

/// One claim with its check and its controls.
pub struct Case {
    /// What it says of itself.
    pub about: About,
    check: Check,
    controls: Vec<(&'static str, Check)>,
    /// What a control that was not caught makes of a case whose evidence passes.
    uncaught: Verdict,
}

impl Case {
    /// Verification of the simulator's core.
    pub fn core(name: &'static str) -> Draft {
        Draft::new(name, Judges::Core)
    }

    /// Verification of whole runs and of the program.
    pub fn program(name: &'static str) -> Draft {
        Draft::new(name, Judges::Program)
    }

    /// Verification of integrators.
    pub fn integrator(name: &'static str) -> Draft {
        Draft::new(name, Judges::Integrator)
    }

    /// Verification of an oracle.
    pub fn oracle(name: &'static str) -> Draft {
        Draft::new(name, Judges::Oracle)
    }

    /// A modelling choice where the paper is open.
    pub fn interpretation(name: &'static str) -> Draft {
        Draft::new(name, Judges::Interpretation)
    }

    /// A sentence of the paper.
    pub fn statement(name: &'static str) -> Draft {
        Draft::new(name, Judges::Statement)
    }

    /// Validation by points that others measured: where they are too few to catch a control, that is no fault of the
    /// code, and the case is under-powered.
    pub fn measurement(name: &'static str) -> Draft {
        Draft::new(name, Judges::Measurement)
    }

    /// Runs the check, then every control. Without data there is nothing that a control could fail on.
    pub fn run(&self, effort: &Effort) -> Outcome {
        let start = Instant::now();
        let evidence: Vec<_> = (self.check)(effort).into_iter().map(Judged::new).collect();
        let no_data = evidence.iter().any(|judged| judged.verdict == Verdict::NoData);
        let controls: Vec<_> = self
            .controls
            .iter()
            .filter(|_| !no_data)
            .map(|(mistake, check)| Control::new(mistake, &check(effort)))
            .collect();
        Outcome {
            about: self.about,
            verdict: overall(&evidence, &controls, self.uncaught),
            evidence,
            controls,
            seconds: start.elapsed().as_secs_f64(),
        }
    }
}

/// A case that still lacks what it judges.
pub struct Draft(About);

impl Draft {
    fn new(name: &'static str, judges: Judges) -> Self {
        Self(About { name, judges, claim: "", source: "", equations: &[] })
    }

    /// The claim, in one sentence.
    pub fn claim(mut self, claim: &'static str) -> Self {
        self.0.claim = claim;
        self
    }

    /// Equations, figures or sections of the paper, in words.
    pub fn source(mut self, source: &'static str) -> Self {
        self.0.source = source;
        self
    }

    /// The equations it tests, by their numbers.
    pub fn equations(mut self, equations: &'static [&'static str]) -> Self {
        self.0.equations = equations;
        self
    }

    /// What is judged: a function, a scene, a model.
    pub fn subject<S>(self, subject: S) -> Subjected<S> {
        Subjected { about: self.0, subject, mistakes: Vec::new() }
    }
}

/// A case that still lacks its check.
pub struct Subjected<S> {
    about: About,
    subject: S,
    mistakes: Vec<(&'static str, S)>,
}

impl<S: Send + Sync + 'static> Subjected<S> {
    /// A control: a broken subject that the same check must fail.
    pub fn mistake(mut self, name: &'static str, broken: S) -> Self {
        self.mistakes.push((name, broken));
        self
    }

    /// Several controls.
    pub fn mistakes(mut self, broken: impl IntoIterator<Item = (&'static str, S)>) -> Self {
        self.mistakes.extend(broken);
        self
    }

    /// The check of the subject and of every mistake.
    pub fn check<F: Findings + 'static>(self, check: fn(&S, &Effort) -> F) -> Case {
        let bind = |subject: S| -> Check { Box::new(move |effort| check(&subject, effort).evidence()) };
        Case {
            about: self.about,
            check: bind(self.subject),
            controls: (self.mistakes.into_iter()).map(|(name, broken)| (name, bind(broken))).collect(),
            uncaught: match self.about.judges {
                Judges::Measurement => Verdict::Underpowered,
                _ => Verdict::Fail,
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn is_three(subject: &f64, _: &Effort) -> Result<Vec<Evidence>, &'static str> {
        match subject {
            7.0 => Err("no seven"),
            _ => Ok(vec![Evidence::exact("three", subject - 3.0)]),
        }
    }

    #[test]
    fn a_case_passes_only_with_its_controls_caught() {
        let verdict = |subject, broken: Vec<(&'static str, f64)>| {
            let case = Case::core("a").claim("c").subject(subject).mistakes(broken).check(is_three);
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
    fn measured_points_that_are_too_few_are_no_fault() {
        let case = Case::measurement("a").subject(3.0).mistake("not broken", 3.0).check(is_three);
        assert_eq!(case.run(&Effort::gate()).verdict, Verdict::Underpowered);
    }
}
