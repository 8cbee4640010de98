//! Free rods that were isotropic at t = 0, infinitely many: means of |p_i|, p_i p_j and p_i p_j p_k p_l in any flow.
//!
//! An isotropic p₀ is the direction of a normal vector, so p has the direction of a normal q = F p₀ with the covariance
//! Σ = F Fᵀ, det Σ = 1. With B = Σ⁻¹ and M(x) = B + x, the normal integrals over 1/|q|, 1/|q|² and 1/|q|⁴ written as
//! integrals over e^{−s|q|²} are closed, and what is left is (x = 2s)
//!   ⟨|p_i|⟩ = (1/π) ∫₀^∞ (adj M)_ii^½ x^{-½} (det M)⁻¹ dx,
//!   ⟨p_i p_j⟩ = ½ ∫₀^∞ (adj M)_ij (det M)^{-3/2} dx,
//!   ⟨p_i p_j p_k p_l⟩ = ¼ ∫₀^∞ x (N_ij N_kl + N_ik N_jl + N_il N_jk) (det M)^{-½} dx, N = adj M/det M,
//! complete and incomplete elliptic integrals in plane Couette flow. adj M = x² + x(tr B − B) + Σ and
//! det M = x³ + x² tr B + x tr Σ + 1 have no negative coefficient on their diagonals: nothing cancels.

use super::big::{Big, Bits, double};
use super::motion::{Matrix, Motion, Unit, matrix, product};

/// The six different entries of a symmetric matrix, in the order of the columns `a11,a22,a33,a12,a13,a23`.
pub const PAIRS: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];

/// The fifteen different entries of a_4, by indices from 1, ascending.
#[rustfmt::skip]
pub const QUADRUPLES: [[usize; 4]; 15] = [
    [1, 1, 1, 1], [1, 1, 1, 2], [1, 1, 1, 3], [1, 1, 2, 2], [1, 1, 2, 3], [1, 1, 3, 3], [1, 2, 2, 2], [1, 2, 2, 3],
    [1, 2, 3, 3], [1, 3, 3, 3], [2, 2, 2, 2], [2, 2, 2, 3], [2, 2, 3, 3], [2, 3, 3, 3], [3, 3, 3, 3],
];

/// Bits that the integrals keep; their quadrature is good to 80.
const KEPT: Bits = Bits(160);

/// Σ and its inverse B.
#[derive(Clone, Debug, PartialEq)]
pub struct Covariance {
    sigma: Matrix,
    inverse: Matrix,
}

impl Covariance {
    /// Of rods that were isotropic at t = 0; `None` where the unit has no meaning in this flow.
    pub fn at(motion: &Motion, time: &Big, unit: Unit) -> Option<Self> {
        let bits = motion.bits(double(time), unit, KEPT.0 + 96);
        let map = motion.map(time, unit, bits)?;
        let transposed = |m: &Matrix| matrix(|i, j| m[j][i].clone());
        // F⁻¹ by cofactors: det F = 1.
        let cofactor = |i: usize, j: usize| {
            let (a, b, c, d) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
            &map[a][c] * &map[b][d] - &map[a][d] * &map[b][c]
        };
        let back = matrix(|i, j| cofactor(j, i));
        let kept = |m: Matrix| m.map(|row| row.map(|x| KEPT.round(x)));
        Some(Self {
            sigma: kept(product(&map, &transposed(&map))),
            inverse: kept(product(&transposed(&back), &back)),
        })
    }

    /// ⟨|p₁|⟩, ⟨|p₂|⟩, ⟨|p₃|⟩.
    pub fn projections(&self) -> [Big; 3] {
        let sums = self.integral(|x, adjugate, determinant| {
            // x dx = x² d(ln x); (adj M)^½ x^{-½} x = (adj M · x)^½.
            [0, 1, 2].map(|i| (adjugate(i, i) * x).sqrt() / determinant)
        });
        let pi = KEPT.pi();
        sums.map(|sum| sum / &pi)
    }

    /// a_ij = ⟨p_i p_j⟩, in the order of `PAIRS`.
    pub fn second(&self) -> [Big; 6] {
        let sums = self.integral(|x, adjugate, determinant| {
            let weight = x / (determinant * determinant.sqrt());
            PAIRS.map(|(i, j)| adjugate(i, j) * &weight)
        });
        sums.map(|sum| sum / KEPT.of(2.0))
    }

