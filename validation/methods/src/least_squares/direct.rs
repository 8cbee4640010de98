//! χ² of the predictions of replicas themselves, without polynomials.

use super::Datum;
use super::best::Goodness;
use super::emulator::{Prediction, of_time};
use super::likelihood::{Residuals, Rods};
use super::scarce::scatter_of_covariance;
use nalgebra::{DMatrix, DVector};

/// Means of replicas, and χ² of the points with the covariance of measured less predicted values.
pub struct Direct {
    /// The mean prediction of each point.
    pub mean: DVector<f64>,
    /// Its standard error.
    pub se: DVector<f64>,
    /// χ².
    pub chi_square: f64,
    /// The covariance of measured less predicted values, and that of one replica.
    covariance: [DMatrix<f64>; 2],
    replicas: usize,
}

impl Direct {
    /// From the predictions of replicas, a row for each (one alone of a model that draws nothing); `None` if the
    /// covariance is not positive definite.
    pub fn of(data: &[Datum], rows: &[Vec<Prediction>], rods: &Rods) -> Option<Self> {
        let (points, n) = (data.len(), rows.len() as f64);
        let mean = |which: usize| {
            DVector::from_fn(points, |point, _| rows.iter().map(|row| row[point][which]).sum::<f64>() / n)
        };
        let [at, before, after] = [0, 1, 2].map(mean);
        let away = DMatrix::from_fn(rows.len(), points, |row, point| rows[row][point][0] - at[point]);
        let of_replica = away.tr_mul(&away) / (n - 1.0).max(1.0);
        let of_time = of_time(&at, before, after);
        let error = DVector::from_fn(points, |i, _| data[i].value) - &at;
        let others = &of_replica / n + DMatrix::from_diagonal(&of_time);
        let residuals = Residuals { error, slopes: DMatrix::zeros(points, 0), others };
        let scatter = rods.scatter(data, &of_replica);
        let reading = rods.reading(data, &scatter, &residuals);
        let Residuals { error, others, .. } = residuals;
        let covariance = reading + scatter + others;
        let chi_square = error.dot(&covariance.clone().cholesky()?.solve(&error));
        let (se, replicas) = ((of_replica.diagonal() / n).map(f64::sqrt), rows.len());
        Some(Self { mean: at, se, chi_square, covariance: [covariance, of_replica], replicas })
    }

    /// The standard uncertainty of measured less predicted values.
    pub fn u(&self) -> DVector<f64> {
        self.covariance[0].diagonal().map(f64::sqrt)
    }

    /// The standard uncertainty of each point alone, without the replicas'.
    pub fn u_of_points(&self) -> Vec<f64> {
        self.u().zip_map(&self.se, |u, se| (u * u - se * se).max(0.0).sqrt()).as_slice().to_vec()
    }

    /// χ² and its law where no parameter was fitted; `None` if the covariance is not positive definite.
    pub fn goodness(&self, data: &[Datum], rods: &Rods) -> Option<Goodness> {
        let [covariance, of_replica] = &self.covariance;
        let inverse = covariance.clone().cholesky()?.inverse();
        let scatter = scatter_of_covariance(data, [self.replicas; 2], of_replica, &rods.over_measured, &inverse);
        let excess = ((inverse * scatter).trace() / data.len() as f64).min(1.0);
        Some(Goodness { chi_square: self.chi_square, excess, freedom: data.len() })
    }
}
