//! Suspensions: error against run time of free ones; of interacting ones how the mean depends on steps, rods and
//! replicas, what a given error costs, and which coupled estimates pay. Plain data; writers are in [`tables`],
//! [`figures`] and [`export`].

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
