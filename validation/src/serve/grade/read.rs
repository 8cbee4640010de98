//! Reading an answer from a file.

use super::answer::{Answer, Collector};
use super::lammps;
use super::layout::{Field, FileOptions, Foreign, Layout, number};
use crate::files::FileError;
use crate::files::csv::Lines;
use crate::serve::problems::LoadedProblem;
use std::path::Path;

/// The largest difference between the two halves of a symmetric tensor: beyond six digits they are two answers.
const SYMMETRIC: f64 = 1e-6;

/// True if the columns of a file are means with standard errors, `_se`.
pub fn has_errors(path: &Path, options: &FileOptions) -> bool {
    let header = || Lines::open(path, options.ends).ok()?.next_line().ok()?;
    let named = options.columns.as_ref().map(|columns| columns.join(","));
    named.or_else(header).is_some_and(|columns| columns.contains("_se"))
}

/// Reads an answer.
pub fn read(
    path: &Path,
    problem: &LoadedProblem,
    options: &FileOptions,
    dump: &lammps::DumpOptions,
) -> Result<Answer, FileError> {
    let mut lines = Lines::open(path, options.ends)?;
    let first = lines.next_line()?;
    let first = first.ok_or_else(|| FileError::at(path, 1, 1, "the file is empty"))?;
    if first.starts_with("ITEM:") {
        return lammps::read(lines, first, problem, options, dump);
    }
    // OpenFOAM's probes have comments, then rows as `t (xx xy xz yy yz zz)`.
    let probes = first.strip_prefix('#').is_some_and(|rest| rest.trim_start().starts_with("Probe"));
    let plain = |line: String| if probes { line.replace(['(', ')'], " ") } else { line };
    let mut first = Some(first);
    let mut below = None;
    // A header may be a comment too: it has a row of numbers below it.
    while let Some(comment) = first.take_if(|line| line.starts_with('#')) {
        let next = lines.next_line()?;
        if !probes && next.as_ref().is_none_or(|line| is_row(line)) {
            (first, below) = (Some(comment), next);
            break;
        }
        first = next;
    }
    let first = plain(first.ok_or_else(|| lines.error(1, "there is no row below the comments"))?);
    let places = (first.split_whitespace().count() - 1) / 6;
    if probes && places > 1 && options.columns.is_none() {
        let rest = ",-".repeat(6 * (places - 1));
        let message = format!(
            "{places} probes; one place is asked for: columns time_s,a11,a12,a13,a22,a23,a33{rest} read the first"
        );
        return Err(lines.error(0, message));
    }
    let foreign = if probes { Some(Foreign::Openfoam) } else { options.foreign };
    let mut layout = Layout::find(&first, &problem.problem, &FileOptions { foreign, ..options.clone() })
        .map_err(|(at, message)| lines.error(at, message))?;
    let mut collector = Collector::new(problem);
    let mut last = lines.number();
    let mut row = match below {
        _ if layout.first_is_row => Some(first),
        None => lines.next_line()?.map(plain),
        below => below,
    };
    // A row of units below the header.
    let is_of_units = |line: &String| layout.split(line).all(|field| is_unit(field.trim_matches('"')));
    if !layout.first_is_row && row.as_ref().is_some_and(is_of_units) {
        row = lines.next_line()?.map(plain);
    }
    if let Some(line) = row.as_ref().filter(|_| !layout.first_is_row) {
        layout.take_separator(line);
    }
    while let Some(line) = row {
        if line.starts_with('#') {
            row = lines.next_line()?.map(plain);
            continue;
        }
        last = lines.number();
        let (keys, values) = fields(&line, &layout, problem).map_err(|(at, message)| lines.error(at, message))?;
        let place =
            |key: usize| layout.fields.iter().position(|field| *field == Field::Key(key)).map_or(0, |at| at + 1);
        collector.add(last, &keys, values).map_err(|(key, message)| lines.error(place(key), message))?;
        row = lines.next_line()?.map(plain);
    }
    collector.finish(path, last)
}

/// True if all fields of a line are numbers.
fn is_row(line: &str) -> bool {
    line.split([',', ';', '\t', ' ']).filter(|field| !field.is_empty()).all(|field| number(field.trim()).is_ok())
}

/// The keys and values of a row. `Err` has the field from 1, or 0, and what is wrong.
fn fields(line: &str, layout: &Layout, problem: &LoadedProblem) -> Result<(Vec<f64>, Vec<f64>), (usize, String)> {
    let key_count = problem.problem.kind.keys().len();
    let mut keys = vec![0.0; key_count];
    let mut values = vec![f64::NAN; problem.problem.columns.len() - key_count];
    let mut again = Vec::new();
    for (k, (text, field)) in layout.split(line).zip(&layout.fields).enumerate() {
        let found = || number(text.trim_matches('"')).map_err(|message| (k + 1, message));
        match *field {
            Field::Key(at) => {
                keys[at] = found()?;
                if !keys[at].is_finite() {
                    return Err((k + 1, format!("{text} is no finite number")));
                }
            }
            Field::Value(at, sign) => values[at] = sign * found()?,
            Field::Again(at) => again.push((k + 1, at, found()?)),
            Field::Nothing => {}
        }
    }
    let (count, due) = (layout.split(line).count(), layout.fields.len());
    if count != due {
        return Err((due.min(count + 1), format!("{count} fields; the first line has {due}")));
    }
    for (column, at, other) in again {
        let sign = layout.fields.iter().find_map(|field| match field {
            Field::Value(found, sign) if *found == at => Some(*sign),
            _ => None,
        });
        let off = (values[at] - sign.unwrap_or(1.0) * other).abs();
        if off > SYMMETRIC {
            return Err((column, format!("the tensor is not symmetric: its two halves are {off:.1e} apart")));
        }
    }
    Ok((keys, values))
}

/// True of the unit of a column, as s, (rad), [1/s] or -.
fn is_unit(field: &str) -> bool {
    const UNITS: &str = "s sec seconds min h rad radians deg degrees mm cm m um µm pa unit none dimensionless";
    let mut words = field.split(|c: char| !c.is_alphabetic()).filter(|word| !word.is_empty());
    number(field).is_err() && words.all(|word| UNITS.split(' ').any(|unit| unit == word.to_lowercase()))
}

#[test]
fn units_are_told_from_other_words() {
    assert!(["s", "(rad)", "[1/s]", "-", "–", "", "s^-1", "Degrees", "°", "µm"].into_iter().all(is_unit));
    assert!(!["garbage", "x", "1.0", "1", "nan", "s or h"].into_iter().any(is_unit));
}
