//! Orientation tensors as the field computes them: closures of the fourth moments, models of a_ij's rate, and their
//! integration.
//!
//! This code is graded, by published values and by the exact distribution; no oracle uses it.
//! a is symmetric with trace 1; axes are as everywhere in this project, 1 = gradient, 2 = flow in shear.

pub mod fourth;
pub mod closures;
pub mod ibof;
mod integrate;
pub mod models;
mod natural;
pub mod orthotropic;
mod polynomials;
pub mod second;
pub mod wrong;

#[cfg(test)]
mod tests;

pub use closures::Closure;
pub use fourth::Fourth;
pub use integrate::{at, at_rate, steady, steady_of};
pub use models::{Equation, Model, Parts, shear_rate};

/// An initial a_ij with three distinct axes, which some models, and ORW, need.
pub const APART: [[f64; 3]; 3] = [[0.1875, 0.125, 0.0], [0.125, 0.5, 0.0], [0.0, 0.0, 0.3125]];

/// a_ij of isotropic directions.
pub fn isotropic() -> nalgebra::Matrix3<f64> {
    nalgebra::Matrix3::identity() / 3.0
}
