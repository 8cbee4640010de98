//! The physics of the paper, each formula as a plain function: flow, directions, Jeffery's equation, contacts and collisions,
//! the control volume, nearest neighbours, random numbers. These modules do not depend on scenes.

pub(crate) mod chunks;
pub mod collision;
pub mod contact;
pub mod flow;
pub(crate) mod gaussian;
pub mod jeffery;
pub mod neighbours;
pub mod orientation;
pub mod phase;
pub mod random;
pub mod shape;
pub mod stress;
pub mod volume;
pub(crate) mod widest;
pub mod work;
