//! Measured points from a CSV file, in the columns of `docs/src/reference/files.md`.

use crate::files::FileError;
use crate::files::csv::{Table, not_allowed};
use crate::input::experiment::{PERCENT, read_text, table};
use crate::methods::least_squares::Datum;
use serde::Serialize;
use shearbed::Plan;
use shearbed::observable::Channel;
use std::path::Path;

/// The most points that are fitted at once: their covariance is a full matrix.
pub const MOST_POINTS: usize = 1000;

/// The unit of a file's times: the name of its first column.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum TimeColumn {
    /// Periods of the scene's mean aspect ratio, also where that aspect ratio is fitted.
    #[serde(rename = "t_over_T")]
    Periods,
    /// Seconds.
    #[serde(rename = "t_s")]
    Seconds,
    /// Shear strain.
    #[serde(rename = "strain")]
    Strain,
}

impl TimeColumn {
    const ALL: [Self; 3] = [Self::Periods, Self::Seconds, Self::Strain];

    /// The column's name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Periods => "t_over_T",
            Self::Seconds => "t_s",
            Self::Strain => "strain",
        }
    }

    /// This column's unit per unit of the plan's times; none for `t_over_T` if the plan's times are not periods.
    pub fn per_unit(self, plan: &Plan) -> Option<f64> {
        match self {
            Self::Periods => (plan.time_name() == "t_over_T").then_some(1.0),
            Self::Seconds => Some(plan.elapsed(1.0).seconds),
            Self::Strain => Some(plan.elapsed(1.0).strain),
        }
    }

    /// The end of the plan's scene, in this unit.
    pub fn end_of(self, plan: &Plan) -> Option<f64> {
        Some(plan.scene().time.duration * self.per_unit(plan)?)
    }
}

/// The points of one file.
#[derive(Clone, Debug, PartialEq)]
pub struct Points {
    /// The unit of the points' times.
    pub time: TimeColumn,
    /// The points, in the order of the columns, then of the lines.
    pub points: Vec<Datum>,
    /// The first column of uncertainties of measured values.
    pub u_column: Option<String>,
    /// Columns that are not read.
    pub unread: Vec<String>,
}

/// How a file of points is read.
#[derive(Clone, Debug, Default)]
pub struct Reading {
    /// Names of the columns in the order of the file, in place of its own; `-` leaves one out.
    pub columns: Option<Vec<String>>,
    /// The uncertainty of each point of a file without a column of uncertainties, in the unit of its column.
    pub u: Option<f64>,
    /// True if uncertainties may be missing, as for a picture: they are NaN then.
    pub without_u: bool,
}

/// A channel's name and the factor that gives its unit, for a column in per cent too.
fn channel(name: &str) -> Option<(&str, f64)> {
    let of = name.strip_suffix(PERCENT).map_or((name, 1.0), |name| (name, 0.01));
    Channel::named(of.0).map(|_| of)
}

