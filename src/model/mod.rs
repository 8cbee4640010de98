//! The physics of the paper, each formula as a plain function: flow, directions, Jeffery's equation, contacts and
//! collisions, the control volume, nearest neighbours, random numbers.
//!
//! These modules use nothing else of the core; they know neither scenes nor runs. A formula is a function with its
//! equation number and its units; a kernel over many rods keeps the bits of the plain function beside it.

pub(crate) mod chunks;
pub mod collision;
pub mod contact;
pub(crate) mod diffusion;
pub mod flow;
pub(crate) mod gaussian;
pub mod jeffery;
pub(crate) mod neighbours;
pub mod orientation;
pub mod phase;
pub(crate) mod random;
pub mod shape;
pub mod stress;
pub(crate) mod volume;
pub(crate) mod widest;
pub mod work;
