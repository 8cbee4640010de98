//! Sizes of samples, and the probability that a failed rule fails again.

use super::{LEVEL, MISS};
use crate::judge::statistics::{freedom, student};
use statrs::distribution::{ChiSquared, ContinuousCDF, Normal};

/// The design of a sample: an effect that must be detected, in values that scatter by `sd`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Design {
    /// The smallest effect that must be detected.
    pub effect: f64,
    /// The largest standard deviation of one value.
    pub sd: f64,
}

impl Design {
    /// A sample that detects `effect` in values with a standard deviation of at most `sd`.
    pub const fn new(effect: f64, sd: f64) -> Self {
        Self { effect, sd }
    }

    /// The smallest number of independent values that misses the effect with the probability [`MISS`] at most, at the
    /// false-alarm probability [`LEVEL`], and whose standard error is too large to decide with another [`LEVEL`] at
    /// most (χ² quantile, Gaussian values).
    pub fn samples(self) -> u64 {
        self.samples_at(LEVEL, MISS)
    }

    fn samples_at(self, level: f64, miss: f64) -> u64 {
        let enough = |samples: u64| {
            let worst_sd = self.sd * scatter(level, samples);
            worst_sd / (samples as f64).sqrt() * needed_noncentrality(level, miss, samples) <= self.effect
        };
        let mut doubled = std::iter::successors(Some(FEWEST), |samples| (*samples <= MOST).then_some(2 * samples));
        let Some(mut high) = doubled.find(|samples| enough(*samples)) else { return u64::MAX };
        let mut low = high / 2;
        while high - low > 1 {
            let middle = low.midpoint(high);
            if enough(middle) { high = middle } else { low = middle }
        }
        high.max(FEWEST)
    }
}

/// With fewer values, a mean is not Gaussian enough for a level of 10⁻⁶.
const FEWEST: u64 = 16;
/// More values than any case can run.
const MOST: u64 = 1 << 40;

/// The smallest number of values with which a Kolmogorov–Smirnov test misses a `distance` between two distribution
/// functions with the probability [`MISS`] at most, at the false-alarm probability [`LEVEL`] (Massart's bound for
/// both).
pub fn kolmogorov_samples(distance: f64) -> u64 {
    ((massart(LEVEL) + massart(MISS)) / distance).powi(2).ceil() as u64
}

/// The ratio of a standard deviation of `samples` Gaussian values to its expectation that is exceeded with the
/// probability `level`.
fn scatter(level: f64, samples: u64) -> f64 {
    let freedom = freedom(samples);
    ChiSquared::new(freedom).map_or(f64::NAN, |chi| (chi.inverse_cdf(1.0 - level) / freedom).sqrt())
}

/// The effect over its standard error that a mean of `samples` values at `level` misses with the probability `miss`.
pub(super) fn needed_noncentrality(level: f64, miss: f64, samples: u64) -> f64 {
    let (critical, nu) = (student(level, samples), freedom(samples));
    let normal = Normal::standard().inverse_cdf(1.0 - miss);
    critical * (1.0 - 0.25 / nu) + normal * (1.0 + 0.5 * critical * critical / nu).sqrt()
}

/// The normal deviate with the probability P(T ≤ t) of the noncentral t distribution of a mean of `samples` values
/// (Abramowitz & Stegun 26.7.10).
pub(super) fn noncentral(t: f64, noncentrality: f64, samples: u64) -> f64 {
    let nu = freedom(samples);
    (t * (1.0 - 0.25 / nu) - noncentrality) / (1.0 + 0.5 * t * t / nu).sqrt()
}

/// The probability of a normal deviate above `deviate`.
pub fn upper_tail(deviate: f64) -> f64 {
    Normal::standard().sf(deviate)
}

/// The value that √n D, with Kolmogorov's distance D, exceeds with at most this probability (Massart 1990).
pub(super) fn massart(probability: f64) -> f64 {
    (0.5 * (2.0 / probability).ln()).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::judge::statistics::Sample;
    use rand::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};
    use rand_pcg::Pcg64Dxsm;

    #[test]
    fn the_noncentral_distribution_is_the_simulated_one() {
        let mut rng = Pcg64Dxsm::seed_from_u64(1);
        for (samples, noncentrality, t) in [(20u64, 3.0f64, 2.5), (20, 6.0, 8.0), (100, 5.0, 4.2)] {
            let root = (samples as f64).sqrt();
            let trials = 20_000;
            let below = (0..trials)
                .filter(|_| {
                    let values = (0..samples).map(|_| noncentrality / root + normal_value(&mut rng));
                    let Sample { mean, se, .. } = Sample::of(values);
                    mean / se <= t
                })
                .count();
            let observed = below as f64 / f64::from(trials);
            let expected = upper_tail(-noncentral(t, noncentrality, samples));
            // Five standard errors of a share, and the approximation's own error at the centre of the distribution.
            assert!((observed - expected).abs() < 5.0 * 0.0036 + 0.005, "{observed} {expected}");
        }
    }

    fn normal_value(rng: &mut Pcg64Dxsm) -> f64 {
        StandardNormal.sample(rng)
    }

    /// At levels that can be simulated, both error rates are as designed, approached from both sides.
    #[test]
    fn a_designed_sample_has_both_error_rates() {
        const LEVEL: f64 = 0.02;
        const MISS: f64 = 0.05;
        const TRIALS: u32 = 20_000;
        for ratio in [0.4, 0.8] {
            let design = Design { effect: ratio, sd: 1.0 };
            let samples = design.samples_at(LEVEL, MISS);
            let mut rng = Pcg64Dxsm::seed_from_u64(2);
            let (mut far, mut wide, mut blind, mut blind_of_half) = (0, 0, 0, 0);
            for _ in 0..TRIALS {
                let Sample { mean, se, .. } = Sample::of((0..samples).map(|_| normal_value(&mut rng)));
                let critical = student(LEVEL, samples);
                far += u32::from(mean.abs() > critical * se);
                wide += u32::from(se * needed_noncentrality(LEVEL, MISS, samples) > design.effect);
                blind += u32::from((mean + design.effect).abs() <= critical * se);
                blind_of_half += u32::from((mean + 0.5 * design.effect).abs() <= critical * se);
            }
            let share = |count: u32| f64::from(count) / f64::from(TRIALS);
            // Five standard errors of a share of 20,000: 0.005 at 0.02, 0.008 at 0.05.
            assert!((share(far) - LEVEL).abs() < 0.005, "{ratio}: far {}", share(far));
            assert!((share(wide) - LEVEL).abs() < 0.008, "{ratio}: wide {}", share(wide));
            assert!(share(blind) < MISS + 0.008, "{ratio}: blind {}", share(blind));
            // The sample is not much larger than needed: half the effect is often missed.
            assert!(share(blind_of_half) > 0.15, "{ratio}: half {}", share(blind_of_half));
        }
    }
}
