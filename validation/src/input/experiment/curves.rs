//! Reads pairs of files into curves in the model's units, sorted by time.

use super::provenance::{Axis, Key, Layout, OBSERVABLES, Provenance};
use super::table::{self, DataRow, Dataset};
use super::{Measured, MeasuredCurve, Source, provenance_file, read_text};
use crate::files::FileError;
use crate::files::csv::{Table, not_allowed};
use crate::files::text::Shown;
use crate::input::scenes;
use std::collections::HashMap;
use std::path::Path;

/// The largest standard uncertainty of a time, in periods. Projections have the period T/2, so ± a quarter of T is one
/// whole oscillation: a point with a more uncertain time contains no information, but makes the model run for long.
const MOST_UNCERTAIN: f64 = 0.25;

/// Letters of a paper in a legend.
const LEGEND: usize = 80;

const TIME_UNCERTAINTY: &str =
    "one standard deviation of at most a quarter of a period: ± that spans a whole oscillation";

/// Reads the provenance file `path` and the CSV file of the same name beside it.
pub(super) fn read(path: &Path, source: &Source) -> Result<Vec<MeasuredCurve>, FileError> {
    let csv_path = path.with_extension("csv");
    if !csv_path.is_file() {
        let message = format!("it has no {} beside it", csv_path.shown());
        return Err(FileError::whole(path, message));
    }
    let mut provenance = provenance_file::parse(&path.display().to_string(), &read_text(path)?, source)?;
    let text = read_text(&csv_path)?;
    let datasets = match provenance.csv {
        Layout::WebPlotDigitizer => table::webplotdigitizer(&csv_path, &text)?,
        Layout::Columns => {
            let ys: Vec<_> = provenance.curves.iter().map(|key| column(&provenance, key)).collect();
            let x = provenance.x.quantity.column();
            let head = Table::new(&csv_path, text.as_bytes())?;
            provenance.unread = table::unread(&head, |name| name == x || ys.iter().any(|y| y == name))?;
            table::columns(&csv_path, &text, None, x, &ys)?
        }
    };
    let axis = &provenance.x;
    let period = |key: &Key| {
        scenes::scene(key.scene).map_or(f64::NAN, |scene| axis.quantity.per_period(scene.particles.aspect_ratio))
    };
    let shortest = provenance.curves.iter().map(period).fold(f64::INFINITY, f64::min);
    if axis.standard_uncertainty > MOST_UNCERTAIN * shortest {
        let message = format!(
            "x.standard_uncertainty = {} is not allowed: expected {TIME_UNCERTAINTY}, here {}",
            axis.standard_uncertainty,
            MOST_UNCERTAIN * shortest
        );
        return Err(FileError::whole(path, message));
    }
    let named = |dataset: &Dataset| format!("`{}`", dataset.name);
    let names = datasets.iter().map(named).collect::<Vec<_>>().join(", ");
    if datasets.len() != provenance.curves.len() {
        let message = format!(
            "{} datasets ({names}); the provenance file has {} [[curve]]: one for each is allowed",
            datasets.len(),
            provenance.curves.len()
        );
        return Err(FileError::line(&csv_path, 1, message));
    }
    let curve = |key: &Key| {
        let wanted = match provenance.csv {
            Layout::Columns => Some(column(&provenance, key)),
            Layout::WebPlotDigitizer => key.dataset.clone(),
        };
        // A name is needed only if there are several datasets.
        let only = wanted.is_none() && datasets.len() == 1;
        let dataset = datasets.iter().find(|dataset| only || Some(&dataset.name) == wanted.as_ref());
        let dataset = dataset.ok_or_else(|| {
            let wanted = wanted.unwrap_or_else(|| "missing".to_owned());
            let message = format!("curve.dataset = {wanted} is not allowed: {} has {names}", csv_path.shown());
            FileError::line(path, key.line as u64, message)
        })?;
        convert(&csv_path, key, dataset, &provenance)
    };
    provenance.curves.iter().map(curve).collect()
}