    /// a_ijkl = ⟨p_i p_j p_k p_l⟩, in the order of `QUADRUPLES`.
    pub fn fourth(&self) -> [Big; 15] {
        let sums = self.integral(|x, adjugate, determinant| {
            let weight = x.sqr() / (determinant.sqr() * determinant.sqrt());
            let n = matrix(adjugate);
            QUADRUPLES.map(|indices| {
                let [i, j, k, l] = indices.map(|index| index - 1);
                (&n[i][j] * &n[k][l] + &n[i][k] * &n[j][l] + &n[i][l] * &n[j][k]) * &weight
            })
        });
        sums.map(|sum| sum / KEPT.of(4.0))
    }

    /// ∫ f d(ln x) from 0 to ∞ for `f(x, adj M, det M)`, good to 80 bits of the largest entry of the same kind.
    ///
    /// The trapezoid rule in u = ln x. The integrands are analytic for |Im u| < π, because the roots of det M and of the
    /// diagonal of adj M are negative, so the error falls as e^{−2π·π/h}: with h = ln 5/4 that is e^{−88}. Close to
    /// Im u = π an integrand is larger by (cos ½Im u)⁻⁵ at most; at 0.95 π that leaves e^{−84}·3·10⁵ = 2^{−103}.
    /// They rise as x^{1/2} or faster and fall as x^{−3/2} or faster beyond the roots of det M, which lie between
    /// 1/tr Σ and tr B.
    fn integral<const N: usize>(
        &self,
        f: impl Fn(&Big, &dyn Fn(usize, usize) -> Big, &Big) -> [Big; N],
    ) -> [Big; N] {
        let trace = |m: &Matrix| &m[0][0] + &m[1][1] + &m[2][2];
        let (trace_sigma, trace_inverse) = (trace(&self.sigma), trace(&self.inverse));
        let step = (KEPT.of(5.0) / KEPT.of(4.0)).ln();
        // ln 2 · 84 bits · 2 on the left and · 2/3 on the right, in steps.
        let steps = |range: f64| (range / 1.25f64.ln()).ceil() as usize;
        let left = steps(double(&trace_sigma.ln()) + 117.0);
        let right = steps(double(&trace_inverse.ln()) + 39.0);
        let one = KEPT.of(1.0);
        // tr B − B_ii, without the difference.
        let others = [0, 1, 2].map(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            &self.inverse[j][j] + &self.inverse[k][k]
        });
        let mut sums = [0; N].map(|_| KEPT.of(0.0));
        let mut add = |x: &Big| {
            let determinant = ((x + &trace_inverse) * x + &trace_sigma) * x + &one;
            let adjugate = |i: usize, j: usize| {
                let linear = match i == j {
                    true => x + &others[i],
                    false => -&self.inverse[i][j],
                };
                linear * x + &self.sigma[i][j]
            };
            for (sum, value) in sums.iter_mut().zip(f(x, &adjugate, &determinant)) {
                *sum += value;
            }
        };
        let (up, down) = (KEPT.of(1.25), KEPT.of(1.0) / KEPT.of(1.25));
        let mut x = one.clone();
        for _ in 0..=right {
            add(&x);
            x *= &up;
        }
        x = one.clone();
        for _ in 0..left {
            x *= &down;
            add(&x);
        }
        sums.map(|sum| sum * &step)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::oracle::isotropic::mean_projections;
    use crate::oracle::quadrature::spread;
    use ellip::elliprd;

    const COUETTE: [[f64; 3]; 3] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0; 3]];

    fn at(gradient_per_s: [[f64; 3]; 3], aspect_ratio: f64, time: f64, unit: Unit) -> Covariance {
        let motion = Motion {
            gradient_per_s,
            aspect_ratio,
        };
        Covariance::at(&motion, &Bits(100).of(time), unit).unwrap()
    }

    fn relative(found: &Big, expected: f64) -> f64 {
        (double(found) / expected - 1.0).abs()
    }

    #[test]
    fn projections_are_carlsons_integrals() {
        for (u, v) in spread(20) {
            let (r, turns) = (1e4f64.powf(2.0 * u - 1.0), 3.0 * v);
            let (found, expected) = (
                at(COUETTE, r, turns, Unit::Period).projections(),
                mean_projections(r, turns),
            );
            let wrong = mean_projections(r, 1.01 * turns);
            for i in 0..3 {
                // What is claimed of the doubles' formula.
                assert!(relative(&found[i], expected[i]) < 4e-15, "{r} {turns} {i}");
            }
            assert!((0..3).any(|i| relative(&found[i], wrong[i]) > 1e-9));
        }
    }
}
