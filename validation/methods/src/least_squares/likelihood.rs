//! χ² of the measured points over the box, with all known contributions to their covariance.

use super::Datum;
use super::basis::Basis;
use super::emulator::Emulator;
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

/// The causes of differences between model and measurement, in the order of [`Causes`]; for tables.
pub const CAUSES: [&str; 5] =
    ["reading off in y", "reading off in time", "rods that were measured", "replicas of the model", "emulator"];

/// The covariance of the points by cause, at one place of the box.
pub type Causes = [DMatrix<f64>; CAUSES.len()];

/// Index in `CAUSES` of the reading in y.
pub const READING: usize = 0;
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
    /// The part of the points' squared uncertainties that is reading, independent for each point.
    pub reading: Reading,
}

/// The part of the points' squared uncertainties u² that is reading.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reading {
    /// This share.
    Share(f64),
    /// What the rods' scatter leaves of u². As u² holds the variance of a sample, it has this standard deviation,
    /// relative to u²; within it the residuals decide.
    Rest(f64),
}

/// Measured less predicted values, their slopes by the parameters (points × parameters), and their covariance without
/// reading and rods.
pub struct Residuals {
    /// The differences.
    pub error: DVector<f64>,
    /// Their slopes; no columns if no parameter is fitted.
    pub slopes: DMatrix<f64>,
    /// The covariance.
    pub others: DMatrix<f64>,
}

impl Residuals {
    /// −2 ln of the restricted likelihood of a covariance, in which the parameters are free (D. A. Harville, J. Am.
    /// Stat. Assoc. 72 (1977) 320); `None` if it is not positive definite.
    pub fn misfit(&self, covariance: DMatrix<f64>) -> Option<f64> {
        let inverse = covariance.cholesky()?;
        let weighted = inverse.solve(&self.slopes);
        let information = self.slopes.tr_mul(&weighted).cholesky()?;
        let gradient = weighted.tr_mul(&self.error);
        let chi_square = self.error.dot(&inverse.solve(&self.error)) - gradient.dot(&information.solve(&gradient));
        let misfit = chi_square + inverse.ln_determinant() + information.ln_determinant();
        misfit.is_finite().then_some(misfit)
    }
}

/// The largest number of points by which the share of reading is chosen, about.
const ENOUGH: usize = 200;

/// Shares of u² that are tried as reading: powers of ½ down to 10⁻⁶.
const SHARES: i32 = 20;

impl Rods {
    /// Points of `sets` sets that share no rods.
    pub fn none(sets: usize) -> Self {
        Self { over_measured: vec![0.0; sets], reading: Reading::Share(1.0) }
    }

    /// Rods whose scatter is the share `share` of the squared uncertainties.
    pub fn within(data: &[Datum], of_replica: &DMatrix<f64>, sets: usize, share: f64) -> Self {
        let ratio = |set: usize| {
            let here = || (0..data.len()).filter(|k| data[*k].set == set);
            let (u, rods) = (here().map(|k| data[k].u.powi(2)), here().map(|k| of_replica[(k, k)]));
            share * u.sum::<f64>() / rods.sum::<f64>().max(f64::MIN_POSITIVE)
        };
        Self { over_measured: (0..sets).map(ratio).collect(), reading: Reading::Share(1.0 - share) }
    }

    /// The covariance of the points by rods. Different data sets have different rods.
    pub fn scatter(&self, data: &[Datum], of_replica: &DMatrix<f64>) -> DMatrix<f64> {
        DMatrix::from_fn(data.len(), data.len(), |i, j| {
            if data[i].set == data[j].set { self.over_measured[data[i].set] * of_replica[(i, j)] } else { 0.0 }
        })
    }

