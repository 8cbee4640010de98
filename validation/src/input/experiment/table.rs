//! The CSV file of measured points, in the project's columns or as WebPlotDigitizer exports it.

use super::error::DataError;
use csv::{ReaderBuilder, StringRecord, Trim};

/// Points of one column or dataset, in the units of the file.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Dataset {
    /// Name of the column or dataset; empty for an export of two columns.
    pub(crate) name: String,
    /// The points in the order of the file.
    pub(crate) rows: Vec<DataRow>,
}

/// One point, in the units of the file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct DataRow {
    pub(crate) line: usize,
    pub(crate) x: f64,
    pub(crate) y: f64,
    /// Uncertainties of this point, if the file states them.
    pub(crate) u_x: Option<f64>,
    pub(crate) u_y: Option<f64>,
}

/// A line of the file that is not blank, split into cells.
struct Record {
    line: usize,
    cells: StringRecord,
}

/// The largest number of lines of a file: more than the points of any figure; a comparison then takes half a minute.
const MOST_LINES: usize = 20_000;

/// Fails if the cells of the first line are separated by semicolons or tabs, and says what to do: such files have
/// decimal commas.
pub(crate) fn commas(file: &str, text: &str) -> Result<(), DataError> {
    let Some((index, first)) = text.lines().enumerate().find(|(_, line)| !line.trim().is_empty()) else {
        return Ok(());
    };
    for (separator, name, shell) in [(';', "semicolons", ";"), ('\t', "tabs", "\\t")] {
        let is_number = |cell: &str| cell.trim().replace(',', ".").parse::<f64>().is_ok();
        let apart = first.contains(separator) && (!first.contains(',') || first.split(separator).all(is_number));
        if apart {
            let message = format!(
                "cells are separated by {name}; commas between cells and points in numbers are allowed: sed 's/,/./g; \
                 s/{shell}/,/g' makes them of it"
            );
            return Err(DataError::at(file, index + 1, message));
        }
    }
    Ok(())
}

/// Reads line by line, so that every error has the line number that an editor shows.
fn records(file: &str, text: &str) -> Result<Vec<Record>, DataError> {
    commas(file, text)?;
    let lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    lines
        .map(|(index, text)| {
            let mut cells = StringRecord::new();
            let mut reader = ReaderBuilder::new().has_headers(false).trim(Trim::All).from_reader(text.as_bytes());
            let line = index + 1;
            if line > MOST_LINES {
                let message = format!("more than {MOST_LINES} lines; at most {MOST_LINES} are allowed");
                return Err(DataError::at(file, line, message));
            }
            reader.read_record(&mut cells).map_err(|error| DataError::at(file, line, error.to_string()))?;
            Ok(Record { line, cells })
        })
        .collect()
}

fn number(file: &str, line: usize, column: &str, cell: &str) -> Result<f64, DataError> {
    let number = cell.parse().ok().filter(|number: &f64| number.is_finite());
    number.ok_or_else(|| {
        let message =
            format!("column {column}: `{cell}` is not allowed: expected a finite number with a decimal point");
        DataError::at(file, line, message)
    })
}

