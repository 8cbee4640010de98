//! What measured points determine about the parameters and about points to come, by linear Bayes estimation.

use nalgebra::{DMatrix, DVector};
use std::sync::Arc;

/// The covariances of the parameters and of each candidate, given the points measured so far.
#[derive(Clone, Debug)]
pub struct Known {
    /// The covariance of the parameters.
    pub parameters: DMatrix<f64>,
    /// Covariances, parameters × candidates.
    cross: DMatrix<f64>,
    /// The variance of each candidate.
    pub own: DVector<f64>,
    /// Values less their mean, times the root of the weight: places × candidates.
    values: Arc<DMatrix<f64>>,
    /// For each point that was added: its covariances with all candidates, and its variance including the error of
    /// measurement.
    measured: Vec<(DVector<f64>, f64)>,
}

impl Known {
    /// The covariances from `parameters` at places with `weights`, and from each candidate's values there (`columns`).
    pub fn new(parameters: &[Vec<f64>], columns: &[DVector<f64>], weights: &[f64]) -> Self {
        let weights = DVector::from_column_slice(weights);
        let centred = |column: &DVector<f64>| {
            let mean = column.dot(&weights);
            column.zip_map(&weights, |value, weight| (value - mean) * weight.sqrt())
        };
        let axes = (0..parameters[0].len()).map(|axis| {
            let column = parameters.iter().map(|place| place[axis]);
            centred(&DVector::from_iterator(parameters.len(), column))
        });
        let theta = DMatrix::from_columns(&axes.collect::<Vec<_>>());
        let values = DMatrix::from_columns(&columns.iter().map(centred).collect::<Vec<_>>());
        Self {
            parameters: theta.tr_mul(&theta),
            cross: theta.tr_mul(&values),
            own: DVector::from_iterator(values.ncols(), values.column_iter().map(|column| column.norm_squared())),
            values: Arc::new(values),
            measured: Vec::new(),
        }
    }

    /// The covariance of the parameters after candidate `k` is measured with error variance `variance`.
    pub fn left(&self, k: usize, variance: f64) -> DMatrix<f64> {
        let with_parameters = self.cross.column(k);
        &self.parameters - with_parameters * with_parameters.transpose() / (variance + self.own[k])
    }

    /// Adds a measurement of candidate `k` with error variance `variance`.
    pub fn measure(&mut self, k: usize, variance: f64) {
        let mut with_all = self.values.tr_mul(&self.values.column(k));
        for (earlier, whole) in &self.measured {
            with_all -= earlier * (earlier[k] / whole);
        }
        let whole = variance + self.own[k];
        self.parameters = self.left(k, variance);
        let with_parameters = self.cross.column(k).clone_owned();
        self.cross -= &with_parameters * with_all.transpose() / whole;
        self.own -= with_all.map(|c| c * c) / whole;
        self.measured.push((with_all, whole));
    }

    /// The candidate that leaves the smallest determinant of the parameters' covariance; `variance` gives each error
    /// variance.
    pub fn best(&self, variance: impl Fn(usize) -> f64) -> Option<usize> {
        let information = self.parameters.clone().try_inverse()?;
        // The share by which a candidate reduces the determinant.
        let gain = |k: usize| {
            let with_parameters = self.cross.column(k);
            with_parameters.dot(&(&information * with_parameters)) / (variance(k) + self.own[k])
        };
        (0..self.own.len()).max_by(|a, b| gain(*a).total_cmp(&gain(*b)))
    }
}
