//! The means of `isotropic.rs` in pairs of doubles, eight nodes at a time: the fast way to their nearest doubles.
//!
//! A pair hi + lo holds 106 bits. Relative to its exact result, with u = 2⁻⁵³, a sum of positive pairs is off by at
//! most 3u², a product by 7u², a quotient by 15u² (Joldes, Muller & Popescu 2017, ACM TOMS 44, 15) and a root by 4u²
//! (Lefèvre et al. 2023, ACM TOMS 49, 10), so a term of the quadrature by less than 200u², and a sum of a thousand
//! terms by 3000u² more: 2⁻⁹³ of the largest entry, while the quadrature itself holds 80 bits. Where 78 bits leave two
//! doubles possible, there is no answer, and more bits decide.

use super::big::{Big, Bits, double, each_power, number};
use super::isotropic::{Covariance, PAIRS, PRECISION, QUADRUPLES};
use fearless_simd::{Level, Simd, dispatch, f64x8, prelude::*};
use std::sync::LazyLock;

/// Traces of Σ and its inverse up to this: squares and roots of det M are far from the ends of the range of a double.
const LARGEST_TRACE: f64 = 1e12;

/// Nodes below and above x = 1 that a trace of [`LARGEST_TRACE`] asks for.
const BELOW: usize = 656;
const ABOVE: usize = 304;

/// 1.25^k for k from −[`BELOW`] to [`ABOVE`], as pairs.
static NODES: LazyLock<[Vec<f64>; 2]> = LazyLock::new(|| {
    let mut nodes = [vec![0.0; BELOW + ABOVE], vec![0.0; BELOW + ABOVE]];
    let mut place = (BELOW..BELOW + ABOVE).chain((0..BELOW).rev());
    each_power(&PRECISION.of(1.0), &PRECISION.of(1.25), BELOW, ABOVE - 1, |x| {
        let k = place.next().expect("as many places as powers");
        [nodes[0][k], nodes[1][k]] = pair(x);
    });
    nodes
});

/// The nearest double, and what it leaves.
fn pair(x: &Big) -> [f64; 2] {
    let hi = double(x);
    [hi, double(&(x - PRECISION.of(hi)))]
}

/// Eight numbers hi + lo, |lo| ≤ ½ ulp(hi).
#[derive(Clone, Copy)]
struct Eight<S: Simd> {
    hi: f64x8<S>,
    lo: f64x8<S>,
}

impl<S: Simd> Eight<S> {
    #[inline(always)]
    fn all(simd: S, [hi, lo]: [f64; 2]) -> Self {
        Self { hi: f64x8::splat(simd, hi), lo: f64x8::splat(simd, lo) }
    }

    /// hi + lo of a sum, |a| ≥ |b|.
    #[inline(always)]
    fn of_sum(a: f64x8<S>, b: f64x8<S>) -> Self {
        let hi = a + b;
        Self { hi, lo: b - (hi - a) }
    }

    #[inline(always)]
    fn exact_sum(a: f64x8<S>, b: f64x8<S>) -> Self {
        let hi = a + b;
        let of_b = hi - a;
        Self { hi, lo: (a - (hi - of_b)) + (b - of_b) }
    }