    /// The covariance of the points by reading.
    pub fn reading(&self, data: &[Datum], scatter: &DMatrix<f64>, residuals: &Residuals) -> DMatrix<f64> {
        let all = DMatrix::from_diagonal(&DVector::from_iterator(data.len(), data.iter().map(|datum| datum.u.powi(2))));
        let (rest, sd) = match self.reading {
            Reading::Share(share) => return all * share,
            Reading::Rest(sd) => (1.0 - scatter.trace() / all.trace(), sd),
        };
        // The time grows with the third power of the points, so not all of many are used.
        let some: Vec<usize> = (0..data.len()).step_by(data.len().div_ceil(ENOUGH).max(1)).collect();
        let of = |matrix: &DMatrix<f64>| matrix.select_rows(&some).select_columns(&some);
        let (own, scatter) = (of(&all), of(scatter));
        let residuals = Residuals {
            error: residuals.error.select_rows(&some),
            slopes: residuals.slopes.select_rows(&some),
            others: of(&residuals.others),
        };
        let misfit = |share: f64| {
            let covariance = &residuals.others + &scatter + &own * share;
            residuals.misfit(covariance).map(|misfit| misfit + ((share - rest) / sd).powi(2))
        };
        let tried: Vec<f64> = (0..=SHARES).map(|k| misfit(0.5f64.powi(k)).unwrap_or(f64::INFINITY)).collect();
        let least = (0..tried.len()).min_by(|a, b| tried[*a].total_cmp(&tried[*b])).unwrap_or(0);
        // A parabola in ln of the share, by its neighbours, where it has two.
        let moved = match tried[least.saturating_sub(1)..].first_chunk() {
            Some([before, at, after]) if least > 0 && (before + after).is_finite() && before + after > 2.0 * at => {
                0.5 * (before - after) / (before - 2.0 * at + after)
            }
            _ => 0.0,
        };
        all * 0.5f64.powf(least as f64 + moved)
    }
}

/// The covariance of each cause.
pub fn causes(data: &[Datum], emulator: &Emulator, place: &[f64], rods: &Rods) -> Causes {
    let scatter = rods.scatter(data, &emulator.covariance_of_replica(place));
    let others = others(emulator, place);
    let reading = rods.reading(data, &scatter, &residuals(data, emulator, place, &others));
    let [of_time, of_mean, of_lack] = others;
    [reading, of_time, scatter, of_mean, of_lack]
}

/// The points less the emulator's at a place, with the covariances of [`others`].
pub fn residuals(data: &[Datum], emulator: &Emulator, place: &[f64], others: &[DMatrix<f64>; 3]) -> Residuals {
    let measured = DVector::from_iterator(data.len(), data.iter().map(|datum| datum.value));
    let others = others.iter().sum();
    Residuals { error: measured - emulator.at(place), slopes: emulator.slopes(place), others }
}

