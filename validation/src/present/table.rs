//! Tables: columns over records, declared once, and all their writers; and rows as CSV by their serialized fields.

#[cfg(test)]
mod tests;

use crate::files::cluster;
use crate::files::csv::written;
use crate::files::text::{cell, left_aligned, widths};
use crate::judge::statistics::{Estimate, Sample};
use crate::present::markup;
use serde::{Deserialize, Serialize};
use std::borrow::Borrow;
use std::io::IsTerminal;

/// The value of a cell as data.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Datum {
    /// No value.
    #[default]
    Nothing,
    /// A text.
    Text(String),
    /// An integer.
    Count(u64),
    /// Any other number.
    Number(f64),
}

/// `data! { TYPE, value => datum; … }` converts values of a type to data.
macro_rules! data {
    ($($from:ty, $value:ident => $datum:expr;)*) => {
        $(impl From<$from> for Datum {
            fn from($value: $from) -> Self {
                $datum
            }
        })*
    };
}

data! {
    f64, number => Self::Number(number);
    u64, count => Self::Count(count);
    u32, count => Self::Count(count.into());
    usize, count => Self::Count(count as u64);
    &str, text => Self::Text(text.into());
}

/// Conversions to a value with its standard error, for columns of estimates.
macro_rules! estimates {
    ($($from:ty, $estimate:ident => $pair:expr;)*) => {
        $(impl From<$from> for (f64, f64) {
            fn from($estimate: $from) -> Self {
                $pair
            }
        }

        impl From<$from> for Option<(f64, f64)> {
            fn from($estimate: $from) -> Self {
                Some($pair)
            }
        })*
    };
}

estimates! {
    Estimate, estimate => (estimate.value, estimate.se);
    Sample, sample => (sample.mean, sample.se);
}

impl<T: Into<Datum>> From<Option<T>> for Datum {
    fn from(value: Option<T>) -> Self {
        value.map_or(Self::Nothing, Into::into)
    }
}

/// A table in plain text. A text in backticks is code, and a link if it is the name of a case.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ReportTable {
    /// Name, in words joined by `-`; the anchor is `table-NAME`.
    pub name: String,
    /// Content of the table, in a few words.
    pub title: String,
    /// A caption that says what to see.
    pub caption: String,
    /// The heads of the columns, with units.
    pub columns: Vec<String>,
    /// The cells as shown, row by row.
    pub rows: Vec<Vec<String>>,
    /// The heads of the data columns; a column of estimates has two.
    pub heads: Vec<String>,
    /// The cells as data, in full precision.
    pub data: Vec<Vec<Datum>>,
}

/// A cell: the text shown, if any, and its data.
type Cell = (Option<String>, Vec<Datum>);

/// A column over records: its name, and the text and data of its cells.
pub struct Column<'a, R> {
    name: String,
    heads: Vec<String>,
    cell: Box<dyn Fn(&R) -> Cell + 'a>,
    none: &'static str,
}

impl<R> Column<'_, R> {
    /// The same column with another text for missing values.
    pub fn or(self, none: &'static str) -> Self {
        Self { none, ..self }
    }
}

/// The text for a missing value.
pub const NONE: &str = "–";

fn column<'a, R>(name: impl Into<String>, cell: impl Fn(&R) -> Cell + 'a) -> Column<'a, R> {
    let name = name.into();
    Column { heads: vec![name.clone()], name, cell: Box::new(cell), none: NONE }
}

/// A column of texts.
pub fn words<'a, R, T: Into<String>>(name: impl Into<String>, of: impl Fn(&R) -> T + 'a) -> Column<'a, R> {
    field(name, move |record| Datum::Text(of(record).into()))
}

/// A column of data, shown unchanged.
pub fn field<'a, R, T: Into<Datum>>(name: impl Into<String>, of: impl Fn(&R) -> T + 'a) -> Column<'a, R> {
    column(name, move |record| {
        let datum = of(record).into();
        let shown = match &datum {
            Datum::Nothing => None,
            Datum::Text(text) => Some(text.clone()),
            Datum::Count(count) => Some(count.to_string()),
            Datum::Number(number) => Some(number.to_string()),
        };
        (shown, vec![datum])
    })
}

/// A column of numbers in a format; a missing number is shown as `–`.
pub fn number<'a, R, T: Into<Option<f64>>>(
    name: impl Into<String>,
    format: impl Fn(f64) -> String + 'a,
    of: impl Fn(&R) -> T + 'a,
) -> Column<'a, R> {
    column(name, move |record| {
        let value = of(record).into();
        (value.map(&format), vec![value.into()])
    })
}

