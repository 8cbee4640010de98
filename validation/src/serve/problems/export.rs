//! Export of problems as folders of files.

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
    output::probe(dir, 0)?;
    let of_problem = |problem: &Built| {
        let files = files(problem).into_iter();
        files.map(|(file, text)| (format!("{}/{file}", problem.problem.name), text)).collect::<Vec<_>>()
    };
    folder.write(built().into_iter().flat_map(of_problem).collect())?;
    Ok(all().iter().map(|def| def.name).collect())
}

/// The files of a problem.
pub fn files(built: &Built) -> Vec<Output> {
    let problem = &built.problem;
    let json = text::json(problem).expect("a problem is plain data");
    let mut files = vec![
        ("problem.json".into(), json),
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
    if let Some(columns) = problem.input_columns() {
        let row = |(at, row): (usize, &Vec<f64>)| {
            let numbers = row.iter().map(|x| format!("{x:?}"));
            std::iter::once(at.to_string()).chain(numbers).collect()
        };
        let rows: Vec<Vec<String>> = built.inputs.iter().enumerate().map(row).collect();
        files.push(("inputs.csv".into(), csv(&columns, &rows)));
    }
    files
}

fn csv<T: AsRef<str>>(columns: &[T], rows: &[Vec<String>]) -> String {
    let header: Vec<_> = columns.iter().map(AsRef::as_ref).collect();
    let lines = rows.iter().map(|row| row.join(","));
    std::iter::once(header.join(",")).chain(lines).map(|line| line + "\n").collect()
}
