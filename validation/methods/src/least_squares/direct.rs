//! χ² of the predictions of replicas themselves, without polynomials.

use super::Datum;
use super::emulator::{Prediction, of_time};
use super::likelihood::Rods;
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
    /// From the predictions of at least two replicas, a row for each; `None` if the covariance is not positive
    /// definite.
    pub fn of(data: &[Datum], rows: &[Vec<Prediction>], rods: &Rods) -> Option<Self> {
        let (points, n) = (data.len(), rows.len() as f64);
        let mean = |which: usize| {
            DVector::from_fn(points, |point, _| rows.iter().map(|row| row[point][which]).sum::<f64>() / n)
        };
        let [at, before, after] = [0, 1, 2].map(mean);
        let away = DMatrix::from_fn(rows.len(), points, |row, point| rows[row][point][0] - at[point]);
        let of_replica = away.tr_mul(&away) / (n - 1.0);
        let of_time = of_time(&at, before, after);
        let [reading, rods] = rods.covariances(data, &of_replica);
        let covariance = reading + rods + &of_replica / n + DMatrix::from_diagonal(&of_time);
        let error = DVector::from_fn(points, |i, _| data[i].value) - &at;
        let chi_square = error.dot(&covariance.cholesky()?.solve(&error));
        Some(Self { mean: at, se: (of_replica.diagonal() / n).map(f64::sqrt), chi_square })
    }
}
