//! Infinitely many free rods that were isotropic at t = 0: means of |p_i|, p_i p_j and p_i p_j p_k p_l in any flow.
//!
//! An isotropic p₀ is the direction of a normal vector, so p has the direction of a normal q = F p₀ with the covariance
//! Σ = F Fᵀ, det Σ = 1. With B = Σ⁻¹ and M(x) = B + x, the normal integrals over 1/|q|, 1/|q|² and 1/|q|⁴ written as
//! integrals over e^{−s|q|²} are closed, and what is left is (x = 2s)
//!   ⟨|p_i|⟩ = (1/π) ∫₀^∞ (adj M)_ii^½ x^{-½} (det M)⁻¹ dx,
//!   ⟨p_i p_j⟩ = ½ ∫₀^∞ (adj M)_ij (det M)^{-3/2} dx,
//!   ⟨p_i p_j p_k p_l⟩ = ¼ ∫₀^∞ x (N_ij N_kl + N_ik N_jl + N_il N_jk) (det M)^{-½} dx, N = adj M/det M,
//! These are complete and incomplete elliptic integrals in plane Couette flow. adj M = x² + x(tr B − B) + Σ and
//! det M = x³ + x² tr B + x tr Σ + 1 have no negative coefficient on their diagonals: nothing cancels.

use super::big::{Big, Bits, double, each_power};
use super::motion::{Matrix, Motion, Unit, matrix, product};
use std::sync::LazyLock;

/// The six distinct entries of a symmetric matrix, in the order of the columns `a11,a22,a33,a12,a13,a23`.
pub const PAIRS: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];

/// The fifteen distinct entries of a_4, by indices from 1, ascending.
#[rustfmt::skip]
pub const QUADRUPLES: [[usize; 4]; 15] = [
    [1, 1, 1, 1], [1, 1, 1, 2], [1, 1, 1, 3], [1, 1, 2, 2], [1, 1, 2, 3], [1, 1, 3, 3], [1, 2, 2, 2], [1, 2, 2, 3],
    [1, 2, 3, 3], [1, 3, 3, 3], [2, 2, 2, 2], [2, 2, 2, 3], [2, 2, 3, 3], [2, 3, 3, 3], [3, 3, 3, 3],
];

/// Precision of the integrals in bits; their quadrature is good to 80.
pub(super) const PRECISION: Bits = Bits(160);

/// The covariance Σ and its inverse B.
#[derive(Clone, Debug, PartialEq)]
pub struct Covariance {
    pub(super) sigma: Matrix,
    pub(super) inverse: Matrix,
}

impl Covariance {
    /// Σ at `time` of rods that were isotropic at t = 0; `None` if the unit is undefined in this flow.
    pub fn at(motion: &Motion, time: &Big, unit: Unit) -> Option<Self> {
        let bits = motion.bits(double(time), unit, PRECISION.0 + 48);
        let map = motion.map(time, unit, bits)?;
        if motion.only_turns() {
            // Exactly: products of the map's entries would leave their rounding in what is 0.
            let one = || matrix(|i, j| PRECISION.of(if i == j { 1.0 } else { 0.0 }));
            return Some(Self { sigma: one(), inverse: one() });
        }
        let transposed = |m: &Matrix| matrix(|i, j| m[j][i].clone());
        // F⁻¹ by cofactors: det F = 1.
        let cofactor = |i: usize, j: usize| {
            let (a, b, c, d) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
            &map[a][c] * &map[b][d] - &map[a][d] * &map[b][c]
        };
        let back = matrix(|i, j| cofactor(j, i));
        let kept = |m: Matrix| m.map(|row| row.map(|x| PRECISION.round(x)));
        Some(Self { sigma: kept(product(&map, &transposed(&map))), inverse: kept(product(&transposed(&back), &back)) })
    }