/// Reads the file `path` as data set number `set`. Every point needs an uncertainty, `NAME_u` or that of `reading`;
/// blank points were not measured.
pub fn read(path: &Path, set: usize, reading: &Reading) -> Result<Points, FileError> {
    let text = read_text(path)?;
    let given = reading.columns.as_deref();
    let head = Table::named(path, text.as_bytes(), given)?;
    let header: Vec<&str> = head.names().iter().map(String::as_str).collect();
    let refused = |message: String| head.error(message);
    let times = TimeColumn::ALL.map(TimeColumn::name).join(", ");
    let here: Vec<_> = TimeColumn::ALL.into_iter().filter(|time| header.contains(&time.name())).collect();
    let [time] = here[..] else {
        if header.contains(&"time_s") && here.is_empty() {
            return Err(refused("measured times in seconds are named `t_s`: rename the column `time_s`".into()));
        }
        let like = |name: &&&str| ["time", "t", "seconds"].contains(&name.to_lowercase().as_str());
        if let Some(name) = header.iter().find(like).filter(|_| here.is_empty()) {
            return Err(refused(format!(
                "column `{name}` does not say its unit: `t_s` for seconds, `t_over_T` for periods and `strain` for Gt \
                 are allowed; rename it in this line"
            )));
        }
        let found = if here.is_empty() {
            format!("no column of times among {}", header.join(", "))
        } else {
            here.iter().map(|time| time.name()).collect::<Vec<_>>().join(" and ") + " are two columns of times"
        };
        return Err(refused(format!("{found}; one of {times} is allowed")));
    };
    let is_value = |name: &str| channel(name).is_some();
    let unread = table::unread(&head, |name| name == time.name() || is_value(name))?;
    if let Some(name) = unread.first().filter(|_| given.is_some()) {
        return Err(refused(format!("column `{name}` is not allowed: {EXPECTED}")));
    }
    let columns: Vec<String> = header.iter().filter(|name| is_value(name)).map(|name| (*name).to_owned()).collect();
    let u_column = header.iter().find(|name| name.strip_suffix("_u").is_some_and(is_value));
    let u_column = u_column.map(|name| (*name).to_owned());
    if columns.is_empty() {
        return Err(refused(format!("no column of measured values among {}: {EXPECTED}", header.join(", "))));
    }
    let bare =
        |name: &&String| reading.u.is_none() && !reading.without_u && !header.contains(&format!("{name}_u").as_str());
    if let Some(bare) = columns.iter().find(bare) {
        let u = if bare.ends_with(PERCENT) { "0.5 (per cent)" } else { "0.005" };
        return Err(refused(format!(
            "column {bare}_u is missing: one standard deviation of each {bare} is needed, or u = {u} for all points"
        )));
    }
    let mut points = Vec::new();
    for dataset in table::columns(path, &text, given, time.name(), &columns)? {
        let (name, factor) = channel(&dataset.name).unwrap_or((&dataset.name, 1.0));
        for row in dataset.rows {
            let refused = |message: String| FileError::line(path, row.line, message);
            let u = row.u_y.or(reading.u).or(reading.without_u.then_some(f64::NAN)).ok_or_else(|| {
                refused(format!("column {}_u is blank: one standard deviation, a number > 0, is needed", dataset.name))
            })?;
            if row.x < 0.0 {
                return Err(refused(not_allowed(time.name(), &row.x.to_string(), "a time ≥ 0")));
            }
            let [least, most] = allowed(name).map(|end| end / factor);
            if !(least..=most).contains(&row.y) {
                let hint = if most <= 2.0 && (most..=100.0).contains(&row.y) {
                    format!("; in per cent it is {name}{PERCENT}")
                } else {
                    String::new()
                };
                let expected = format!("a value from {least} to {most}{hint}");
                return Err(refused(not_allowed(&dataset.name, &format!("{:?}", row.y), &expected)));
            }
            // A smaller u is lost in the rounding of the model, a larger one carries no information.
            if !u.is_nan() && !(LEAST_U..=most - least).contains(&u) {
                let (name, width) = (&dataset.name, most - least);
                let expected =
                    format!("one standard deviation from {LEAST_U:?} to {width}, the width of what {name} can be");
                let whose = row.u_y.map_or(format!("{name}, its uncertainty"), |_| format!("{name}_u"));
                return Err(refused(not_allowed(&whose, &format!("{u:?}"), &expected)));
            }
            points.push(Datum {
                set,
                line: row.line as usize,
                column: name.to_owned(),
                time: row.x,
                value: row.y * factor,
                u_time: row.u_x.unwrap_or(0.0),
                u: u * factor,
            });
        }
    }
    check(path, &points)?;
    Ok(Points { time, points, u_column, unread })
}

/// The columns that a file may have.
const EXPECTED: &str = "expected a time (t_over_T, t_s, strain), x1, x2, x3 or another column of `shearbed run` (phi, \
    c_b, a11, …), and after a name `_u` for its uncertainty; in per cent x1_percent and x1_percent_u";

/// The smallest standard deviation of a point.
const LEAST_U: f64 = 1e-12;

/// The largest size of a value whose column has no bound, as stresses in Pa.
const MOST: f64 = 1e12;

/// The least and the largest value that a column of `shearbed run` can have, by its name.
fn allowed(column: &str) -> [f64; 2] {
    let range = Channel::named(column).map_or([f64::NEG_INFINITY, f64::INFINITY], Channel::range);
    range.map(|end| end.clamp(-MOST, MOST))
}

fn check(path: &Path, points: &[Datum]) -> Result<(), FileError> {
    if points.is_empty() {
        return Err(FileError::line(path, 1, "no points: one row for each is needed"));
    }
    if points.len() > MOST_POINTS {
        let message = format!("{} points; at most {MOST_POINTS} are allowed", points.len());
        return Err(FileError::line(path, points[MOST_POINTS].line as u64, message));
    }
    for (k, point) in points.iter().enumerate() {
        let same =
            |other: &&Datum| (&other.column, other.time, other.value) == (&point.column, point.time, point.value);
        if let Some(first) = points[..k].iter().find(same) {
            let message = format!(
                "{} = {} at {} is in line {} already: each point once is allowed",
                point.column, point.value, point.time, first.line
            );
            return Err(FileError::line(path, point.line as u64, message));
        }
    }
    Ok(())
}

/// Each pair of data set and column that occurs in `data`, sorted, once.
pub(super) fn kinds(data: &[Datum]) -> Vec<(usize, String)> {
    let mut kinds: Vec<_> = data.iter().map(|datum| (datum.set, datum.column.clone())).collect();
    kinds.sort();
    kinds.dedup();
    kinds
}

#[cfg(test)]
mod tests;
