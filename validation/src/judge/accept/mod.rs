//! Every rule by which a number is accepted. The default tolerance is zero; a looser one says why.
//!
//! A statistical rule has two errors: correct code that turns red, and a mistake that stays unseen. Both have a bound
//! for each check, and samples are sized by calculation so that both hold ([`Design`]).

mod sizes;
#[cfg(test)]
mod tests;

pub use sizes::{Design, kolmogorov_samples, upper_tail};

use crate::judge::statistics::{Sample, student};
use serde::{Deserialize, Serialize};
use sizes::{massart, needed_noncentrality, noncentral};
use std::borrow::Cow;

/// The probability that a run of the registry on correct code turns red for any reason, at most.
pub const FALSE_ALARM_BUDGET: f64 = 1e-3;
/// The probability that one statistical check of correct code fails, and that its data turn out to be too little.
pub const LEVEL: f64 = 2e-6;
/// The probability that one statistical check does not see the effect it is sized for.
pub const MISS: f64 = 4e-6;

/// How a check or a case ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// The rule holds, and where it is statistical there was enough data.
    Pass,
    /// The rule does not hold, or a control was not caught.
    Fail,
    /// Too little data to say.
    Underpowered,
    /// The case needs measured points that are not at hand.
    NoData,
}

/// A sentence of the source, or of another rank.
pub type Text = Cow<'static, str>;

/// A rule with the number it judges.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "rule", rename_all = "snake_case")]
pub enum Rule {
    /// |error| ≤ tolerance.
    Within {
        /// What was found off.
        error: f64,
        /// What is allowed.
        tolerance: f64,
        /// Why that much.
        because: Text,
    },
    /// |mean − reference| ≤ t·se + allowance at [`LEVEL`], on a sample that would have shown `effect`.
    Mean {
        /// The mean over independent replicas or samples.
        mean: f64,
        /// Its standard error.
        se: f64,
        /// Independent samples behind it.
        samples: u64,
        /// What it should be.
        reference: f64,
        /// A systematic difference that is allowed, 0 unless the reason says more.
        allowance: f64,
        /// The smallest |μ − reference| − allowance that must be seen.
        effect: f64,
        /// Why this allowance and this effect.
        because: Text,
    },
    /// mean − t·se > bound at [`LEVEL`]; on a sample that would have shown `effect`, anything else is a failure, and on any
    /// sample mean + t·se < bound is.
    Above {
        /// The mean over independent replicas or samples.
        mean: f64,
        /// Its standard error.
        se: f64,
        /// Independent samples behind it.
        samples: u64,
        /// What it must exceed.
        bound: f64,
        /// By how much the expectation of correct code exceeds the bound, at least.
        effect: f64,
        /// Why this bound and this effect.
        because: Text,
    },
    /// p ≥ [`LEVEL`], for a test on at least `enough` samples.
    PValue {
        /// The p-value of a goodness-of-fit test.
        p: f64,
        /// The samples it is from.
        samples: u64,
        /// The samples below which the test has no power.
        enough: u64,
        /// The largest distance between the two distribution functions, where that is what is tested.
        distance: Option<f64>,
        /// Which test, and why that many samples.
        because: Text,
    },
    /// Needs measured points that are not at hand.
    NoData {
        /// How to supply them.
        supply: Text,
    },
}

impl Rule {
    /// Nothing off at all.
    pub fn exact(error: f64) -> Self {
        Self::Within { error, tolerance: 0.0, because: "exact".into() }
    }

    /// |error| ≤ tolerance, and why.
    pub fn within(error: f64, tolerance: f64, because: impl Into<Text>) -> Self {
        Self::Within { error, tolerance, because: because.into() }
    }

    /// Whether the rule shares in the family-wise false-alarm rate.
    pub fn is_statistical(&self) -> bool {
        matches!(self, Self::Mean { .. } | Self::Above { .. } | Self::PValue { .. })
    }

    /// The error that the rule bounds; for [`Rule::Above`] the mean itself.
    pub fn error(&self) -> f64 {
        match self {
            Self::Within { error, .. } => error.abs(),
            Self::Mean { mean, reference, .. } => (mean - reference).abs(),
            Self::Above { mean, .. } => *mean,
            Self::PValue { p, .. } => *p,
            Self::NoData { .. } => f64::NAN,
        }
    }