/// The covariances by errors in time, replicas and emulator.
pub fn others(emulator: &Emulator, place: &[f64]) -> [DMatrix<f64>; 3] {
    let lack = emulator.lack_of_fit(place);
    [
        DMatrix::from_diagonal(&emulator.time_variance(place)),
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

/// Many places, for χ² of many sets of points.
pub struct Places {
    /// The terms at each place less those at the origin: terms × places.
    away: DMatrix<f64>,
    squares: DVector<f64>,
}

impl ChiSquare {
    /// χ² of the data with this covariance, expanded about the parameters `near`; `None` if the covariance is not
    /// positive definite.
    pub fn new(data: &[Datum], emulator: &Emulator, covariance: &DMatrix<f64>, near: &[f64]) -> Option<Self> {
        let terms = emulator.mean();
        let measured = DVector::from_iterator(data.len(), data.iter().map(|datum| datum.value));
        let error = measured - emulator.at(near);
        let solver = covariance.clone().cholesky()?;
        let (origin, noise) = (emulator.basis.terms(near), emulator.noise(&solver.inverse()));
        let square = terms * solver.solve(&terms.transpose());
        let mut all = Self {
            constant: 0.0,
            linear: DVector::zeros(0),
            reduced: &square - &noise,
            square,
            noise,
            origin,
            basis: emulator.basis.clone(),
        };
        all.take(&error, terms, &solver);
        Some(all)
    }

    /// Takes the points that differ by `error` from the emulator, with the coefficients `terms`, at the origin, by V's
    /// factors.
    pub fn take(&mut self, error: &DVector<f64>, terms: &DMatrix<f64>, solver: &Cholesky<f64, Dyn>) {
        let weighted = solver.solve(error);
        self.constant = error.dot(&weighted);
        self.linear = terms * weighted + &self.noise * &self.origin;
    }

    /// The terms at the place about which χ² is expanded.
    pub fn origin(&self) -> &DVector<f64> {
        &self.origin
    }

    // Below, `tr_mul` is the product with the symmetric matrices: the library's faster one.
    /// χ² at a place.
    pub fn at(&self, place: &[f64]) -> f64 {
        let away = self.basis.terms(place) - &self.origin;
        self.constant - 2.0 * self.linear.dot(&away) + away.dot(&self.reduced.tr_mul(&away))
    }

    /// The part of χ² at these places that does not depend on the points.
    pub fn places(&self, places: &[Vec<f64>]) -> Places {
        let away: Vec<_> = places.iter().map(|place| self.basis.terms(place) - &self.origin).collect();
        let away = DMatrix::from_columns(&away);
        let squares = (&self.reduced * &away).component_mul(&away).row_sum().transpose();
        Places { away, squares }
    }

    /// χ² at the places; they may be from a surface that differs in its points alone.
    pub fn at_all(&self, Places { away, squares }: &Places) -> DVector<f64> {
        let linear = away.tr_mul(&self.linear);
        squares.zip_map(&linear, |square, linear| self.constant - 2.0 * linear + square)
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

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_distr::StandardNormal;
    use rand_pcg::Pcg64Dxsm;

    const POINTS: usize = 20;
    /// The variance of a point by the rods that all points share.
    const SCATTER: f64 = 1e-3;

    /// The mean over synthetic curves of ln of the reading's variance, relative to the right one, where u² is that and
    /// a sample's estimate of `SCATTER`.
    fn found(reading: f64, how: Reading) -> f64 {
        let mut rng = Pcg64Dxsm::seed_from_u64(11);
        let mut normal = || rng.sample::<f64, _>(StandardNormal);
        let together = |i: usize, j: usize| SCATTER * (-0.02 * (i as f64 - j as f64).powi(2)).exp();
        let scatter = DMatrix::from_fn(POINTS, POINTS, together) + DMatrix::identity(POINTS, POINTS) * 1e-9;
        let roots = scatter.clone().cholesky().expect("positive definite").unpack();
        let mut one = || {
            let u2 = reading + SCATTER * (1.0 + 0.14 * normal());
            let data = vec![Datum { u: u2.sqrt(), ..Datum::place(0, "x1", 0.0) }; POINTS];
            let mut normals = || DVector::from_fn(POINTS, |_, _| normal());
            let error = &roots * normals() + normals() * reading.sqrt();
            let others = DMatrix::zeros(POINTS, POINTS);
            let residuals = Residuals { error, slopes: DMatrix::repeat(POINTS, 1, 1.0), others };
            let rods = Rods { over_measured: vec![1.0], reading: how };
            (rods.reading(&data, &scatter, &residuals)[(0, 0)] / reading).ln()
        };
        (0..200).map(|_| one()).sum::<f64>() / 200.0
    }

    #[test]
    fn reading_beside_rods_is_found_in_the_residuals() {
        for part in [0.003, 0.03, 0.3, 1.0] {
            assert!(found(part * SCATTER, Reading::Rest(0.14)).abs() < 0.15);
        }
        // By u² alone, however well it is known, its errors remain: the control.
        assert!(found(0.003 * SCATTER, Reading::Rest(1e-6)).abs() > 1.0);
    }
}
