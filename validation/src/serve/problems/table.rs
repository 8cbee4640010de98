//! CSV tables of numbers, read strictly: an error names file, line and column.

use crate::files::bounded;
use crate::files::text::{Shown, start_of};
use std::fmt;
use std::path::{Path, PathBuf};

/// A table of finite numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// The header.
    pub columns: Vec<String>,
    /// The rows, one number per column.
    pub rows: Vec<Vec<f64>>,
}

impl Table {
    /// The index of a column.
    pub fn column(&self, name: &str) -> Option<usize> {
        self.columns.iter().position(|column| column == name)
    }
}

/// The reason why a file of a problem is refused.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ReadError {
    /// The file or folder.
    pub path: PathBuf,
    /// The line, from 1; 0 for the whole file.
    pub line: u64,
    /// The column, from 1: the field of a table, the character of JSON; 0 for the whole line.
    pub column: u64,
    /// What is wrong, and what is allowed.
    pub message: String,
}

impl ReadError {
    /// An error in a whole file or folder.
    pub fn whole(path: &Path, message: impl Into<String>) -> Self {
        Self::at(path, 0, 0, message)
    }

    /// An error at a place in a file.
    pub fn at(path: &Path, line: u64, column: u64, message: impl Into<String>) -> Self {
        Self { path: path.to_owned(), line, column, message: message.into() }
    }
}

impl fmt::Display for ReadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.path.shown())?;
        for place in [self.line, self.column].iter().take_while(|place| **place > 0) {
            write!(f, ":{place}")?;
        }
        write!(f, ": {}", self.message)
    }
}

impl std::error::Error for ReadError {}

/// The start of a foreign text, for messages.
pub(super) fn cut(text: &str) -> String {
    start_of(text, 300)
}

/// The line of a key in a JSON text, 0 if the key is missing.
pub(super) fn line_of(json: &str, key: &str) -> u64 {
    let key = format!("\"{key}\"");
    let lines = json.lines().position(|line| line.contains(&key));
    lines.map_or(0, |at| at as u64 + 1)
}

/// The text of a file of at most 100 MB.
pub(super) fn text(path: &Path) -> Result<String, ReadError> {
    const MOST: u64 = 100_000_000;
    bounded::text(path, MOST).map_err(|error| ReadError::whole(path, format!("cannot be read: {error}")))
}

/// The table of a file with exactly these columns, at least one row, and finite numbers only.
pub(super) fn read(path: &Path, columns: &[&str]) -> Result<Table, ReadError> {
    parse(path, &text(path)?, columns)
}

fn parse(path: &Path, text: &str, columns: &[&str]) -> Result<Table, ReadError> {
    let mut lines = (1..).zip(text.lines());
    let header = lines.next().map_or("", |(_, header)| header);
    if header != columns.join(",") {
        let message = format!("the header is {:?}; it must be {:?}", cut(header), columns.join(","));
        return Err(ReadError::at(path, 1, 0, message));
    }
    let row = |(line, text): (u64, &str)| {
        let fields: Vec<_> = text.split(',').collect();
        if fields.len() != columns.len() {
            let message = format!("{} fields; the header has {}", fields.len(), columns.len());
            return Err(ReadError::at(path, line, 0, message));
        }
        let number = |(column, field): (u64, &&str)| match field.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(number),
            _ => Err(ReadError::at(path, line, column, format!("{:?} is no finite number", cut(field)))),
        };
        (1..).zip(&fields).map(number).collect()
    };
    let rows: Vec<Vec<f64>> = lines.map(row).collect::<Result<_, _>>()?;
    if rows.is_empty() {
        return Err(ReadError::at(path, 1, 0, "there is no row below the header"));
    }
    Ok(Table { columns: columns.iter().map(|column| (*column).to_owned()).collect(), rows })
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
    let each = rows.map(|((name, a), (other, b))| {
        if name == other && a[0] == b[0] {
            a.iter().zip(&b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
        } else {
            1.0
        }
    });
    each.fold(0.0, f64::max)
}
