//! Measured points over the curves of runs.

use super::Drawn;
use super::folders::Run;
use crate::{Failure, scene};
use shearbed::Plan;
use shearbed_validation::files::text::Shown;
use shearbed_validation::input::experiment::not_read;
use shearbed_validation::methods::least_squares::Datum;
use shearbed_validation::present::plot::{MEASURED, Points, WITHOUT_BARS, names};
use shearbed_validation::serve::fit::data::{self, Reading, TimeColumn};
use std::path::Path;

/// The points of each channel that was measured, with times in the unit of the axis, and with bars of one standard
/// uncertainty if all points have one; `columns` replace the names of the file's.
pub(super) fn points(path: &Path, columns: Option<&Vec<String>>, drawn: &Drawn) -> Result<Vec<Points>, Failure> {
    let Drawn { runs, channels, time, .. } = drawn;
    let at = |what: String| Failure::Input(format!("--data {}: {what}", path.shown()));
    let read = data::read(path, 0, &Reading { columns: columns.cloned(), u: None, without_u: true })?;
    scene::warn("--data", &not_read(path, &read.unread).into_iter().collect::<Vec<_>>());
    let unit = |run: &Run| {
        let plan = Plan::new(&run.scene).map_err(|error| at(error.to_string()))?;
        let axis = match time.as_str() {
            "time_s" => TimeColumn::Seconds,
            "strain" => TimeColumn::Strain,
            _ => TimeColumn::Periods,
        };
        // Points have no periods where the scene has none, and then the axis has none either.
        let unit = read.time.per_unit(&plan).map(|own| own / axis.per_unit(&plan).unwrap_or(1.0));
        unit.ok_or_else(|| {
            at(format!("{} has no periods; t_s or strain are allowed in place of t_over_T", run.dir.shown()))
        })
    };
    let units = runs.iter().map(unit).collect::<Result<Vec<f64>, _>>()?;
    let unit = units[0];
    // Every run has the same axis, in its own unit of time.
    if let Some(k) = units.iter().position(|other| (other / unit - 1.0).abs() > 1e-9) {
        return Err(at(format!(
            "a point at one {} stands at different places of the curves: a unit of their axis is {unit} in {} and {} \
             in {}; draw them one by one, or give the points' times in the unit of the axis",
            read.time.name(),
            runs[0].label,
            units[k],
            runs[k].label
        )));
    }
    let of_channel = |channel: &String| {
        let own: Vec<_> = read.points.iter().filter(|point| point.column == *channel).collect();
        let each = |value: fn(&Datum) -> f64| own.iter().map(|point| value(point)).collect::<Vec<f64>>();
        let in_units = |value: fn(&Datum) -> f64| each(value).into_iter().map(|time| time / unit).collect();
        let has_u = own.iter().all(|point| point.u.is_finite());
        Points {
            label: names::channel(channel) + if has_u { MEASURED } else { WITHOUT_BARS },
            x: in_units(|point| point.time),
            y: each(|point| point.value),
            x_error: own.iter().any(|point| point.u_time > 0.0).then(|| in_units(|point| point.u_time)),
            y_error: has_u.then(|| each(|point| point.u)),
        }
    };
    let mut found: Vec<Points> = channels.iter().map(of_channel).collect();
    found.retain(|points| !points.x.is_empty());
    if found.is_empty() {
        let mut columns: Vec<_> = read.points.iter().map(|point| point.column.as_str()).collect();
        columns.dedup();
        let (channels, columns) = (channels.join(", "), columns.join(", "));
        return Err(at(format!("has no points of {channels}; it has {columns}, which --y takes")));
    }
    Ok(found)
}
