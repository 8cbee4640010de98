//! Numerical methods of the validation suite: integrators of a free rod's motion, closures and models of orientation
//! tensors, rods that diffuse, and the least squares of fits. Some of them are graded beside other programs. They form
//! a crate of their own because it is optimised and the suite is not.
//!
//! Nothing here judges the simulator; that is done by the oracles.

pub mod coefficients;
pub mod contact;
pub mod derived;
pub mod integrators;
pub mod interpolate;
pub mod least_squares;
pub mod least_work;
pub mod projections;
pub mod stages;
pub mod starts;
pub mod tensors;
pub mod textbook;
pub mod turning;
