//! A measured point of a fit.

use serde::Serialize;

/// A measured point.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Datum {
    /// Index of its data set.
    pub set: usize,
    /// Line number in the file.
    pub line: usize,
    /// Name of the column, such as `x1`.
    pub column: String,
    /// Time in the unit of the file's time column.
    pub time: f64,
    /// The measured value.
    pub value: f64,
    /// One standard deviation of the time; 0 if none is given.
    pub u_time: f64,
    /// One standard deviation of the value.
    pub u: f64,
}

impl Datum {
    /// A possible point, without line, value and uncertainties.
    pub fn place(set: usize, column: &str, time: f64) -> Self {
        Self { set, line: 0, column: column.into(), time, value: f64::NAN, u_time: 0.0, u: f64::NAN }
    }
}
