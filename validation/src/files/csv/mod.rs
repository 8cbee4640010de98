//! The one reader of tables of numbers in CSV.
//!
//! Cells are separated by commas, or by semicolons or tabs, and numbers may then have decimal commas; they may be in
//! quotes and have blanks around them, and numbers may have Fortran's exponents (`1.0D-3`). Blank lines, lines that
//! begin with `#`, CR LF and a byte order mark are skipped. An error names line and column.

mod lines;
#[cfg(test)]
mod tests;

pub use lines::{LineEnds, Lines};

use super::text::{line, start};
use super::{FileError, bounded};
use shearbed::plan::counted;
use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::Path;

/// Parses a number as printed by C, C++, Fortran, Julia, Octave or Python: NaN and infinities too; and as typeset, with
/// a minus sign for the hyphen.
pub fn number(text: &str) -> Option<f64> {
    text.parse().ok().or_else(|| text.replace(['D', 'd'], "e").replace('−', "-").parse().ok())
}

/// The same, with a decimal point or a decimal comma.
pub fn number_with_comma(text: &str) -> Option<f64> {
    number(text).or_else(|| number(&text.replace(',', ".")))
}

/// The message that a cell is not allowed.
pub fn not_allowed(column: &str, cell: &str, expected: &str) -> String {
    const MOST: usize = 40;
    format!("column {column}: `{}` is not allowed: expected {expected}", start(&line(cell), MOST))
}

/// The cells of tables that hold no value, in letters of either case.
const NO_VALUE: [&str; 12] = ["", "nan", "na", "n/a", "#n/a", "n.a.", "none", "null", "-", "--", "–", "—"];

fn says_nothing(cell: &str) -> bool {
    NO_VALUE.iter().any(|word| cell.trim().eq_ignore_ascii_case(word))
}

/// What [`Row::number`] expects.
pub const FINITE: &str = "a finite number with a decimal point";

/// The text of a table with these rows of cells, in quotes where they need them.
///
/// # Errors
///
/// Rows with different numbers of cells.
pub fn text(rows: &[Vec<String>]) -> Result<String, String> {
    written(|table| rows.iter().try_for_each(|row| table.write_record(row)))
}

/// The text of a table that `write` fills.
///
/// # Errors
///
/// Rows with different numbers of cells.
pub fn written(write: impl FnOnce(&mut csv::Writer<Vec<u8>>) -> csv::Result<()>) -> Result<String, String> {
    let mut table = csv::Writer::from_writer(Vec::new());
    write(&mut table).map_err(|error| error.to_string())?;
    let bytes = table.into_inner().map_err(|error| error.to_string())?;
    String::from_utf8(bytes).map_err(|error| error.to_string())
}

/// The cells of a line between commas: trimmed, and without their quotes.
pub fn split(text: &str) -> Vec<String> {
    split_at(text, ',')
}

/// Stands for any white space between cells.
const BLANK: char = ' ';

/// The cells of a line, with a point in numbers where commas do not separate cells.
fn cells(line: &str, separator: char) -> Vec<String> {
    marked(line, separator).0
}

/// The same, with the last number that had a point, and the last that had a comma, if commas do not separate cells.
fn marked(line: &str, separator: char) -> (Vec<String>, [Option<String>; 2]) {
    let mut cells: Vec<_> = match separator {
        BLANK => line.split_whitespace().map(|word| word.trim_matches('"').to_owned()).collect(),
        other => split_at(line, other),
    };
    let mut marks = [None, None];
    for cell in cells.iter_mut().filter(|cell| separator != ',' && cell.contains(['.', ','])) {
        let pointed = cell.replace(',', ".");
        if number(&pointed).is_some() {
            let mark = usize::from(cell.contains(','));
            marks[mark] = Some(std::mem::replace(cell, pointed));
        }
    }
    (cells, marks)
}

fn split_at(text: &str, separator: char) -> Vec<String> {
    let mut cells = Vec::new();
    let mut rest = Some(text);
    while let Some(text) = rest {
        let quoted = text.trim_start().strip_prefix('"').and_then(|text| {
            let mut end = text.find('"')?;
            while text[end + 1..].starts_with('"') {
                end += 2 + text[end + 2..].find('"')?;
            }
            Some((text[..end].replace("\"\"", "\""), &text[end + 1..]))
        });
        let (cell, after) = quoted.unwrap_or((String::new(), text));
        let (more, next) = after.split_once(separator).map_or((after, None), |(more, next)| (more, Some(next)));
        cells.push(cell + more.trim());
        rest = next;
    }
    cells
}

