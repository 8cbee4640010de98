//! A measured point of a fit.

use serde::Serialize;

/// A measured point.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Datum {
    /// Which data set it is of.
    pub set: usize,
    /// Its line in the file.
    pub line: usize,
    /// The column, as `x1`.
    pub column: String,
    /// Its time in the unit of the file's column.
    pub time: f64,
    /// What was measured.
    pub value: f64,
    /// One standard deviation of the time; 0 where none is given.
    pub u_time: f64,
    /// One standard deviation of the value.
    pub u: f64,
}

impl Datum {
    /// A place where a point could be: without a line, a value and uncertainties.
    pub fn place(set: usize, column: &str, time: f64) -> Self {
        Self { set, line: 0, column: column.into(), time, value: f64::NAN, u_time: 0.0, u: f64::NAN }
    }
}
