//! From measured points to a model's parameters: estimate, intervals, goodness of fit, and what limits them.
//!
//! The model runs at the nodes of a box of parameters, with the same random numbers at each; polynomials run through what is
//! found there, and generalised least squares through those. The covariance of the points holds reading off in both axes,
//! the measured rods, the model's replicas and the polynomials' lack of fit. `docs/src/theory/fits.md` has the formulas.

pub mod basis;
mod best;
pub mod budget;
pub mod data;
pub mod design;
pub mod elsewhere;
pub mod emulator;
#[cfg(test)]
mod feigned;
pub mod likelihood;
mod minimise;
pub mod pictures;
pub mod profile;
mod range;
pub mod report;
mod scarce;
#[cfg(test)]
mod scarce_tests;
pub mod scenes;
pub mod search;
pub mod terminal;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod valleys;

pub use range::Range;
