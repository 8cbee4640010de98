//! What measured points tell of parameters and of points to come, by linear Bayes estimation.

use nalgebra::{DMatrix, DVector};
use std::sync::Arc;

/// What is known of the parameters and of each candidate.
#[derive(Clone, Debug)]
pub struct Known {
    /// The covariance of the parameters.
    pub parameters: DMatrix<f64>,
    /// Parameters × candidates: their covariances.
    cross: DMatrix<f64>,
    /// The variance of each candidate.
    pub own: DVector<f64>,
    /// Places × candidates: values less their mean, times the root of the weight.
    values: Arc<DMatrix<f64>>,
    /// Of each point that was measured: its covariances with all candidates, and its whole variance.
    measured: Vec<(DVector<f64>, f64)>,
}

impl Known {
    /// From the parameters at weighted places, and each candidate's values there.
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
            own: DVector::from_iterator(
                values.ncols(),
                values.column_iter().map(|column| column.norm_squared()),
            ),
            values: Arc::new(values),
            measured: Vec::new(),
        }
    }

    /// The covariance of the parameters once a point with a variance of its own is known.
    pub fn left(&self, k: usize, variance: f64) -> DMatrix<f64> {
        let with_parameters = self.cross.column(k);
        &self.parameters - with_parameters * with_parameters.transpose() / (variance + self.own[k])
    }

    /// One more point is known, with a variance of its own.
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

    /// The point that leaves the least determinant of the parameters' covariance, each with a variance of its own.
    pub fn best(&self, variance: impl Fn(usize) -> f64) -> Option<usize> {
        let information = self.parameters.clone().try_inverse()?;
        // The share of the determinant that a point takes away.
        let gain = |k: usize| {
            let with_parameters = self.cross.column(k);
            with_parameters.dot(&(&information * with_parameters)) / (variance(k) + self.own[k])
        };
        (0..self.own.len()).max_by(|a, b| gain(*a).total_cmp(&gain(*b)))
    }
}
