//! χ² of the measured points over the box, with everything in their covariance that is known to be there.

use super::Datum;
use super::basis::Basis;
use super::emulator::Emulator;
use nalgebra::{DMatrix, DVector};

/// The causes of a difference between model and measurement, in the order of [`Causes`]; for tables.
pub const CAUSES: [&str; 5] = [
    "reading off in y",
    "reading off in time",
    "rods that were measured",
    "replicas of the model",
    "emulator",
];

/// The covariance that each cause gives the points, at one place of the box.
pub type Causes = [DMatrix<f64>; CAUSES.len()];

/// The index of the simulation's own error among the causes.
pub const REPLICAS: usize = 3;
/// The index of the emulator's.
pub const EMULATOR: usize = 4;

/// The covariance of each cause. `rods_over_measured`, for each data set: rods of a replica over rods that each point is a
/// mean of, 0 where that is not known. Rods of different data sets are different ones.
pub fn causes(data: &[Datum], emulator: &Emulator, place: &[f64], rods_over_measured: &[f64]) -> Causes {
    let reading = DVector::from_iterator(data.len(), data.iter().map(|datum| datum.u.powi(2)));
    let of_replica = emulator.covariance(place);
    let lack = emulator.lack_of_fit(place);
    let rods = DMatrix::from_fn(data.len(), data.len(), |i, j| match data[i].set == data[j].set {
        true => rods_over_measured[data[i].set] * of_replica[(i, j)],
        false => 0.0,
    });
    [
        DMatrix::from_diagonal(&reading),
        DMatrix::from_diagonal(&emulator.time_variance(place)),
        rods,
        of_replica / emulator.replicas() as f64,
        // A polynomial that does not fit may move points together or each by itself: half of either.
        (&lack * lack.transpose() + DMatrix::from_diagonal(&lack.map(|lack| lack * lack))) / 2.0,
    ]
}

/// χ² over the box at a fixed covariance V: a polynomial form, so that its cost does not grow with the points.
///
/// The replicas' noise makes the curves of different parameters differ more than they do, and so χ² rise where the points tell
/// nothing. What it adds on average is subtracted (the correction of a regression whose regressors are noisy: W. A. Fuller,
/// Measurement Error Models, 1987, ch. 2).
#[derive(Clone, Debug)]
pub struct ChiSquare {
    basis: Basis,
    /// The terms at a place near the best one, from which all else counts: so little cancels.
    origin: DVector<f64>,
    /// EᵀV⁻¹E, CV⁻¹E, CV⁻¹Cᵀ with E = D − S there; C holds a row of coefficients for each term.
    constant: f64,
    linear: DVector<f64>,
    square: DMatrix<f64>,
    /// What the replicas' noise adds to the square on average.
    noise: DMatrix<f64>,
}

impl ChiSquare {
    /// χ² of the data with this covariance, about the parameters `near`; `None` where the covariance is not positive definite.
    pub fn new(data: &[Datum], emulator: &Emulator, covariance: &DMatrix<f64>, near: &[f64]) -> Option<Self> {
        let terms = emulator.mean();
        let measured = DVector::from_iterator(data.len(), data.iter().map(|datum| datum.value));
        let error = measured - emulator.at(near);
        let solver = covariance.clone().cholesky()?;
        let weighted = solver.solve(&error);
        let (origin, noise) = (emulator.basis.terms(near), emulator.noise(&solver.inverse()));
        Some(Self {
            constant: error.dot(&weighted),
            linear: terms * weighted + &noise * &origin,
            square: terms * solver.solve(&terms.transpose()),
            noise,
            origin,
            basis: emulator.basis.clone(),
        })
    }

    /// χ² at a place.
    pub fn at(&self, place: &[f64]) -> f64 {
        let away = self.basis.terms(place) - &self.origin;
        let square = away.dot(&(&self.square * &away)) - away.dot(&(&self.noise * &away));
        self.constant - 2.0 * self.linear.dot(&away) + square
    }

    /// Half its gradient, and half its second derivatives without those of the model (Gauss–Newton), the noise in them.
    pub fn slopes(&self, place: &[f64]) -> (DVector<f64>, DMatrix<f64>) {
        let (away, slopes) = (self.basis.terms(place) - &self.origin, self.basis.slopes(place));
        let gradient = slopes.tr_mul(&(&self.square * &away - &self.noise * &away - &self.linear));
        (gradient, slopes.tr_mul(&(&self.square * &slopes)))
    }

    /// As if the noise were the model: for a control.
    pub fn with_noise(&self) -> Self {
        Self {
            linear: &self.linear - &self.noise * &self.origin,
            noise: DMatrix::zeros(self.noise.nrows(), self.noise.ncols()),
            ..self.clone()
        }
    }

    /// What the replicas' noise adds on average to χ² at a place, beside another.
    pub fn noise_between(&self, place: &[f64], other: &[f64]) -> f64 {
        let away = self.basis.terms(place) - self.basis.terms(other);
        away.dot(&(&self.noise * &away))
    }

    /// What the replicas' noise adds to those second derivatives on average.
    pub fn noise(&self, place: &[f64]) -> DMatrix<f64> {
        let slopes = self.basis.slopes(place);
        slopes.tr_mul(&(&self.noise * &slopes))
    }
}

/// The correlations that belong to a covariance.
pub fn correlation_of(covariance: &DMatrix<f64>) -> DMatrix<f64> {
    DMatrix::from_fn(covariance.nrows(), covariance.ncols(), |i, j| {
        covariance[(i, j)] / (covariance[(i, i)] * covariance[(j, j)]).sqrt()
    })
}
