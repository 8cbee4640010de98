//! The Fokker–Planck operator −∇·(ṗψ) + D_r∇²ψ as a sparse matrix between spherical harmonics.
//!
//! ṗ = ω × p + ∇V with V = ½Λ p·Dp, D traceless (a trace turns no rod). V is a harmonic of degree 2, so
//! −∇·(ψ∇V) = ½[−∇²(Vψ) + V∇²ψ + 6Vψ]: between degrees l and l' this is ½(l'(l'+1) − l(l+1) + 6) times the matrix of V,
//! which couples |l' − l| ≤ 2 and |m' − m| ≤ 2. −(ω × p)·∇ψ = −i ω·Lψ conserves l, and ∇²ψ = −l(l+1)ψ.

use super::harmonics::{Basis, quadratic};
use nalgebra::{Complex, Matrix3, SymmetricEigen, Vector3};
use std::f64::consts::SQRT_2;

/// The motion of rods in some axes, in 1/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// ΛD in 1/s, symmetric and traceless.
    pub strain: Matrix3<f64>,
    /// ω in 1/s, half the vorticity.
    pub spin: Vector3<f64>,
    /// The rotary diffusivity D_r in 1/s.
    pub diffusivity: f64,
}

impl Motion {
    /// Rods of this aspect ratio (∞ for Λ = 1) with D_r = C_I γ̇ in the flow L; row i and column j hold ∂u_i/∂x_j.
    pub fn new(gradient_per_s: [[f64; 3]; 3], aspect_ratio: f64, c_i: f64) -> Self {
        let rate = strain_rate_per_s(gradient_per_s);
        Self::diffusing(gradient_per_s, aspect_ratio, if rate == 0.0 { 0.0 } else { c_i * rate })
    }

    /// The same rods with D_r in 1/s, also in a liquid at rest.
    pub fn diffusing(gradient_per_s: [[f64; 3]; 3], aspect_ratio: f64, diffusivity: f64) -> Self {
        let l = Matrix3::from_fn(|i, j| gradient_per_s[i][j]);
        let (strain, turning) = ((l + l.transpose()) * 0.5, (l - l.transpose()) * 0.5);
        let traceless = strain - Matrix3::identity() * (strain.trace() / 3.0);
        Self {
            strain: traceless * shape_factor(aspect_ratio),
            spin: Vector3::new(turning[(2, 1)], turning[(0, 2)], turning[(1, 0)]),
            diffusivity,
        }
    }

    /// The factor by which this flow is another one, to a few last digits.
    pub(super) fn over(&self, other: &Self) -> Option<f64> {
        let size = |of: &Self| of.strain.amax().max(of.spin.amax());
        let pairs = || self.strain.iter().chain(&self.spin).zip(other.strain.iter().chain(&other.spin));
        let factor =
            pairs().find(|(_, other_rate)| other_rate.abs() == size(other)).map(|(rate, other)| rate / other)?;
        let off = |(rate, other): (&f64, &f64)| (rate - factor * other).abs();
        pairs().all(|pair| off(pair) <= 8.0 * f64::EPSILON * size(self)).then_some(factor)
    }

    /// If positive, a rate in 1/s at which every deviation from the steady density decays at least.
    pub(super) fn least_decay(&self) -> f64 {
        6.0 * self.diffusivity - 1.5 * SymmetricEigen::new(self.strain).eigenvalues.max()
    }

    /// A bound of the operator's norm up to this degree, from the largest rate of turning and the slopes of harmonics.
    pub fn norm(&self, degree: usize) -> f64 {
        let l = degree as f64;
        let rates = SymmetricEigen::new(self.strain).eigenvalues;
        let turning = 0.5 * (rates.max() - rates.min()) + self.spin.norm();
        self.diffusivity * l * (l + 1.0) + (l + 1.0) * turning + 3.0 * rates.amax()
    }

    /// The factors of the products of `quadratic` in p·(ΛD)p, for m' − m = 0, 1, 2.
    fn factors(&self) -> [Complex<f64>; 3] {
        let d = &self.strain;
        [
            Complex::from(d[(2, 2)]),
            Complex::new(d[(0, 2)], -d[(1, 2)]),
            Complex::new(0.25 * (d[(0, 0)] - d[(1, 1)]), -0.5 * d[(0, 1)]),
        ]
    }

    /// The contribution of b_lm to the rate of b_l'm'.
    fn element(&self, factors: &[Complex<f64>; 3], to: (i64, i64), from: (i64, i64)) -> Complex<f64> {
        let ((l_to, m_to), (l, m)) = (to, from);
        let shift = m_to - m;
        let factor = factors[shift.unsigned_abs() as usize];
        let factor = if shift < 0 { factor.conj() } else { factor };
        let degrees = (l_to * (l_to + 1) - l * (l + 1) + 6) as f64;
        let mut sum = factor * (0.25 * degrees * quadratic(to, from));
        if l_to == l {
            let ladder = ((l * (l + 1) - m * m_to) as f64).sqrt();
            let [x, y, z] = self.spin.into();
            // −i ω·L, with ω·L = ω_z L_z + ½(ω_x − iω_y)L₊ + ½(ω_x + iω_y)L₋.
            sum += match shift {
                0 => Complex::new(-self.diffusivity * (l * (l + 1)) as f64, -z * m as f64),
                1 => Complex::new(-0.5 * y, -0.5 * x) * ladder,
                -1 => Complex::new(0.5 * y, -0.5 * x) * ladder,
                _ => Complex::ZERO,
            };
        }
        sum
    }
}

