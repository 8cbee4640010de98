//! The meaning of each field of a row: by the header, by `--columns`, or by the layout of a known program.

use super::axes::Axes;
use super::tensors::columns::indices;
use crate::files::csv::{self, LineEnds};
use crate::files::text::start;
use crate::methods::tensors::fourth::PAIRS;
use crate::serve::problems::{Kind, Problem};

/// The meaning of a field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Field {
    /// The key with this index.
    Key(usize),
    /// The value with this index, times a sign.
    Value(usize, f64),
    /// The value with this index again, from the other half of a symmetric tensor.
    Again(usize),
    /// A field that the problem does not ask for.
    Nothing,
}

/// The layout of a file's rows.
#[derive(Clone, Debug, PartialEq)]
pub struct Layout {
    /// The separator of fields; a blank stands for any white space.
    pub separator: char,
    /// The meaning of each field of a row.
    pub fields: Vec<Field>,
    /// True if the first line is a row, not a header.
    pub first_is_row: bool,
}

/// Layouts of programs whose tables have no names, or other names than ours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Foreign {
    /// Without a header: t, then A row by row (nine numbers), as fiberoripy's and PySPH's tables.
    Fiberoripy,
    /// Without a header: t, then A in the order 11, 22, 33, 12, 23, 13 of fiberpy's Mat2.
    Fiberpy,
    /// time, A2_0 to A2_5: OpenFOAM's symmTensor xx, xy, xz, yy, yz, zz.
    Openfoam,
}

impl Foreign {
    fn columns(self) -> &'static [&'static str] {
        match self {
            Self::Fiberoripy => &["time_s", "a11", "a12", "a13", "a21", "a22", "a23", "a31", "a32", "a33"],
            Self::Fiberpy => &["time_s", "a11", "a22", "a33", "a12", "a23", "a13"],
            Self::Openfoam => &["time_s", "a11", "a12", "a13", "a22", "a23", "a33"],
        }
    }
}

/// Our name for a column's name in the header of another program.
fn known(name: &str) -> &str {
    match name {
        "time" | "t" => "time_s",
        "A2_0" | "A2_1" | "A2_2" | "A2_3" | "A2_4" | "A2_5" => {
            let component = usize::from(name.as_bytes()[3] - b'0');
            Foreign::Openfoam.columns()[1 + component]
        }
        other => other,
    }
}

/// Options for the form of answer files.
#[derive(Clone, Debug, Default)]
pub struct FileOptions {
    /// The names of the columns in the order of the file; `-` skips a column.
    pub columns: Option<Vec<String>>,
    /// The layout of a known program.
    pub foreign: Option<Foreign>,
    /// The order of the program's axes.
    pub axes: Axes,
    /// The allowed line ends.
    pub ends: LineEnds,
}

impl Layout {
    /// The layout of a file whose first line is `first`. `Err` has the field from 1, or 0, and what is wrong.
    pub fn find(first: &str, problem: &Problem, options: &FileOptions) -> Result<Self, (usize, String)> {
        let separator = [',', ';', '\t'].into_iter().find(|letter| first.contains(*letter)).unwrap_or(' ');
        let header: Vec<_> = split(first.trim_start_matches('#').trim(), separator).collect();
        let first_is_row = header.iter().all(|field| number(field).is_ok());
        let of_tensor = problem.kind == Kind::Tensor && header.len() == 10;
        let foreign = options.foreign.or((first_is_row && of_tensor).then_some(Foreign::Fiberoripy));
        // Names differ by more than capitals.
        let lower: Vec<_> = header.iter().map(|name| known(name.trim_matches('"')).to_lowercase()).collect();
        let names: Vec<&str> = match (&options.columns, foreign) {
            (Some(columns), _) => columns.iter().map(String::as_str).collect(),
            (None, Some(foreign)) => foreign.columns().to_vec(),
            (None, None) if !first_is_row => lower.iter().map(String::as_str).collect(),
            (None, None) => {
                let message = format!(
                    "there is no header; it must be {:?}, or --columns or --layout must say what the columns are",
                    problem.columns.join(",")
                );
                return Err((0, message));
            }
        };
        if names.len() != header.len() {
            return Err((0, format!("{} fields where {} columns are named", header.len(), names.len())));
        }
        // A formula holds in any axes, and its rows are asked for in these.
        let axes = if problem.kind == Kind::Formula { Axes::default() } else { options.axes };
        Ok(Self { separator, fields: fields(&names, problem, axes)?, first_is_row })
    }

