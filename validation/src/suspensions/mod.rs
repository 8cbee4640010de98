//! Suspensions: error against run time of free ones; of interacting ones how the mean depends on steps, rods and
//! replicas, what a given error costs, and which coupled estimates pay. Plain data; writers are in [`tables`],
//! [`figures`] and [`export`].

pub mod chapter;
pub mod coupled;
pub mod export;
pub mod figures;
pub mod fit;
pub mod free;
pub mod job;
pub mod law;
pub mod law_tables;
pub mod split;
pub mod starts;
pub mod study;
pub mod tables;

use serde::Serialize;

/// The mean of independent values and its standard error.
pub fn mean_and_se(values: &[f64]) -> (f64, f64) {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    (mean, (covariance(values, values) / count).sqrt())
}

/// The covariance of as many pairs as both have.
pub fn covariance(a: &[f64], b: &[f64]) -> f64 {
    let count = a.len().min(b.len());
    let (a, b) = (&a[..count], &b[..count]);
    let mean = |values: &[f64]| values.iter().sum::<f64>() / count as f64;
    let (mean_a, mean_b) = (mean(a), mean(b));
    let products = a.iter().zip(b).map(|(a, b)| (a - mean_a) * (b - mean_b));
    products.sum::<f64>() / (count as f64 - 1.0)
}

/// The slope of a straight line through points, by least squares.
pub fn slope(points: &[(f64, f64)]) -> f64 {
    let (x, y): (Vec<_>, Vec<_>) = points.iter().copied().unzip();
    covariance(&x, &y) / covariance(&x, &x)
}

/// A number with its standard error.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Estimate {
    /// The number.
    pub value: f64,
    /// Its standard error.
    pub se: f64,
}

impl Estimate {
    /// Whether it is known from 0: two standard errors or more.
    pub fn readable(&self) -> bool {
        self.value.abs() >= 2.0 * self.se
    }
}

/// The correlation of pairs.
pub fn correlation(a: &[f64], b: &[f64]) -> f64 {
    covariance(a, b) / (covariance(a, a) * covariance(b, b)).sqrt()
}