    /// The exact product of two doubles, by halves of 26 bits: the same with and without fused instructions.
    #[inline(always)]
    fn exact_product(a: f64x8<S>, b: f64x8<S>) -> Self {
        const SPLIT: f64 = 134_217_729.0;
        let halves = |x: f64x8<S>| {
            let shifted = x * SPLIT;
            let upper = shifted - (shifted - x);
            (upper, x - upper)
        };
        let ((a1, a2), (b1, b2)) = (halves(a), halves(b));
        let hi = a * b;
        Self { hi, lo: a2 * b2 - (((hi - a1 * b1) - a2 * b1) - a1 * b2) }
    }

    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        let (upper, lower) = (Self::exact_sum(self.hi, other.hi), Self::exact_sum(self.lo, other.lo));
        let first = Self::of_sum(upper.hi, upper.lo + lower.hi);
        Self::of_sum(first.hi, first.lo + lower.lo)
    }

    #[inline(always)]
    fn times(self, other: Self) -> Self {
        let upper = Self::exact_product(self.hi, other.hi);
        Self::of_sum(upper.hi, upper.lo + (self.hi * other.lo + self.lo * other.hi))
    }

    #[inline(always)]
    fn over(self, other: Self) -> Self {
        let first = self.hi / other.hi;
        let back = other.times(Self { hi: first, lo: f64x8::splat(first.simd, 0.0) });
        let rest = (self.hi - back.hi) + (self.lo - back.lo);
        Self::of_sum(first, rest / other.hi)
    }

    #[inline(always)]
    fn root(self) -> Self {
        let first = self.hi.sqrt();
        let back = Self::exact_product(first, first);
        let rest = ((self.hi - back.hi) - back.lo) + self.lo;
        Self::of_sum(first, rest / (first + first))
    }

    /// The sum of the eight, exactly.
    fn total(self) -> Big {
        let parts = self.hi.as_slice().iter().chain(self.lo.as_slice());
        parts.fold(PRECISION.of(0.0), |sum, part| sum + PRECISION.of(*part))
    }
}

/// Σ, its inverse, and what det M and adj M take of them.
pub(super) struct Matrices {
    sigma: [[[f64; 2]; 3]; 3],
    minus_inverse: [[[f64; 2]; 3]; 3],
    trace_sigma: [f64; 2],
    trace_inverse: [f64; 2],
    /// tr B − B_ii.
    others: [[f64; 2]; 3],
    /// The nodes in [`NODES`], a multiple of eight.
    first: usize,
    last: usize,
}

impl Matrices {
    /// `None` where a trace is above [`LARGEST_TRACE`].
    pub fn new(covariance: &Covariance) -> Option<Self> {
        let (sigma, inverse) = (&covariance.sigma, &covariance.inverse);
        let traces = covariance.traces();
        if traces.iter().any(|trace| double(trace) > LARGEST_TRACE) {
            return None;
        }
        let (left, right) = Covariance::steps(&traces[0], &traces[1]);
        Some(Self {
            sigma: sigma.each_ref().map(|row| row.each_ref().map(pair)),
            minus_inverse: inverse.each_ref().map(|row| row.each_ref().map(|x| pair(&-x))),
            trace_sigma: pair(&traces[0]),
            trace_inverse: pair(&traces[1]),
            others: covariance.others().each_ref().map(pair),
            first: (BELOW - left) / 8 * 8,
            last: (BELOW + right + 8) / 8 * 8,
        })
    }

    /// Σ over the nodes x of `f(x, adj M, det M)`.
    #[inline(always)]
    fn sums<S: Simd, const N: usize>(
        &self,
        simd: S,
        f: impl Fn(Eight<S>, &[[Eight<S>; 3]; 3], Eight<S>) -> [Eight<S>; N],
    ) -> [Big; N] {
        let all = |x: [f64; 2]| Eight::all(simd, x);
        let zero = all([0.0; 2]);
        let mut sums = [zero; N];
        for k in (self.first..self.last).step_by(8) {
            let [hi, lo] = &*NODES;
            let x = Eight { hi: f64x8::from_slice(simd, &hi[k..k + 8]), lo: f64x8::from_slice(simd, &lo[k..k + 8]) };
            let determinant = x.plus(all(self.trace_inverse)).times(x).plus(all(self.trace_sigma)).times(x);
            let determinant = determinant.plus(all([1.0, 0.0]));
            let mut adjugate = [[zero; 3]; 3];
            for (i, j) in PAIRS {
                let linear = if i == j { x.plus(all(self.others[i])) } else { all(self.minus_inverse[i][j]) };
                adjugate[i][j] = linear.times(x).plus(all(self.sigma[i][j]));
                adjugate[j][i] = adjugate[i][j];
            }
            let values = f(x, &adjugate, determinant);
            for i in 0..N {
                sums[i] = sums[i].plus(values[i]);
            }
        }
        sums.map(Eight::total)
    }

