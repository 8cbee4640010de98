//! The records of the studies as files.

use super::order::{Convergence, Halving};
use super::{Bench, Point};
use crate::present::table::{Column, ReportTable, field};
use crate::studies::integrators::Errors;

/// The four errors of a run that ended, as columns.
fn errors<'a, R>(of: impl Fn(&R) -> Option<Errors> + Copy + 'a) -> [Column<'a, R>; 4] {
    [
        field("orientation_error_rad", move |r| of(r).map(|e| e.orientation_rad)),
        field("orbit_constant_error", move |r| of(r).map(|e| e.orbit_constant)),
        field("phase_error_turns", move |r| of(r).map(|e| e.phase_turns)),
        field("length_error", move |r| of(r).map(|e| e.length)),
    ]
}

/// bench.csv.
pub fn bench_csv(benches: &[Bench]) -> Result<String, String> {
    type Row<'a> = (&'a Bench, &'a str, &'a Point);
    let points = benches.iter().flat_map(|bench| {
        let curves = bench.curves.iter();
        curves.flat_map(move |c| c.points.iter().map(move |point| (bench, c.subject.as_str(), point)))
    });
    let mut columns: Vec<Column<Row>> = vec![
        field("case", |r: &Row| r.0.name.as_str()),
        field("aspect_ratio", |r: &Row| r.0.aspect_ratio),
        field("subject", |r: &Row| r.1),
        field("steps", |r: &Row| r.2.setting.steps().ok()),
        field("tolerance", |r: &Row| r.2.setting.tolerance().ok()),
        field("status", |r: &Row| r.2.failure.as_deref().unwrap_or("ok")),
        field("seconds_min", |r: &Row| r.2.seconds.least),
        field("seconds_max", |r: &Row| r.2.seconds.most),
        field("measurements", |r: &Row| r.2.seconds.measurements),
    ];
    columns.extend(errors(|r: &Row| r.2.errors));
    ReportTable::new(["bench", ""], "", points, columns).csv()
}

/// converge.csv of a free scene.
pub fn orders_csv(studies: &[Convergence]) -> Result<String, String> {
    type Row<'a> = (&'a Convergence, &'a Halving);
    let halvings = (studies.iter()).flat_map(|study| study.halvings.iter().map(move |h| (study, h)));
    let mut columns: Vec<Column<Row>> = vec![
        field("subject", |r: &Row| r.0.subject.as_str()),
        field("theory", |r: &Row| r.0.theory),
        field("steps", |r: &Row| r.1.steps),
    ];
    columns.extend(errors(|r: &Row| r.1.errors));
    columns.push(field("observed_order", |r: &Row| r.1.order));
    ReportTable::new(["converge", ""], "", halvings, columns).csv()
}
