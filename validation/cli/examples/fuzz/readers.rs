//! Folders of measured points, of problems and of answers.

use crate::{Files, Taken, Target};
use shearbed_validation::files::FileError;
use shearbed_validation::input::experiment::{self, SOURCES};
use shearbed_validation::serve::grade::{self, Options};
use shearbed_validation::serve::problems::{self, LoadedProblem};
use std::fs;
use std::path::Path;

const PROVENANCE: &str = r#"paper = "synthetic, for this test"
figure = "none"
digitised_by = "nobody"
tool = "none"
date = "2026-11-21"
csv = "columns"
rods = 50
[x]
quantity = "t_over_T"
calibration = [0, 3]
standard_uncertainty = 0.01
[y]
quantity = "fraction"
calibration = [0, 1]
standard_uncertainty = 0.01
[[curve]]
scene = "fig4-n50"
observable = "x1"
[inputs]
alpha = 0.1
"#;

/// Puts files into a folder that is made empty first.
pub fn put(folder: &Path, files: &Files) -> Result<(), String> {
    let failed = |error: std::io::Error| format!("the harness: {error}");
    match fs::remove_dir_all(folder) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => return Err(failed(error)),
        _ => fs::create_dir_all(folder).map_err(failed)?,
    }
    files.iter().try_for_each(|(name, bytes)| fs::write(folder.join(name), bytes).map_err(failed))
}

/// A refusal names the file, and a line that it has.
pub fn refused(FileError { path, line, message, .. }: &FileError, files: &Files) -> Result<Taken, String> {
    let lines = files.iter().map(|(_, bytes)| 1 + bytes.iter().filter(|byte| **byte == b'\n').count() as u64).max();
    if message.is_empty() || path.as_os_str().is_empty() || Some(*line) > lines {
        return Err(format!("{}, line {line} of {lines:?}: {message:?}", path.display()));
    }
    Ok(Taken::Refused(message.clone()))
}

/// Measured points with their provenance.
pub fn data() -> Target {
    let with = |changes: &[(&str, &str)], csv: &str| {
        let changed = changes.iter().fold(PROVENANCE.to_owned(), |text, (old, new)| text.replace(old, new));
        vec![("a.toml", changed.into_bytes()), ("a.csv", csv.as_bytes().to_vec())]
    };
    let column = ("observable = \"x1\"", "observable = \"x1\"\ndataset = \"n = 50\"");
    let seconds = ("\"t_over_T\"", "\"t_s\"\nshear_rate_per_s = 0.5");
    Target {
        name: "data",
        corpus: vec![
            with(&[], "t_over_T,x1,x1_u\n0,0.5,\n0.5,0.4,0.02\n1,0.3,\n"),
            with(&[("t_over_T", "strain"), ("[0, 3]", "[0, 200]")], "strain,x1,x3\n0,0.5,\n10,,0.3\n"),
            with(&[("\"columns\"", "\"webplotdigitizer\""), column], "n = 50,\nX,Y\n0.1, 0.5\n0.2, 0.4\n"),
            with(&[seconds, ("[0, 3]", "[0, 400]")], "t_s,x1\n0,0.5\n80,0.4\n"),
        ],
        take: Box::new(|folder, files| {
            put(&folder.join(SOURCES[0].folder), files)?;
            if let Err(error) = experiment::check(folder) {
                return refused(&error, files);
            }
            let curves =
                experiment::read(folder, &SOURCES[0]).map_err(|error| format!("checked, and then: {error}"))?;
            let all = curves.iter().flat_map(|curve| &curve.points);
            let mut numbers = all.flat_map(|point| [point.x, point.y, point.u_x, point.u_y]);
            Taken::if_finite(numbers.all(f64::is_finite), "a point")
        }),
    }
}

/// The files of a problem that are read.
fn files_of(name: &str) -> Vec<(&'static str, Vec<u8>)> {
    let built = problems::named(name).expect("its name is in the registry");
    let known = ["problem.json", "start.csv", "inputs.csv", "certified.csv"];
    let named = |(name, text): (String, String)| {
        let name = known.into_iter().find(|known| *known == name);
        (name.expect("a file of a problem"), text.into_bytes())
    };
    problems::files(built).into_iter().filter(|(name, _)| !name.ends_with(".md")).map(named).collect()
}

/// Small problems of two kinds.
const PROBLEMS: [&str; 2] = ["mid-flip-2", "mid-flip-11.6"];

/// A problem of somebody else.
const FOREIGN: &str = "my-own";

fn foreign() -> Vec<(&'static str, Vec<u8>)> {
    let mut files = files_of(PROBLEMS[0]);
    let renamed = |bytes: &[u8]| String::from_utf8_lossy(bytes).replace(PROBLEMS[0], FOREIGN).into_bytes();
    files.iter_mut().for_each(|(_, bytes)| *bytes = renamed(bytes));
    files
}

/// Exported problems.
pub fn problems() -> Target {
    Target {
        name: "problems",
        corpus: PROBLEMS.iter().map(|name| files_of(name)).chain([foreign()]).collect(),
        take: Box::new(|folder, files| {
            let problem = files.iter().find(|(file, _)| *file == "problem.json");
            let text = problem.map(|(_, bytes)| String::from_utf8_lossy(bytes)).unwrap_or_default();
            let is_its_name = |name: &&&str| text.contains(&format!("\"name\": \"{name}\""));
            put(folder, &[])?;
            put(&folder.join(PROBLEMS.iter().find(is_its_name).unwrap_or(&FOREIGN)), files)?;
            match problems::read(folder) {
                Ok(found) => Taken::if_finite(found.iter().all(finite), "a number"),
                Err(error) => refused(&error, files),
            }
        }),
    }
}

fn finite(loaded: &LoadedProblem) -> bool {
    let rows = loaded.certified.rows.iter().flatten();
    rows.chain(loaded.start.iter().flatten()).all(|x| x.is_finite())
}

/// Answers to a problem, which may be wrong in any way.
pub fn answers() -> Target {
    let corpus = PROBLEMS.map(|name| {
        let files = files_of(name);
        let certified = files.into_iter().find(|(name, _)| *name == "certified.csv");
        let (_, answer) = certified.expect("it is exported");
        vec![(name, answer)]
    });
    let dir = tempfile::tempdir().expect("the harness has a folder");
    for name in PROBLEMS {
        put(&dir.path().join(name), &files_of(name)).expect("the harness writes");
    }
    let loaded = problems::read(dir.path()).expect("what is exported is read");
    Target {
        name: "answers",
        corpus: corpus.to_vec(),
        take: Box::new(move |folder, files| {
            let (name, answer) = &files[0];
            put(&folder.join(name), &[("answer.csv", answer.clone())])?;
            let asked = loaded.iter().find(|loaded| loaded.problem.name == *name).ok_or("no such problem")?;
            match grade::grade_one(asked, &folder.join(name), &Options::default()) {
                Ok(graded) => {
                    let numbers = [graded.error, graded.length_drift, graded.orbit_drift];
                    Taken::if_finite(numbers.into_iter().flatten().all(f64::is_finite), "a number")
                }
                Err(error) => refused(&error, files),
            }
        }),
    }
}
