//! Reading exported problems back.

use super::table::{self, ReadError, Table};
use super::{FORMAT, Kind, LoadedProblem, Problem};
use std::fs;
use std::path::Path;

/// The problems in the folders of `dir`, by name. Folders without `problem.json` are not looked at.
///
/// Refused, with file, line and column: another format version, an unknown key, a table with other columns, fields or
/// keys than the problem has, a number that is not finite, and a folder without any problem.
pub fn read(dir: &Path) -> Result<Vec<LoadedProblem>, ReadError> {
    let failed = |error: std::io::Error| ReadError::whole(dir, format!("cannot be read: {error}"));
    let mut folders = Vec::new();
    for entry in fs::read_dir(dir).map_err(failed)? {
        let folder = entry.map_err(failed)?.path();
        if folder.join("problem.json").exists() {
            folders.push(folder);
        }
    }
    folders.sort();
    if folders.is_empty() {
        let message =
            "no problems here: no folder in it has a problem.json; `shearbed problems export` writes them";
        return Err(ReadError::whole(dir, message));
    }
    folders.iter().map(|folder| read_one(folder)).collect()
}

fn read_one(dir: &Path) -> Result<LoadedProblem, ReadError> {
    let path = dir.join("problem.json");
    let problem = problem(&path)?;
    let start = match problem.kind {
        Kind::Rods => start(&dir.join("start.csv"))?,
        _ => Vec::new(),
    };
    let inputs = match problem.kind {
        Kind::Contact => Some(table::read(&dir.join("inputs.csv"), &super::INPUT_COLUMNS)?),
        _ => None,
    };
    let columns: Vec<_> = problem.columns.iter().map(String::as_str).collect();
    let certified_path = dir.join("certified.csv");
    let certified = table::read(&certified_path, &columns)?;
    let loaded = LoadedProblem {
        dir: dir.to_owned(),
        problem,
        start,
        inputs,
        certified,
    };
    check_keys(&certified_path, &loaded)?;
    Ok(loaded)
}

fn problem(path: &Path) -> Result<Problem, ReadError> {
    let text = table::text(path)?;
    let wrong = |error: serde_json::Error| {
        ReadError::at(
            path,
            error.line() as u64,
            error.column() as u64,
            error.to_string(),
        )
    };
    // The version first: another format may have other keys.
    let value: serde_json::Value = serde_json::from_str(&text).map_err(wrong)?;
    if value["format"] != FORMAT {
        let message = format!("format = {}; this program reads {FORMAT}", value["format"]);
        let line = (text.lines().position(|line| line.contains("\"format\""))).map_or(0, |at| at as u64 + 1);
        return Err(ReadError::at(path, line, 0, message));
    }
    let problem: Problem = serde_json::from_str(&text).map_err(wrong)?;
    check(path, &problem)?;
    Ok(problem)
}

fn check(path: &Path, problem: &Problem) -> Result<(), ReadError> {
    let refuse = |message: String| Err(ReadError::whole(path, message));
    let keys = problem.kind.keys();
    if !(problem.columns.len() > keys.len() && problem.columns.iter().zip(keys).all(|(a, b)| a == b)) {
        return refuse(format!(
            "columns: they must begin with {}, and have more",
            keys.join(",")
        ));
    }
    if !(problem.tolerance > 0.0 && problem.tolerance.is_finite()) {
        return refuse(format!("tolerance = {}: must be positive", problem.tolerance));
    }
    let ascending = problem.times_s.windows(2).all(|pair| pair[0] < pair[1]);
    if !ascending || problem.times_s.is_empty() != (problem.kind == Kind::Contact) {
        return refuse("times_s: must ascend, and be empty for contacts only".into());
    }
    if (problem.kind == Kind::Ensemble) != problem.ensemble.is_some() {
        return refuse("ensemble: must be there for the kind \"ensemble\", and for no other".into());
    }
    Ok(())
}

fn start(path: &Path) -> Result<Vec<[f64; 3]>, ReadError> {
    let table = table::read(path, &["rod", "p1", "p2", "p3"])?;
    let direction = |(rod, row): (usize, &Vec<f64>)| {
        let line = rod as u64 + 2;
        if row[0] != rod as f64 {
            return Err(ReadError::at(
                path,
                line,
                1,
                format!("rod {}; rod {rod} is next", row[0]),
            ));
        }
        let p = [row[1], row[2], row[3]];
        let length = p.iter().map(|x| x * x).sum::<f64>().sqrt();
        // The rounding of three numbers near 1.
        if (length - 1.0).abs() > 4.0 * f64::EPSILON {
            return Err(ReadError::at(
                path,
                line,
                2,
                format!("|p| = {length}; it must be 1"),
            ));
        }
        Ok(p)
    };
    table.rows.iter().enumerate().map(direction).collect()
}

/// Rows must be there once each, in order: by time, then by rod.
fn check_keys(path: &Path, loaded: &LoadedProblem) -> Result<(), ReadError> {
    let wanted = keys(loaded);
    let rows = &loaded.certified.rows;
    for (at, (row, key)) in rows.iter().zip(&wanted).enumerate() {
        if let Some(wrong) = (0..key.len()).find(|i| row[*i] != key[*i]) {
            let name = &loaded.problem.columns[wrong];
            let message = format!("{name} = {}; {} is next", row[wrong], key[wrong]);
            return Err(ReadError::at(path, at as u64 + 2, wrong as u64 + 1, message));
        }
    }
    if rows.len() != wanted.len() {
        let message = format!("{} rows; there must be {}", rows.len(), wanted.len());
        return Err(ReadError::whole(path, message));
    }
    Ok(())
}

/// The keys of an answer's rows, in order.
pub(super) fn keys(loaded: &LoadedProblem) -> Vec<Vec<f64>> {
    let times = &loaded.problem.times_s;
    let numbers = |table: &Table| (0..table.rows.len()).map(|i| vec![i as f64]).collect();
    match loaded.problem.kind {
        Kind::Rods => (times.iter())
            .flat_map(|time| (0..loaded.start.len()).map(|rod| vec![*time, rod as f64]))
            .collect(),
        Kind::Tensor | Kind::Ensemble => times.iter().map(|time| vec![*time]).collect(),
        Kind::Contact => loaded.inputs.as_ref().map(numbers).unwrap_or_default(),
    }
}
