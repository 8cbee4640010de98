//! CSV tables of numbers, read strictly: an error names file, line and column.

use crate::files::text::start;
use crate::files::{FileError, bounded, csv};
use std::path::Path;

/// The most characters of a foreign text in a message.
pub(super) const LONGEST_EXCERPT: usize = 300;

/// A table of finite numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// The header.
    pub columns: Vec<String>,
    /// The rows, one number per column.
    pub rows: Vec<Vec<f64>>,
    /// The line of each row in its file; empty for a table of this program.
    pub lines: Vec<u64>,
}

impl Table {
    /// A table of this program, each row after its number.
    pub(super) fn numbered<R: AsRef<[f64]>>(columns: &[&str], rows: &[R]) -> Self {
        let rows = rows.iter().enumerate().map(|(at, row)| [&[at as f64], row.as_ref()].concat());
        Self { columns: columns.iter().map(|name| (*name).into()).collect(), rows: rows.collect(), lines: Vec::new() }
    }

    /// The line of a row, counted from 0.
    pub fn line(&self, row: usize) -> u64 {
        self.lines.get(row).copied().unwrap_or(row as u64 + 2)
    }

    /// The index of a column.
    pub fn column(&self, name: &str) -> Option<usize> {
        self.columns.iter().position(|column| column == name)
    }
}

/// The text of a file of at most 100 MB.
pub(super) fn text(path: &Path) -> Result<String, FileError> {
    const MOST: u64 = 100_000_000;
    bounded::text(path, MOST).map_err(|error| FileError::unreadable(path, &error))
}

/// The line of a key in a JSON text, 0 if the key is missing.
pub(super) fn line_of(json: &str, key: &str) -> u64 {
    let key = format!("\"{key}\"");
    let lines = json.lines().position(|line| line.contains(&key));
    lines.map_or(0, |at| at as u64 + 1)
}

/// The table of a file with exactly these columns, at least one row, and finite numbers only.
pub(super) fn read(path: &Path, columns: &[&str]) -> Result<Table, FileError> {
    let text = text(path)?;
    let mut table = csv::Table::new(path, text.as_bytes())?;
    if table.names() != columns {
        let header = start(&table.names().join(","), LONGEST_EXCERPT);
        return Err(table.error(format!("the header is {header:?}; it must be {:?}", columns.join(","))));
    }
    let (mut rows, mut lines) = (Vec::new(), Vec::new());
    while let Some(row) = table.next_row()? {
        let number = |place: usize| row.finite(place).map_err(|error| FileError { column: place as u64 + 1, ..error });
        rows.push((0..columns.len()).map(number).collect::<Result<_, _>>()?);
        lines.push(row.line);
    }
    if rows.is_empty() {
        return Err(table.error("there is no row below the header"));
    }
    Ok(Table { columns: columns.iter().map(|column| (*column).to_owned()).collect(), rows, lines })
}

/// The fields of a certified table: twelve decimals, without −0.
pub(super) fn twelve_decimals(values: impl IntoIterator<Item = f64>) -> String {
    let field = |x: f64| format!("{:.12}", x + 0.0).replace("-0.000000000000", "0.000000000000");
    values.into_iter().map(field).collect::<Vec<_>>().join(",")
}

/// A row of a certified table: its setting, and its numbers from the time on.
#[cfg(test)]
pub(super) fn certified_row(line: &str) -> (String, Vec<f64>) {
    let (name, values) = line.split_once(',').unwrap();
    (name.to_owned(), values.split(',').map(|field| field.parse().unwrap()).collect())
}

/// The largest difference of two certified tables; 1 if their rows are not of the same setting and time.
#[cfg(test)]
pub(super) fn tables_apart(a: &str, b: &str) -> f64 {
    assert_eq!(a.lines().next(), b.lines().next());
    assert_eq!(a.lines().count(), b.lines().count());
    let rows = a.lines().zip(b.lines()).skip(1).map(|(a, b)| (certified_row(a), certified_row(b)));
    let off = |a: &[f64], b: &[f64]| if a[0] == b[0] { crate::oracle::apart(a, b) } else { 1.0 };
    crate::oracle::worst(rows.map(|((name, a), (other, b))| if name == other { off(&a, &b) } else { 1.0 }))
}

/// A table in the sources is the one that is computed, to half a unit of the twelfth decimal on either side, and the
/// difference between machines. A digit changed from the first text to the second is seen.
#[test]
fn tables_are_computed_anew() {
    use super::{TABLES, brownian, closed, folgar_tucker, formula};
    let tables = [
        (brownian::TABLE, 2e-12, ["0.4", "0.5"]),
        (closed::TABLE, 2e-12, ["0.6", "0.7"]),
        (folgar_tucker::TABLE, 2e-12, ["0.6", "0.7"]),
        (formula::TABLE, 4e-12, [",0.2", ",0.3"]),
    ];
    for ((name, certify), (table, most, [from, to])) in TABLES.into_iter().zip(tables) {
        let computed = certify().unwrap();
        let off = tables_apart(&computed, table);
        assert!(off < most, "{name}: {off:e}");
        assert!(tables_apart(&computed, &table.replacen(from, to, 1)) > 0.09, "{name}");
    }
}