/// A column of numbers with two digits of their standard errors; it has two columns of data.
pub fn estimate<'a, R, T: Into<Option<(f64, f64)>>>(
    name: impl Into<String>,
    of: impl Fn(&R) -> T + 'a,
) -> Column<'a, R> {
    with_errors(name, two_digits, of)
}

/// Like `estimate`, for differences, which are shown with their signs, but for a zero.
pub fn difference<'a, R, T: Into<Option<(f64, f64)>>>(
    name: impl Into<String>,
    of: impl Fn(&R) -> T + 'a,
) -> Column<'a, R> {
    let signed = |number: f64, se| {
        let text = two_digits(number.abs(), se);
        let is_zero = text.split(' ').next().is_some_and(|digits| !digits.contains(|c| ('1'..='9').contains(&c)));
        let sign = if is_zero {
            ""
        } else if number.is_sign_negative() {
            "−"
        } else {
            "+"
        };
        format!("{sign}{text}")
    };
    with_errors(name, signed, of)
}

fn with_errors<'a, R, T: Into<Option<(f64, f64)>>>(
    name: impl Into<String>,
    format: impl Fn(f64, f64) -> String + 'a,
    of: impl Fn(&R) -> T + 'a,
) -> Column<'a, R> {
    let name = name.into();
    let heads = vec![name.clone(), format!("± {name}")];
    let cell = move |record: &R| {
        let found = of(record).into();
        let data = [found.map(|f| f.0), found.map(|f| f.1)].map(Datum::from);
        (found.map(|(value, se)| format(value, se)), data.into())
    };
    Column { heads, ..column(name, cell) }
}

/// A format with `places` decimals.
pub fn decimals(places: usize) -> impl Fn(f64) -> String + Copy {
    move |number| format!("{number:.places$}")
}

/// A format such as 1.2e-3, with `places` decimals.
pub fn powers(places: usize) -> impl Fn(f64) -> String + Copy {
    move |number| format!("{number:.places$e}")
}

/// A number with two digits of its standard error; without an error, with six decimals at most.
pub fn two_digits(number: f64, se: f64) -> String {
    if !(se > 0.0 && se.is_finite()) {
        let rounded = (1e6 * number).round() / 1e6;
        return if rounded == 0.0 { "0".into() } else { rounded.to_string() };
    }
    let places = (1.0 - se.log10().floor()).clamp(0.0, 9.0) as usize;
    format!("{number:.places$} ± {se:.places$}")
}

/// Records as CSV by the columns over them, as [`ReportTable::csv`] writes a table.
pub fn columns_csv<R>(
    records: impl IntoIterator<Item: Borrow<R>>,
    columns: Vec<Column<'_, R>>,
) -> Result<String, String> {
    ReportTable::new(["", ""], "", records, columns).csv()
}

/// Records as CSV by their own fields, where these are the columns; the heads are the fields' names, even without
/// records. Every number is the shortest text that reads back as the same bits; missing values are empty, and a text
/// that a spreadsheet would treat as a formula has an apostrophe before it.
pub fn rows_csv<R: Serialize + Default>(records: impl IntoIterator<Item = R>) -> Result<String, String> {
    // The heads are written with the first record, which is dropped again.
    let mut all = std::iter::once(R::default()).chain(records);
    let plain = written(|table| all.try_for_each(|record| table.serialize(record)))?;
    let mut rows = csv::ReaderBuilder::new().has_headers(false).from_reader(plain.as_bytes()).into_records();
    let mut kept = rows.next().into_iter().chain(rows.skip(1));
    written(|table| kept.try_for_each(|row| table.write_record(row?.iter().map(cell))))
}

/// A table of texts.
pub fn of_words(
    name: &str,
    title: &str,
    caption: &str,
    columns: &[impl AsRef<str>],
    rows: Vec<Vec<String>>,
) -> ReportTable {
    let columns = columns.iter().enumerate();
    let columns = columns.map(|(k, name)| words(name.as_ref(), move |row: &Vec<String>| row[k].clone()));
    ReportTable::new([name, title], caption, rows, columns.collect())
}

