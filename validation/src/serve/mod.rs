//! Tools for users: reference problems, grading, fits, sweeps. They may use `studies` and the modules below it.

pub mod fit;
pub mod grade;
pub mod problems;
pub mod sweep;
