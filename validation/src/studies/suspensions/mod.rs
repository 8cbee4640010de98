//! Suspensions. For free ones: error against run time. For interacting ones: how the mean depends on steps, rods and
//! replicas, the cost of a given error, and which coupled estimates pay. Results are plain data; the
//! studies are `free_study` and `interacting`.

pub(crate) mod blocks;
pub(crate) mod coupled;
pub(crate) mod fit;
pub(crate) mod free;
pub(crate) mod free_study;
pub mod interacting;
pub mod job;
pub mod law;
pub mod law_tables;
pub mod split;

use super::*;
