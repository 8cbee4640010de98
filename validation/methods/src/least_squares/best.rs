//! The best-fitting place in a box of parameters.

use super::Datum;
use super::emulator::Emulator;
use super::likelihood::{CAUSES, Causes, ChiSquare, REPLICAS, Rods, causes, others, residuals};
use super::minimise::minimise;
use super::scarce::{added, scatter_of_covariance};
use nalgebra::DMatrix;
use statrs::distribution::{ChiSquared, ContinuousCDF, FisherSnedecor};

/// Index in [`Best::spread`] of the finite number of replicas behind V.
pub const SCARCE: usize = CAUSES.len();

/// The best-fitting place in a box, by generalised least squares. V is taken at the best place; the two are found by
/// iteration.
#[derive(Clone, Debug)]
pub struct Best {
    /// The coordinates in the box, from −1 to 1.
    pub place: Vec<f64>,
    /// χ² at this place.
    pub chi_square: f64,
    /// χ² over the box at fixed V.
    pub surface: ChiSquare,
    /// V by its causes.
    pub causes: Causes,
    /// The covariance of the parameters by cause, on the box's scale: A V_cause Aᵀ, A = (JᵀV⁻¹J)⁻¹JᵀV⁻¹, with the
    /// replicas' noise subtracted in JᵀV⁻¹J. The last one is added for the finite number of replicas behind V.
    pub spread: Vec<DMatrix<f64>>,
    /// χ² of the points and its law.
    pub goodness: Goodness,
    /// A, parameters × points: the sensitivity of each estimate to each point.
    pub influence: DMatrix<f64>,
    /// Bartlett's factor of each parameter, by which the rise of χ² is too large where the model is not linear: 1
    /// until [`super::bartlett::factors`] says more.
    pub factors: Vec<f64>,
}

impl Best {
    /// The covariance of the parameters, on the box's scale.
    pub fn covariance(&self) -> DMatrix<f64> {
        self.spread.iter().sum()
    }

    /// The best place if the replicas' noise is not subtracted, for a control.
    pub fn with_noise(&self) -> Self {
        let surface = self.surface.with_noise();
        let (place, chi_square) = minimise(&surface, &vec![None; self.place.len()], &[&self.place]);
        Self { place, chi_square, surface, ..self.clone() }
    }

    /// The largest share of a cause in the variance of any parameter. For replicas it includes their part in the mean
    /// curve and in V.
    pub fn share(&self, cause: usize) -> f64 {
        let all = self.covariance().diagonal();
        let share = |cause: usize| self.spread[cause].diagonal().component_div(&all);
        match cause {
            // Half of the last covariance corrects one that is too small.
            REPLICAS => (share(REPLICAS) + share(SCARCE) * 0.5).max(),
            SCARCE => 0.5 * share(SCARCE).max(),
            cause => share(cause).max(),
        }
    }

    /// The smallest share, over `axes`, of a parameter's variance that the curvature of χ² shows, over Bartlett's
    /// factor.
    pub fn shown(&self, axes: &[usize]) -> f64 {
        let (hidden, all) = (&self.spread[CAUSES.len()], self.covariance());
        let share = |axis: &usize| (1.0 - hidden[(*axis, *axis)] / all[(*axis, *axis)]) / self.factors[*axis];
        axes.iter().map(share).fold(1.0, f64::min)
    }
}

/// The least χ² with a covariance of a finite number of replicas.
#[derive(Clone, Copy, Debug)]
pub struct Goodness {
    /// χ².
    pub chi_square: f64,
    /// The average relative excess of χ² due to the finite number of replicas behind V.
    pub excess: f64,
    /// Points less parameters.
    pub freedom: usize,
}

impl Goodness {
    /// χ² without the average contribution of the noise of V.
    pub fn chi_square_of_points(&self) -> f64 {
        self.chi_square * (1.0 - self.excess)
    }

    /// The probability of a larger χ² if the model is right. With a covariance of n replicas χ² follows Hotelling's
    /// law, as F of q and n − q degrees of freedom, q = points − parameters; n is that number from which V alone would
    /// give this excess, (q + 1)/(n − 1).
    pub fn p_value(&self) -> f64 {
        let q = self.freedom as f64;
        let rest = (q + 1.0) / self.excess - q + 1.0;
        match FisherSnedecor::new(q, rest) {
            Ok(law) if rest < EXACT => law.sf(self.chi_square * rest / (q * (rest + q - 1.0))),
            _ => ChiSquared::new(q).map_or(f64::NAN, |law| law.sf(self.chi_square)),
        }
    }
}

