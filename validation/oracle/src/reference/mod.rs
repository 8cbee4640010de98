//! Exact values without a simulation, to the digits that a double holds: one free rod, and rods that are isotropic at t = 0.
//!
//! Computed with 100 bits and more; inputs are doubles and are taken as exact. Nothing here uses the core.

pub mod big;
pub mod constants;
pub mod diffusing;
pub mod isotropic;
pub mod motion;
pub mod rod;
pub mod table;
pub mod unequal;
