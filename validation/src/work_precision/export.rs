//! The studies as files, and tables as text.

use super::order::Study;
use super::{Bench, Point};
use crate::build::{BUILD, Build};
use crate::report::ReportTable;
use serde::Serialize;

/// A row of bench.csv.
#[derive(Serialize)]
struct Row<'a> {
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

/// A row of converge.csv for a free scene.
#[derive(Serialize)]
struct HalvingRow<'a> {
    subject: &'a str,
    theory: u32,
    steps: u64,
    orientation_error_rad: Option<f64>,
    orbit_constant_error: Option<f64>,
    phase_error_turns: Option<f64>,
    length_error: Option<f64>,
    observed_order: Option<f64>,
}

/// bench.csv.
pub fn bench_csv(benches: &[Bench]) -> Result<String, String> {
    let mut rows = Vec::new();
    for bench in benches {
        for curve in &bench.curves {
            rows.extend(curve.points.iter().map(|point| row(bench, &curve.subject, point)));
        }
    }
    csv(rows)
}

fn row<'a>(bench: &'a Bench, subject: &'a str, point: &'a Point) -> Row<'a> {
    Row {
        case: &bench.name,
        aspect_ratio: bench.aspect_ratio,
        subject,
        steps: point.setting.steps().ok(),
        tolerance: point.setting.tolerance().ok(),
        status: point.failure.as_deref().unwrap_or("ok"),
        seconds_min: point.seconds.least,
        seconds_max: point.seconds.most,
        measurements: point.seconds.measurements,
        orientation_error_rad: point.errors.map(|errors| errors.orientation_rad),
        orbit_constant_error: point.errors.map(|errors| errors.orbit_constant),
        phase_error_turns: point.errors.map(|errors| errors.phase_turns),
        length_error: point.errors.map(|errors| errors.length),
    }
}

/// converge.csv of a free scene.
pub fn orders_csv(studies: &[Study]) -> Result<String, String> {
    let rows = studies.iter().flat_map(|study| {
        study.halvings.iter().map(|halving| HalvingRow {
            subject: &study.subject,
            theory: study.theory,
            steps: halving.steps,
            orientation_error_rad: halving.errors.map(|errors| errors.orientation_rad),
            orbit_constant_error: halving.errors.map(|errors| errors.orbit_constant),
            phase_error_turns: halving.errors.map(|errors| errors.phase_turns),
            length_error: halving.errors.map(|errors| errors.length),
            observed_order: halving.order,
        })
    });
    csv(rows)
}

/// Rows as CSV, with a head.
pub(crate) fn csv(rows: impl IntoIterator<Item = impl Serialize>) -> Result<String, String> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for row in rows {
        writer.serialize(row).map_err(|error| error.to_string())?;
    }
    let bytes = writer.into_inner().map_err(|error| error.to_string())?;
    String::from_utf8(bytes).map_err(|error| error.to_string())
}

/// Benches as the field of a record.
#[derive(Serialize)]
pub struct Benches<'a, T> {
    /// All of them.
    pub benches: &'a [T],
}

/// A record with the build that made it.
#[derive(Serialize)]
struct Made<'a, T> {
    #[serde(flatten)]
    build: Build,
    #[serde(flatten)]
    data: &'a T,
}

/// Any structure as JSON, after the build that made it.
pub fn json(data: &impl Serialize) -> Result<String, String> {
    let made = Made { build: BUILD, data };
    let text = serde_json::to_string_pretty(&made).map_err(|error| error.to_string())?;
    Ok(text + "\n")
}

/// A table for the terminal: its title, columns of even width, and what to see.
pub fn text(table: &ReportTable) -> String {
    let lines = || std::iter::once(&table.columns).chain(&table.rows);
    let width = |column: usize| {
        let cells = lines().filter_map(|cells| cells.get(column));
        cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
    };
    let widths: Vec<_> = (0..table.columns.len()).map(width).collect();
    let mut text = format!("{}\n\n", table.title);
    for cells in lines() {
        let padded = cells
            .iter()
            .zip(&widths)
            .map(|(cell, width)| format!("{cell:<width$}  "));
        text.push_str(padded.collect::<String>().trim_end());
        text.push('\n');
    }
    format!("{text}\n{}\n\n", table.caption)
}
