//! Statistics of independent values, for runs, figures, cases and studies.

pub use crate::oracle::{larger, worst};
use serde::{Deserialize, Serialize};
use statrs::distribution::{ContinuousCDF, Normal, StudentsT, Uniform};
use statrs::statistics::Statistics;
use statrs::stats_tests::NaNPolicy;
use statrs::stats_tests::ks_test::{KSOneSampleAlternativeMethod, ks_onesample};
use std::borrow::Borrow;

/// Mean and standard error of independent values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// The mean.
    pub mean: f64,
    /// The standard error of the mean.
    pub se: f64,
    /// Number of values.
    pub samples: u64,
}

impl Sample {
    /// The sample of `values`.
    pub fn of(values: impl IntoIterator<Item: Borrow<f64>>) -> Self {
        let values: Vec<f64> = values.into_iter().map(|value| *value.borrow()).collect();
        let values = values.as_slice();
        Self { mean: values.mean(), se: values.std_dev() / (values.len() as f64).sqrt(), samples: values.len() as u64 }
    }

    /// The sample of the differences a − b, pair by pair.
    pub fn of_differences(a: &[f64], b: &[f64]) -> Self {
        Self::of(a.iter().zip(b).map(|(a, b)| a - b))
    }

    /// Half the width of the 95 % confidence interval of the mean.
    pub fn half_width(self) -> f64 {
        student(0.05, self.samples) * self.se
    }
}

/// A number with its standard error.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// The number.
    pub value: f64,
    /// The standard error of the number.
    pub se: f64,
}

impl Estimate {
    /// True if the number differs from 0 by two standard errors or more.
    pub fn readable(&self) -> bool {
        self.value.abs() >= 2.0 * self.se
    }

    /// The mean of independent values.
    pub fn mean_of(values: &[f64]) -> Self {
        let Sample { mean, se, .. } = Sample::of(values);
        Self { value: mean, se }
    }

    /// A statistic with the standard error of the delete-one jackknife, se² = (n−1)/n Σ(s_k − s̄)², where s_k is the
    /// statistic without the k-th value (Efron & Stein 1981).
    pub fn jackknife(value: f64, without: &[f64]) -> Self {
        let n = without.len() as f64;
        let mean = without.mean();
        let square: f64 = without.iter().map(|s| (s - mean).powi(2)).sum();
        Self { value, se: ((n - 1.0) / n * square).sqrt() }
    }
}

/// Every pair of an item of one list and an item of the other.
pub fn pairs<A: Clone, B: Clone>(
    first: impl IntoIterator<Item = A>,
    second: impl IntoIterator<Item = B>,
) -> impl Iterator<Item = (A, B)> {
    let second: Vec<B> = second.into_iter().collect();
    first.into_iter().flat_map(move |a| second.clone().into_iter().map(move |b| (a.clone(), b)))
}

/// The covariance of pairs; surplus values of the longer list are ignored.
pub fn covariance(a: &[f64], b: &[f64]) -> f64 {
    let count = a.len().min(b.len());
    let (a, b) = (&a[..count], &b[..count]);
    let (mean_a, mean_b) = (a.mean(), b.mean());
    let products = a.iter().zip(b).map(|(a, b)| (a - mean_a) * (b - mean_b));
    products.sum::<f64>() / (count as f64 - 1.0)
}

/// The correlation of pairs.
pub fn correlation(a: &[f64], b: &[f64]) -> f64 {
    covariance(a, b) / (covariance(a, a) * covariance(b, b)).sqrt()
}

/// The slope of the least-squares line through points.
pub fn slope(points: &[(f64, f64)]) -> f64 {
    let (x, y): (Vec<_>, Vec<_>) = points.iter().copied().unzip();
    covariance(&x, &y) / covariance(&x, &x)
}

/// Kolmogorov's distance of `values` in [0, 1] from uniform ones, and its p.
pub(super) fn kolmogorov(values: Vec<f64>) -> (f64, f64) {
    let method = KSOneSampleAlternativeMethod::TwoSidedAsymptotic;
    let test = |unit: Uniform| ks_onesample(values, &unit, method, NaNPolicy::Propogate).ok();
    Uniform::new(0.0, 1.0).ok().and_then(test).unwrap_or((f64::NAN, f64::NAN))
}

