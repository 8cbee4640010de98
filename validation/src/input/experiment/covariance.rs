//! The covariance of many points with few shared causes: the cost of solving is linear in the number of points, not
//! cubic.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

/// V = D + UᵀU: D are the points' own variances, and each row of U is a cause that moves all points together.
pub(super) struct Covariance {
    /// D.
    pub(super) own: DVector<f64>,
    /// U, a row for each cause and a column for each point.
    pub(super) shared: DMatrix<f64>,
}

/// A solver for V. With A = U D^−½, V = D^½ (1 + AᵀA) D^½.
pub(super) struct Solver {
    /// D^½.
    root: DVector<f64>,
    /// A.
    causes: DMatrix<f64>,
    /// 1 + AAᵀ.
    inner: Cholesky<f64, Dyn>,
}

impl Covariance {
    pub(super) fn variances(&self) -> DVector<f64> {
        let shared = self.shared.column_iter().map(|column| column.norm_squared());
        &self.own + DVector::from_iterator(self.own.len(), shared)
    }

    /// A solver for V x = e; `None` if a point's own variance is not positive, or a number is not finite.
    pub(super) fn solver(&self) -> Option<Solver> {
        if !self.own.iter().all(|own| *own > 0.0 && own.is_finite()) {
            return None;
        }
        let root = self.own.map(f64::sqrt);
        let mut causes = self.shared.clone();
        for (mut column, root) in causes.column_iter_mut().zip(root.iter()) {
            column /= *root;
        }
        let mut inner = &causes * causes.transpose();
        (0..inner.nrows()).for_each(|k| inner[(k, k)] += 1.0);
        let inner = inner.cholesky()?;
        Some(Solver { root, causes, inner })
    }
}

impl Solver {
    /// y = (1 + AAᵀ)⁻¹ A f and f − Aᵀy = (1 + AᵀA)⁻¹ f, for f = D^−½ e (Woodbury).
    fn split(&self, e: &DVector<f64>) -> (DVector<f64>, DVector<f64>) {
        let f = e.component_div(&self.root);
        let y = self.inner.solve(&(&self.causes * &f));
        let rest = f - self.causes.tr_mul(&y);
        (y, rest)
    }

    /// V⁻¹ e.
    pub(super) fn solve(&self, e: &DVector<f64>) -> DVector<f64> {
        self.split(e).1.component_div(&self.root)
    }

    /// eᵀ V⁻¹ e = |f − Aᵀy|² + |y|², a sum of squares that y minimises, so that an error of y enters squared.
    pub(super) fn chi_square(&self, e: &DVector<f64>) -> f64 {
        let (y, rest) = self.split(e);
        rest.norm_squared() + y.norm_squared()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// Numbers from −1 to 1 without a pattern.
    fn noise(rows: usize, columns: usize) -> DMatrix<f64> {
        DMatrix::from_fn(rows, columns, |r, c| ((r * 7919 + c * 104_729 + 13) as f64).sin())
    }

    #[test]
    fn it_is_solved_as_the_whole_matrix_is() {
        for (causes, points) in [(1, 2), (7, 3), (5, 40), (60, 40)] {
            let covariance = Covariance {
                own: DVector::from_fn(points, |k, _| 0.3 + 0.1 * (k as f64).cos()),
                shared: noise(causes, points),
            };
            // The textbook's method, with a cost cubic in the number of points.
            let whole = DMatrix::from_diagonal(&covariance.own) + covariance.shared.transpose() * &covariance.shared;
            assert_relative_eq!(covariance.variances(), whole.diagonal(), max_relative = 1e-13);
            let e: DVector<f64> = noise(points, 1).column(0).into();
            let expected = whole.cholesky().unwrap().solve(&e);
            let solver = covariance.solver().unwrap();
            // The condition number is below 1e4: 1e-10 is far above the round-off.
            assert_relative_eq!(solver.solve(&e), expected, epsilon = 1e-10);
            assert_relative_eq!(solver.chi_square(&e), e.dot(&expected), max_relative = 1e-10);
        }
    }

    #[test]
    fn what_cannot_be_solved_is_not() {
        for own in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let own = DVector::from_vec(vec![1.0, own]);
            assert!(Covariance { own, shared: noise(1, 2) }.solver().is_none());
        }
        let own = DVector::from_vec(vec![1.0, 1.0]);
        let shared = DMatrix::from_element(1, 2, f64::NAN);
        assert!(Covariance { own, shared }.solver().is_none());
    }
}
