//! Writing problems as folders of files.

use super::{Built, INPUT_COLUMNS, all, built, page};
use crate::files::output::{self, Output, OutputError};
use std::ffi::OsString;
use std::fmt;
use std::fs;
use std::path::{Path, PathBuf};

/// The files of a problem's folder.
pub const FILES: [&str; 5] = ["problem.json", "start.csv", "inputs.csv", "certified.csv", "README.md"];

/// The JSON Schema of `problem.json`.
pub const SCHEMA: &str = include_str!("../../../schemas/problem.schema.json");

/// Why nothing was exported.
#[derive(Debug)]
pub enum ExportError {
    /// A folder holds something that no export writes.
    Foreign(PathBuf),
    /// A file cannot be read or written.
    Output(OutputError),
}

impl fmt::Display for ExportError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Foreign(path) => write!(
                f,
                "{}: is no file of an exported problem; give a folder of its own, or --force to write beside it",
                path.display()
            ),
            Self::Output(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for ExportError {}

/// Writes every problem as a folder in `dir`, which is made where it does not exist, and says which.
///
/// Where `dir` holds something that no export writes, nothing is written but by `force`, which leaves it beside the
/// problems. On any error the folders made by this call are removed again.
pub fn export(dir: &Path, force: bool) -> Result<Vec<&'static str>, ExportError> {
    if !force && let Some(foreign) = foreign(dir).map_err(|reason| failed(dir, reason))? {
        return Err(ExportError::Foreign(foreign));
    }
    output::probe(dir, 0).map_err(ExportError::Output)?;
    let built = built();
    let dir_made = !dir.exists();
    let mut made = Vec::new();
    for problem in built {
        let folder = dir.join(&problem.problem.name);
        if !folder.exists() {
            made.push(folder.clone());
        }
        if let Err(error) = output::write_all(&folder, &files(problem)) {
            // The first error is the one to report.
            made.iter().for_each(|folder| drop(fs::remove_dir_all(folder)));
            if dir_made {
                let _ = fs::remove_dir(dir);
            }
            return Err(ExportError::Output(error));
        }
    }
    Ok(all().iter().map(|def| def.name).collect())
}

fn failed(path: &Path, reason: std::io::Error) -> ExportError {
    let path = path.to_owned();
    ExportError::Output(OutputError { path, reason })
}

/// Something in `dir` that no export writes.
fn foreign(dir: &Path) -> std::io::Result<Option<PathBuf>> {
    let entries = |dir: &Path| -> std::io::Result<Vec<(OsString, PathBuf)>> {
        match dir.exists() {
            false => Ok(Vec::new()),
            true => (fs::read_dir(dir)?)
                .map(|entry| entry.map(|entry| (entry.file_name(), entry.path())))
                .collect(),
        }
    };
    for (name, folder) in entries(dir)? {
        if !all().iter().any(|def| name == def.name) || !folder.is_dir() {
            return Ok(Some(folder));
        }
        for (name, file) in entries(&folder)? {
            if !FILES.iter().any(|known| name == *known) {
                return Ok(Some(file));
            }
        }
    }
    Ok(None)
}

/// The files of a problem.
pub fn files(built: &Built) -> Vec<Output> {
    let problem = &built.problem;
    let json = serde_json::to_string_pretty(problem).expect("a problem is plain data");
    let mut files = vec![
        ("problem.json".into(), format!("{json}\n")),
        ("certified.csv".into(), csv(&problem.columns, &built.certified)),
        ("README.md".into(), page::page(built)),
    ];
    if !built.start.is_empty() {
        let rows: Vec<Vec<String>> = (0..)
            .zip(&built.start)
            .map(|(rod, p): (usize, _)| [vec![rod.to_string()], p.map(|x| format!("{x:?}")).into()].concat())
            .collect();
        files.push(("start.csv".into(), csv(&["rod", "p1", "p2", "p3"], &rows)));
    }
    if !built.inputs.is_empty() {
        let row = |(at, row): (usize, &Vec<f64>)| {
            let numbers = row.iter().map(|x| format!("{x:?}"));
            std::iter::once(at.to_string()).chain(numbers).collect()
        };
        let rows: Vec<Vec<String>> = built.inputs.iter().enumerate().map(row).collect();
        files.push(("inputs.csv".into(), csv(&INPUT_COLUMNS, &rows)));
    }
    files
}

fn csv<T: AsRef<str>>(columns: &[T], rows: &[Vec<String>]) -> String {
    let header: Vec<_> = columns.iter().map(AsRef::as_ref).collect();
    let lines = rows.iter().map(|row| row.join(","));
    std::iter::once(header.join(",")).chain(lines).map(|line| line + "\n").collect()
}
