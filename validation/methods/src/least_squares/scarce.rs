//! The effect on a fit of the finite number of replicas behind the covariance of the points.
//!
//! V is V₀ + K∘Ĉ, where Ĉ is the covariance of a replica as estimated from n replicas: for the measured rods from more
//! of them than for the mean curve, of which both have the fewer in common. Its noise δV gives the points
//! wrong weights in generalised least squares. To first order in 1/n, A E[δV P δV] Aᵀ adds to the scatter of the
//! estimates, the covariance (JᵀV⁻¹J)⁻¹ is too small by as much, and χ² is too large by tr(P E[δV P δV]), with A the
//! influence of the points and P = V⁻¹ − V⁻¹JA. For Gaussian replicas E[δC Q δC] = (C Qᵀ C + C tr(QC))/(n − 1). If V
//! comes only from replicas, the corrections below are exact in the number of replicas except for terms ∝ 1/n (J.
//! Hartlap, P. Simon & P. Schneider, Astron. Astrophys. 464 (2007) 399, for the inverse; S. Dodelson & M. D. Schneider,
//! Phys. Rev. D 88 (2013) 063537, for the estimates).

use super::Datum;
use nalgebra::DMatrix;

/// E[δV P δV], points × points, with so many replicas behind the mean curve, and behind the covariance of a replica.
/// `rods_over_measured` is as for `causes`.
pub fn scatter_of_covariance(
    data: &[Datum],
    [curve, rods]: [usize; 2],
    of_replica: &DMatrix<f64>,
    rods_over_measured: &[f64],
    projector: &DMatrix<f64>,
) -> DMatrix<f64> {
    // K∘C is a sum of parts of C: all of C with the weight 1/n, and the points of each set with that set's weight.
    let sets = (0..rods_over_measured.len()).map(|set| (rods_over_measured[set], Some(set), rods));
    let parts: Vec<(f64, Option<usize>, usize)> = [(1.0 / curve as f64, None, curve)].into_iter().chain(sets).collect();
    let within = |set: Option<usize>, k: usize| set.is_none_or(|set| data[k].set == set);
    let mut sum = DMatrix::zeros(data.len(), data.len());
    for (weight, rows, n) in parts.iter().filter(|(weight, ..)| *weight > 0.0) {
        for (other, columns, m) in parts.iter().filter(|(other, ..)| *other > 0.0) {
            // The errors of two means, of which one has the other's values and more, vary together as the larger's do.
            let n = (*n).max(*m) as f64;
            let between =
                projector.map_with_location(|i, j, p| if within(*rows, i) && within(*columns, j) { p } else { 0.0 });
            let trace = (&between * of_replica).trace();
            let scatter = (of_replica * between.transpose() * of_replica + of_replica * trace) / (n - 1.0).max(1.0);
            sum += scatter.map_with_location(|i, j, s| {
                if within(*rows, i) && within(*columns, j) { weight * other * s } else { 0.0 }
            });
        }
    }
    sum
}

/// The covariance to add to a covariance of the parameters that is too small by `scatter`, while the estimates scatter
/// more by as much: C(C − X)⁻¹C(C − X)⁻¹C − C. `None` if there are too few replicas.
pub fn added(covariance: &DMatrix<f64>, scatter: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let rest = (covariance - scatter).cholesky()?;
    let ratio = rest.solve(covariance);
    Some(covariance * &ratio * &ratio - covariance)
}
