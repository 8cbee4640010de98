//! A case: one claim, the check that tests it, and the controls that the same check must fail.

use crate::accept::{Rule, Verdict, Words, judge};
use crate::cluster::text_of_the_source;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;
use std::time::Instant;

/// What a case asks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// Are the equations solved right: closed forms, orders, invariants.
    Verification,
    /// Are they the right equations: experiments, and what the paper says of them.
    Validation,
}

/// One number and the rule it is judged by.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Evidence {
    /// What was measured, in a few words.
    pub what: String,
    /// How it is judged.
    pub rule: Rule,
}

impl Evidence {
    /// `rule` applied to what `what` says.
    pub fn new(what: impl Into<String>, rule: Rule) -> Self {
        Self {
            what: what.into(),
            rule,
        }
    }
}

/// How hard a case works, and at which level its statistical checks are judged.
#[derive(Clone, Debug)]
pub struct Effort {
    /// More replicas and samples, the same cases.
    pub full: bool,
    /// The false-alarm probability of each statistical check.
    pub level: f64,
    /// A folder with measured points, where the user has them.
    pub data: Option<PathBuf>,
}

impl Effort {
    /// `quick` for the gate, `full` for `--full`.
    pub fn pick<T>(&self, quick: T, full: T) -> T {
        if self.full { full } else { quick }
    }
}

type Check = Box<dyn Fn(&Effort) -> Vec<Evidence> + Send + Sync>;

/// What a case says of itself.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct About {
    /// Its name, in words joined by `-`.
    pub name: &'static str,
    /// Verification or validation.
    pub kind: Kind,
    /// The claim, in one sentence.
    pub claim: &'static str,
    /// Equations, figures or sections of the paper, in words.
    pub source: &'static str,
    /// The equations it tests, by their numbers: the traceability table is made from these.
    pub equations: &'static [&'static str],
    /// How many statistical checks it makes: the family-wise false-alarm rate is shared among all.
    pub statistical_checks: usize,
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
    /// A case whose `check` judges `subject`; the very same `check` must fail on each of `broken`.
    pub fn new<S: Send + Sync + 'static>(
        about: About,
        subject: S,
        broken: Vec<(&'static str, S)>,
        check: fn(&S, &Effort) -> Vec<Evidence>,
    ) -> Self {
        let bind = |subject: S| -> Check { Box::new(move |effort| check(&subject, effort)) };
        Self {
            about,
            check: bind(subject),
            controls: broken
                .into_iter()
                .map(|(name, subject)| (name, bind(subject)))
                .collect(),
            uncaught: Verdict::Fail,
        }
    }

    /// The same case on points that others measured: where they are too few to catch a control, that is no
    /// fault of the code, and the case is under-powered.
    pub fn on_measured_points(mut self) -> Self {
        self.uncaught = Verdict::Underpowered;
        self
    }

    /// Runs the check, then every control. Without data there is nothing that a control could fail on.
    pub fn run(&self, effort: &Effort) -> Outcome {
        let start = Instant::now();
        let evidence: Vec<_> = (self.check)(effort)
            .into_iter()
            .map(|evidence| {
                let verdict = judge(&evidence.rule, effort.level);
                Judged { evidence, verdict }
            })
            .collect();
        let no_data = evidence.iter().any(|judged| judged.verdict == Verdict::NoData);
        let controls: Vec<_> = self
            .controls
            .iter()
            .filter(|_| !no_data)
            .map(|(mistake, check)| Control {
                mistake,
                caught: check(effort)
                    .iter()
                    .any(|evidence| judge(&evidence.rule, effort.level) == Verdict::Fail),
            })
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

/// A case passes when all its evidence does and every control was caught.
fn overall(evidence: &[Judged], controls: &[Control], uncaught: Verdict) -> Verdict {
    let has = |verdict| evidence.iter().any(|judged| judged.verdict == verdict);
    if has(Verdict::NoData) {
        Verdict::NoData
    } else if evidence.is_empty() || has(Verdict::Fail) || controls.is_empty() {
        Verdict::Fail
    } else if controls.iter().any(|control| !control.caught) {
        uncaught
    } else if has(Verdict::Underpowered) {
        Verdict::Underpowered
    } else {
        Verdict::Pass
    }
}

/// Evidence with its verdict.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Judged {
    /// The evidence.
    pub evidence: Evidence,
    /// How it ended.
    pub verdict: Verdict,
}

/// A deliberate mistake and whether the check failed on it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Control {
    /// The mistake in the model.
    #[serde(deserialize_with = "text_of_the_source")]
    pub mistake: Words,
    /// Whether the check failed, as it must.
    pub caught: bool,
}

/// The outcome of a case.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Outcome {
    /// Which case.
    pub about: About,
    /// How it ended.
    pub verdict: Verdict,
    /// Everything measured.
    pub evidence: Vec<Judged>,
    /// Every control.
    pub controls: Vec<Control>,
    /// Wall time of check and controls.
    pub seconds: f64,
}

#[cfg(test)]
mod tests {
    use super::*;

    fn about() -> About {
        About {
            name: "a",
            kind: Kind::Verification,
            claim: "c",
            source: "s",
            equations: &[],
            statistical_checks: 0,
        }
    }

    fn is_three(subject: &f64, _: &Effort) -> Vec<Evidence> {
        vec![Evidence::new("three", Rule::exact(*subject - 3.0))]
    }

    const EFFORT: Effort = Effort {
        full: false,
        level: 1e-3,
        data: None,
    };

    #[test]
    fn a_case_passes_only_with_its_controls_caught() {
        let verdict = |subject, broken| Case::new(about(), subject, broken, is_three).run(&EFFORT).verdict;
        assert_eq!(verdict(3.0, vec![("four", 4.0)]), Verdict::Pass);
        assert_eq!(verdict(4.0, vec![("four", 4.0)]), Verdict::Fail);
        assert_eq!(
            verdict(3.0, vec![("four", 4.0), ("not broken", 3.0)]),
            Verdict::Fail
        );
        assert_eq!(
            verdict(3.0, vec![]),
            Verdict::Fail,
            "a case without a control is no case"
        );
        assert_eq!(verdict(f64::NAN, vec![("four", 4.0)]), Verdict::Fail);
    }
}
