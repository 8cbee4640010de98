//! The rows that formulas are asked about: fixed random numbers, and corners.

use super::Formula;
use crate::methods::tensors::fourth::PAIRS;
use crate::methods::tensors::{Closure, Model};
use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Dxsm;

/// The number of random rows; a_ij has further ones at the corners of what it can be.
const RANDOM: usize = 30;

/// Aspect ratios of rates, in turn: rods, discs, a sphere.
const RATIOS: [f64; 8] = [11.6, 0.2, 3.0, 50.0, 1.0, 0.05, 1000.0, 1.5];

/// Gradients are whole multiples of this, a_ij of [`UNIT`]: they are exact, and so are their traces.
const GRADIENT: f64 = 1.0 / 64.0;
const UNIT: f64 = 1.0 / 1_048_576.0;

struct Numbers(Pcg64Dxsm);

impl Numbers {
    fn uniform(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * self.0.random::<f64>()
    }

    /// A rotation, all alike (Shoemake 1992).
    fn rotation(&mut self) -> Matrix3<f64> {
        let (share, turns) = (self.uniform(0.0, 1.0), [0, 1].map(|_| self.uniform(0.0, std::f64::consts::TAU)));
        let (a, b) = ((1.0 - share).sqrt(), share.sqrt());
        let [(s, c), (t, d)] = turns.map(f64::sin_cos);
        UnitQuaternion::from_quaternion(Quaternion::new(a * s, a * c, b * t, b * d)).to_rotation_matrix().into_inner()
    }

    /// L in 1/s without divergence: shear along a pair of axes, extension along them, and flows without symmetry.
    fn gradient(&mut self, row: usize) -> Matrix3<f64> {
        let mut l = Matrix3::zeros();
        match row % 3 {
            0 => l[[(1, 0), (0, 1), (2, 0), (0, 2), (2, 1), (1, 2)][row / 3 % 6]] = self.uniform(0.25, 2.0),
            1 => {
                l[(0, 0)] = self.uniform(-1.0, 1.0);
                l[(1, 1)] = self.uniform(-1.0, 1.0);
            }
            _ => l = Matrix3::from_fn(|_, _| self.uniform(-1.0, 1.0)),
        }
        let mut l = l.map(|x| (x / GRADIENT).round() * GRADIENT);
        l[(2, 2)] = 0.0 - l[(0, 0)] - l[(1, 1)];
        l
    }

    /// a_ij with distinct eigenvalues: all shares of the trace alike, in any axes.
    fn tensor(&mut self) -> Matrix3<f64> {
        loop {
            let mut ends = [self.uniform(0.0, 1.0), self.uniform(0.0, 1.0)];
            ends.sort_by(f64::total_cmp);
            let mut values = [ends[0], ends[1] - ends[0], 1.0 - ends[1]];
            let turn = self.rotation();
            values.sort_by(f64::total_cmp);
            if values[0] > 0.02 && values[1] - values[0] > 0.02 && values[2] - values[1] > 0.02 {
                return exact(&(turn * Matrix3::from_diagonal(&Vector3::from(values)) * turn.transpose()));
            }
        }
    }
}

/// The tensor with rounded components and the trace 1.
fn exact(a: &Matrix3<f64>) -> Matrix3<f64> {
    let mut a = a.map(|x| (x / UNIT).round() * UNIT);
    a[(2, 2)] = 1.0 - a[(0, 0)] - a[(1, 1)];
    a
}

/// Where a closure is at its limits: aligned, random in a plane and in space, two equal eigenvalues, nearly aligned.
fn corners() -> Vec<Matrix3<f64>> {
    let p = Vector3::new(0.75, -0.5, 0.433_012_701_892_219_3);
    let around = |along: f64| {
        let across = 0.5 * (1.0 - along);
        exact(&(Matrix3::identity() * across + p * p.transpose() * (along - across)))
    };
    let diagonal = |values: [f64; 3]| exact(&Matrix3::from_diagonal(&Vector3::from(values)));
    vec![
        diagonal([1.0, 0.0, 0.0]),
        diagonal([0.0, 1.0, 0.0]),
        diagonal([0.5, 0.5, 0.0]),
        diagonal([0.0, 0.5, 0.5]),
        diagonal([1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0]),
        diagonal([0.5, 0.25, 0.25]),
        diagonal([0.25, 0.375, 0.375]),
        around(0.75),
        around(0.125),
        around(0.96875),
    ]
}

/// True if the formula has one value where two eigenvalues of a_ij are equal: fits in the two largest eigenvalues, and
/// models in the axes of a, depend on which of the two is which.
fn is_smooth(formula: &Formula) -> bool {
    let fitted = |closure: Closure| matches!(closure, Closure::Orw | Closure::Ore);
    match *formula {
        Formula::Pdot => true,
        Formula::Closure { closure } => !fitted(closure),
        Formula::Dadt { closure, model } => {
            !fitted(closure) && matches!(model, Model::FolgarTucker { .. } | Model::Iard { .. })
        }
    }
}

/// Rows of `inputs.csv` of a formula of a_ij, without their numbers.
pub(super) fn of_tensors(formula: &Formula) -> Vec<Vec<f64>> {
    let mut random = Numbers(Pcg64Dxsm::seed_from_u64(1987));
    let mut tensors: Vec<_> = (0..RANDOM).map(|_| random.tensor()).collect();
    if is_smooth(formula) {
        tensors.extend(corners());
    }
    let row = |(row, a): (usize, &Matrix3<f64>)| match (formula, PAIRS.map(|place| a[place])) {
        (Formula::Dadt { .. }, six) => {
            let l = random.gradient(row);
            [&six[..], l.transpose().as_slice(), &[RATIOS[row % RATIOS.len()]]].concat()
        }
        (_, six) => six.to_vec(),
    };
    tensors.iter().enumerate().map(row).collect()
}

/// Rows of `inputs.csv` of ṗ, without their numbers: rods of these aspect ratios, in plane Couette flow alone or in
/// any.
pub(super) fn of_rods(ratios: [f64; 2], couette: bool) -> Vec<Vec<f64>> {
    let mut random = Numbers(Pcg64Dxsm::seed_from_u64(1922));
    let of_row = |row: usize| {
        let p = random.rotation() * Vector3::z();
        let share = random.uniform(0.0, 1.0);
        let ratio = if ratios[0] == ratios[1] { ratios[0] } else { ratios[0] * (ratios[1] / ratios[0]).powf(share) };
        let l = if couette { random.gradient(0) } else { random.gradient(row) };
        [p.as_slice(), l.transpose().as_slice(), &[(ratio * 64.0).round() / 64.0]].concat()
    };
    (0..2 * RANDOM).map(of_row).collect()
}

/// L of a row that ends with L and r_e.
pub(crate) fn gradient(row: &[f64]) -> Matrix3<f64> {
    Matrix3::from_row_slice(&row[row.len() - 10..row.len() - 1])
}