/// Reads the project's columns: `x`, each of `ys`, and their uncertainties `NAME_u` if given. A blank `y` was not
/// measured; for a blank uncertainty that of the provenance file applies.
pub(crate) fn columns(file: &str, text: &str, x: &str, ys: &[String]) -> Result<Vec<Dataset>, DataError> {
    let records = records(file, text)?;
    let Some((header, body)) = records.split_first() else {
        return Err(DataError::at(file, 1, "the file is empty"));
    };
    let known: Vec<String> = std::iter::once(x)
        .chain(ys.iter().map(String::as_str))
        .flat_map(|name| [name.to_owned(), format!("{name}_u")])
        .collect();
    let names: Vec<&str> = header.cells.iter().collect();
    for (k, name) in names.iter().enumerate() {
        let fault = if !known.iter().any(|known| known == name) {
            "is not in the provenance file"
        } else if names[..k].contains(name) {
            "is there twice"
        } else {
            continue;
        };
        let message = format!("column `{name}` {fault}: there are {}", known.join(", "));
        return Err(DataError::at(file, header.line, message));
    }
    let place = |name: &str| names.iter().position(|other| *other == name);
    let needed = |name: &str| {
        place(name).ok_or_else(|| {
            let message = format!("column {name} is missing: the provenance file says that it is there");
            DataError::at(file, header.line, message)
        })
    };
    let x_place = needed(x)?;
    let u_x_place = place(&format!("{x}_u"));
    let mut datasets = Vec::new();
    for y in ys {
        let (y_place, u_y_place) = (needed(y)?, place(&format!("{y}_u")));
        let mut rows = Vec::new();
        for Record { line, cells } in body {
            if cells.len() != names.len() {
                let message = format!("{} cells; the header has {}", cells.len(), names.len());
                return Err(DataError::at(file, *line, message));
            }
            let read = |place: usize| number(file, *line, names[place], &cells[place]);
            let own = |place: Option<usize>| match place {
                Some(place) if !cells[place].is_empty() => positive(file, *line, names[place], &cells[place]),
                _ => Ok(None),
            };
            let point = DataRow {
                line: *line,
                x: read(x_place)?,
                y: if cells[y_place].is_empty() { f64::NAN } else { read(y_place)? },
                u_x: own(u_x_place)?,
                u_y: own(u_y_place)?,
            };
            if !point.y.is_nan() {
                rows.push(point);
            }
        }
        datasets.push(Dataset { name: y.clone(), rows });
    }
    Ok(datasets)
}

fn positive(file: &str, line: usize, column: &str, cell: &str) -> Result<Option<f64>, DataError> {
    match number(file, line, column, cell)? {
        u if u > 0.0 => Ok(Some(u)),
        _ => {
            let message =
                format!("column {column}: `{cell}` is not allowed: expected one standard deviation, a number > 0");
            Err(DataError::at(file, line, message))
        }
    }
}

/// Reads WebPlotDigitizer's export: two columns without a header; or all datasets side by side, where the first line
/// has a name over the first column of each pair, the second has `X,Y` for each pair, and cells below shorter datasets
/// are blank.
pub(super) fn webplotdigitizer(file: &str, text: &str) -> Result<Vec<Dataset>, DataError> {
    let records = records(file, text)?;
    let Some(first) = records.first() else {
        return Err(DataError::at(file, 1, "the file is empty"));
    };
    let axes = |record: &&Record| {
        let upper = |k: usize, cell: &str| cell.eq_ignore_ascii_case(["X", "Y"][k % 2]);
        record.cells.iter().enumerate().all(|(k, cell)| upper(k, cell))
    };
    let (names, body): (Vec<&str>, &[Record]) = match records.get(1).filter(axes) {
        Some(second) => {
            let (named, width) = (first.cells.len(), second.cells.len());
            if named != width || width % 2 != 0 {
                let message =
                    format!("{named} cells of names over {width} of X, Y: two columns for each dataset are allowed");
                return Err(DataError::at(file, first.line, message));
            }
            (first.cells.iter().step_by(2).collect(), &records[2..])
        }
        None => (vec![""], &records),
    };
    if let Some(k) = (1..names.len()).find(|k| names[..*k].contains(&names[*k])) {
        let message = format!("dataset `{}` is there twice: each needs a name of its own", names[k]);
        return Err(DataError::at(file, first.line, message));
    }
    let mut datasets: Vec<Dataset> =
        names.iter().map(|name| Dataset { name: (*name).to_owned(), rows: Vec::new() }).collect();
    for Record { line, cells } in body {
        if cells.len() > 2 * datasets.len() {
            let message = format!("{} cells; two for each dataset are allowed: {}", cells.len(), 2 * datasets.len());
            return Err(DataError::at(file, *line, message));
        }
        for (k, dataset) in datasets.iter_mut().enumerate() {
            let cell = |place: usize| cells.get(place).unwrap_or_default();
            let (x, y) = (cell(2 * k), cell(2 * k + 1));
            // Only with several datasets can one be shorter.
            if names.len() > 1 && x.is_empty() && y.is_empty() {
                continue;
            }
            let read = |axis: &str, cell: &str| number(file, *line, &format!("{} {axis}", dataset.name), cell);
            let (x, y) = (read("X", x)?, read("Y", y)?);
            dataset.rows.push(DataRow { line: *line, x, y, u_x: None, u_y: None });
        }
    }
    Ok(datasets)
}
