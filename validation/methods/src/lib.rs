//! What the suite of shearbed computes with, and what it grades beside other programs: integrators of a free rod's motion, closures
//! and models of orientation tensors, rods that diffuse, and the least squares of fits. A crate of its own, because it is optimised
//! and the suite is not.
//!
//! None of this judges the simulator: that is the oracles'.

pub mod coefficients;
pub mod integrators;
pub mod least_squares;
pub mod projections;
pub mod tensors;
pub mod textbook;