/// Degrees of freedom beyond which F is χ² to all digits that are printed.
const EXACT: f64 = 1e6;

/// Added variance over the present one, if the replicas are too few to estimate it; the result is a request for more
/// replicas.
const UNKNOWN: f64 = 99.0;

/// The largest number of iterations of V and best place, and the move in half boxes below which they end.
const ROUNDS: usize = 6;
const STAYS: f64 = 1e-3;

/// Parts of the points' squared uncertainties that are tried as the scatter of shared rods.
const PARTS: u32 = 20;

/// A part is possible if −2 ln L is at most this much above its least: 95 % of χ² of one degree of freedom.
const POSSIBLE: f64 = 3.84;

/// The rods of the most likely scatter and of the largest possible one, if the points' uncertainties contain it, by the
/// restricted likelihood at a place.
pub fn within(data: &[Datum], emulator: &Emulator, place: &[f64]) -> Option<[Rods; 2]> {
    let of_replica = emulator.covariance_of_replica(place);
    let sets = data.iter().map(|datum| datum.set + 1).max().unwrap_or(0);
    let residuals = residuals(data, emulator, place, &others(emulator, place));
    let of_part = |part: u32| {
        let rods = Rods::within(data, &of_replica, sets, f64::from(part) / f64::from(PARTS));
        let scatter = rods.scatter(data, &of_replica);
        let covariance = &residuals.others + rods.reading(data, &scatter, &residuals) + scatter;
        Some((residuals.misfit(covariance)?, rods))
    };
    let parts: Vec<(f64, Rods)> = (0..=PARTS).filter_map(of_part).collect();
    let likely = parts.iter().min_by(|a, b| a.0.total_cmp(&b.0))?;
    let most = parts.iter().rfind(|(misfit, _)| *misfit <= likely.0 + POSSIBLE)?;
    Some([likely.1.clone(), most.1.clone()])
}

/// The best place; `None` if V or the information is not positive definite, or χ² is not finite.
pub fn best(data: &[Datum], emulator: &Emulator, rods: &Rods) -> Option<Best> {
    let parameters = emulator.basis.nodes[0].len();
    let mut place = vec![0.0; parameters];
    for _ in 0..ROUNDS {
        let causes = causes(data, emulator, &place, rods);
        let surface = ChiSquare::new(data, emulator, &causes.iter().sum(), &place)?;
        let before = std::mem::replace(&mut place, minimise(&surface, &vec![None; parameters], &[]).0);
        if before.iter().zip(&place).all(|(a, b)| (a - b).abs() < STAYS) {
            break;
        }
    }
    let causes = causes(data, emulator, &place, rods);
    let covariance = causes.iter().sum();
    let surface = ChiSquare::new(data, emulator, &covariance, &place)?;
    let (place, chi_square) = minimise(&surface, &vec![None; parameters], &[&place]);
    if !chi_square.is_finite() {
        return None;
    }
    let slopes = emulator.slopes(&place);
    let inverse = covariance.cholesky()?;
    let weighted = inverse.solve(&slopes);
    let information = slopes.tr_mul(&weighted);
    let projector = inverse.inverse() - &weighted * information.clone().cholesky()?.solve(&weighted.transpose());
    // The noise is subtracted, unless the rest is not positive definite.
    let own = (&information - surface.noise(&place)).cholesky();
    let solver = own.or_else(|| information.cholesky())?;
    let influence = solver.solve(&weighted.transpose());
    let mut spread: Vec<_> = (causes.iter()).map(|cause| &influence * cause * influence.transpose()).collect();
    let of_replica = emulator.covariance_of_replica(&place);
    let replicas = [emulator.replicas(), emulator.behind_covariance()];
    let scatter = scatter_of_covariance(data, replicas, &of_replica, &rods.over_measured, &projector);
    let linear = spread.iter().sum();
    let hidden = added(&linear, &(&influence * &scatter * influence.transpose()));
    spread.push(hidden.unwrap_or_else(|| linear * UNKNOWN));
    let excess = ((&projector * &scatter).trace() / (data.len() - parameters).max(1) as f64).min(1.0);
    let goodness = Goodness { chi_square, excess, freedom: data.len() - parameters };
    Some(Best { factors: vec![1.0; parameters], place, chi_square, surface, causes, spread, goodness, influence })
}
