//! The least squares of fits: polynomials through what a model gives at the nodes of a box of parameters, the covariance of points,
//! estimates and profiles. `docs/src/theory/fits.md` has the formulas.

pub mod basis;
pub mod best;
mod datum;
pub mod emulator;
pub mod likelihood;
pub mod minimise;
pub mod profile;
pub mod scarce;

pub use datum::Datum;
