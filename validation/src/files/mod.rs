//! Reading and writing: a bounded reader, the rule for overwriting, checkpoints, ranks of an MPI job. This module depends on the core's
//! scenes, but on no other physics.

pub mod bounded;
pub mod build;
pub mod checkpoint;
pub mod cluster;
pub(crate) mod difference;
pub mod output;
pub(crate) mod text;
