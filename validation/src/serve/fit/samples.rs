//! Samples of a fit's parameters, for corner plots and for what depends on several of them.

use super::search::Fit;
use crate::files::csv;
use crate::methods::least_squares::profile::rise_to;
use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng};
use rand_distr::StandardNormal;
use rand_pcg::Pcg64Dxsm;

/// Number of samples, and of steps of the walk from one to the next, which suffice to forget the former.
pub const SAMPLES: usize = 4000;
const STEPS: usize = 20;

/// Samples of the parameters, one row each, from the density exp(−Δχ²/2) within the last box. Δχ² is the rise that the
/// intervals use; the prior is uniform on the scale of each range. The same fit gives the same samples.
pub fn samples(fit: &Fit) -> Vec<Vec<f64>> {
    let best = &fit.best;
    let parameters = best.place.len();
    let rise = |place: &[f64]| rise_to(best, &place.iter().copied().map(Some).collect::<Vec<_>>());
    // The steps of a random walk (Metropolis) that forgets fastest in a Gaussian: Gelman, Roberts & Gilks (1996). Axes
    // wider than the box need no larger steps.
    let axes = best.covariance().symmetric_eigen();
    let lengths = axes.eigenvalues.map(|square| 2.4 * square.sqrt().clamp(0.0, 1.0) / (parameters as f64).sqrt());
    let steps = axes.eigenvectors * DMatrix::from_diagonal(&lengths);
    let mut rng = Pcg64Dxsm::seed_from_u64(1);
    let mut at = (DVector::from_column_slice(&best.place), 0.0);
    let mut walk = || {
        for _ in 0..STEPS {
            let place = &at.0 + &steps * DVector::from_fn(parameters, |_, _| rng.sample::<f64, _>(StandardNormal));
            let inside = place.iter().all(|place| place.abs() <= 1.0);
            let next = if inside { rise(place.as_slice()) } else { f64::INFINITY };
            if rng.random::<f64>() < (0.5 * (at.1 - next)).exp() {
                at = (place, next);
            }
        }
        fit.values(at.0.as_slice())
    };
    (0..SAMPLES).map(|_| walk()).collect()
}

/// `samples.csv`: a column for each parameter, a row for each sample.
pub fn samples_csv(fit: &Fit) -> Result<String, String> {
    let head = fit.ranges.iter().map(|range| range.label()).collect();
    let numbers = |row: Vec<f64>| row.iter().map(f64::to_string).collect();
    let rows: Vec<Vec<String>> = std::iter::once(head).chain(samples(fit).into_iter().map(numbers)).collect();
    csv::text(&rows)
}
