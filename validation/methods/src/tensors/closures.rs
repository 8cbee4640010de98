//! Closures: a_ijkl as a function of a_ij.

use super::{ibof, natural, orthotropic};
use nalgebra::{Matrix3, Matrix6, SymmetricEigen, Vector3, Vector6};
use serde::{Deserialize, Serialize};

/// The index pairs (i, j) of the rows and columns of [`Fourth`].
pub const PAIRS: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];

/// a_ijkl with a_ijkl = a_jikl = a_ijlk: row (i, j), column (k, l) by [`PAIRS`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fourth(pub Matrix6<f64>);

impl Fourth {
    /// The tensor with these components, which must be symmetric in i, j and in k, l.
    pub fn from_fn(of: impl Fn(usize, usize, usize, usize) -> f64) -> Self {
        Self(Matrix6::from_fn(|row, column| {
            let ((i, j), (k, l)) = (PAIRS[row], PAIRS[column]);
            of(i, j, k, l)
        }))
    }

    /// The component a_ijkl, indices from 0.
    pub fn at(&self, i: usize, j: usize, k: usize, l: usize) -> f64 {
        self.0[(place(i, j), place(k, l))]
    }

    /// The contraction a_ijkl m_kl with a symmetric `m`.
    pub fn contract(&self, m: &Matrix3<f64>) -> Matrix3<f64> {
        let twice = |n: usize| if n < 3 { 1.0 } else { 2.0 };
        let product = self.0 * Vector6::from_fn(|n, _| twice(n) * m[PAIRS[n]]);
        Matrix3::from_fn(|i, j| product[place(i, j)])
    }

    /// a_ijkl of an orthotropic distribution: the columns of `axes` are its axes, `mixed` is a_2233, a_3311, a_1122 in
    /// them, `values` is a_11, a_22, a_33. a_iiii follows from a_iikk = a_ii.
    pub(super) fn orthotropic(axes: &Matrix3<f64>, values: &Vector3<f64>, mixed: &Vector3<f64>) -> Self {
        let all = Matrix3::from_fn(|i, j| {
            if i == j { values[i] - mixed[(i + 1) % 3] - mixed[(i + 2) % 3] } else { mixed[3 - i - j] }
        });
        let principal = Self::from_fn(|i, j, k, l| match (i == j && k == l, i == k && j == l) {
            (true, _) => all[(i, k)],
            (_, true) => all[(i, j)],
            _ => 0.0,
        });
        principal.turned(axes)
    }

    /// The same tensor in other axes: it is given in those that are the columns of `axes`.
    pub(super) fn turned(&self, axes: &Matrix3<f64>) -> Self {
        let turn = Matrix6::from_fn(|row, column| {
            let ((i, j), (m, n)) = (PAIRS[row], PAIRS[column]);
            let swapped = if m == n { 0.0 } else { axes[(i, n)] * axes[(j, m)] };
            axes[(i, m)] * axes[(j, n)] + swapped
        });
        Self(turn * self.0 * turn.transpose())
    }
}

fn place(i: usize, j: usize) -> usize {
    if i == j { i } else { i + j + 2 }
}

/// The eigenvalues of a, in descending order, and their axes as columns.
pub(super) fn principal(a: &Matrix3<f64>) -> (Vector3<f64>, Matrix3<f64>) {
    let eigen = SymmetricEigen::new(*a);
    let mut order = [0, 1, 2];
    order.sort_by(|i, j| eigen.eigenvalues[*j].total_cmp(&eigen.eigenvalues[*i]));
    let axes = Matrix3::from_columns(&order.map(|k| eigen.eigenvectors.column(k).into_owned()));
    (Vector3::from(order.map(|k| eigen.eigenvalues[k])), axes)
}