/// γ̇ = (2D:D)^½ in 1/s.
pub fn strain_rate_per_s(gradient_per_s: [[f64; 3]; 3]) -> f64 {
    let l = Matrix3::from_fn(|i, j| gradient_per_s[i][j]);
    (2.0 * ((l + l.transpose()) * 0.5).norm_squared()).sqrt()
}

/// The shape factor Λ = (r² − 1)/(r² + 1); 1 for r = ∞.
fn shape_factor(aspect_ratio: f64) -> f64 {
    let r = aspect_ratio.abs();
    // Uses 1/r, because r² may overflow.
    let square = r.min(r.recip()).powi(2);
    let size = (1.0 - square) / (1.0 + square);
    if r < 1.0 { -size } else { size }
}

/// A sparse matrix, row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct Operator {
    /// The harmonics of its rows and columns.
    pub basis: Basis,
    ends: Vec<usize>,
    columns: Vec<u32>,
    entries: Vec<f64>,
}

impl Operator {
    /// The operator between the harmonics of `basis`.
    pub fn new(motion: &Motion, basis: Basis) -> Self {
        let factors = motion.factors();
        let mut operator = Self { basis, ends: vec![0], columns: Vec::new(), entries: Vec::new() };
        let mut row: Vec<(u32, f64)> = Vec::new();
        let mut couplings = Vec::new();
        let offsets: Vec<_> = (0..=basis.degree).step_by(2).map(|l| basis.offset(l)).collect();
        for (l_to, m_to, imaginary) in basis.unknowns() {
            let weight = if m_to == 0 { 1.0 } else { SQRT_2 };
            // The imaginary part comes right after the real one, and has the same couplings.
            if !imaginary {
                couplings.clear();
                for l in [l_to.wrapping_sub(2), l_to, l_to + 2].into_iter().filter(|l| *l <= basis.degree) {
                    let most = l.min(basis.order) as i64;
                    let orders = (m_to as i64 - 2).max(-most)..=(m_to as i64 + 2).min(most);
                    let element = |m| motion.element(&factors, (l_to as i64, m_to as i64), (l as i64, m));
                    couplings.extend(orders.map(|m| (offsets[l / 2], m, element(m))));
                }
            }
            for (offset, m, z) in &couplings {
                // b_l,−m = (−1)^m b̄_lm.
                let sign = if *m < 0 && m % 2 != 0 { -1.0 } else { 1.0 };
                let turn = if *m < 0 { -1.0 } else { 1.0 };
                let scale = sign * weight / if *m == 0 { 1.0 } else { SQRT_2 };
                let [real, unreal] = if imaginary { [z.im, z.re * turn] } else { [z.re, -z.im * turn] };
                let mut add = |imaginary: bool, entry: f64| {
                    if entry != 0.0 {
                        let at = offset + basis.place(m.unsigned_abs() as usize, imaginary);
                        row.push((at as u32, entry * scale));
                    }
                };
                add(false, real);
                if !basis.even && *m != 0 {
                    add(true, unreal);
                }
            }
            row.sort_by_key(|(at, _)| *at);
            for (at, entry) in row.drain(..) {
                match operator.columns.last() {
                    Some(last) if *last == at && operator.columns.len() > operator.ends[operator.ends.len() - 1] => {
                        let last = operator.entries.len() - 1;
                        operator.entries[last] += entry;
                    }
                    _ => {
                        operator.columns.push(at);
                        operator.entries.push(entry);
                    }
                }
            }
            operator.ends.push(operator.columns.len());
        }
        operator
    }

    /// Number of stored entries.
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// The columns and entries of a row.
    pub fn row(&self, row: usize) -> impl Iterator<Item = (usize, f64)> {
        let range = self.ends[row]..self.ends[row + 1];
        self.columns[range.clone()].iter().map(|at| *at as usize).zip(self.entries[range].iter().copied())
    }

    /// Sets `into` to `scale` × this matrix × `values`.
    pub fn apply(&self, scale: f64, values: &[f64], into: &mut [f64]) {
        for (row, sum) in into.iter_mut().enumerate() {
            *sum = scale * self.row(row).map(|(at, entry)| entry * values[at]).sum::<f64>();
        }
    }

    /// The operator with one entry set to 0, as if a coupling were missing.
    #[cfg(test)]
    pub fn without(&self, entry: usize) -> Self {
        let mut wrong = self.clone();
        wrong.entries[entry] = 0.0;
        wrong
    }
}
