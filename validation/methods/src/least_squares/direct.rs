//! χ² of the predictions of replicas themselves, without polynomials.

use super::Datum;
use super::emulator::Prediction;
use nalgebra::{DMatrix, DVector};

/// Means of replicas, and χ² of the points with the covariance of measured less predicted values.
pub struct Direct {
    /// The mean prediction of each point.
    pub mean: DVector<f64>,
    /// Its standard error.
    pub se: DVector<f64>,
    /// χ².
    pub chi_square: f64,
}

impl Direct {
    /// From the predictions of at least two replicas, a row for each; `None` if the covariance is not positive definite.
    /// `rods_over_measured` is that of [`causes`](super::likelihood::causes).
    pub fn of(data: &[Datum], rows: &[Vec<Prediction>], rods_over_measured: &[f64]) -> Option<Self> {
        let (points, n) = (data.len(), rows.len() as f64);
        let mean = |which: usize| {
            DVector::from_fn(points, |point, _| rows.iter().map(|row| row[point][which]).sum::<f64>() / n)
        };
        let [at, before, after] = [0, 1, 2].map(mean);
        let away = DMatrix::from_fn(rows.len(), points, |row, point| rows[row][point][0] - at[point]);
        let of_replica = away.tr_mul(&away) / (n - 1.0);
        let covariance = DMatrix::from_fn(points, points, |i, j| {
            let rods = if data[i].set == data[j].set { rods_over_measured[data[i].set] } else { 0.0 };
            let reading =
                data[i].u.powi(2) + ((before[i] - at[i]).powi(2) + (after[i] - at[i]).powi(2)) / 6.0;
            of_replica[(i, j)] * (rods + 1.0 / n) + if i == j { reading } else { 0.0 }
        });
        let error = DVector::from_fn(points, |i, _| data[i].value) - &at;
        let chi_square = error.dot(&covariance.cholesky()?.solve(&error));
        Some(Self { mean: at, se: (of_replica.diagonal() / n).map(f64::sqrt), chi_square })
    }
}
