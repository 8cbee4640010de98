//! The validation suite of shearbed: cases with tolerances and controls, the oracles that judge the core,
//! the report, reference problems, grading and fits. Each part may use those before it.
#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

pub mod files;
pub mod input;
pub mod judge;
pub mod present;
pub mod studies;
pub mod serve;
pub mod cases;

pub use shearbed_methods as methods;
pub use shearbed_oracle as oracle;
