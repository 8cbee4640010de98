//! Export of problems as folders of files.

use super::problem::START;
use super::{Built, ProblemDef, all, built, page};
use crate::files::output::{self, Output, Refused, ResultFolder};
use crate::files::text;
use serde_json::json;
use std::path::Path;

/// The JSON Schema of `problem.json`.
pub const SCHEMA: &str = include_str!("../../../schemas/problem.schema.json");

/// Writes every problem as a folder in `dir`, all together or none, and returns their names.
///
/// # Errors
///
/// Without `force`: a file in the way that no export wrote, or that was changed since. A file that cannot be written.
pub fn export(dir: &Path, force: bool) -> Result<Vec<&'static str>, Refused> {
    let folder = ResultFolder::new(dir, "problems export", json!({}), force).as_argument();
    let always = |def: &ProblemDef| ["problem.json", "certified.csv"].map(|file| format!("{}/{file}", def.name));
    // Checked before the problems are built, which takes seconds.
    folder.check(&all().iter().flat_map(always).collect::<Vec<_>>())?;
    output::probe(dir, 0, [])?;
    let of_problem = |problem: &Built| {
        let files = files(problem).into_iter();
        files.map(|(file, text)| (format!("{}/{file}", problem.problem.name), text)).collect::<Vec<_>>()
    };
    folder.write(&built().into_iter().flat_map(of_problem).collect::<Vec<_>>())?;
    Ok(all().iter().map(|def| def.name).collect())
}

/// The files of a problem.
pub fn files(built: &Built) -> Vec<Output> {
    let problem = &built.problem;
    let json = text::json(problem).expect("a problem is plain data");
    let columns: Vec<_> = problem.columns.iter().map(String::as_str).collect();
    let mut files = vec![
        ("problem.json".into(), json),
        ("certified.csv".into(), csv(&columns, built.certified.iter().cloned())),
        ("README.md".into(), page::page(built)),
    ];
    if !built.start.is_empty() {
        files.push(("start.csv".into(), csv(&START, numbered(&built.start))));
    }
    if let Some(columns) = problem.input_columns() {
        files.push(("inputs.csv".into(), csv(&columns, numbered(&built.inputs))));
    }
    files
}

/// The cells of rows of numbers, each after its number.
fn numbered<R: AsRef<[f64]>>(rows: &[R]) -> impl Iterator<Item = Vec<String>> {
    let cells = |row: &R| row.as_ref().iter().map(|x| format!("{x:?}")).collect::<Vec<_>>();
    rows.iter().enumerate().map(move |(at, row)| [vec![at.to_string()], cells(row)].concat())
}

fn csv(columns: &[&str], rows: impl Iterator<Item = Vec<String>>) -> String {
    let lines = rows.map(|row| row.join(","));
    std::iter::once(columns.join(",")).chain(lines).map(|line| line + "\n").collect()
}
