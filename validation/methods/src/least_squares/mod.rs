//! The least squares of fits: polynomials fitted to the model at the nodes of a box of parameters, the covariance of
//! points, estimates and profiles. The formulas are in `docs/src/theory/fits.md`.

pub mod bartlett;
pub mod basis;
pub mod best;
mod datum;
pub mod direct;
pub mod emulator;
pub mod likelihood;
pub mod minimise;
pub mod profile;
pub mod scarce;

pub use datum::Datum;

use nalgebra::{DMatrix, DVector};

/// How much of each column explains what is found, and the length of what that leaves.
pub fn by_svd(columns: &[DVector<f64>], found: &DVector<f64>) -> Option<(DVector<f64>, f64)> {
    let columns = DMatrix::from_columns(columns);
    let off = columns.clone().svd(true, true).solve(found, 0.0).ok()?;
    let left = (found - columns * &off).norm();
    Some((off, left))
}
