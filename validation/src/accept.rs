//! Every rule by which a number is accepted, in one file. The default tolerance is zero; a looser one says why.

use crate::cluster::text_of_the_source;
use serde::{Deserialize, Serialize};
use statrs::distribution::{ContinuousCDF, StudentsT};

/// The probability that a gate of correct code turns red by chance, over all its statistical checks.
pub const FAMILY_FALSE_ALARM_RATE: f64 = 1e-3;

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

/// Words that are written in the source. (Under its own name the type would be read by borrowing.)
pub type Words = &'static str;

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
        #[serde(deserialize_with = "text_of_the_source")]
        because: Words,
    },
    /// |mean − reference| ≤ t·se + allowance at the gate's level, and se ≤ enough.
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
        /// The standard error above which the data is too little to say anything.
        enough: f64,
        /// Why this allowance and this `enough`.
        #[serde(deserialize_with = "text_of_the_source")]
        because: Words,
    },
    /// mean − t·se > bound at the gate's level; with se ≤ enough, anything else is a failure.
    Above {
        /// The mean over independent replicas or samples.
        mean: f64,
        /// Its standard error.
        se: f64,
        /// Independent samples behind it.
        samples: u64,
        /// What it must exceed.
        bound: f64,
        /// The standard error above which the data is too little to say anything.
        enough: f64,
        /// Why this bound and this `enough`.
        #[serde(deserialize_with = "text_of_the_source")]
        because: Words,
    },
    /// p ≥ the gate's level, for a test on at least `enough` samples.
    PValue {
        /// The p-value of a goodness-of-fit test.
        p: f64,
        /// The samples it is from.
        samples: u64,
        /// The samples below which the test has no power.
        enough: u64,
        /// Which test, and why that many samples.
        #[serde(deserialize_with = "text_of_the_source")]
        because: Words,
    },
    /// Needs measured points that are not at hand.
    NoData {
        /// How to supply them.
        #[serde(deserialize_with = "text_of_the_source")]
        supply: Words,
    },
}

impl Rule {
    /// Nothing off at all.
    pub fn exact(error: f64) -> Self {
        Self::Within {
            error,
            tolerance: 0.0,
            because: "exact",
        }
    }

    /// |error| ≤ tolerance, and why.
    pub fn within(error: f64, tolerance: f64, because: &'static str) -> Self {
        Self::Within {
            error,
            tolerance,
            because,
        }
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

    /// The bound on the error at a level; for a p-value, the level itself; for [`Rule::Above`] what the
    /// mean must exceed.
    pub fn tolerance(&self, level: f64) -> f64 {
        match self {
            Self::Within { tolerance, .. } => *tolerance,
            Self::Mean {
                se,
                samples,
                allowance,
                ..
            } => critical(level, *samples) * se + allowance,
            Self::Above {
                se, samples, bound, ..
            } => bound + critical(level, *samples) * se,
            Self::PValue { .. } => level,
            Self::NoData { .. } => f64::NAN,
        }
    }

    /// Why the bound is what it is.
    pub fn because(&self) -> &'static str {
        match self {
            Self::Within { because, .. }
            | Self::Mean { because, .. }
            | Self::Above { because, .. }
            | Self::PValue { because, .. } => because,
            Self::NoData { supply } => supply,
        }
    }
}

/// Judges a rule at the false-alarm probability `level` of one statistical check. NaN fails.
pub fn judge(rule: &Rule, level: f64) -> Verdict {
    let holds = match rule {
        Rule::Within { .. } | Rule::Mean { .. } => rule.error() <= rule.tolerance(level),
        Rule::Above { .. } => rule.error() > rule.tolerance(level),
        Rule::PValue { p, .. } => *p >= level,
        Rule::NoData { .. } => return Verdict::NoData,
    };
    let enough_data = match rule {
        Rule::Mean { se, enough, .. } | Rule::Above { se, enough, .. } => se <= enough,
        Rule::PValue { samples, enough, .. } => samples >= enough,
        _ => true,
    };
    match (holds, enough_data) {
        // Noise can hide a difference, but it cannot make a mean come out close.
        (false, false) if matches!(rule, Rule::Above { .. }) => Verdict::Underpowered,
        (false, _) => Verdict::Fail,
        (true, false) => Verdict::Underpowered,
        (true, true) => Verdict::Pass,
    }
}

/// The two-sided critical value of Student's t for a mean of `samples` independent values.
pub(crate) fn critical(level: f64, samples: u64) -> f64 {
    let freedom = samples.saturating_sub(1).max(1) as f64;
    StudentsT::new(0.0, 1.0, freedom).map_or(f64::NAN, |t| t.inverse_cdf(1.0 - 0.5 * level))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mean(mean: f64, se: f64, allowance: f64) -> Verdict {
        let rule = Rule::Mean {
            mean,
            se,
            samples: 400,
            reference: 1.0,
            allowance,
            enough: 0.02,
            because: "",
        };
        judge(&rule, 1e-3)
    }

    #[test]
    fn a_mean_needs_closeness_and_enough_data() {
        assert_eq!(mean(1.02, 0.01, 0.0), Verdict::Pass);
        assert_eq!(mean(1.05, 0.01, 0.0), Verdict::Fail);
        assert_eq!(mean(1.05, 0.01, 0.03), Verdict::Pass);
        assert_eq!(mean(1.02, 0.1, 0.0), Verdict::Underpowered);
        assert_eq!(
            mean(2.0, 0.1, 0.0),
            Verdict::Fail,
            "little data is no excuse for a large error"
        );
        assert_eq!(mean(f64::NAN, 0.01, 0.0), Verdict::Fail);
    }

    #[test]
    fn a_difference_needs_to_be_seen() {
        let above = |mean, se| {
            let rule = Rule::Above {
                mean,
                se,
                samples: 400,
                bound: 0.0,
                enough: 0.02,
                because: "",
            };
            judge(&rule, 1e-3)
        };
        assert_eq!(above(0.05, 0.01), Verdict::Pass);
        assert_eq!(above(0.02, 0.01), Verdict::Fail);
        assert_eq!(above(0.02, 0.1), Verdict::Underpowered);
        assert_eq!(above(f64::NAN, 0.01), Verdict::Fail);
    }

    #[test]
    fn the_critical_value_is_students() {
        // Tables: t at 0.9995 with 10 degrees of freedom is 4.587, and 3.291 for the normal limit.
        assert!((critical(1e-3, 11) - 4.587).abs() < 1e-3);
        assert!((critical(1e-3, 1_000_000) - 3.2905).abs() < 1e-3);
    }

    #[test]
    fn tolerances_are_closed_and_nan_fails() {
        assert_eq!(judge(&Rule::exact(0.0), 0.1), Verdict::Pass);
        assert_eq!(judge(&Rule::exact(f64::MIN_POSITIVE), 0.1), Verdict::Fail);
        assert_eq!(judge(&Rule::within(-2.0, 2.0, ""), 0.1), Verdict::Pass);
        assert_eq!(judge(&Rule::within(f64::NAN, 2.0, ""), 0.1), Verdict::Fail);
    }

    #[test]
    fn a_p_value_needs_samples() {
        let p = |p, samples| {
            judge(
                &Rule::PValue {
                    p,
                    samples,
                    enough: 100,
                    because: "",
                },
                1e-3,
            )
        };
        assert_eq!(p(0.5, 100), Verdict::Pass);
        assert_eq!(p(0.5, 99), Verdict::Underpowered);
        assert_eq!(p(1e-4, 1000), Verdict::Fail);
    }
}