    /// The means ⟨|p₁|⟩, ⟨|p₂|⟩, ⟨|p₃|⟩.
    pub fn projections(&self) -> [Big; 3] {
        let sums = self.integral(|x, adjugate, determinant| {
            // x dx = x² d(ln x); (adj M)^½ x^{-½} x = (adj M · x)^½.
            [0, 1, 2].map(|i| (adjugate(i, i) * x).sqrt() / determinant)
        });
        let pi = PRECISION.pi();
        sums.map(|sum| sum / &pi)
    }

    /// a_ij = ⟨p_i p_j⟩, in the order of `PAIRS`.
    pub fn second(&self) -> [Big; 6] {
        let sums = self.integral(|x, adjugate, determinant| {
            let weight = x / (determinant * determinant.sqrt());
            PAIRS.map(|(i, j)| adjugate(i, j) * &weight)
        });
        sums.map(|sum| sum / PRECISION.of(2.0))
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
        sums.map(|sum| sum / PRECISION.of(4.0))
    }

    /// ∫ f d(ln x) from 0 to ∞ for `f(x, adj M, det M)`, good to 80 bits of the largest entry of the same kind.
    ///
    /// The trapezoid rule in u = ln x. The integrands are analytic for |Im u| < π, because the roots of det M and of
    /// the diagonal of adj M are negative, so the error falls as e^{−2π·π/h}: with h = ln 5/4 that is e^{−88}. Close to
    /// Im u = π an integrand is larger by (cos ½Im u)⁻⁵ at most; at 0.95 π that leaves e^{−84}·3·10⁵ = 2^{−103}.
    /// They rise as x^{1/2} or faster and fall as x^{−3/2} or faster beyond the roots of det M, which lie between
    /// 1/tr Σ and tr B.
    fn integral<const N: usize>(&self, f: impl Fn(&Big, &dyn Fn(usize, usize) -> Big, &Big) -> [Big; N]) -> [Big; N] {
        let [trace_sigma, trace_inverse] = self.traces();
        let (left, right) = Self::steps(&trace_sigma, &trace_inverse);
        let one = PRECISION.of(1.0);
        let others = self.others();
        let mut sums = [0; N].map(|_| PRECISION.of(0.0));
        let add = |x: &Big| {
            let determinant = ((x + &trace_inverse) * x + &trace_sigma) * x + &one;
            let adjugate = |i: usize, j: usize| {
                let linear = if i == j { x + &others[i] } else { -&self.inverse[i][j] };
                linear * x + &self.sigma[i][j]
            };
            for (sum, value) in sums.iter_mut().zip(f(x, &adjugate, &determinant)) {
                *sum += value;
            }
        };
        each_power(&one, &PRECISION.of(1.25), left, right, add);
        sums.map(|sum| sum * Self::step())
    }

    pub(super) fn traces(&self) -> [Big; 2] {
        [&self.sigma, &self.inverse].map(|m| &m[0][0] + &m[1][1] + &m[2][2])
    }

    /// tr B − B_ii, computed without a difference.
    pub(super) fn others(&self) -> [Big; 3] {
        let b = &self.inverse;
        [0, 1, 2].map(|i| &b[(i + 1) % 3][(i + 1) % 3] + &b[(i + 2) % 3][(i + 2) % 3])
    }

    /// ln x from node to node.
    pub(super) fn step() -> Big {
        static STEP: LazyLock<Big> = LazyLock::new(|| (PRECISION.of(5.0) / PRECISION.of(4.0)).ln());
        STEP.clone()
    }

