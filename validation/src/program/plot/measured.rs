//! Measured points over the curves of runs.

use super::folders::Run;
use crate::files::text::Shown;
use crate::present::plot::{MEASURED, Points, names};
use crate::program::Failure;
use crate::serve::fit::data;
use shearbed::Plan;
use std::path::Path;

/// The points of a channel, with times in the unit of the runs, and with bars of one standard uncertainty.
pub(super) fn points(path: &Path, run: &Run, channel: &str) -> Result<Points, Failure> {
    let at = |what: String| Failure::Input(format!("--data {}: {what}", path.shown()));
    let read = data::read(path, 0).map_err(|error| Failure::Input(error.to_string()))?;
    let plan = Plan::new(&run.scene).map_err(|error| at(error.to_string()))?;
    let unit = read.time.per_unit(&plan).ok_or_else(|| {
        at(format!("{} has no periods; t_s or strain are allowed in place of t_over_T", run.dir.shown()))
    })?;
    let own: Vec<_> = read.points.iter().filter(|point| point.column == channel).collect();
    if own.is_empty() {
        let mut columns: Vec<_> = read.points.iter().map(|point| point.column.as_str()).collect();
        columns.dedup();
        return Err(at(format!(
            "has no points of {channel}; it has {}, which --y takes",
            columns.join(", ")
        )));
    }
    let each = |value: &dyn Fn(&crate::methods::least_squares::Datum) -> f64| {
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
