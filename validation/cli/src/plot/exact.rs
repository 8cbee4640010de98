//! Exact curves over those of runs.

use crate::Failure;
use shearbed_validation::files::bounded;
use shearbed_validation::files::csv::Table;
use shearbed_validation::files::text::Shown;
use shearbed_validation::present::plot::{Curve, REFERENCE, names};
use std::io::BufReader;
use std::path::Path;

use super::table::MOST_ROWS;

/// The channels in a table of `shearbed reference` that has the column `time`, each against it.
pub(super) fn curves(path: &Path, time: &str, channels: &[String]) -> Result<Vec<Curve>, Failure> {
    let at = |what: String| Failure::Input(format!("--reference {}: {what}", path.shown()));
    let file = bounded::open(path).map_err(|error| at(format!("cannot be read: {error}")))?;
    let mut table = Table::new(path, BufReader::new(file))?;
    let known = table.names().join(", ");
    let place = |name: &str| {
        table.place(name).ok_or_else(|| at(format!("has no column {name}, which the picture needs; it has {known}")))
    };
    let x = place(time)?;
    let y = channels.iter().map(|channel| place(channel)).collect::<Result<Vec<_>, _>>()?;
    let mut curves: Vec<Curve> = (channels.iter())
        .map(|channel| Curve { label: names::channel(channel) + REFERENCE, ..Curve::default() })
        .collect();
    let mut rows = 0;
    while let Some(row) = table.next_row()? {
        rows += 1;
        if rows > MOST_ROWS {
            return Err(row.error(format!("more than {MOST_ROWS} rows for one picture; fewer are allowed")).into());
        }
        for (curve, y) in curves.iter_mut().zip(&y) {
            curve.x.push(row.finite(x)?);
            curve.y.push(row.finite(*y)?);
        }
    }
    Ok(curves)
}