/// The rows of a table without a header.
pub struct Rows<R> {
    lines: Lines<R>,
    separator: char,
    /// The last comment before the first row, and its line.
    comment: Option<(u64, String)>,
    /// A number with a decimal point, and one with a decimal comma: in one file `1.234` beside `0,5` may be 1234.
    marks: [Option<String>; 2],
}

impl<R: BufRead> Rows<R> {
    /// The rows of `reader`; `path` is for messages.
    pub fn new(path: &Path, reader: R) -> Self {
        Self { lines: Lines::new(path, reader, LineEnds::Windows), separator: ',', comment: None, marks: [None, None] }
    }

    /// The next line's number and cells.
    fn read(&mut self, is_first: bool) -> Result<Option<(u64, Vec<String>)>, FileError> {
        while let Some(line) = self.lines.next_line()? {
            let number = self.lines.number();
            // In the first cell of a row too, `#N/A` is no comment.
            let text = line.trim_start();
            let is_cell = !is_first && text.split(self.separator).next().is_some_and(says_nothing);
            if let Some(comment) = text.strip_prefix('#').filter(|_| !is_cell) {
                self.comment = is_first.then(|| (number, comment.to_owned()));
                continue;
            }
            if is_first {
                self.separator = separator(&line);
            }
            let (cells, marks) = marked(&line, self.separator);
            for (known, found) in self.marks.iter_mut().zip(marks) {
                *known = known.take().or(found);
            }
            if let [Some(point), Some(comma)] = &self.marks {
                let (point, comma) = (start(point, 40), start(comma, 40));
                let what =
                    format!("`{point}` has a decimal point and `{comma}` a decimal comma; one of the two is allowed");
                return Err(self.lines.error(0, what));
            }
            return Ok(Some((number, cells)));
        }
        Ok(None)
    }

    /// The number and the cells of every line that is not blank.
    ///
    /// # Errors
    ///
    /// A file without rows, or with more than `most` lines.
    pub fn all(mut self, most: u64) -> Result<Vec<(u64, Vec<String>)>, FileError> {
        let mut rows = Vec::new();
        while let Some(row) = self.read(rows.is_empty())? {
            if row.0 > most {
                return Err(self.lines.error(0, format!("more than {most} lines; at most {most} are allowed")));
            }
            rows.push(row);
        }
        if rows.is_empty() { Err(FileError::line(self.lines.path(), 1, EMPTY)) } else { Ok(rows) }
    }
}

const EMPTY: &str = "the file is empty";

/// What separates the cells of a file with this first line: commas in it beside semicolons or tabs are those of
/// numbers, and blanks separate where nothing else does.
fn separator(first: &str) -> char {
    let is_number = |cell: &str| number_with_comma(cell.trim()).is_some();
    let other = |separator: &char| {
        first.contains(*separator) && (!first.contains(',') || first.split(*separator).all(is_number))
    };
    let blank = first.trim().contains(BLANK) && !first.contains([',', '"']);
    [';', '\t'].into_iter().find(other).unwrap_or(if blank { BLANK } else { ',' })
}

/// True if the cells are numbers or empty.
fn is_row(cells: &[String]) -> bool {
    cells.iter().all(|cell| cell.is_empty() || number(cell).is_some())
}

/// A table with a header, read row by row.
pub struct Table<R> {
    rows: Rows<R>,
    line: u64,
    names: Vec<String>,
    /// The first line, if it is a row.
    first: Option<(u64, Vec<String>)>,
}

/// The name of a column to leave out, which several columns may have.
pub const LEFT_OUT: &str = "-";

/// A table in a file.
pub type FileTable = Table<BufReader<File>>;

impl FileTable {
    /// Opens a file, and reads its header as [`Table::new`] does.
    ///
    /// # Errors
    ///
    /// A file that cannot be read, and those of [`Table::new`].
    pub fn open(path: &Path) -> Result<Self, FileError> {
        let file = bounded::open(path).map_err(|error| FileError::unreadable(path, &error))?;
        Self::new(path, BufReader::new(file))
    }
}

impl<R: BufRead> Table<R> {
    /// Reads the header, or that in the comment before a first line of numbers; `path` is for messages.
    ///
    /// # Errors
    ///
    /// An empty file, a column that is there twice.
    pub fn new(path: &Path, reader: R) -> Result<Self, FileError> {
        Self::named(path, reader, None)
    }

