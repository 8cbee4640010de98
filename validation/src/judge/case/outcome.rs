//! How a case ended: its evidence and its controls, judged.

use super::{About, Evidence};
use crate::judge::accept::{MISS, Rule, Text, Verdict, judge};
use serde::{Deserialize, Serialize};

/// A case passes when all its evidence does and every control was caught.
pub(super) fn overall(evidence: &[Judged], controls: &[Control], uncaught: Verdict) -> Verdict {
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

impl Judged {
    pub(super) fn new(evidence: Evidence) -> Self {
        let verdict = judge(&evidence.rule);
        Self { evidence, verdict }
    }
}

/// A deliberate mistake and whether the check failed on it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Control {
    /// The mistake in the model.
    pub mistake: Text,
    /// Whether the check failed, as it must, on numbers.
    pub caught: bool,
    /// Whether it was caught by drawn numbers alone, so that it could be missed at another seed.
    pub drawn: bool,
    /// By how many standard deviations the surest of its rules failed ([`Rule::margin`]).
    pub margin: Option<f64>,
}

impl Control {
    /// A check that ends in no numbers has broken, and has caught nothing.
    pub(super) fn new(mistake: &'static str, evidence: &[Evidence]) -> Self {
        let broke = evidence.iter().any(|e| e.rule.error().is_nan());
        let failed: Vec<_> = (evidence.iter().map(|e| &e.rule))
            .filter(|rule| !broke && judge(rule) == Verdict::Fail)
            .collect();
        let drawn = failed.iter().all(|rule| rule.is_statistical());
        Self {
            mistake: mistake.into(),
            caught: !failed.is_empty(),
            drawn,
            margin: (failed.iter().filter(|_| drawn)).filter_map(|rule| rule.margin()).reduce(f64::max),
        }
    }
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

impl Outcome {
    /// The probability, at most, that correct code turns this case red: its checks, and a control that is not caught.
    pub fn false_alarm(&self) -> f64 {
        if self.verdict == Verdict::NoData {
            return 0.0;
        }
        let rules = || self.evidence.iter().map(|judged| &judged.evidence.rule);
        let checks: f64 = rules().map(Rule::false_alarm).sum();
        // What is sized for a control misses it with this probability at most.
        checks + MISS * self.controls.iter().filter(|control| control.drawn).count() as f64
    }
}