/// The two-sided critical value of Student's t at `level` for a mean of `samples` independent values.
pub fn student(level: f64, samples: u64) -> f64 {
    let (freedom, p) = (freedom(samples), 1.0 - 0.5 * level);
    // statrs 0.19 loses digits above about 10⁵ degrees of freedom, and does not return above 10⁷.
    if freedom < MANY {
        return StudentsT::new(0.0, 1.0, freedom).map_or(f64::NAN, |t| t.inverse_cdf(p));
    }
    let z = Normal::standard().inverse_cdf(p);
    let terms = [
        (z.powi(3) + z) / 4.0,
        (5.0 * z.powi(5) + 16.0 * z.powi(3) + 3.0 * z) / 96.0,
        (3.0 * z.powi(7) + 19.0 * z.powi(5) + 17.0 * z.powi(3) - 15.0 * z) / 384.0,
    ];
    z + terms.iter().rev().fold(0.0, |sum, term| (sum + term) / freedom)
}

/// Degrees of freedom from which Student's t is computed by a series in their inverse around the normal (Abramowitz &
/// Stegun 26.7.5): three terms leave an error of 10⁻⁸ in a critical value of 6, and of 10⁻¹² in one of 2.
const MANY: f64 = 1000.0;

/// The degrees of freedom of the standard deviation of `samples` values.
pub fn freedom(samples: u64) -> f64 {
    samples.saturating_sub(1).max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_are_all_pairs() {
        assert!(pairs([1, 2], ["a", "b"]).eq([(1, "a"), (1, "b"), (2, "a"), (2, "b")]));
    }

    #[test]
    fn critical_values_of_any_number_of_samples_are_those_of_tables() {
        for (level, samples, expected) in [
            (0.05, 2, 12.706),
            (0.05, 11, 2.228),
            (0.05, 101, 1.984),
            (0.05, 1001, 1.962),
            (1e-3, 11, 4.587),
            (1e-3, 1_000_000, 3.2905),
        ] {
            assert!((student(level, samples) - expected).abs() < 6e-4, "{level} {samples}");
        }
        // Both methods where they meet; the value for 1000 degrees of freedom, to 16 digits; the limit, which is the
        // normal's.
        let [below, above] = [1000, 1001].map(|samples| student(0.05, samples));
        // The slope is 2.4 over the square of 1000.
        assert!((below - above - 2.37e-6).abs() < 2e-8, "{below} {above}");
        assert!((student(0.05, 1001) - 1.962_339_080_826_408).abs() < 1e-11);
        for samples in [1_000_000, 20_000_000, u64::MAX] {
            assert!((student(0.05, samples) - 1.959_963_984_540_054).abs() < 3e-6, "{samples}");
        }
    }

    #[test]
    fn small_samples_by_hand() {
        // Squared deviations from 3: 4 + 1 + 9, over 3 − 1.
        let values = [1.0, 2.0, 6.0];
        assert_eq!(covariance(&values, &values), 7.0);
        let mean = Estimate::mean_of(&values);
        assert_eq!(mean.value, 3.0);
        assert!((mean.se - (7f64 / 3.0).sqrt()).abs() < 1e-15);
        // With −1, 0, 4 less their mean 1: −2·−2 − 1·−1 + 3·3; a surplus value on one side has no pair.
        let others = [-1.0, 0.0, 4.0, 100.0];
        assert_eq!(covariance(&values, &others), 7.0);
        assert_eq!(correlation(&values, &[2.0, 1.0, -3.0]), -1.0);
        assert_eq!(slope(&[(0.0, 1.0), (1.0, 3.0), (2.0, 5.0)]), 2.0);
        let sample = Sample::of_differences(&[2.0, 4.0, 9.0], &[1.0, 2.0, 3.0]);
        assert_eq!((sample.mean, sample.samples), (3.0, 3));
        assert!((sample.se - (7f64 / 3.0).sqrt()).abs() < 1e-15);
        // With two degrees of freedom, t is 4.3027 at 5 %.
        assert!((sample.half_width() / sample.se - 4.3027).abs() < 1e-4);
        assert_eq!([1, 2, 10].map(freedom), [1.0, 1.0, 9.0]);
        let readable = |value| Estimate { value, se: 2.0 }.readable();
        assert!(readable(-4.0) && !readable(3.9));
    }
}