    /// The bound on the error; for a p-value, the level; for [`Rule::Above`] what the mean must exceed.
    pub fn tolerance(&self) -> f64 {
        match self {
            Self::Within { tolerance, .. } => *tolerance,
            Self::Mean { se, samples, allowance, .. } => student(LEVEL, *samples) * se + allowance,
            Self::Above { se, samples, bound, .. } => bound + student(LEVEL, *samples) * se,
            Self::PValue { .. } => LEVEL,
            Self::NoData { .. } => f64::NAN,
        }
    }

    /// The probability, at most, that correct code does not pass this rule.
    pub fn false_alarm(&self) -> f64 {
        match self {
            // That the mean is far, and that the scatter is larger than planned.
            Self::Mean { .. } => 2.0 * LEVEL,
            Self::Above { .. } => MISS + LEVEL,
            Self::PValue { .. } => LEVEL,
            Self::Within { .. } | Self::NoData { .. } => 0.0,
        }
    }

    /// By how many standard deviations of the test's statistic a rule that fails does so: at another seed it would not fail
    /// with the probability [`upper_tail`] of it, by the noncentral t distribution, for Kolmogorov's by Massart's bound.
    /// `None` where nothing is drawn, or no effect is told.
    pub fn margin(&self) -> Option<f64> {
        match self {
            Self::Mean { se, samples, allowance, .. } => {
                Some(-noncentral(student(LEVEL, *samples), (self.error() - allowance) / se, *samples))
            }
            Self::Above { mean, se, samples, bound, .. } => {
                // Values that do not scatter fail at every seed.
                if *se == 0.0 && mean <= bound {
                    return Some(f64::INFINITY);
                }
                let critical = student(LEVEL, *samples);
                // With fewer values than its effect needs, it fails only where the mean is below.
                let t = if self.has_enough() { critical } else { -critical };
                Some(noncentral(t, (mean - bound) / se, *samples))
            }
            Self::PValue { distance, samples, .. } => {
                let distance = distance.as_ref()?;
                Some(2.0 * (distance * (*samples as f64).sqrt() - massart(LEVEL)))
            }
            Self::Within { .. } | Self::NoData { .. } => None,
        }
    }

    /// Whether the sample shows the effect that it is meant to show.
    fn has_enough(&self) -> bool {
        match self {
            Self::Mean { se, samples, effect, .. } | Self::Above { se, samples, effect, .. } => {
                se * needed_noncentrality(LEVEL, MISS, *samples) <= *effect
            }
            Self::PValue { samples, enough, .. } => samples >= enough,
            Self::Within { .. } | Self::NoData { .. } => true,
        }
    }

    /// Whether the mean may be above its bound, for all that the sample shows.
    fn is_hidden(&self) -> bool {
        match self {
            Self::Above { mean, se, samples, bound, .. } => mean + student(LEVEL, *samples) * se >= *bound,
            _ => false,
        }
    }

    /// Why the bound is what it is.
    pub fn because(&self) -> &str {
        match self {
            Self::Within { because, .. }
            | Self::Mean { because, .. }
            | Self::Above { because, .. }
            | Self::PValue { because, .. } => because,
            Self::NoData { supply } => supply,
        }
    }
}

/// Judges a rule. NaN fails.
pub fn judge(rule: &Rule) -> Verdict {
    let holds = match rule {
        Rule::Within { .. } | Rule::Mean { .. } => rule.error() <= rule.tolerance(),
        Rule::Above { .. } => rule.error() > rule.tolerance(),
        Rule::PValue { p, .. } => *p >= LEVEL,
        Rule::NoData { .. } => return Verdict::NoData,
    };
    match (holds, rule.has_enough()) {
        // Noise can hide a difference, but it cannot make a mean come out close, nor below the bound by many of its errors.
        (false, false) if rule.is_hidden() => Verdict::Underpowered,
        (false, _) => Verdict::Fail,
        (true, false) => Verdict::Underpowered,
        (true, true) => Verdict::Pass,
    }
}

impl Sample {
    /// The rule that this mean is `reference`, up to an `allowance`, by a sample that would show `effect` beyond it.
    pub fn is(self, reference: f64, allowance: f64, effect: f64, because: impl Into<Text>) -> Rule {
        Rule::Mean {
            mean: self.mean,
            se: self.se,
            samples: self.samples,
            reference,
            allowance,
            effect,
            because: because.into(),
        }
    }

    /// The rule that this mean exceeds `bound`, by a sample that shows it where it does so by `effect`.
    pub fn exceeds(self, bound: f64, effect: f64, because: impl Into<Text>) -> Rule {
        Rule::Above {
            mean: self.mean,
            se: self.se,
            samples: self.samples,
            bound,
            effect,
            because: because.into(),
        }
    }
}
