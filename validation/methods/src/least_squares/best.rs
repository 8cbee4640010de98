//! The best-fitting place in a box of parameters.

use super::Datum;
use super::emulator::Emulator;
use super::likelihood::{CAUSES, Causes, ChiSquare, REPLICAS, causes};
use super::minimise::minimise;
use super::scarce::{added, scatter_of_covariance};
use nalgebra::DMatrix;

/// The best-fitting place in a box, by generalised least squares. V is taken at the best place; the two are found by iteration.
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
    /// The covariance of the parameters by cause, on the box's scale: A V_cause Aᵀ, A = (JᵀV⁻¹J)⁻¹JᵀV⁻¹, with the replicas' noise
    /// subtracted in JᵀV⁻¹J. The last one is added for the finite number of replicas behind V.
    pub spread: Vec<DMatrix<f64>>,
    /// The average relative excess of χ² due to the finite number of replicas behind V.
    pub excess: f64,
    /// A, parameters × points: the sensitivity of each estimate to each point.
    pub influence: DMatrix<f64>,
}

impl Best {
    /// The covariance of the parameters, on the box's scale.
    pub fn covariance(&self) -> DMatrix<f64> {
        let zero = DMatrix::zeros(self.place.len(), self.place.len());
        self.spread.iter().fold(zero, |sum, one| sum + one)
    }

    /// The best place if the replicas' noise is not subtracted, for a control.
    pub fn with_noise(&self) -> Self {
        let surface = self.surface.with_noise();
        let (place, chi_square) = minimise(&surface, &vec![None; self.place.len()], &[&self.place]);
        Self { place, chi_square, surface, ..self.clone() }
    }

    /// The largest share of a cause in the variance of any parameter. For replicas it includes their part in the mean curve and in V.
    pub fn share(&self, cause: usize) -> f64 {
        let all = self.covariance().diagonal();
        let share = |cause: usize| self.spread[cause].diagonal().component_div(&all);
        match cause {
            // Half of the last covariance corrects one that is too small.
            REPLICAS => (share(REPLICAS) + share(CAUSES.len()) * 0.5).max(),
            cause => share(cause).max(),
        }
    }

    /// The smallest share, over `axes`, of a parameter's variance that the curvature of χ² shows.
    pub fn shown(&self, axes: &[usize]) -> f64 {
        let (hidden, all) = (&self.spread[CAUSES.len()], self.covariance());
        axes.iter().map(|&axis| 1.0 - hidden[(axis, axis)] / all[(axis, axis)]).fold(1.0, f64::min)
    }

    /// χ² without the average contribution of the noise of V.
    pub fn chi_square_of_points(&self) -> f64 {
        self.chi_square * (1.0 - self.excess)
    }
}

/// Added variance over the present one, if the replicas are too few to estimate it; the result is a request for more replicas.
const UNKNOWN: f64 = 99.0;

/// The largest number of iterations of V and best place, and the move in half boxes below which they end.
const ROUNDS: usize = 6;
const STAYS: f64 = 1e-3;

/// The best place; `None` if V or the information is not positive definite, or χ² is not finite.
pub fn best(data: &[Datum], emulator: &Emulator, rods_over_measured: &[f64]) -> Option<Best> {
    let parameters = emulator.basis.nodes[0].len();
    let mut place = vec![0.0; parameters];
    let total =
        |causes: &Causes| causes.iter().fold(DMatrix::zeros(data.len(), data.len()), |sum, one| sum + one);
    for _ in 0..ROUNDS {
        let causes = causes(data, emulator, &place, rods_over_measured);
        let surface = ChiSquare::new(data, emulator, &total(&causes), &place)?;
        let before = std::mem::replace(&mut place, minimise(&surface, &vec![None; parameters], &[]).0);
        if before.iter().zip(&place).all(|(a, b)| (a - b).abs() < STAYS) {
            break;
        }
    }
    let causes = causes(data, emulator, &place, rods_over_measured);
    let covariance = total(&causes);
    let surface = ChiSquare::new(data, emulator, &covariance, &place)?;
    let (place, chi_square) = minimise(&surface, &vec![None; parameters], &[&place]);
    if !chi_square.is_finite() {
        return None;
    }
    let slopes = emulator.slopes(&place);
    let inverse = covariance.cholesky()?;
    let weighted = inverse.solve(&slopes);
    let told = slopes.tr_mul(&weighted);
    let projector = inverse.inverse() - &weighted * told.clone().cholesky()?.solve(&weighted.transpose());
    // The noise is subtracted, unless the rest is not positive definite.
    let own = (&told - surface.noise(&place)).cholesky();
    let solver = own.or_else(|| told.cholesky())?;
    let influence = solver.solve(&weighted.transpose());
    let mut spread: Vec<_> =
        (causes.iter()).map(|cause| &influence * cause * influence.transpose()).collect();
    let scatter =
        scatter_of_covariance(data, emulator, &emulator.covariance(&place), rods_over_measured, &projector);
    let linear = spread.iter().fold(DMatrix::zeros(parameters, parameters), |sum, one| sum + one);
    let hidden = added(&linear, &(&influence * &scatter * influence.transpose()));
    spread.push(hidden.unwrap_or_else(|| linear * UNKNOWN));
    let excess = ((&projector * &scatter).trace() / (data.len() - parameters).max(1) as f64).min(1.0);
    Some(Best { place, chi_square, surface, causes, spread, excess, influence })
}