    /// The nodes on the left and on the right of x = 1, from tr Σ and tr B: ln 2 · 84 bits · 2 and · 2/3, in steps,
    /// beyond the roots.
    pub(super) fn steps(trace_sigma: &Big, trace_inverse: &Big) -> (usize, usize) {
        let steps = |range: f64| (range / 1.25f64.ln()).ceil() as usize;
        // Traces may be beyond the range of a double.
        let ln = |trace: &Big| match double(trace) {
            trace if trace.is_finite() => trace.ln(),
            _ => double(&trace.ln()),
        };
        (steps(ln(trace_sigma) + 117.0), steps(ln(trace_inverse) + 39.0))
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::isotropic::mean_projections;
    use crate::quadrature::spread;

    pub const COUETTE: [[f64; 3]; 3] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0; 3]];

    pub fn at(gradient_per_s: [[f64; 3]; 3], aspect_ratio: f64, time: f64, unit: Unit) -> Covariance {
        let motion = Motion { gradient_per_s, aspect_ratio };
        Covariance::at(&motion, &Bits(100).of(time), unit).unwrap()
    }

    fn relative(found: &Big, expected: f64) -> f64 {
        (double(found) / expected - 1.0).abs()
    }

    #[test]
    fn projections_are_carlsons_integrals() {
        for (u, v) in spread(60) {
            let (r, turns) = (1e4f64.powf(2.0 * u - 1.0), 3.0 * v);
            let (found, expected) = (at(COUETTE, r, turns, Unit::Period).projections(), mean_projections(r, turns));
            for i in 0..3 {
                // The tolerance is the claimed accuracy of the formula in doubles.
                assert!(relative(&found[i], expected[i]) < 4e-15, "{r} {turns} {i}");
            }
            for wrong in [mean_projections(r, 1.01 * turns), mean_projections(1.0 / r, turns)] {
                assert!((0..3).any(|i| relative(&found[i], wrong[i]) > 1e-9));
            }
        }
    }

    pub const SPIRAL: [[f64; 3]; 3] = [[-0.25, -1.0, 0.5], [0.75, -0.25, 0.125], [0.25, -0.5, 0.5]];

    #[test]
    fn where_rods_only_turn_they_stay_isotropic_exactly() {
        let turning = [[0.0, 2.0, 3.0], [-2.0, 0.0, 5.0], [-3.0, -5.0, 0.0]];
        let any = [[1.0, 2.0, 3.0], [4.0, 1.0, 5.0], [6.0, 7.0, -2.0]];
        for (gradient, r) in [(turning, 3.0), (any, 1.0)] {
            let means = at(gradient, r, 0.1, Unit::Second).nearest();
            assert_eq!(means, [0.5, 0.5, 0.5, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0, 0.0, 0.0, 0.0]);
        }
        assert_ne!(at(any, 1.0 + f64::EPSILON, 0.1, Unit::Second).nearest()[6], 0.0);
    }

    #[test]
    fn moments_contract_to_80_bits_everywhere() {
        let rate = [[0.25, 1e8, 0.0], [1e-8, 0.125, 3.0], [0.0, 0.0, -0.375]];
        for (gradient, r, time, unit) in [
            (COUETTE, 11.6, 0.2, Unit::Period),
            (COUETTE, 1e100, 0.249, Unit::Period),
            (COUETTE, 1e-100, 1e6 + 0.13, Unit::Period),
            (COUETTE, 1.0 + f64::EPSILON, 0.3, Unit::Period),
            (SPIRAL, 7.0, 300.0, Unit::Second),
            (rate, 50.0, 1e-6, Unit::Second),
        ] {
            let covariance = at(gradient, r, time, unit);
            let (second, fourth) = (covariance.second(), covariance.fourth());
            let entry = |mut indices: [usize; 4]| {
                indices.sort_unstable();
                let place = QUADRUPLES.iter().position(|q| *q == indices).unwrap();
                &fourth[place]
            };
            let most = 2f64.powi(-80);
            let trace = &second[0] + &second[1] + &second[2] - PRECISION.of(1.0);
            assert!(double(&trace).abs() < most, "{r} {time} {:e}", double(&trace));
            for (found, (i, j)) in second.iter().zip(PAIRS) {
                let contracted = [1, 2, 3].map(|k| entry([i + 1, j + 1, k, k]));
                let apart = contracted[0] + contracted[1] + contracted[2] - found;
                assert!(double(&apart).abs() < most, "{r} {time} {i} {j} {:e}", double(&apart));
            }
        }
    }
}
