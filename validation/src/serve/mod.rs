//! Tools for others: reference problems, grading, fits, sweeps. It may use `studies` and what is below.

pub mod fit;
pub mod grade;
pub mod problems;
pub mod sweep;
