//! The CSV file of measured points, in the project's columns or as WebPlotDigitizer exports it.

use crate::files::FileError;
use crate::files::csv::{self, LEFT_OUT, Row, Rows, Table};
use std::io::BufRead;
use std::path::Path;

/// Points of one column or dataset, in the units of the file.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Dataset {
    /// Name of the column or dataset; empty for an export of two columns.
    pub(crate) name: String,
    pub(crate) rows: Vec<DataRow>,
}

/// One point, in the units of the file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct DataRow {
    pub(crate) line: u64,
    pub(crate) x: f64,
    pub(crate) y: f64,
    /// Uncertainties of this point, if the file states them.
    pub(crate) u_x: Option<f64>,
    pub(crate) u_y: Option<f64>,
}

/// The largest number of lines of a file: more than the points of any figure; a comparison then takes half a minute.
const MOST_LINES: u64 = 20_000;

/// The columns that are neither `known` nor uncertainties `NAME_u` of these; they are not read.
///
/// # Errors
///
/// A column that looks like a misspelt one of them.
pub(crate) fn unread<R: BufRead>(table: &Table<R>, known: impl Fn(&str) -> bool) -> Result<Vec<String>, FileError> {
    let is_read = |name: &str| name == LEFT_OUT || known(name.strip_suffix("_u").unwrap_or(name));
    let unread: Vec<String> = table.names().iter().filter(|name| !is_read(name)).cloned().collect();
    match unread.iter().find_map(|name| Some((name, misnamed(name, &known)?))) {
        Some((name, why)) => Err(table.error(format!("column `{name}`: {why}"))),
        None => Ok(unread),
    }
}

/// Why a column with a name like a known one's is refused, and what to do; `None` if it may be anything.
fn misnamed(name: &str, known: impl Fn(&str) -> bool) -> Option<String> {
    let lower = name.to_lowercase();
    if lower != name && known(&lower) {
        return Some(format!("columns have small letters: rename it `{lower}`"));
    }
    let (value, suffix) = name.rsplit_once('_')?;
    let value = Some(value.strip_suffix("_u").unwrap_or(value)).filter(|value| known(value))?;
    match suffix {
        "plus" | "minus" | "upper" | "lower" | "low" | "high" => Some(format!(
            "errors that differ above and below are not fitted: give one standard deviation, {value}_u, the mean of \
             both"
        )),
        "se" | "err" | "error" | "sd" | "std" | "sigma" | "uncertainty" => Some(format!(
            "a measured value's standard uncertainty is named `{value}_u`; rename the column if that is what it has"
        )),
        _ => None,
    }
}

/// Reads the project's columns: `x`, each of `ys`, and their uncertainties `NAME_u` if given. A `y` that is
/// blank or NaN was not measured; for such an uncertainty that of the provenance file applies.
///
/// Other columns are not read. `given` are names in place of those in the file.
pub(crate) fn columns(
    path: &Path,
    text: &str,
    given: Option<&[String]>,
    x: &str,
    ys: &[String],
) -> Result<Vec<Dataset>, FileError> {
    let mut table = Table::named(path, text.as_bytes(), given)?;
    let places = |name: &str| {
        let missing = || table.error(format!("column {name} is missing: the provenance file says that it is there"));
        Ok((table.place(name).ok_or_else(missing)?, table.place(&format!("{name}_u"))))
    };
    let (x_place, u_x_place) = places(x)?;
    let y_places = ys.iter().map(|y| places(y)).collect::<Result<Vec<_>, FileError>>()?;
    let mut datasets: Vec<_> = ys.iter().map(|y| Dataset { name: y.clone(), rows: Vec::new() }).collect();
    while let Some(row) = table.next_row()? {
        if row.line > MOST_LINES {
            return Err(row.error(format!("more than {MOST_LINES} lines; at most {MOST_LINES} are allowed")));
        }
        if y_places.iter().all(|(place, _)| row.is_missing(*place)) {
            continue;
        }
        if row.is_missing(x_place) {
            let message = format!("column {x}: a measured value without a time; give it, or take the row out");
            return Err(row.error(message));
        }
        let (x, u_x) = (row.finite(x_place)?, uncertainty(&row, u_x_place)?);
        for (dataset, (y_place, u_y_place)) in datasets.iter_mut().zip(&y_places) {
            if !row.is_missing(*y_place) {
                let u_y = uncertainty(&row, *u_y_place)?;
                dataset.rows.push(DataRow { line: row.line, x, y: row.finite(*y_place)?, u_x, u_y });
            }
        }
    }
    Ok(datasets)
}

fn uncertainty(row: &Row<'_>, place: Option<usize>) -> Result<Option<f64>, FileError> {
    let given = place.filter(|place| !row.is_missing(*place));
    given.map(|place| row.positive(place, "one standard deviation, a number > 0")).transpose()
}

/// Reads WebPlotDigitizer's export: two columns without a header; or all datasets side by side, where the first line
/// has a name over the first column of each pair, the second has `X,Y` for each pair, and cells below shorter datasets
/// are blank.
pub(super) fn webplotdigitizer(path: &Path, text: &str) -> Result<Vec<Dataset>, FileError> {
    let rows = Rows::new(path, text.as_bytes()).all(MOST_LINES)?;
    let (first_line, first) = &rows[0];
    let refused = |line: u64, message: String| FileError::line(path, line, message);
    let axes = |cells: &[String]| {
        let upper = |k: usize, cell: &str| cell.eq_ignore_ascii_case(["X", "Y"][k % 2]);
        cells.iter().enumerate().all(|(k, cell)| upper(k, cell))
    };
    let (names, body) = match rows.get(1).filter(|(_, cells)| axes(cells)) {
        Some((_, second)) => {
            let (named, width) = (first.len(), second.len());
            if named != width || width % 2 != 0 {
                let message =
                    format!("{named} cells of names over {width} of X, Y: two columns for each dataset are allowed");
                return Err(refused(*first_line, message));
            }
            (first.iter().step_by(2).map(String::as_str).collect(), &rows[2..])
        }
        None => (vec![""], &rows[..]),
    };
    if let Some(k) = (1..names.len()).find(|k| names[..*k].contains(&names[*k])) {
        let message = format!("dataset `{}` is there twice: each needs a name of its own", names[k]);
        return Err(refused(*first_line, message));
    }
    let mut datasets: Vec<Dataset> =
        names.iter().map(|name| Dataset { name: (*name).to_owned(), rows: Vec::new() }).collect();
    for (line, cells) in body {
        if cells.len() > 2 * datasets.len() {
            let message = format!("{} cells; two for each dataset are allowed: {}", cells.len(), 2 * datasets.len());
            return Err(refused(*line, message));
        }
        for (k, dataset) in datasets.iter_mut().enumerate() {
            let cell = |place: usize| cells.get(place).map_or("", String::as_str);
            let (x, y) = (cell(2 * k), cell(2 * k + 1));
            // Only with several datasets can one be shorter.
            if names.len() > 1 && x.is_empty() && y.is_empty() {
                continue;
            }
            let read = |axis: &str, cell: &str| {
                let number = csv::number(cell).filter(|number| number.is_finite());
                let column = format!("{} {axis}", dataset.name);
                number.ok_or_else(|| refused(*line, csv::not_allowed(&column, cell, csv::FINITE)))
            };
            let (x, y) = (read("X", x)?, read("Y", y)?);
            dataset.rows.push(DataRow { line: *line, x, y, u_x: None, u_y: None });
        }
    }
    Ok(datasets)
}
