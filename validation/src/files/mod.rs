//! Reading and writing: one bounded reader, one rule for what may be overwritten, checkpoints, ranks of an MPI job. It knows scenes
//! as the core has them, and nothing of physics beyond.

pub mod bounded;
pub mod build;
pub mod checkpoint;
pub mod cluster;
pub(crate) mod difference;
pub mod output;
pub(crate) mod text;