/// The name of the column of a curve in the project's layout.
fn column(provenance: &Provenance, key: &Key) -> String {
    OBSERVABLES[key.channel].to_owned() + provenance.y.quantity.suffix()
}

fn convert(file: &Path, key: &Key, dataset: &Dataset, provenance: &Provenance) -> Result<MeasuredCurve, FileError> {
    if dataset.rows.is_empty() {
        let message = format!("`{}` has no points", dataset.name);
        return Err(FileError::line(file, 1, message));
    }
    let mut seen = HashMap::new();
    for row in &dataset.rows {
        let columns = [provenance.x.quantity.column().to_owned(), column(provenance, key)];
        on_axis(file, row.line, ["x", &columns[0]], row.x, &provenance.x, row.u_x)?;
        on_axis(file, row.line, ["y", &columns[1]], row.y, &provenance.y, row.u_y)?;
        // 0 and −0 are the same number.
        let place = [row.x + 0.0, row.y + 0.0].map(f64::to_bits);
        if let Some(first) = seen.insert(place, row.line) {
            let message =
                format!("the point ({}, {}) is in line {first} already: each point once is allowed", row.x, row.y);
            return Err(FileError::line(file, row.line, message));
        }
    }
    let particles = scenes::scene(key.scene).map(|scene| scene.particles);
    // A test checks that the scenes of every source exist and are valid.
    let (aspect_ratio, length_mm) = particles.map_or((f64::NAN, f64::NAN), |p| (p.aspect_ratio, p.length_mm));
    let period = provenance.x.quantity.per_period(aspect_ratio);
    let most = MOST_UNCERTAIN * period;
    let vague = |row: &&DataRow| row.u_x.is_some_and(|u| u > most);
    if let Some(row) = dataset.rows.iter().find(vague) {
        let (name, u) = (provenance.x.quantity.column(), row.u_x.unwrap_or_default());
        let message = not_allowed(&format!("{name}_u"), &u.to_string(), &format!("{TIME_UNCERTAINTY}, here {most}"));
        return Err(FileError::line(file, row.line, message));
    }
    let length = provenance.y.quantity.per_length(length_mm);
    let point = |row: &DataRow| Measured {
        label: provenance.stated.short(LEGEND),
        observable: OBSERVABLES[key.channel],
        x: row.x / period,
        y: row.y / length,
        u_x: row.u_x.unwrap_or(provenance.x.standard_uncertainty) / period,
        u_y: row.u_y.unwrap_or(provenance.y.standard_uncertainty) / length,
    };
    let mut points: Vec<_> = dataset.rows.iter().map(point).collect();
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    Ok(MeasuredCurve { scene: key.scene, channel: key.channel, points, provenance: provenance.clone() })
}

/// Fails if a value is beyond the reference points by more than the reading uncertainty explains.
fn on_axis<Q>(
    file: &Path,
    line: u64,
    [name, column]: [&str; 2],
    value: f64,
    axis: &Axis<Q>,
    own: Option<f64>,
) -> Result<(), FileError> {
    let [least, most] = axis.uncertainties();
    if let Some(u) = own.filter(|u| !(least..=most).contains(u)) {
        let allowed = provenance_file::uncertainty(least, most);
        return Err(FileError::line(file, line, not_allowed(&format!("{column}_u"), &format!("{u:?}"), &allowed)));
    }
    let (least, most) = axis.range();
    let slack = 3.0 * own.unwrap_or(axis.standard_uncertainty);
    if (least - slack..=most + slack).contains(&value) {
        return Ok(());
    }
    let message = format!(
        "{name} = {value} is not allowed: the axis is calibrated from {least} to {most} (three standard uncertainties \
         beyond its ends are allowed)"
    );
    Err(FileError::line(file, line, message))
}
