//! The core in the corners of plane Couette flow, as a table.

use super::corners::{self, Worst};
use super::map::{self, ASPECT_RATIOS};
use super::maps::ratio;
use crate::present::table::{ReportTable, number};

/// The worst at each aspect ratio.
pub fn table() -> ReportTable {
    type Row = (f64, Worst);
    let one = |x: f64| format!("{x:.1}");
    ReportTable::new(
        ["stability-core", "The core in the corners of plane Couette flow"],
        format!(
            "The worst over G = 10⁻³⁰, ½ and 10³⁰ 1/s, {} durations from 10⁻⁹ to 10⁸ periods, and {} starts: both poles, \
             the flip, C = 0, 10⁻³⁰⁰, 10³⁰⁰, ∞. ε = 2.2·10⁻¹⁶. Bounds: 4 ε, 8 ε, and 1.",
            corners::TURNS.len(),
            map::places(2.0).len()
        ),
        ASPECT_RATIOS.map(|r| (r, corners::worst(r, &corners::exact))),
        vec![
            number("r_e", ratio, |row: &Row| row.0),
            number("||p| − 1| / ε", one, |row: &Row| row.1.length / f64::EPSILON),
            number("change of C_b / ε", one, |row: &Row| row.1.orbit / f64::EPSILON),
            number("angle to the closed form over its bound", |x| format!("{x:.2}"), |row: &Row| row.1.angle),
        ],
    )
}