impl ReportTable {
    /// A table from its name and title, its caption, its records (owned or borrowed), and the columns over them.
    pub fn new<R>(
        [name, title]: [&str; 2],
        caption: impl Into<String>,
        records: impl IntoIterator<Item: Borrow<R>>,
        columns: Vec<Column<'_, R>>,
    ) -> Self {
        let cells = |record: &R| -> (Vec<String>, Vec<Vec<Datum>>) {
            let cell = |column: &Column<'_, R>| {
                let (shown, data) = (column.cell)(record);
                (shown.unwrap_or_else(|| column.none.into()), data)
            };
            columns.iter().map(cell).unzip()
        };
        let (rows, data): (Vec<_>, Vec<_>) = records.into_iter().map(|record| cells(record.borrow())).unzip();
        Self {
            name: name.into(),
            title: title.into(),
            caption: caption.into(),
            rows,
            data: data.into_iter().map(|row| row.concat()).collect(),
            heads: columns.iter().flat_map(|column| column.heads.clone()).collect(),
            columns: columns.into_iter().map(|column| column.name).collect(),
        }
    }

    /// The width of the table in letters, if sentences may be wrapped but numbers may not, with two between columns.
    pub(crate) fn letters_across(&self) -> usize {
        /// Width at which a sentence is wrapped.
        const SENTENCE: usize = 24;
        let word = |text: &str| text.split(' ').map(|word| word.chars().count()).max().unwrap_or(0);
        let cell = |text: &String| {
            if text.contains('±') { text.chars().count() } else { text.chars().count().min(SENTENCE).max(word(text)) }
        };
        let column = |k: usize| {
            let cells = self.rows.iter().map(|row| cell(&row[k]));
            2 + cells.chain([word(&self.columns[k])]).max().unwrap_or(0)
        };
        (0..self.columns.len()).map(column).sum()
    }

    /// The data as CSV. Every number is the shortest text that reads back as the same bits; missing values are empty,
    /// and a text that a spreadsheet would treat as a formula has an apostrophe before it.
    pub fn csv(&self) -> Result<String, String> {
        let safe = |datum: &Datum| match datum {
            Datum::Text(text) => Datum::Text(cell(text)),
            other => other.clone(),
        };
        written(|table| {
            table.write_record(self.heads.iter().map(|head| cell(head)))?;
            self.data.iter().try_for_each(|row| table.serialize(row.iter().map(safe).collect::<Vec<_>>()))
        })
    }

    /// The table as plain text: title, columns of even width, and caption.
    pub fn text(&self) -> String {
        self.text_within(usize::MAX)
    }

    /// The same; on a terminal in lines of at most 80 letters, where columns without room are named instead.
    pub fn for_terminal(&self) -> String {
        let room = if is_narrow() { WIDTH } else { usize::MAX };
        wrapped(&self.text_within(room))
    }

    fn text_within(&self, room: usize) -> String {
        let mut rows: Vec<_> = std::iter::once(&self.columns).chain(&self.rows).cloned().collect();
        let widths = widths(&rows);
        // Two blanks stand between columns.
        let across = |last: usize| widths[..=last].iter().sum::<usize>() + 2 * last;
        let shown = (0..widths.len()).take_while(|last| across(*last) <= room).count().max(1);
        rows.iter_mut().for_each(|cells| cells.truncate(shown));
        let mut text = format!("{}\n\n{}", self.title, left_aligned(&rows));
        if shown < self.columns.len() {
            text += &format!("\nLeft out for want of room: {}.\n", self.columns[shown..].join(", "));
        }
        format!("{text}\n{}\n\n", self.caption)
    }

    /// The caption and the cells as Markdown.
    pub fn markdown(&self) -> String {
        format!("{}\n\n{}", self.caption, self.cells_as_markdown(markup::markdown))
    }

    /// The cells as Markdown, each written by `cell`.
    pub(crate) fn cells_as_markdown(&self, cell: fn(&str) -> String) -> String {
        let line = |cells: &[String]| {
            let cells: Vec<_> = cells.iter().map(|text| cell(text)).collect();
            format!("| {} |\n", cells.join(" | "))
        };
        let rows: String = self.rows.iter().map(|row| line(row)).collect();
        format!("{}|{}\n{rows}", line(&self.columns), " --- |".repeat(self.columns.len()))
    }
}

/// True on a terminal: a pipe or a file has room for all columns. What starts ranks gives them a terminal of its own.
pub fn is_narrow() -> bool {
    cluster::size() == 1 && std::io::stdout().is_terminal()
}

/// The largest number of characters of a line on a terminal.
const WIDTH: usize = 80;

/// Breaks lines that are too long between words and indents their continuation; rows of tables, whose cells are
/// separated by two blanks, stay as they are.
pub(crate) fn wrapped(text: &str) -> String {
    let mut all = String::new();
    for line in text.lines() {
        let mut width = 0;
        let words = if line.trim_end().contains("  ") { vec![line] } else { line.split(' ').collect() };
        for (k, word) in words.into_iter().enumerate() {
            let length = word.chars().count();
            if k > 0 && width + 1 + length > WIDTH {
                all += "\n  ";
                width = 2;
            } else if k > 0 {
                all.push(' ');
                width += 1;
            }
            all += word;
            width += length;
        }
        all.push('\n');
    }
    all
}
