//! The outcome of a case: its evidence and its controls, judged.

use super::{About, Evidence, Judges};
use crate::judge::accept::{MISS, Rule, Text, Verdict, judge};
use serde::{Deserialize, Serialize};

/// The verdict of a case: it passes if all its evidence passes and every control was caught.
pub(super) fn overall(evidence: &[Judged], controls: &[Control], uncaught: Verdict) -> Verdict {
    let has = |verdict| evidence.iter().any(|judged| judged.verdict == verdict);
    if lacks_data(evidence) {
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

/// True if there is evidence, and none of it has data: what data there are is judged.
pub(super) fn lacks_data(evidence: &[Judged]) -> bool {
    !evidence.is_empty() && evidence.iter().all(|judged| judged.verdict == Verdict::NoData)
}

/// Evidence with its verdict.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Judged {
    /// The evidence.
    pub evidence: Evidence,
    /// The verdict of its rule.
    pub verdict: Verdict,
}

impl Judged {
    pub(super) fn new(evidence: Evidence) -> Self {
        let verdict = judge(&evidence.rule);
        Self { evidence, verdict }
    }
}

/// A deliberate mistake, and the result of the check on it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Control {
    /// The mistake in the model.
    pub mistake: Text,
    /// True if the check failed on numbers, as it must.
    pub caught: bool,
    /// True if only random numbers caught it, so that it could be missed at another seed.
    pub drawn: bool,
    /// By how many standard deviations the clearest of its rules failed ([`Rule::margin`]).
    pub margin: Option<f64>,
}

impl Control {
    /// Judges a control: a check with NaN has broken, and has caught nothing.
    pub(super) fn new(mistake: &'static str, evidence: &[Evidence]) -> Self {
        let rules = || evidence.iter().map(|e| &e.rule).filter(|rule| !matches!(rule, Rule::NoData { .. }));
        let broke = rules().any(|rule| rule.error().is_nan());
        let failed: Vec<_> = rules().filter(|rule| !broke && judge(rule) == Verdict::Fail).collect();
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
    /// Description of the case.
    pub about: About,
    /// The verdict of the case.
    pub verdict: Verdict,
    /// All evidence.
    pub evidence: Vec<Judged>,
    /// All controls.
    pub controls: Vec<Control>,
    /// Wall time of check and controls in s.
    pub seconds: f64,
}

impl Outcome {
    /// The largest probability that correct code fails this case: by its checks, or by a control that is not caught.
    /// Measured points judge the model, not the code.
    pub fn false_alarm(&self) -> f64 {
        if self.verdict == Verdict::NoData || self.about.judges == Judges::Measurement {
            return 0.0;
        }
        let rules = || self.evidence.iter().map(|judged| &judged.evidence.rule);
        let checks: f64 = rules().map(Rule::false_alarm).sum();
        // A check sized for a control misses it with this probability at most.
        checks + MISS * self.controls.iter().filter(|control| control.drawn).count() as f64
    }
}
