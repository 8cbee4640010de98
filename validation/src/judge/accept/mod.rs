//! The rules by which numbers are accepted. The default tolerance is zero; a looser one gives its reason.
//!
//! A statistical rule has two errors: correct code fails, or a mistake passes. Both have a bound for each check, and
//! the sizes of samples are computed such that both hold ([`Design`]).

mod sizes;
#[cfg(test)]
mod tests;

pub use sizes::{Design, kolmogorov_samples, upper_tail};

use crate::judge::statistics::student;
use serde::{Deserialize, Serialize};
use sizes::{massart, needed_noncentrality, noncentral};
use std::borrow::Cow;

/// The largest probability that a run of the registry on correct code fails for any reason.
pub const FALSE_ALARM_BUDGET: f64 = 1e-3;
/// The probability that a statistical check of correct code fails, and that of too few data for it.
pub const LEVEL: f64 = 2e-6;
/// The same for measured points, which contradict the model at this p: they judge no code.
pub const MEASURED_LEVEL: f64 = 1e-3;
/// The probability that a statistical check misses the effect for which it is sized.
pub const MISS: f64 = 4e-6;

/// The result of a check or a case.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// The rule holds, and if it is statistical there were enough data.
    Pass,
    /// The rule does not hold, or a control was not caught.
    Fail,
    /// There are too few data to decide.
    Underpowered,
    /// The case needs measured points that are not available.
    NoData,
}

impl std::fmt::Display for Verdict {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&format!("{self:?}").to_lowercase())
    }
}

/// A text of the source code, or received from another rank.
pub type Text = Cow<'static, str>;

/// A rule with the number that it judges.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "rule", rename_all = "snake_case")]
pub enum Rule {
    /// |error| ≤ tolerance.
    Within {
        /// The error found.
        error: f64,
        /// The largest error allowed.
        tolerance: f64,
        /// The reason for the tolerance.
        because: Text,
    },
    /// |mean − reference| ≤ t·se + allowance at [`LEVEL`], for a sample large enough to show `effect`.
    Mean {
        /// The mean over independent replicas or samples.
        mean: f64,
        /// The standard error of the mean.
        se: f64,
        /// Number of independent samples.
        samples: u64,
        /// The expected mean.
        reference: f64,
        /// An allowed systematic difference; 0 unless the reason says more.
        allowance: f64,
        /// The smallest |μ − reference| − allowance that must be detected.
        effect: f64,
        /// The reason for the allowance and the effect.
        because: Text,
    },
    /// mean − t·se > bound at [`LEVEL`]. Otherwise the rule fails if the sample is large enough to show `effect`, or if
    /// mean + t·se < bound.
    Above {
        /// The mean over independent replicas or samples.
        mean: f64,
        /// The standard error of the mean.
        se: f64,
        /// Number of independent samples.
        samples: u64,
        /// The bound that the mean must exceed.
        bound: f64,
        /// The smallest excess of the expectation of correct code over the bound.
        effect: f64,
        /// The reason for the bound and the effect.
        because: Text,
    },
    /// p ≥ `level`, for a test on at least `enough` samples.
    PValue {
        /// The p-value of a goodness-of-fit test.
        p: f64,
        /// Number of samples of the test.
        samples: u64,
        /// The number of samples below which the test has no power.
        enough: u64,
        /// The probability of a smaller p if the claim holds.
        level: f64,
        /// The largest distance between the two distribution functions, if the test is about that.
        distance: Option<f64>,
        /// The test, and the reason for the number of samples.
        because: Text,
    },
    /// Measured points are needed but not available.
    NoData {
        /// How to supply the points.
        supply: Text,
    },
}

impl Rule {
    /// The rule that `error` is 0.
    pub fn exact(error: f64) -> Self {
        Self::Within { error, tolerance: 0.0, because: "exact".into() }
    }

    /// The rule |error| ≤ tolerance, with its reason.
    pub fn within(error: f64, tolerance: f64, because: impl Into<Text>) -> Self {
        Self::Within { error, tolerance, because: because.into() }
    }

    /// True if the rule contributes to the family-wise false-alarm rate.
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

    /// The bound on the error; the level for a p-value; for [`Rule::Above`] the number that the mean must exceed.
    pub fn tolerance(&self) -> f64 {
        match self {
            Self::Within { tolerance, .. } => *tolerance,
            Self::Mean { se, samples, allowance, .. } => student(LEVEL, *samples) * se + allowance,
            Self::Above { se, samples, bound, .. } => bound + student(LEVEL, *samples) * se,
            Self::PValue { level, .. } => *level,
            Self::NoData { .. } => f64::NAN,
        }
    }

    /// The largest probability that correct code does not pass this rule.
    pub fn false_alarm(&self) -> f64 {
        match self {
            // The mean may be far off, or the scatter larger than planned.
            Self::Mean { .. } => 2.0 * LEVEL,
            Self::Above { .. } => MISS + LEVEL,
            Self::PValue { level, .. } => *level,
            Self::Within { .. } | Self::NoData { .. } => 0.0,
        }
    }

    /// By how many standard deviations of the test's statistic a failing rule fails: at another seed it would not fail
    /// with the probability [`upper_tail`] of this, by the noncentral t distribution, or for Kolmogorov's test by
    /// Massart's bound. `None` if nothing is random, or no distance is given.
    pub fn margin(&self) -> Option<f64> {
        match self {
            Self::Mean { se, samples, allowance, .. } => {
                Some(-noncentral(student(LEVEL, *samples), (self.error() - allowance) / se, *samples))
            }
            Self::Above { mean, se, samples, bound, .. } => {
                // Values without scatter fail at every seed.
                if *se == 0.0 && mean <= bound {
                    return Some(f64::INFINITY);
                }
                let critical = student(LEVEL, *samples);
                // With fewer values than its effect needs, the rule fails only if the mean is below the bound.
                let t = if self.has_enough() { critical } else { -critical };
                Some(noncentral(t, (mean - bound) / se, *samples))
            }
            Self::PValue { distance, samples, level, .. } => {
                let distance = distance.as_ref()?;
                Some(2.0 * (distance * (*samples as f64).sqrt() - massart(*level)))
            }
            Self::Within { .. } | Self::NoData { .. } => None,
        }
    }

    /// True if the sample is large enough to show the effect.
    fn has_enough(&self) -> bool {
        match self {
            Self::Mean { se, samples, effect, .. } | Self::Above { se, samples, effect, .. } => {
                se * needed_noncentrality(LEVEL, MISS, *samples) <= *effect
            }
            Self::PValue { samples, enough, .. } => samples >= enough,
            Self::Within { .. } | Self::NoData { .. } => true,
        }
    }

    /// The reason for the bound.
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
        Rule::PValue { p, level, .. } => p >= level,
        Rule::NoData { .. } => return Verdict::NoData,
    };
    // True if the sample does not exclude that the mean is above its bound.
    let is_hidden = matches!(rule, Rule::Above { mean, se, samples, bound, .. }
        if mean + student(LEVEL, *samples) * se >= *bound);
    match (holds, rule.has_enough()) {
        // Noise can hide a difference, but can bring a mean neither close to its reference nor many standard errors
        // below its bound.
        (false, false) if is_hidden => Verdict::Underpowered,
        (false, _) => Verdict::Fail,
        (true, false) => Verdict::Underpowered,
        (true, true) => Verdict::Pass,
    }
}
