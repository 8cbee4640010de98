//! Measured points from a CSV file, in the columns of `docs/src/reference/files.md`.

use crate::files::FileError;
use crate::files::csv::{LEFT_OUT, Table, not_allowed};
use crate::input::experiment::{read_text, table};
use crate::methods::least_squares::Datum;
use serde::Serialize;
use shearbed::observable::Channel;
use shearbed::{Observable, Plan};
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
    /// The uncertainty of each point of a file without a column of uncertainties.
    pub u: Option<f64>,
}

/// Every column that can be measured: the channels of all observables.
fn measurable() -> Vec<String> {
    Observable::ALL.iter().flat_map(|observable| observable.channels()).map(Channel::name).collect()
}

/// A channel's name and the factor that gives its unit, for a column in per cent too.
fn channel<'a>(name: &'a str, known: &[String]) -> Option<(&'a str, f64)> {
    let in_percent = name.strip_suffix(PERCENT).map(|name| (name, 0.01));
    let of = in_percent.unwrap_or((name, 1.0));
    known.iter().any(|known| known == of.0).then_some(of)
}

const PERCENT: &str = "_percent";

/// Why a column beside a known one's name is refused, and what to do; `None` if it may be anything.
fn misnamed(name: &str, known: &[String]) -> Option<String> {
    let lower = name.to_lowercase();
    if lower != name && known.contains(&lower) {
        return Some(format!("columns have small letters: rename it `{lower}`"));
    }
    let (value, suffix) = name.rsplit_once('_').filter(|(value, _)| channel(value, known).is_some())?;
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
    let known = measurable();
    let mut columns: Vec<String> = Vec::new();
    let left_out = |name: &&&str| given.is_some() && **name == LEFT_OUT;
    let (mut u_column, mut unread) = (None, Vec::new());
    for name in header.iter().filter(|name| !left_out(name)) {
        let of_uncertainty = name.strip_suffix("_u");
        let value = of_uncertainty.unwrap_or(name);
        if value == time.name() {
            continue;
        }
        if let Some(why) = misnamed(name, &known) {
            return Err(refused(format!("column `{name}`: {why}")));
        }
        if channel(value, &known).is_none() {
            if given.is_some() {
                return Err(refused(format!("column `{name}` is not allowed: {EXPECTED}")));
            }
            unread.push((*name).to_owned());
            continue;
        }
        if of_uncertainty.is_some() {
            u_column = u_column.or_else(|| Some((*name).to_owned()));
        } else {
            columns.push(value.to_owned());
        }
    }
    if columns.is_empty() {
        return Err(refused(format!("no column of measured values among {}: {EXPECTED}", header.join(", "))));
    }
    let bare = |name: &&String| reading.u.is_none() && !header.contains(&format!("{name}_u").as_str());
    if let Some(bare) = columns.iter().find(bare) {
        return Err(refused(format!(
            "column {bare}_u is missing: one standard deviation of each {bare} is needed, or u = 0.005 for all points"
        )));
    }
    let mut points = Vec::new();
    // Names as they are, but for those left out.
    let read = |name: &&str| if unread.iter().any(|unread| unread == name) { LEFT_OUT } else { name }.to_owned();
    let names: Vec<String> = header.iter().map(read).collect();
    for dataset in table::columns(path, &text, Some(&names), time.name(), &columns)? {
        let (name, factor) = channel(&dataset.name, &known).unwrap_or((&dataset.name, 1.0));
        for row in dataset.rows {
            let refused = |message: String| FileError::line(path, row.line, message);
            let u = row.u_y.or(reading.u).ok_or_else(|| {
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
            if !(LEAST_U..=most - least).contains(&u) {
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
mod tests {
    use super::*;
    use std::fs;

    fn read_of(text: &str) -> Result<Points, String> {
        read_as(text, &Reading::default())
    }

    fn read_as(text: &str, reading: &Reading) -> Result<Points, String> {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("points.csv");
        fs::write(&path, text).unwrap();
        read(&path, 3, reading).map_err(|error| error.to_string())
    }

    #[test]
    fn points_are_read_column_by_column_with_blanks_left_out() {
        let found =
            read_of("t_over_T,t_over_T_u,x1,x1_u,x3,x3_u\n0,,0.5,0.01,,\n0.5,0.02,0.4,0.02,0.6,0.03\n").unwrap();
        assert_eq!(found.time, TimeColumn::Periods);
        let short: Vec<_> =
            (found.points.iter()).map(|p| (p.line, p.column.as_str(), p.time, p.u_time, p.value, p.u)).collect();
        let expected =
            [(2, "x1", 0.0, 0.0, 0.5, 0.01), (3, "x1", 0.5, 0.02, 0.4, 0.02), (3, "x3", 0.5, 0.02, 0.6, 0.03)];
        assert_eq!(short, expected);
        assert!(found.points.iter().all(|point| point.set == 3));
        assert_eq!(read_of("strain,phi,phi_u\n1,0.7,0.1\n").unwrap().time, TimeColumn::Strain);
    }

    /// Names of one's own, with or without a header, and one uncertainty for all points, say what the same columns in
    /// the file would.
    #[test]
    fn names_and_an_uncertainty_can_be_given_beside_the_file() {
        let reading = |names: &str, u: Option<f64>| {
            let columns = (!names.is_empty()).then(|| names.split(',').map(str::to_owned).collect());
            Reading { columns, u }
        };
        let expected = read_of("t_s,x1,x1_u\n1,0.5,0.02\n2,0.4,0.02\n").unwrap();
        assert_eq!(expected.u_column.as_deref(), Some("x1_u"));
        for (text, names, u) in [
            ("t_s,x1\n1,0.5\n2,0.4\n", "", Some(0.02)),
            ("time,X,X\n1,0.5,7\n2,0.4,8\n", "t_s,x1,-", Some(0.02)),
            ("run,time,X,T,s\na,1,0.5,20,0.02\nb,2,0.4,21,0.02\n", "-,t_s,x1,-,x1_u", None),
        ] {
            let found = read_as(text, &reading(names, u)).unwrap();
            assert_eq!((&found.points, found.u_column.is_some()), (&expected.points, u.is_none()), "{text}");
        }
        // Without a header, the first point is in the first line.
        let found = read_as("0.5,0.5,1\n0.5,0.4,2\n", &reading("-,x1,t_s", Some(0.02))).unwrap();
        assert!(found.points.iter().zip(&expected.points).all(|(a, b)| a.line + 1 == b.line && a.value == b.value));
        for (text, names, u, told) in [
            ("a,b,c\n1,2,3\n", "t_s,x1", None, "points.csv:1: 3 cells where 2 columns are named"),
            ("a,b\n1,2\n", "t_s,x4", None, "column `x4` is not allowed"),
            ("a,b,c\n1,2,3\n", "t_s,x1,x1", Some(0.1), "column `x1` is there twice"),
            ("t_s,x1\n1,0.5\n", "", Some(1.5), "points.csv:2: column x1, its uncertainty: `1.5` is not allowed"),
            ("t_s,-\n1,0.5\n", "", Some(0.1), "no column of measured values among t_s, -"),
        ] {
            let error = read_as(text, &reading(names, u)).unwrap_err();
            assert!(error.contains(told), "{error}");
        }
    }

    /// What the program writes can be fitted.
    #[test]
    fn every_column_can_have_the_values_of_its_observable() {
        for text in ["cos_2phi,cos_2phi_u\n0,-0.8,0.1", "n1_pa,n1_pa_u\n0,-3e4,0.1", "s12_pa,s12_pa_u\n0,1e5,0.1"] {
            assert_eq!(read_of(&format!("t_s,{text}\n")).unwrap().points.len(), 1);
        }
        for name in measurable() {
            let [least, most] = allowed(&name);
            assert!(least < most && least.is_finite() && most.is_finite(), "{name}");
        }
    }

    /// What spreadsheets, instruments and numpy write says the same as the plain file.
    #[test]
    fn files_of_other_programs_are_the_plain_file() {
        let plain = read_of("t_s,x1,x1_u\n1.5,0.5,0.125\n2,0.25,0.125\n").unwrap().points;
        for text in [
            "t_s;x1;x1_u\n1,5;0,5;0,125\n2;0,25;0,125\n;;\n",
            "# t_s,x1,x1_u\n1.5,0.5,0.125\n2,0.25,0.125\n",
            "t_s,x1,x1_u\n1.5,0.5,0.125\n# a pause\n1.7,NaN,NaN\n1.8,,\n2,0.25,0.125\n",
            "\"t_s\",\"x1_percent\",\"x1_percent_u\"\n1.5,50,12.5\n2,25,12.5\n",
            "t_s,temperature_C,x1,x1_u,note\n1.5,20,0.5,0.125,a\n2,21,0.25,0.125,b\n",
        ] {
            let found = read_of(text).unwrap();
            let of =
                |points: &[Datum]| points.iter().map(|p| (p.time, p.column.clone(), p.value, p.u)).collect::<Vec<_>>();
            assert_eq!(of(&found.points), of(&plain), "{text}");
            assert_eq!(found.unread.len(), 2 * usize::from(text.contains("note")), "{text}");
        }
    }

    #[test]
    fn what_cannot_be_is_refused_with_line_and_what_is_allowed() {
        for (text, line, named) in [
            ("", 1, "empty"),
            ("x1,x1_u\n0.5,0.1\n", 1, "one of t_over_T, t_s, strain is allowed"),
            ("t_s,strain,x1,x1_u\n", 1, "t_s and strain are two columns of times"),
            ("t_min,x1,x1_u\n", 1, "no column of times among t_min, x1, x1_u"),
            ("time_s,x1,x1_u\n", 1, "rename the column `time_s`"),
            ("t_s,x1,x1_se\n", 1, "is named `x1_u`"),
            (
                "t_s,x1,x1_plus,x1_minus\n",
                1,
                "column `x1_plus`: errors that differ above and below are not fitted: give",
            ),
            ("t_s,X1,x1_u\n", 1, "rename it `x1`"),
            ("t_s,x4,x4_u\n", 1, "no column of measured values among t_s, x4, x4_u: expected a time"),
            ("time,x1,x1_u\n1,0.5,0.1\n", 1, "`t_s` for seconds"),
            ("t_s\n1\n", 1, "no column of measured values"),
            (
                "t_s,x1\n1,0.5\n",
                1,
                "x1_u is missing: one standard deviation of each x1 is needed, or u = 0.005 for all points",
            ),
            ("t_s,x1,x1_u\n1,12.9,0.1\n", 2, "a value from 0 to 1; in per cent it is x1_percent"),
            ("t_s,x1,x1_u\n", 1, "no points"),
            ("t_s,x1,x1_u\n1,0.5,\n", 2, "x1_u is blank"),
            ("t_s,x1,x1_u\n1,0.5,0\n", 2, "> 0"),
            ("t_s,x1,x1_u\n1,inf,0.1\n", 2, "`inf`"),
            ("t_s,x1,x1_u\n-1,0.5,0.1\n", 2, "a time ≥ 0"),
            ("t_s,x1,x1_u\n1,0.5,0.1\n\n1,0.5,0.2\n", 4, "in line 2 already"),
            ("t_s,x1,x1_u,x1\n1,0.5,0.1,2\n", 1, "twice"),
            ("t_s,x1,x1_u\n1,0.5\n", 2, "2 cells"),
            ("t_s,x1,x1_u\n1,1e300,0.1\n", 2, "column x1: `1e300` is not allowed"),
            ("t_s,x1,x1_u\n1,1e153,0.1\n", 2, "a value from 0 to 1"),
            ("t_s,x1,x1_u\n1,1.01,0.1\n", 2, "column x1: `1.01` is not allowed"),
            ("t_s,x1,x1_u\n1,0.5,0.1\n2,-0.01,0.1\n", 3, "a value from 0 to 1"),
            ("t_s,phi,phi_u\n1,1.6,0.1\n", 2, "from 0 to 1.57"),
            ("t_s,a12,a12_u\n1,-0.51,0.1\n", 2, "from -0.5 to 0.5"),
            ("t_s,cos_2phi,cos_2phi_u\n1,-1.01,0.1\n", 2, "from -1 to 1"),
            ("t_s,s12_per_mu_fiber_g,s12_per_mu_fiber_g_u\n1,0.26,0.1\n", 2, "from 0 to 0.25"),
            ("t_s,x1,x1_u\n1,0.5,1e200\n", 2, "column x1_u: `1e200`"),
            ("t_s,x1,x1_u\n1,0.5,1e-200\n", 2, "1e-12 to 1"),
        ] {
            let error = read_of(text).unwrap_err();
            assert!(error.contains(&format!("points.csv:{line}: ")), "{text:?}: {error}");
            assert!(error.contains(named), "{text:?}: {error}");
        }
    }
}