    /// The doubles nearest to ⟨|p_i|⟩; `None` where pairs of doubles do not settle them.
    pub fn projections(&self) -> Option<[f64; 3]> {
        let sums = dispatch!(Level::new(), simd => self.sums(
            simd,
            #[inline(always)]
            |x, adjugate, determinant| {
                let mut values = [x; 3];
                for i in 0..3 {
                    values[i] = adjugate[i][i].times(x).root().over(determinant);
                }
                values
            },
        ));
        nearest(sums.map(|sum| sum * Covariance::step() / PRECISION.pi()))
    }

    /// Those nearest to a_ij, in the order of [`PAIRS`].
    pub fn second(&self) -> Option<[f64; 6]> {
        let sums = dispatch!(Level::new(), simd => self.sums(
            simd,
            #[inline(always)]
            |x, adjugate, determinant| {
                let weight = x.over(determinant.times(determinant.root()));
                let mut values = [weight; 6];
                for (value, (i, j)) in values.iter_mut().zip(PAIRS) {
                    *value = adjugate[i][j].times(weight);
                }
                values
            },
        ));
        nearest(sums.map(|sum| (sum * Covariance::step()) >> 1))
    }

    /// Those nearest to a_ijkl, in the order of [`QUADRUPLES`].
    pub fn fourth(&self) -> Option<[f64; 15]> {
        let sums = dispatch!(Level::new(), simd => self.sums(
            simd,
            #[inline(always)]
            |x, n, determinant| {
                let square = determinant.times(determinant);
                let weight = x.times(x).over(square.times(determinant.root()));
                let mut values = [weight; 15];
                for (value, [i, j, k, l]) in values.iter_mut().zip(QUADRUPLES) {
                    let n = |i: usize, j: usize| n[i - 1][j - 1];
                    let [a, b, c] = [n(i, j).times(n(k, l)), n(i, k).times(n(j, l)), n(i, l).times(n(j, k))];
                    *value = a.plus(b).plus(c).times(weight);
                }
                values
            },
        ));
        nearest(sums.map(|sum| (sum * Covariance::step()) >> 2))
    }
}

/// The nearest doubles of entries of one kind, which are good to 78 bits of the largest of them; an entry that is 0 is
/// exactly so.
fn nearest<const N: usize>(entries: [Big; N]) -> Option<[f64; N]> {
    let largest = crate::worst(entries.iter().map(double).map(f64::abs));
    let bound = Bits(64).of(largest) >> 78;
    let mut found = [0.0; N];
    for (found, entry) in found.iter_mut().zip(&entries).filter(|(_, entry)| **entry != Big::ZERO) {
        let [least, most] = [entry - &bound, entry + &bound].map(|x| double(&x));
        if least != most {
            return None;
        }
        *found = least;
    }
    Some(found)
}

impl Covariance {
    /// The doubles nearest to the means: ⟨|p_i|⟩, then a_ij in the order of `PAIRS`.
    pub fn nearest(&self) -> [f64; 9] {
        let matrices = Matrices::new(self);
        let projections = matrices.as_ref().and_then(Matrices::projections);
        let [x1, x2, x3] = projections.unwrap_or_else(|| self.projections().each_ref().map(number));
        let second = matrices.as_ref().and_then(Matrices::second);
        let [a, b, c, d, e, f] = second.unwrap_or_else(|| self.second().each_ref().map(number));
        [x1, x2, x3, a, b, c, d, e, f]
    }

    /// The doubles nearest to a_ijkl, in the order of `QUADRUPLES`.
    pub fn nearest_fourth(&self) -> [f64; 15] {
        let settled = Matrices::new(self).and_then(|matrices| matrices.fourth());
        settled.unwrap_or_else(|| self.fourth().each_ref().map(number))
    }
}

#[cfg(test)]
mod tests;
