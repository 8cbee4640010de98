//! From measured points to a model's parameters: estimate, intervals, goodness of fit, and what limits them.
//!
//! The model runs at the nodes of a box of parameters, with the same random numbers at each; polynomials interpolate
//! the results, and generalised least squares fits them. The covariance of the points includes reading errors in both
//! axes, the measured rods, the model's replicas and the polynomials' lack of fit. `docs/src/theory/fits.md` has the
//! formulas.

mod answer;
pub mod budget;
pub mod contents;
pub mod data;
pub mod design;
pub mod digits;
pub mod elsewhere;
pub mod error;
mod hypothesis;
pub mod pictures;
mod range;
pub mod report;
pub mod runs;
pub mod samples;
pub mod scenes;
pub mod search;
#[cfg(test)]
mod tests;

pub use hypothesis::{Difference, Hypothesis, LEAST_P, Tested};
pub use range::Range;
