//! Every rule by which a number is accepted, in one file. The default tolerance is zero; a looser one says why.
//!
//! A statistical rule has two errors: correct code that turns red, and a mistake that stays unseen. Both have a bound
//! for each check, and samples are sized by calculation so that both hold ([`Design`]).

use crate::cluster::text_of_the_source;
use serde::{Deserialize, Serialize};
use statrs::distribution::{ChiSquared, ContinuousCDF, Normal, StudentsT};

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
        #[serde(deserialize_with = "text_of_the_source")]
        because: Words,
    },
    /// mean − t·se > bound at [`LEVEL`]; on a sample that would have shown `effect`, anything else is a failure.
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
        #[serde(deserialize_with = "text_of_the_source")]
        because: Words,
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

    /// The bound on the error; for a p-value, the level; for [`Rule::Above`] what the mean must exceed.
    pub fn tolerance(&self) -> f64 {
        match self {
            Self::Within { tolerance, .. } => *tolerance,
            Self::Mean {
                se,
                samples,
                allowance,
                ..
            } => critical(*samples) * se + allowance,
            Self::Above {
                se, samples, bound, ..
            } => bound + critical(*samples) * se,
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
            Self::Mean {
                se,
                samples,
                allowance,
                ..
            } => Some(-noncentral(
                critical(*samples),
                (self.error() - allowance) / se,
                *samples,
            )),
            Self::Above {
                mean,
                se,
                samples,
                bound,
                ..
            } => Some(noncentral(critical(*samples), (mean - bound) / se, *samples)),
            Self::PValue {
                distance, samples, ..
            } => {
                let distance = distance.as_ref()?;
                Some(2.0 * (distance * (*samples as f64).sqrt() - massart(LEVEL)))
            }
            Self::Within { .. } | Self::NoData { .. } => None,
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

/// Judges a rule. NaN fails.
pub fn judge(rule: &Rule) -> Verdict {
    let holds = match rule {
        Rule::Within { .. } | Rule::Mean { .. } => rule.error() <= rule.tolerance(),
        Rule::Above { .. } => rule.error() > rule.tolerance(),
        Rule::PValue { p, .. } => *p >= LEVEL,
        Rule::NoData { .. } => return Verdict::NoData,
    };
    let enough_data = match rule {
        Rule::Mean {
            se, samples, effect, ..
        }
        | Rule::Above {
            se, samples, effect, ..
        } => se * needed_noncentrality(LEVEL, MISS, *samples) <= *effect,
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

/// What a sample is sized for: an effect that must be seen, in values that scatter by `sd`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Design {
    /// The smallest effect that must be seen.
    pub effect: f64,
    /// The standard deviation of one value, at most.
    pub sd: f64,
}

impl Design {
    /// The fewest independent values that see the effect but for a probability [`MISS`], at a false-alarm probability
    /// [`LEVEL`], and whose standard error is small enough to say so but for another [`LEVEL`] (χ² quantile, Gaussian
    /// values).
    pub fn samples(self) -> u64 {
        self.samples_at(LEVEL, MISS)
    }

    fn samples_at(self, level: f64, miss: f64) -> u64 {
        let enough = |samples: u64| {
            let worst_sd = self.sd * scatter(level, samples);
            worst_sd / (samples as f64).sqrt() * needed_noncentrality(level, miss, samples) <= self.effect
        };
        let mut high = FEWEST;
        while !enough(high) {
            if high > MOST {
                return u64::MAX;
            }
            high *= 2;
        }
        let mut low = high / 2;
        while high - low > 1 {
            let middle = low.midpoint(high);
            *(if enough(middle) { &mut high } else { &mut low }) = middle;
        }
        high.max(FEWEST)
    }
}

/// Below this a mean is not Gaussian enough for a level of 10⁻⁶.
const FEWEST: u64 = 16;
/// No case can run more.
const MOST: u64 = 1 << 40;

/// The fewest values by which a Kolmogorov–Smirnov test sees a distance of `distance` between two distribution
/// functions but for a probability [`MISS`], at a false-alarm probability [`LEVEL`] (Massart's bound for both).
pub fn kolmogorov_samples(distance: f64) -> u64 {
    ((massart(LEVEL) + massart(MISS)) / distance).powi(2).ceil() as u64
}

/// How much larger than its expectation a standard deviation of `samples` Gaussian values is, but for a probability
/// `level`.
fn scatter(level: f64, samples: u64) -> f64 {
    let freedom = freedom(samples);
    ChiSquared::new(freedom).map_or(f64::NAN, |chi| (chi.inverse_cdf(1.0 - level) / freedom).sqrt())
}

/// The effect over its standard error that a mean of `samples` values shows at `level` but for a probability `miss`.
fn needed_noncentrality(level: f64, miss: f64, samples: u64) -> f64 {
    let (critical, nu) = (critical_at(level, samples), freedom(samples));
    let normal = normal().inverse_cdf(1.0 - miss);
    critical * (1.0 - 0.25 / nu) + normal * (1.0 + 0.5 * critical * critical / nu).sqrt()
}

/// The normal deviate that has the probability P(T ≤ t) of the noncentral t distribution of a mean of `samples` values
/// (Abramowitz & Stegun 26.7.10).
fn noncentral(t: f64, noncentrality: f64, samples: u64) -> f64 {
    let nu = freedom(samples);
    (t * (1.0 - 0.25 / nu) - noncentrality) / (1.0 + 0.5 * t * t / nu).sqrt()
}

/// The probability of a normal deviate above `deviate`.
pub fn upper_tail(deviate: f64) -> f64 {
    normal().sf(deviate)
}

/// The √n D that Kolmogorov's distance D exceeds with a probability of at most `probability` (Massart 1990).
fn massart(probability: f64) -> f64 {
    (0.5 * (2.0 / probability).ln()).sqrt()
}

fn critical(samples: u64) -> f64 {
    critical_at(LEVEL, samples)
}

/// The two-sided critical value of Student's t at `level` for a mean of `samples` independent values.
pub(crate) fn critical_at(level: f64, samples: u64) -> f64 {
    StudentsT::new(0.0, 1.0, freedom(samples)).map_or(f64::NAN, |t| t.inverse_cdf(1.0 - 0.5 * level))
}

fn freedom(samples: u64) -> f64 {
    samples.saturating_sub(1).max(1) as f64
}

fn normal() -> Normal {
    Normal::standard()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};
    use rand_pcg::Pcg64Dxsm;

    fn mean(mean: f64, se: f64, allowance: f64) -> Verdict {
        judge(&Rule::Mean {
            mean,
            se,
            samples: 400,
            reference: 1.0,
            allowance,
            effect: 0.1,
            because: "",
        })
    }

    #[test]
    fn a_mean_needs_closeness_and_enough_data() {
        assert_eq!(mean(1.02, 0.01, 0.0), Verdict::Pass);
        assert_eq!(mean(1.06, 0.01, 0.0), Verdict::Fail);
        assert_eq!(mean(1.06, 0.01, 0.03), Verdict::Pass);
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
            judge(&Rule::Above {
                mean,
                se,
                samples: 400,
                bound: 0.0,
                effect: 0.1,
                because: "",
            })
        };
        assert_eq!(above(0.1, 0.01), Verdict::Pass);
        assert_eq!(above(0.02, 0.01), Verdict::Fail);
        assert_eq!(above(0.02, 0.1), Verdict::Underpowered);
        assert_eq!(above(f64::NAN, 0.01), Verdict::Fail);
    }

    #[test]
    fn the_critical_value_is_students() {
        // Tables: t at 0.9995 with 10 degrees of freedom is 4.587, and 3.291 for the normal limit.
        assert!((critical_at(1e-3, 11) - 4.587).abs() < 1e-3);
        assert!((critical_at(1e-3, 1_000_000) - 3.2905).abs() < 1e-3);
    }

    #[test]
    fn the_noncentral_distribution_is_the_simulated_one() {
        let mut rng = Pcg64Dxsm::seed_from_u64(1);
        for (samples, noncentrality, t) in [(20u64, 3.0f64, 2.5), (20, 6.0, 8.0), (100, 5.0, 4.2)] {
            let root = (samples as f64).sqrt();
            let trials = 20_000;
            let below = (0..trials)
                .filter(|_| {
                    let values = (0..samples).map(|_| noncentrality / root + normal_value(&mut rng));
                    let values: Vec<f64> = values.collect();
                    let mean = values.iter().sum::<f64>() / samples as f64;
                    let square = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>();
                    mean / (square / freedom(samples)).sqrt() * root <= t
                })
                .count();
            let found = below as f64 / f64::from(trials);
            let expected = upper_tail(-noncentral(t, noncentrality, samples));
            // Five standard errors of a share, and the approximation's own error in the middle of the distribution.
            assert!(
                (found - expected).abs() < 5.0 * 0.0036 + 0.005,
                "{found} {expected}"
            );
        }
    }

    fn normal_value(rng: &mut Pcg64Dxsm) -> f64 {
        StandardNormal.sample(rng)
    }

    /// At levels that can be simulated: both errors come out as designed, approached from both sides.
    #[test]
    fn a_designed_sample_has_both_error_rates() {
        const LEVEL: f64 = 0.02;
        const MISS: f64 = 0.05;
        const TRIALS: u32 = 20_000;
        for ratio in [0.4, 0.8] {
            let design = Design {
                effect: ratio,
                sd: 1.0,
            };
            let samples = design.samples_at(LEVEL, MISS);
            let mut rng = Pcg64Dxsm::seed_from_u64(2);
            let (mut far, mut wide, mut blind, mut blind_of_half) = (0, 0, 0, 0);
            for _ in 0..TRIALS {
                let values: Vec<f64> = (0..samples).map(|_| normal_value(&mut rng)).collect();
                let n = samples as f64;
                let mean = values.iter().sum::<f64>() / n;
                let se = (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (n - 1.0) / n).sqrt();
                let critical = critical_at(LEVEL, samples);
                far += u32::from(mean.abs() > critical * se);
                wide += u32::from(se * needed_noncentrality(LEVEL, MISS, samples) > design.effect);
                blind += u32::from((mean + design.effect).abs() <= critical * se);
                blind_of_half += u32::from((mean + 0.5 * design.effect).abs() <= critical * se);
            }
            let share = |count: u32| f64::from(count) / f64::from(TRIALS);
            // Five standard errors of a share of 20,000: 0.005 at 0.02, 0.008 at 0.05.
            assert!((share(far) - LEVEL).abs() < 0.005, "{ratio}: far {}", share(far));
            assert!(
                (share(wide) - LEVEL).abs() < 0.008,
                "{ratio}: wide {}",
                share(wide)
            );
            assert!(share(blind) < MISS + 0.008, "{ratio}: blind {}", share(blind));
            // And the sample is not much larger than needed: half the effect is often missed.
            assert!(
                share(blind_of_half) > 0.15,
                "{ratio}: half {}",
                share(blind_of_half)
            );
        }
    }

    #[test]
    fn tolerances_are_closed_and_nan_fails() {
        assert_eq!(judge(&Rule::exact(0.0)), Verdict::Pass);
        assert_eq!(judge(&Rule::exact(f64::MIN_POSITIVE)), Verdict::Fail);
        assert_eq!(judge(&Rule::within(-2.0, 2.0, "")), Verdict::Pass);
        assert_eq!(judge(&Rule::within(f64::NAN, 2.0, "")), Verdict::Fail);
    }

    #[test]
    fn a_p_value_needs_samples() {
        let p = |p, samples| {
            judge(&Rule::PValue {
                p,
                samples,
                enough: 100,
                distance: None,
                because: "",
            })
        };
        assert_eq!(p(0.5, 100), Verdict::Pass);
        assert_eq!(p(0.5, 99), Verdict::Underpowered);
        assert_eq!(p(1e-7, 1000), Verdict::Fail);
    }
}
