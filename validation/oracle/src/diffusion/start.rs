//! The density of directions at t = 0.

use super::NoAnswer;
use super::frame::Frame;
use super::harmonics::{Basis, by_ratio, sphere_rule};
use nalgebra::{Matrix3, SymmetricEigen, Vector3};
use std::f64::consts::PI;

/// The density of directions at t = 0.
#[derive(Clone, Copy)]
pub enum Start<'a> {
    /// Isotropic directions.
    Isotropic,
    /// A smooth function of p with ψ(−p) = ψ(p), in the laboratory's axes. It need not be normalised.
    Density(&'a (dyn Fn([f64; 3]) -> f64 + Sync)),
    /// The density of Bingham, ψ ∝ exp(p·Kp), with these rows of the symmetric K: see [`bingham`].
    Bingham([[f64; 3]; 3]),
    /// One direction and its opposite, of length 1.
    Direction([f64; 3]),
    /// These directions and their opposites, each of length 1, with equal weights; at least one.
    Directions(&'a [[f64; 3]]),
    /// All directions across this one, of length 1, alike.
    Plane([f64; 3]),
}

impl Start<'_> {
    /// ⟨|p_i|⟩ of a start that no number of harmonics resolves; `None` for other starts.
    pub(super) fn sharp(&self) -> Option<[f64; 3]> {
        match self {
            Self::Isotropic | Self::Density(_) | Self::Bingham(_) => None,
            Self::Direction(p) => Start::Directions(std::slice::from_ref(p)).sharp(),
            Self::Directions(all) => {
                Some([0, 1, 2].map(|i| all.iter().map(|p| p[i].abs()).sum::<f64>() / all.len() as f64))
            }
            Self::Plane(n) => Some(n.map(|x| 2.0 / PI * (1.0 - x * x).max(0.0).sqrt())),
        }
    }

    /// The harmonics of the start in the frame's axes, normalised; those of a sharp one up to the degree `most`.
    pub(super) fn unknowns(&self, frame: &Frame, most: usize) -> Result<(Basis, Vec<f64>), NoAnswer> {
        let mean = (4.0 * PI).recip().sqrt();
        match self {
            Self::Isotropic => {
                let basis = Basis { degree: 8, order: 4, even: frame.even };
                let mut unknowns = vec![0.0; basis.len()];
                unknowns[0] = mean;
                Ok((basis, unknowns))
            }
            Self::Direction(p) => Start::Directions(std::slice::from_ref(p)).unknowns(frame, most),
            // ∫ψY over a great circle with the axis n (Funk & Hecke): P_l(0) Y(n).
            Self::Plane(n) => {
                let (basis, mut unknowns) = Self::Direction(*n).unknowns(frame, most)?;
                let factors = by_ratio(most, 1.0, |l| -(l + 1.0) / (l + 2.0));
                unknowns.iter_mut().zip(basis.unknowns()).for_each(|(x, (l, ..))| *x *= factors[l / 2]);
                Ok((basis, unknowns))
            }
            Self::Directions(all) => {
                let basis = Basis { degree: most, order: most, even: false };
                let mut unknowns = vec![0.0; basis.len()];
                for p in *all {
                    unknowns.iter_mut().zip(basis.values(frame.inward(*p))).for_each(|(sum, x)| *sum += x);
                }
                Ok((basis, unknowns.iter().map(|sum| sum / all.len() as f64).collect()))
            }
            Self::Bingham(k) => {
                let k = Matrix3::from_fn(|i, j| k[i][j]);
                let largest = k.symmetric_eigenvalues().max();
                let density = |p: [f64; 3]| (Vector3::from(p).dot(&(k * Vector3::from(p))) - largest).exp();
                Start::Density(&density).unknowns(frame, most)
            }
            Self::Density(density) => {
                for degree in [16, 32, 64, 128] {
                    // The start need not have the flow's plane of reflection.
                    let basis = Basis { degree, order: degree, even: false };
                    let unknowns = projected(&basis, &|p| density(frame.outward(p)));
                    let high = unknowns[basis.offset(degree - 4)..].iter().map(|x| x * x).sum::<f64>().sqrt();
                    let (scale, all) = (mean / unknowns[0], unknowns.iter().map(|x| x * x).sum::<f64>().sqrt());
                    // Sums of doubles leave some 1e-16 of the whole in each of many harmonics.
                    if unknowns[0] > 0.0 && high <= 1e-13 * all {
                        return Ok((basis, unknowns.iter().map(|x| x * scale).collect()));
                    }
                }
                Err(NoAnswer::RoughStart)
            }
        }
    }
}

/// K of the density of Bingham, ψ ∝ exp(p·Kp), that has the second moments a_ij of trace 1, in the order of
/// [`PAIRS`](crate::reference::isotropic::PAIRS).
///
/// By Newton's method in the axes of a_ij; d⟨p_i²⟩/dk_j is the covariance of p_i² and p_j².
///
/// # Errors
///
/// The smallest eigenvalue, if it is not above 0, or so small that the peak is not resolved.
pub fn bingham([a11, a22, a33, a12, a13, a23]: [f64; 6]) -> Result<[[f64; 3]; 3], f64> {
    let eigen = SymmetricEigen::new(Matrix3::new(a11, a12, a13, a12, a22, a23, a13, a23, a33));
    let least = eigen.eigenvalues.min();
    if least <= 0.0 {
        return Err(least);
    }
    let due = eigen.eigenvalues;
    let rule = sphere_rule(100);
    let mut k = Vector3::zeros();
    for _ in 0..100 {
        let (mut sum, mut first, mut second) = (0.0, Vector3::zeros(), Matrix3::zeros());
        for (p, weight) in &rule {
            let squares = Vector3::from(p.map(|x| x * x));
            let share = weight * (squares.dot(&k) - k.max()).exp();
            sum += share;
            first += share * squares;
            second += share * squares * squares.transpose();
        }
        let (first, second) = (first / sum, second / sum);
        let off = due - first;
        if off.amax() < 5e-14 {
            let k = eigen.eigenvectors * Matrix3::from_diagonal(&k) * eigen.eigenvectors.transpose();
            return Ok(std::array::from_fn(|i| std::array::from_fn(|j| k[(i, j)])));
        }
        // The squares add up to 1: k is known up to a constant, and the third stays 0.
        let covariance = (second - first * first.transpose()).fixed_resize::<2, 2>(0.0);
        let step = covariance.lu().solve(&off.fixed_rows::<2>(0).into_owned()).ok_or(least)?;
        // A longer step may leave where the exponential is resolved.
        let step = step * (20.0 / step.norm()).min(1.0);
        k += Vector3::new(step.x, step.y, 0.0);
    }
    Err(least)
}

pub(super) fn projected(basis: &Basis, function: &dyn Fn([f64; 3]) -> f64) -> Vec<f64> {
    let mut unknowns = vec![0.0; basis.len()];
    for (p, weight) in sphere_rule(basis.degree + 8) {
        let share = weight * function(p);
        unknowns.iter_mut().zip(basis.values(p)).for_each(|(sum, value)| *sum += share * value);
    }
    unknowns
}
