//! The author of a problem in a folder: this program, as `problems export` writes it, or somebody else.

use super::problem::START;
use super::table::{LONGEST_EXCERPT, Table, line_of};
use super::{CORRECTED, LoadedProblem, Origin, named};
use crate::files::FileError;
use crate::files::difference::difference;
use crate::files::text::start;
use shearbed::plan::counted;
use std::path::Path;

/// Distinguishes a built-in problem from a foreign one by its name.
///
/// # Errors
///
/// A problem with the name of a built-in one that differs from it in any value: file, line, key or column, with the
/// value that was found and this program's own.
pub(super) fn origin(loaded: &LoadedProblem, json: &str) -> Result<Origin, FileError> {
    let Some(built) = named(&loaded.problem.name) else {
        return Ok(Origin::Foreign);
    };
    let own = built.loaded(loaded.dir.clone());
    let path = |file: &str| loaded.dir.join(file);
    let name = &loaded.problem.name;
    let version = loaded.problem.version;
    if let Some((_, now, wrong)) = CORRECTED.iter().find(|(of, now, _)| of == name && version < *now) {
        let message =
            format!("version = {version}: {wrong}; version {now} is right, and `shearbed problems export` writes it");
        return Err(FileError::whole(path("problem.json"), message));
    }
    let record = |loaded: &LoadedProblem| serde_json::to_value(&loaded.problem).unwrap_or_default();
    if let Some((key, found, due)) = difference(&record(loaded), &record(&own)) {
        let place = line_of(json, key.split('.').next().unwrap_or_default());
        let (found, due) = (start(&found.to_string(), LONGEST_EXCERPT), start(&due.to_string(), LONGEST_EXCERPT));
        let message = format!("{key} = {found}: {}", differs(name, &due));
        return Err(FileError::at(path("problem.json"), place, 0, message));
    }
    let starts = |start: &[[f64; 3]]| Table::numbered(&START, start);
    same(&path("start.csv"), name, &starts(&loaded.start), &starts(&own.start))?;
    if let (Some(found), Some(due)) = (&loaded.inputs, &own.inputs) {
        same(&path("inputs.csv"), name, found, due)?;
    }
    same(&path("certified.csv"), name, &loaded.certified, &own.certified)?;
    Ok(Origin::BuiltIn)
}

fn differs(name: &str, due: &str) -> String {
    format!(
        "{name} is a problem of this program, which has {due} there; `shearbed problems export` writes it again, and \
         a problem of your own needs a name of its own"
    )
}

fn same(path: &Path, name: &str, found: &Table, due: &Table) -> Result<(), FileError> {
    for (at, (row, own)) in found.rows.iter().zip(&due.rows).enumerate() {
        if let Some(k) = (0..row.len()).find(|k| row[*k] != own[*k]) {
            let message = format!("{} = {}: {}", found.columns[k], row[k], differs(name, &own[k].to_string()));
            return Err(FileError::at(path, found.line(at), k as u64 + 1, message));
        }
    }
    if found.rows.len() != due.rows.len() {
        let message =
            format!("{}: {}", counted(found.rows.len() as u64, "row"), differs(name, &due.rows.len().to_string()));
        return Err(FileError::whole(path, message));
    }
    Ok(())
}
