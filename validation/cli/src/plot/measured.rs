//! Measured points over the curves of runs.

use super::folders::Run;
use crate::Failure;
use shearbed::Plan;
use shearbed_validation::files::text::Shown;
use shearbed_validation::present::plot::{MEASURED, Points, names};
use shearbed_validation::serve::fit::data::{self, Reading};
use std::path::Path;

/// The points of a channel, with times in the unit of the runs, of which there is at least one, and with bars of one
/// standard uncertainty.
pub(super) fn points(path: &Path, runs: &[Run], channel: &str) -> Result<Points, Failure> {
    let at = |what: String| Failure::Input(format!("--data {}: {what}", path.shown()));
    let read = data::read(path, 0, &Reading::default())?;
    let unit = |run: &Run| {
        let plan = Plan::new(&run.scene).map_err(|error| at(error.to_string()))?;
        read.time.per_unit(&plan).ok_or_else(|| {
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
    let own: Vec<_> = read.points.iter().filter(|point| point.column == channel).collect();
    if own.is_empty() {
        let mut columns: Vec<_> = read.points.iter().map(|point| point.column.as_str()).collect();
        columns.dedup();
        return Err(at(format!("has no points of {channel}; it has {}, which --y takes", columns.join(", "))));
    }
    let each = |value: &dyn Fn(&shearbed_validation::methods::least_squares::Datum) -> f64| {
        own.iter().map(|point| value(point)).collect::<Vec<f64>>()
    };
    Ok(Points {
        label: names::channel(channel) + MEASURED,
        x: each(&|point| point.time / unit),
        y: each(&|point| point.value),
        x_error: own.iter().any(|point| point.u_time > 0.0).then(|| each(&|point| point.u_time / unit)),
        y_error: Some(each(&|point| point.u)),
    })
}
