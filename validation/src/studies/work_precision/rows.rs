//! The records of the study as rows of CSV: the fields' names are the columns' names.

use super::order::{Convergence, Halving};
use super::{Bench, IntegratorCurve, Point};
use crate::methods::integrators::Errors;
use crate::present::table::rows_csv;
use serde::Serialize;

/// A row of bench.csv.
#[derive(Default, Serialize)]
struct BenchRow<'a> {
    case: &'a str,
    aspect_ratio: f64,
    subject: &'a str,
    steps: Option<u64>,
    tolerance: Option<f64>,
    status: &'a str,
    seconds_min: f64,
    seconds_max: f64,
    measurements: usize,
    orientation_error_rad: Option<f64>,
    orbit_constant_error: Option<f64>,
    phase_error_turns: Option<f64>,
    length_error: Option<f64>,
}

/// The content of bench.csv.
pub fn bench_csv(benches: &[Bench]) -> Result<String, String> {
    let row = |bench, curve, point| -> BenchRow {
        let (bench, curve, point): (&Bench, &IntegratorCurve, &Point) = (bench, curve, point);
        let [orientation_error_rad, orbit_constant_error, phase_error_turns, length_error] =
            parts(point.errors);
        BenchRow {
            case: &bench.name,
            aspect_ratio: bench.aspect_ratio,
            subject: &curve.subject,
            steps: point.setting.steps().ok(),
            tolerance: point.setting.tolerance().ok(),
            status: point.failure.as_deref().unwrap_or("ok"),
            seconds_min: point.seconds.least,
            seconds_max: point.seconds.most,
            measurements: point.seconds.measurements,
            orientation_error_rad,
            orbit_constant_error,
            phase_error_turns,
            length_error,
        }
    };
    let curves = benches.iter().flat_map(|bench| bench.curves.iter().map(move |curve| (bench, curve)));
    rows_csv(curves.flat_map(|(bench, curve)| curve.points.iter().map(move |point| row(bench, curve, point))))
}

/// A row of converge.csv of a free scene.
#[derive(Default, Serialize)]
struct OrderRow<'a> {
    subject: &'a str,
    theory: u32,
    steps: u64,
    orientation_error_rad: Option<f64>,
    orbit_constant_error: Option<f64>,
    phase_error_turns: Option<f64>,
    length_error: Option<f64>,
    observed_order: Option<f64>,
}

/// The content of converge.csv for a free scene.
pub fn orders_csv(studies: &[Convergence]) -> Result<String, String> {
    let row = |study, halving| -> OrderRow {
        let (study, halving): (&Convergence, &Halving) = (study, halving);
        let [orientation_error_rad, orbit_constant_error, phase_error_turns, length_error] =
            parts(halving.errors);
        OrderRow {
            subject: &study.subject,
            theory: study.theory,
            steps: halving.steps,
            orientation_error_rad,
            orbit_constant_error,
            phase_error_turns,
            length_error,
            observed_order: halving.order,
        }
    };
    rows_csv((studies.iter()).flat_map(|study| study.halvings.iter().map(move |halving| row(study, halving))))
}

/// The four errors of a run that ended.
fn parts(errors: Option<Errors>) -> [Option<f64>; 4] {
    errors.map_or([None; 4], |e| [e.orientation_rad, e.orbit_constant, e.phase_turns, e.length].map(Some))
}
