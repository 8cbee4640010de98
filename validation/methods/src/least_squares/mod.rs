//! The least squares of fits: polynomials fitted to the model at the nodes of a box of parameters, the covariance of
//! points, estimates and profiles. The formulas are in `docs/src/theory/fits.md`.

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