/// A closure: a_ijkl as a function of a_ij.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Closure {
    /// Exact for nearly random rods (Hand 1962; Advani & Tucker 1987, eq. 22).
    Linear,
    /// a_ij a_kl, exact for aligned rods (Doi 1981; Advani & Tucker 1987, eq. 24).
    Quadratic,
    /// The linear and the quadratic closure, mixed by f = 1 − 27 det a (Advani & Tucker 1990).
    Hybrid,
    /// Exact for rods without diffusion that were isotropic at first (Verleye & Dupret 1993; Montgomery-Smith et al.
    /// 2011).
    Natural,
    /// A fit of the natural closure by polynomials of degree 4 (Verweyst 1998).
    Ore,
    /// A fit over C_I from 10⁻⁴ to 10⁻¹ (Chung & Kwon 2001).
    Orw,
    /// A fit over the same C_I in the invariants of a (Chung & Kwon 2002).
    Ibof,
}

impl Closure {
    /// Every closure.
    pub const ALL: [Self; 7] =
        [Self::Linear, Self::Quadratic, Self::Hybrid, Self::Natural, Self::Ore, Self::Orw, Self::Ibof];

    /// The usual name of the closure.
    pub fn name(self) -> &'static str {
        match self {
            Self::Linear => "linear",
            Self::Quadratic => "quadratic",
            Self::Hybrid => "hybrid",
            Self::Natural => "natural",
            Self::Ore => "ORE",
            Self::Orw => "ORW",
            Self::Ibof => "IBOF",
        }
    }

    /// The source of the closure.
    pub fn source(self) -> &'static str {
        match self {
            Self::Linear => "the linear closure: Advani & Tucker 1987, J. Rheol. 31, 751",
            Self::Quadratic => "the quadratic closure a_ijkl = a_ij a_kl: Advani & Tucker 1987, J. Rheol. 31, 751",
            Self::Hybrid => {
                "the hybrid closure, f = 1 − 27 det a times the quadratic plus 1 − f times the linear one: Advani & \
                    Tucker 1990, \
                 J. Rheol. 34, 367"
            }
            Self::Natural => {
                "the natural closure, exact: Verleye & Dupret 1993; Montgomery-Smith, He, Jack & Smith 2011, J. Fluid \
                    Mech. 680, 321"
            }
            Self::Ore => "the closure ORE, 45 coefficients: Verweyst 1998, thesis, University of Illinois",
            Self::Orw => "the closure ORW, 18 coefficients: Chung & Kwon 2001, Polym. Compos. 22, 636",
            Self::Ibof => "the closure IBOF, 63 coefficients: Chung & Kwon 2002, J. Rheol. 46, 169",
        }
    }

    /// a_ijkl by this closure.
    pub fn fourth(self, a: &Matrix3<f64>) -> Fourth {
        match self {
            Self::Linear => linear(a),
            Self::Quadratic => quadratic(a),
            Self::Hybrid => {
                let f = 1.0 - 27.0 * a.determinant();
                Fourth(quadratic(a).0 * f + linear(a).0 * (1.0 - f))
            }
            Self::Natural => natural::fourth(a),
            Self::Ore => orthotropic::ore(a),
            Self::Orw => orthotropic::orw(a),
            Self::Ibof => ibof::fourth(a),
        }
    }
}

fn delta(i: usize, j: usize) -> f64 {
    if i == j { 1.0 } else { 0.0 }
}

fn linear(a: &Matrix3<f64>) -> Fourth {
    Fourth::from_fn(|i, j, k, l| {
        let ones = delta(i, j) * delta(k, l) + delta(i, k) * delta(j, l) + delta(i, l) * delta(j, k);
        let mixed = a[(i, j)] * delta(k, l)
            + a[(i, k)] * delta(j, l)
            + a[(i, l)] * delta(j, k)
            + a[(k, l)] * delta(i, j)
            + a[(j, l)] * delta(i, k)
            + a[(j, k)] * delta(i, l);
        mixed / 7.0 - ones / 35.0
    })
}

fn quadratic(a: &Matrix3<f64>) -> Fourth {
    Fourth::from_fn(|i, j, k, l| a[(i, j)] * a[(k, l)])
}
