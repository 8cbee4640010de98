//! Exact values without a simulation, to the digits of a double: for one free rod, and for rods that are isotropic at t
//! = 0.
//!
//! They are computed with 100 bits and more; inputs are doubles, taken as exact. Nothing here uses the core.

pub mod big;
pub mod constants;
pub mod diffusing;
pub mod isotropic;
pub mod motion;
mod planar;
pub mod rod;
pub mod second;
pub mod table;
mod twofold;
pub mod unequal;