    /// Takes white space as the separator where a row below the header has that and none of the header's, as NumPy's
    /// `savetxt` writes.
    pub fn take_separator(&mut self, row: &str) {
        let count = self.fields.len();
        if count > 1 && !row.contains(self.separator) && split(row, ' ').count() == count {
            self.separator = ' ';
        }
    }

    /// The fields of a row.
    pub fn split<'a>(&self, line: &'a str) -> impl Iterator<Item = &'a str> + use<'a> {
        split(line, self.separator)
    }
}

fn split(line: &str, separator: char) -> impl Iterator<Item = &str> {
    // White space may be several blanks; between commas a field may be empty.
    let blank = separator == ' ';
    let parts = line.split(move |letter: char| if blank { letter.is_whitespace() } else { letter == separator });
    parts.map(str::trim).filter(move |part| !blank || !part.is_empty())
}

/// The name of a fourth moment whose indices are in order: all four of moments, those of each pair and the pairs of a
/// closure, for which a_1122 need not be a_1212. Other names stay.
fn in_order(name: &str, kind: Kind) -> String {
    let Some(mut at) = indices(name).filter(|at| at.len() == 4) else { return name.to_owned() };
    if kind == Kind::Formula {
        at.chunks_mut(2).for_each(<[usize]>::sort_unstable);
        let place = |pair: &[usize]| PAIRS.iter().position(|(i, j)| pair == [*i, *j]);
        if place(&at[..2]) > place(&at[2..]) {
            at.rotate_left(2);
        }
    } else {
        at.sort_unstable();
    }
    format!("a{}", at.iter().map(|k| (k + 1).to_string()).collect::<String>())
}

fn fields(names: &[&str], problem: &Problem, axes: Axes) -> Result<Vec<Field>, (usize, String)> {
    let keys = problem.kind.keys();
    let of_program = |column: &String| {
        let (name, sign) = axes.theirs(column);
        (in_order(&name, problem.kind), sign)
    };
    let theirs: Vec<_> = problem.columns[keys.len()..].iter().map(of_program).collect();
    let mut fields = Vec::new();
    for (k, name) in names.iter().enumerate() {
        let mirrored: String = match name.strip_prefix('a') {
            Some(digits) if digits.len() == 2 => format!("a{}", digits.chars().rev().collect::<String>()),
            _ => String::new(),
        };
        let value = |name: &str| theirs.iter().position(|(column, _)| *column == in_order(name, problem.kind));
        let field = if *name == "-" {
            Field::Nothing
        } else if let Some(key) = keys.iter().position(|key| key == name) {
            Field::Key(key)
        } else if let Some(at) = value(name) {
            Field::Value(at, theirs[at].1)
        } else if let Some(at) = value(&mirrored) {
            Field::Again(at)
        } else {
            let along = ["distance", "arc_length", "Points:0", "Points_0", "x", "xyz"].contains(name);
            let remedy = if along {
                "these are samples along a line: take the series at one point, as OpenFOAM's probes write"
            } else {
                "--columns can leave one out with a -"
            };
            let columns = problem.columns.join(",");
            return Err((k + 1, format!("column {name:?} is not asked for; the columns are {columns} ({remedy})")));
        };
        if !matches!(field, Field::Nothing) && fields.contains(&field) {
            return Err((k + 1, format!("column {name:?} is there twice")));
        }
        fields.push(field);
    }
    // A single rod needs no number.
    let keys = keys.iter().enumerate().filter(|(_, key)| **key != "rod");
    let needed = keys.map(|(k, key)| (Field::Key(k), *key));
    let values = theirs.iter().enumerate().map(|(k, (column, sign))| (Field::Value(k, *sign), column.as_str()));
    match needed.chain(values).find(|(field, _)| !fields.contains(field)) {
        None => Ok(fields),
        Some((_, column)) => {
            Err((0, format!("column {column:?} is missing; asked for are {}", problem.columns.join(","))))
        }
    }
}

/// Parses a field as a number. NaN and infinities written as such are valid; a number too large for a double is an
/// error.
pub(super) fn number(field: &str) -> Result<f64, String> {
    // Where commas separate no fields, one is a decimal comma.
    match csv::number_with_comma(field) {
        Some(value) if value.is_infinite() && field.contains(|c: char| c.is_ascii_digit()) => {
            Err(format!("{field} is too large for a double"))
        }
        Some(value) => Ok(value),
        None => Err(format!("{:?} is not a number", start(field, 40))),
    }
}
