//! Reading exported problems.

use super::problem::START;
use super::table::{self, LONGEST_EXCERPT, Table, line_of};
use super::{FORMAT, Kind, LoadedProblem, Origin, Problem};
use super::{check, origin};
use crate::files::{FileError, entries, text};
use shearbed::plan::counted;
use std::path::Path;

/// The problems in the folders of `dir`, by name. Folders without `problem.json` are ignored.
///
/// # Errors
///
/// File, line and column of: another format version, an unknown key, keys that do not belong together or are out of
/// range, a table with other columns, fields or keys than the problem has, a number that is not finite, a folder with
/// the name of a built-in problem that differs from it, and a folder without any problem.
pub fn read(dir: &Path) -> Result<Vec<LoadedProblem>, FileError> {
    let folders: Vec<_> = (entries(dir)?.into_iter()).filter(|folder| folder.join("problem.json").exists()).collect();
    if folders.is_empty() {
        let message = "no problems here: no folder in it has a problem.json; `shearbed problems export` writes them";
        return Err(FileError::whole(dir, message));
    }
    folders.iter().map(|folder| read_one(folder)).collect()
}

fn read_one(dir: &Path) -> Result<LoadedProblem, FileError> {
    let path = dir.join("problem.json");
    let json = table::text(&path)?;
    let problem = problem(&path, &json)?;
    let refused =
        |(key, message): check::Refused| FileError::at(&path, line_of(&json, key), 0, format!("{key} = {message}"));
    check::check(dir, &problem).map_err(refused)?;
    let start = if problem.kind == Kind::Rods { start(&dir.join("start.csv"))? } else { Vec::new() };
    let inputs = problem.input_columns().map(|columns| table::read(&dir.join("inputs.csv"), &columns)).transpose()?;
    let columns: Vec<_> = problem.columns.iter().map(String::as_str).collect();
    let certified_path = dir.join("certified.csv");
    let certified = table::read(&certified_path, &columns)?;
    let (own_tolerance, origin) = (problem.tolerance, Origin::Foreign);
    let mut loaded = LoadedProblem { dir: dir.to_owned(), origin, problem, start, inputs, certified, own_tolerance };
    check_keys(&certified_path, &loaded)?;
    check::tables(&loaded)?;
    loaded.origin = origin::origin(&loaded, &json)?;
    Ok(loaded)
}

fn problem(path: &Path, text: &str) -> Result<Problem, FileError> {
    let wrong = |error: serde_json::Error| {
        let message = text::start(&error.to_string(), LONGEST_EXCERPT);
        FileError::at(path, error.line() as u64, error.column() as u64, message)
    };
    // The version is checked first: another format may have other keys.
    let value: serde_json::Value = serde_json::from_str(text).map_err(wrong)?;
    if value["format"] != FORMAT {
        let found = text::start(&value["format"].to_string(), LONGEST_EXCERPT);
        let message = format!("format = {found}; this program reads {FORMAT}");
        return Err(FileError::at(path, line_of(text, "format"), 0, message));
    }
    serde_json::from_str(text).map_err(wrong)
}

fn start(path: &Path) -> Result<Vec<[f64; 3]>, FileError> {
    let table = table::read(path, &START)?;
    let direction = |(rod, row): (usize, &Vec<f64>)| {
        let wrong = |column: u64, message: String| FileError::at(path, table.line(rod), column, message);
        if row[0] != rod as f64 {
            return Err(wrong(1, format!("rod {}; rod {rod} is next", row[0])));
        }
        check::unit(&row[1..]).map_err(|message| wrong(2, message))?;
        Ok([row[1], row[2], row[3]])
    };
    table.rows.iter().enumerate().map(direction).collect()
}

/// Checks that every row occurs once, in order: by time, then by rod.
fn check_keys(path: &Path, loaded: &LoadedProblem) -> Result<(), FileError> {
    let wanted = keys(loaded);
    let rows = &loaded.certified.rows;
    for (at, (row, key)) in rows.iter().zip(&wanted).enumerate() {
        if let Some(wrong) = (0..key.len()).find(|i| row[*i] != key[*i]) {
            let name = &loaded.problem.columns[wrong];
            let message = format!("{name} = {}; {} is next", row[wrong], key[wrong]);
            return Err(FileError::at(path, loaded.certified.line(at), wrong as u64 + 1, message));
        }
    }
    if rows.len() != wanted.len() {
        let message = format!("{}; there must be {}", counted(rows.len() as u64, "row"), wanted.len());
        return Err(FileError::whole(path, message));
    }
    Ok(())
}

/// The keys of an answer's rows, in order.
pub(super) fn keys(loaded: &LoadedProblem) -> Vec<Vec<f64>> {
    let times = &loaded.problem.times_s;
    let numbers = |table: &Table| (0..table.rows.len()).map(|i| vec![i as f64]).collect();
    match loaded.problem.kind {
        Kind::Rods => {
            (times.iter()).flat_map(|time| (0..loaded.start.len()).map(|rod| vec![*time, rod as f64])).collect()
        }
        Kind::Tensor | Kind::Ensemble => times.iter().map(|time| vec![*time]).collect(),
        Kind::Contact | Kind::Formula => loaded.inputs.as_ref().map(numbers).unwrap_or_default(),
    }
}
