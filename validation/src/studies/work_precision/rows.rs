//! The records of the study as CSV.

use super::order::{Convergence, Halving};
use super::*;

/// A run of a bench: its bench, curve and point.
type Row<'a> = (&'a Bench, &'a IntegratorCurve, &'a Point);

/// The content of bench.csv.
pub fn bench_csv(benches: &[Bench]) -> Result<String, String> {
    columns_csv(bench_rows(benches), bench_columns())
}

/// The same with the evaluations of each run.
pub fn runs_csv(benches: &[Bench]) -> Result<String, String> {
    let mut columns = bench_columns();
    columns.push(field("evaluations", |r: &Row| r.2.evaluations));
    columns_csv(bench_rows(benches), columns)
}

fn bench_rows(benches: &[Bench]) -> impl Iterator<Item = Row<'_>> {
    let curves = benches.iter().flat_map(|bench| bench.curves.iter().map(move |curve| (bench, curve)));
    curves.flat_map(|(bench, curve)| curve.points.iter().map(move |point| (bench, curve, point)))
}

fn bench_columns<'a>() -> Vec<Column<'a, Row<'a>>> {
    let mut columns = vec![
        words("case", |r: &Row| r.0.name.clone()),
        field("aspect_ratio", |r: &Row| r.0.aspect_ratio),
        words("integrator", |r: &Row| r.1.integrator.clone()),
        field("steps", |r: &Row| r.2.setting.steps().ok()),
        field("tolerance", |r: &Row| r.2.setting.tolerance().ok()),
        words("status", |r: &Row| r.2.failure.clone().unwrap_or("ok".into())),
    ];
    columns.extend(seconds(|r: &Row| r.2.seconds));
    columns.extend(errors(|r: &Row| r.2.errors));
    columns
}

/// The content of converge.csv for a free scene.
pub fn orders_csv(studies: &[Convergence]) -> Result<String, String> {
    type Row<'a> = (&'a Convergence, &'a Halving);
    let rows = studies.iter().flat_map(|study| study.halvings.iter().map(move |halving| (study, halving)));
    let mut columns = vec![
        words("integrator", |r: &Row| r.0.integrator.clone()),
        field("theory", |r: &Row| r.0.theory),
        field("steps", |r: &Row| r.1.steps),
    ];
    columns.extend(errors(|r: &Row| r.1.errors));
    columns.push(field("observed_order", |r: &Row| r.1.order));
    columns_csv(rows, columns)
}

/// The columns of a run time.
pub(crate) fn seconds<'a, R>(of: impl Fn(&R) -> Seconds + Copy + 'a) -> [Column<'a, R>; 3] {
    [
        field("seconds_min", move |row| of(row).least),
        field("seconds_max", move |row| of(row).most),
        field("measurements", move |row| of(row).measurements),
    ]
}

/// The columns of the errors of a run, empty if it failed and where they are undefined.
fn errors<'a, R>(of: impl Fn(&R) -> Option<Errors> + Copy + 'a) -> [Column<'a, R>; 4] {
    [
        field("orientation_error_rad", move |row| of(row).map(|errors| errors.orientation_rad)),
        field("orbit_constant_error", move |row| of(row).map(|errors| errors.orbit_constant).filter(|x| x.is_finite())),
        field("phase_error_turns", move |row| of(row).map(|errors| errors.phase_turns).filter(|x| x.is_finite())),
        field("length_error", move |row| of(row).map(|errors| errors.length).filter(|x| x.is_finite())),
    ]
}
