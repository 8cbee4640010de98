//! Fourth-order tensors symmetric in each pair of indices, and the principal axes of a.

use nalgebra::{Matrix3, Matrix6, SymmetricEigen, Vector3, Vector6};

/// The index pairs (i, j) of the rows and columns of [`Fourth`].
pub const PAIRS: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];

/// a_ijkl with a_ijkl = a_jikl = a_ijlk: row (i, j), column (k, l) by [`PAIRS`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
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

    /// a_ijkl of an orthotropic distribution: the columns of `axes` are its axes, in which `all` is a_iijj.
    pub(super) fn in_axes(axes: &Matrix3<f64>, all: impl Fn(usize, usize) -> f64) -> Self {
        let all = Matrix3::from_fn(all);
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
