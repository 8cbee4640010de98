//! χ² of the measured points over the box, with all known contributions to their covariance.

use super::Datum;
use super::basis::Basis;
use super::emulator::Emulator;
use nalgebra::{DMatrix, DVector};

/// The causes of differences between model and measurement, in the order of [`Causes`]; for tables.
pub const CAUSES: [&str; 5] =
    ["reading off in y", "reading off in time", "rods that were measured", "replicas of the model", "emulator"];

/// The covariance of the points by cause, at one place of the box.
pub type Causes = [DMatrix<f64>; CAUSES.len()];

/// Index in `CAUSES` of the measured rods.
pub const RODS: usize = 2;
/// Index in `CAUSES` of the simulation's own noise.
pub const REPLICAS: usize = 3;
/// Index in `CAUSES` of the emulator's error.
pub const EMULATOR: usize = 4;

/// The rods that were measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Rods {
    /// For each data set: the number of rods of a replica over the number of rods averaged in a point, 0 if the points
    /// share no rods.
    pub over_measured: Vec<f64>,
    /// True if the points' uncertainties contain the scatter of these rods.
    pub in_u: bool,
}

impl Rods {
    /// Points of `sets` sets that share no rods.
    pub fn none(sets: usize) -> Self {
        Self { over_measured: vec![0.0; sets], in_u: false }
    }

    /// Rods whose scatter is the share `share` of the squared uncertainties.
    pub fn within(data: &[Datum], of_replica: &DMatrix<f64>, sets: usize, share: f64) -> Self {
        let ratio = |set: usize| {
            let here = || (0..data.len()).filter(|k| data[*k].set == set);
            let (u, rods) = (here().map(|k| data[k].u.powi(2)), here().map(|k| of_replica[(k, k)]));
            share * u.sum::<f64>() / rods.sum::<f64>().max(f64::MIN_POSITIVE)
        };
        Self { over_measured: (0..sets).map(ratio).collect(), in_u: true }
    }

    /// The covariances of the points by reading and by rods. Different data sets have different rods.
    pub fn covariances(&self, data: &[Datum], of_replica: &DMatrix<f64>) -> [DMatrix<f64>; 2] {
        let rods = DMatrix::from_fn(data.len(), data.len(), |i, j| {
            if data[i].set == data[j].set { self.over_measured[data[i].set] * of_replica[(i, j)] } else { 0.0 }
        });
        let contained = if self.in_u { 1.0 } else { 0.0 };
        let reading = |k: usize| (data[k].u.powi(2) - contained * rods[(k, k)]).max(0.0);
        let reading = DVector::from_iterator(data.len(), (0..data.len()).map(reading));
        [DMatrix::from_diagonal(&reading), rods]
    }
}

/// The covariance of each cause.
pub fn causes(data: &[Datum], emulator: &Emulator, place: &[f64], rods: &Rods) -> Causes {
    let [reading, rods] = rods.covariances(data, &emulator.covariance_of_replica(place));
    let lack = emulator.lack_of_fit(place);
    [
        reading,
        DMatrix::from_diagonal(&emulator.time_variance(place)),
        rods,
        emulator.covariance_of_mean(place),
        // A polynomial's error may move points together or independently: half of either.
        (&lack * lack.transpose() + DMatrix::from_diagonal(&lack.map(|lack| lack * lack))) / 2.0,
    ]
}

/// χ² over the box at a fixed covariance V, as a form in the polynomials' terms, so that its cost does not grow with
/// the points.
///
/// The replicas' noise adds to the differences between curves of different parameters, and so lets χ² rise where the
/// points contain no information. Its average contribution is subtracted (the correction of a regression whose
/// regressors are noisy: W. A. Fuller, Measurement Error Models, 1987, ch. 2).
#[derive(Clone, Debug)]
pub struct ChiSquare {
    basis: Basis,
    /// The terms at a place near the best one. Differences are taken from it, so that little cancels.
    origin: DVector<f64>,
    /// EᵀV⁻¹E, CV⁻¹E and CV⁻¹Cᵀ with E = D − S at the origin; C has a row of coefficients for each term.
    constant: f64,
    linear: DVector<f64>,
    square: DMatrix<f64>,
    /// The average contribution of the replicas' noise to `square`.
    noise: DMatrix<f64>,
    /// `square` less `noise`.
    reduced: DMatrix<f64>,
}

impl ChiSquare {
    /// χ² of the data with this covariance, expanded about the parameters `near`; `None` if the covariance is not
    /// positive definite.
    pub fn new(data: &[Datum], emulator: &Emulator, covariance: &DMatrix<f64>, near: &[f64]) -> Option<Self> {
        let terms = emulator.mean();
        let measured = DVector::from_iterator(data.len(), data.iter().map(|datum| datum.value));
        let error = measured - emulator.at(near);
        let solver = covariance.clone().cholesky()?;
        let weighted = solver.solve(&error);
        let (origin, noise) = (emulator.basis.terms(near), emulator.noise(&solver.inverse()));
        let square = terms * solver.solve(&terms.transpose());
        Some(Self {
            constant: error.dot(&weighted),
            linear: terms * weighted + &noise * &origin,
            reduced: &square - &noise,
            square,
            noise,
            origin,
            basis: emulator.basis.clone(),
        })
    }

    // Below, `tr_mul` is the product with the symmetric matrices: the library's faster one.
    /// χ² at a place.
    pub fn at(&self, place: &[f64]) -> f64 {
        let away = self.basis.terms(place) - &self.origin;
        self.constant - 2.0 * self.linear.dot(&away) + away.dot(&self.reduced.tr_mul(&away))
    }

    /// Half the gradient by the parameters `free`, and half the second derivatives without those of the model
    /// (Gauss–Newton) but with the noise.
    pub fn slopes(&self, place: &[f64], free: &[usize]) -> (DVector<f64>, DMatrix<f64>) {
        let (away, slopes) = (self.basis.terms(place) - &self.origin, self.basis.slopes(place, free));
        let gradient = slopes.tr_mul(&(self.reduced.tr_mul(&away) - &self.linear));
        (gradient, slopes.tr_mul(&self.square.tr_mul(&slopes)))
    }

    /// χ² with the replicas' noise not subtracted, for a control.
    pub fn with_noise(&self) -> Self {
        Self {
            linear: &self.linear - &self.noise * &self.origin,
            noise: DMatrix::zeros(self.noise.nrows(), self.noise.ncols()),
            reduced: self.square.clone(),
            ..self.clone()
        }
    }

    /// The average contribution of the replicas' noise to χ² at `place` relative to `other`.
    pub fn noise_between(&self, place: &[f64], other: &[f64]) -> f64 {
        let away = self.basis.terms(place) - self.basis.terms(other);
        away.dot(&(&self.noise * &away))
    }

    /// The average contribution of the replicas' noise to the second derivatives of `slopes`.
    pub fn noise(&self, place: &[f64]) -> DMatrix<f64> {
        let slopes = self.basis.slopes_of_all(place);
        slopes.tr_mul(&(&self.noise * &slopes))
    }
}

/// The correlation matrix of a covariance.
pub fn correlation_of(covariance: &DMatrix<f64>) -> DMatrix<f64> {
    DMatrix::from_fn(covariance.nrows(), covariance.ncols(), |i, j| {
        covariance[(i, j)] / (covariance[(i, i)] * covariance[(j, j)]).sqrt()
    })
}
