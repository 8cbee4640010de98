//! A program's answer to a problem, in the order of the problem's own rows.

use crate::files::FileError;
use crate::files::text::Shown;
use crate::judge::statistics::worst;
use crate::serve::problems::{Kind, LoadedProblem};
use std::path::{Path, PathBuf};

/// The largest difference of a time from the problem's, as a share of the gap to the next one: times are labels, with
/// few digits.
const LABEL: f64 = 1e-4;

/// An answer to a problem.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// The file.
    pub path: PathBuf,
    /// The values without keys, one row for each of the problem's; they need not be finite.
    pub rows: Vec<Vec<f64>>,
    /// The line number of each row.
    pub lines: Vec<u64>,
}

impl Answer {
    /// The certified values as an answer.
    pub fn certified(problem: &LoadedProblem) -> Self {
        let keys = problem.problem.kind.keys().len();
        Self {
            path: "certified.csv".into(),
            rows: problem.certified.rows.iter().map(|row| row[keys..].to_vec()).collect(),
            lines: Vec::new(),
        }
    }

    /// The file of a row, with its line if it has one: a program that runs writes no file.
    pub fn place(&self, row: usize) -> String {
        let path = self.path.shown();
        match self.lines[row] {
            0 => path,
            line => format!("{path}:{line}"),
        }
    }

    /// The largest difference of a value from the same value of `other`; NaN if one of them is not finite.
    pub fn largest_change(&self, other: &Self) -> f64 {
        apart(&self.rows, &other.rows)
    }
}

/// The largest difference of a value; NaN if one is not finite.
pub(super) fn apart(rows: &[Vec<f64>], others: &[Vec<f64>]) -> f64 {
    worst(rows.iter().zip(others).map(|(row, other)| crate::oracle::apart(row, other)))
}

/// The keys of a row with their values, in words.
pub(super) fn keys_of(loaded: &LoadedProblem, row: usize) -> String {
    let keys = loaded.problem.kind.keys().iter().zip(&loaded.certified.rows[row]);
    keys.map(|(name, value)| format!("{name} = {value}")).collect::<Vec<_>>().join(", ")
}

/// Collects rows by their keys. They must come in the problem's order: a shuffled file suggests a mistake.
pub(super) struct Collector<'a> {
    problem: &'a LoadedProblem,
    rods: usize,
    /// Number of rows at t = 0, which may precede the rows of the answer.
    ahead: usize,
    /// The line number of each row that was read, those at t = 0 first.
    lines: Vec<Option<u64>>,
    last: usize,
    rows: Vec<Vec<f64>>,
    /// True if any time is late enough.
    steady: bool,
    /// The first line of a series whose time is not asked for, and why not.
    skipped: Option<(u64, String)>,
}

impl<'a> Collector<'a> {
    pub(super) fn new(problem: &'a LoadedProblem) -> Self {
        let rods = problem.start.len().max(1);
        let ahead = match problem.problem.kind {
            Kind::Contact | Kind::Formula => 0,
            _ => rods,
        };
        let rows = problem.certified.rows.len();
        let lines = vec![None; ahead + rows];
        let steady = problem.problem.is_steady();
        Self { problem, rods, ahead, lines, last: 0, rows: vec![Vec::new(); rows], steady, skipped: None }
    }

    /// Adds the row with these keys. `Err` has the index of the wrong key, and the reason.
    pub(super) fn add(&mut self, line: u64, keys: &[f64], values: Vec<f64>) -> Result<(), (usize, String)> {
        let at = match self.place(keys) {
            // Programs of a_ij write whole time series.
            Err((0, why)) if self.problem.problem.kind == Kind::Tensor => {
                self.skipped.get_or_insert((line, why));
                return Ok(());
            }
            at => at?,
        };
        if self.steady && at == self.ahead {
            // The last row of a series counts.
            self.lines[at] = None;
        }
        let names = self.problem.problem.kind.keys().join(" and ");
        if let Some(before) = self.lines[at] {
            return Err((keys.len() - 1, format!("the same {names} as in line {before}")));
        }
        if at < self.last {
            let earlier = at / self.rods < self.last / self.rods;
            let key = if earlier { 0 } else { keys.len() - 1 };
            return Err((key, format!("out of order: rows must ascend in {names}")));
        }
        self.last = at;
        self.lines[at] = Some(line);
        if let Some(row) = at.checked_sub(self.ahead) {
            self.rows[row] = values;
        }
        Ok(())
    }

    /// The index of a row with these keys, rows at t = 0 included.
    fn place(&self, keys: &[f64]) -> Result<usize, (usize, String)> {
        let whole = |key: usize, count: usize| {
            let found = keys[key];
            let name = self.problem.problem.kind.keys()[key];
            if found >= 0.0 && found < count as f64 && found.fract() == 0.0 {
                Ok(found as usize)
            } else {
                Err((key, format!("{name} = {found}; whole numbers from 0 to {} are asked for", count - 1)))
            }
        };
        if self.ahead == 0 {
            return whole(0, self.rows.len());
        }
        let time = self.time(keys[0])?;
        let rod = if keys.len() > 1 { whole(1, self.rods)? } else { 0 };
        Ok(time.map_or(0, |time| time + 1) * self.rods + rod)
    }

    /// The index of the time `found`; `None` at the start if the problem does not ask for it.
    fn time(&self, found: f64) -> Result<Option<usize>, (usize, String)> {
        let times = &self.problem.problem.times_s;
        let off = |at: usize| (times[at] - found).abs();
        let nearest = (0..times.len()).min_by(|a, b| off(*a).total_cmp(&off(*b)));
        let gap = |at: usize| {
            let below = at.checked_sub(1).map_or(0.0, |before| times[before]);
            let above = times.get(at + 1).map_or(f64::INFINITY, |next| next - times[at]);
            (times[at] - below).abs().min(above)
        };
        match nearest {
            _ if self.steady && found > 0.0 => Ok(Some(0)),
            Some(at) if off(at) <= LABEL * gap(at) => Ok(Some(at)),
            _ if found == 0.0 => Ok(None),
            Some(at) => {
                Err((0, format!("time_s = {found} is not asked for; the nearest that is asked for is {}", times[at])))
            }
            None => Err((0, format!("time_s = {found} is not asked for"))),
        }
    }

    pub(super) fn finish(self, path: &Path, last: u64) -> Result<Answer, FileError> {
        let lines = &self.lines[self.ahead..];
        let missing = lines.iter().filter(|line| line.is_none()).count();
        if let Some(first) = lines.iter().position(Option::is_none) {
            let other = self.skipped.map_or(String::new(), |(line, why)| format!("; line {line}: {why}"));
            let key = keys_of(self.problem, first);
            let (line, what) = match lines[first..].iter().flatten().next() {
                Some(next) => (*next, format!("the row of {key} is missing before this one")),
                None => (last, format!("the file ends before {key}")),
            };
            let message = format!("{what} ({missing} of {} rows are missing){other}", lines.len());
            return Err(FileError::at(path, line, 1, message));
        }
        Ok(Answer { path: path.to_owned(), lines: lines.iter().flatten().copied().collect(), rows: self.rows })
    }
}