    /// Like [`Table::new`], with `given` names in the order of the columns in place of the header's, [`LEFT_OUT`] for
    /// one to leave out. A first line of numbers is then a row.
    ///
    /// # Errors
    ///
    /// As of [`Table::new`], and more or fewer names than columns.
    pub fn named(path: &Path, reader: R, given: Option<&[String]>) -> Result<Self, FileError> {
        let mut rows = Rows::new(path, reader);
        let (line, cells) = rows.read(true)?.ok_or_else(|| FileError::line(path, 1, EMPTY))?;
        let table = match given {
            None => match rows.comment.take().map(|(line, text)| (line, self::cells(&text, separator(&text)))) {
                Some((of_names, names)) if is_row(&cells) && names.len() == cells.len() => {
                    Self { rows, line: of_names, names, first: Some((line, cells)) }
                }
                _ => Self { rows, line, names: cells, first: None },
            },
            Some(given) => {
                let (found, due) = (cells.len(), given.len());
                let first = is_row(&cells).then_some((line, cells));
                let table = Self { rows, line, names: given.to_vec(), first };
                if found != due {
                    return Err(table.error(format!("{} where {due} columns are named", counted(found as u64, "cell"))));
                }
                table
            }
        };
        let left_out = |k: usize| given.is_some() && table.names[k] == LEFT_OUT;
        let twice = (1..table.names.len()).find(|k| !left_out(*k) && table.names[..*k].contains(&table.names[*k]));
        match twice {
            Some(k) => {
                let name = start(&table.names[k], 40);
                Err(table.error(format!("column `{}` is there twice; once is allowed", super::text::line(&name))))
            }
            None => Ok(table),
        }
    }

    /// The names of the columns.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// The index of a column.
    pub fn place(&self, name: &str) -> Option<usize> {
        self.names.iter().position(|other| other == name)
    }

    /// An error in the header.
    pub fn error(&self, message: impl Into<String>) -> FileError {
        FileError::line(self.rows.lines.path(), self.line, message)
    }

    /// What the table is read from.
    pub fn reader(&self) -> &R {
        &self.rows.lines.reader
    }

    /// The next row; `None` at the end.
    ///
    /// # Errors
    ///
    /// A row with more or fewer cells than the header.
    pub fn next_row(&mut self) -> Result<Option<Row<'_>>, FileError> {
        let first = self.first.take();
        let Some((line, cells)) = first.map_or_else(|| self.rows.read(false), |row| Ok(Some(row)))? else {
            return Ok(None);
        };
        // NumPy's savetxt writes blanks below a header of any form.
        let mut cells = match &cells[..] {
            [one] if self.names.len() > 1 && one.split_whitespace().count() == self.names.len() => {
                self::cells(one, BLANK)
            }
            _ => cells,
        };
        // Some instruments end rows with a separator.
        if cells.len() == self.names.len() + 1 && cells.last().is_some_and(String::is_empty) {
            cells.pop();
        }
        let row = Row { path: self.rows.lines.path(), names: &self.names, line, cells };
        match (row.cells.len(), row.names.len()) {
            (found, due) if found != due => {
                Err(row.error(format!("{}; the header has {due}", counted(found as u64, "cell"))))
            }
            _ => Ok(Some(row)),
        }
    }
}

/// A row of a [`Table`].
pub struct Row<'a> {
    path: &'a Path,
    names: &'a [String],
    /// The number of its line, from 1.
    pub line: u64,
    /// Its cells, as many as the header has.
    pub cells: Vec<String>,
}

impl Row<'_> {
    /// True if the cell is empty, or has a word for no value.
    pub fn is_missing(&self, place: usize) -> bool {
        says_nothing(&self.cells[place])
    }

    /// True if the cell is empty.
    pub fn is_blank(&self, place: usize) -> bool {
        self.cells[place].is_empty()
    }

    /// The number in a cell, also NaN and infinities.
    pub fn number(&self, place: usize) -> Result<f64, FileError> {
        number(&self.cells[place]).ok_or_else(|| self.refused(place, "a number"))
    }

    /// The finite number in a cell.
    pub fn finite(&self, place: usize) -> Result<f64, FileError> {
        let number = number(&self.cells[place]).filter(|number| number.is_finite());
        number.ok_or_else(|| self.refused(place, FINITE))
    }

    /// The finite number above 0 in a cell; `expected` is for the message.
    pub fn positive(&self, place: usize, expected: &str) -> Result<f64, FileError> {
        match self.finite(place)? {
            number if number > 0.0 => Ok(number),
            _ => Err(self.refused(place, expected)),
        }
    }

    /// The error that a cell is not allowed.
    pub fn refused(&self, place: usize, expected: &str) -> FileError {
        self.error(not_allowed(&self.names[place], &self.cells[place], expected))
    }

    /// An error in this row.
    pub fn error(&self, message: impl Into<String>) -> FileError {
        FileError::line(self.path, self.line, message)
    }
}
