//! Files of flows one after another, and of directions.

use shearbed::nalgebra::Vector3;
use shearbed_validation::files::FileError;
use shearbed_validation::files::csv::{FileTable, Row, Table};
use shearbed_validation::files::text::line;
use std::path::Path;

/// The largest number of flows, and of directions.
const MOST: usize = 10_000;

/// Gradients in 1/s, with durations in s.
type Flows = Vec<([[f64; 3]; 3], f64)>;

/// Reads flows: `duration_s` and `shear_rate_per_s` of u_2 = G x_1, or all of `l11` to `l33`.
pub(super) fn read(path: &Path) -> Result<Flows, FileError> {
    let table = Table::open(path)?;
    let gradient: Vec<String> = (0..9).map(|k| format!("l{}{}", k / 3 + 1, k % 3 + 1)).collect();
    let by_rate = table.place("shear_rate_per_s").is_some();
    let names = if by_rate { vec!["shear_rate_per_s".to_owned()] } else { gradient };
    let places: Option<Vec<usize>> = names.iter().map(|name| table.place(name)).collect();
    let (Some(duration), Some(places), true) =
        (table.place("duration_s"), places, table.names().len() == names.len() + 1)
    else {
        let allowed = "allowed are duration_s,shear_rate_per_s, or duration_s,l11,l12,l13,l21,l22,l23,l31,l32,l33";
        return Err(other_columns(&table, allowed));
    };
    each(table, "flow", |row| {
        let mut values = Vec::new();
        for place in &places {
            let rate = row.finite(*place)?;
            if rate != 0.0 && !(1e-100..=1e100).contains(&rate.abs()) {
                return Err(row.refused(*place, "0 or a number with a size from 1e-100 to 1e100"));
            }
            values.push(rate);
        }
        let mut gradient = [[0.0; 3]; 3];
        match values[..] {
            [rate] => gradient[1][0] = rate,
            _ => gradient.as_flattened_mut().copy_from_slice(&values),
        }
        Ok((gradient, row.positive(duration, "a finite number > 0")?))
    })
}

/// Reads directions: `p1`, `p2` and `p3` of any length above 0.
pub(super) fn directions(path: &Path) -> Result<Vec<[f64; 3]>, FileError> {
    let table = Table::open(path)?;
    let [Some(first), Some(second), Some(third)] = ["p1", "p2", "p3"].map(|name| table.place(name)) else {
        return Err(other_columns(&table, "p1, p2 and p3 are needed"));
    };
    each(table, "direction", |row| {
        let p = Vector3::new(row.finite(first)?, row.finite(second)?, row.finite(third)?);
        // Squares of the components may overflow, or be 0.
        let unit = (p.amax() > 0.0).then(|| (p / p.amax()).normalize());
        Ok(unit.ok_or_else(|| row.error("p has no direction; a length above 0 is needed"))?.into())
    })
}

fn other_columns(table: &FileTable, allowed: &str) -> FileError {
    table.error(format!("the columns are {}; {allowed}", line(&table.names().join(","))))
}

/// What `of` reads in each row: one at least, and [`MOST`] at most.
fn each<T>(
    mut table: FileTable,
    what: &str,
    of: impl Fn(&Row<'_>) -> Result<T, FileError>,
) -> Result<Vec<T>, FileError> {
    let mut all = Vec::new();
    while let Some(row) = table.next_row()? {
        all.push(of(&row)?);
        if all.len() > MOST {
            return Err(row.error(format!("more than {MOST} {what}s; at most {MOST} are allowed")));
        }
    }
    if all.is_empty() { Err(table.error(format!("no {what}: a row each is needed"))) } else { Ok(all) }
}
