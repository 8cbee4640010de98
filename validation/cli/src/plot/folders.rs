//! The runs in folders of `shearbed run` and `shearbed sweep`, checked to be unchanged.

use crate::Failure;
use crate::derived::EXTREMES;
use serde_json::{Value, json as value};
use shearbed::Scene;
use shearbed_validation::files::output::{RECORD, Record, Sum};
use shearbed_validation::files::{FileError, bounded};
use shearbed_validation::present::plot::{Figure, names};
use shearbed_validation::present::study::ReportFigure;
use shearbed_validation::serve::sweep::{self, Axis, POINT, Pairs};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// A folder of tables, its label, its scene, and its record.
pub(super) struct Run {
    pub(super) dir: PathBuf,
    pub(super) label: String,
    /// Of a sweep's point: its keys and values.
    pub(super) point: Option<Pairs>,
    pub(super) scene: Scene,
    pub(super) record: Record,
}

/// The largest size of a record, in bytes.
const MOST_BYTES: u64 = 64 << 20;

/// The runs in a folder: the folder itself, or all points of a sweep.
pub(super) fn runs_in(dir: &Path) -> Result<Vec<Run>, Failure> {
    let refused = |path: &Path, what: &str| Failure::from(FileError::whole(path, what));
    let is_there = |name: &str| dir.join(name).symlink_metadata().is_ok();
    if !["run.json", "sweep.json", RECORD].into_iter().any(is_there) {
        let what = "is no folder of results; one that `shearbed run`, `sweep`, `fit` or `validate` wrote is allowed";
        return Err(refused(dir, what));
    }
    let path = dir.join(RECORD);
    let missing = "is missing: it has the checksums of the folder's files; run the command that wrote the folder again";
    let record = Record::read(dir).map_err(|why| refused(&path, &why))?.ok_or_else(|| refused(&path, missing))?;
    match record.origin.command.as_str() {
        "run" => Ok(vec![Run {
            label: name(dir),
            point: None,
            scene: scene(dir, "run.json", &json(dir, "run.json", &record)?)?,
            dir: dir.to_owned(),
            record,
        }]),
        "sweep" if record.origin.inputs.get(POINT).is_some() => {
            Err(refused(dir, "is one point of a sweep; the sweep's folder is allowed, two folders above"))
        }
        "sweep" => points(dir, &record),
        other @ ("fit" | "validate") => Err(refused(
            &path,
            &format!("is of `shearbed {other}`, whose pictures are drawn from its folder alone; give no other folder"),
        )),
        other => Err(refused(
            &path,
            &format!("is of `shearbed {other}`; folders of `run`, `sweep`, `fit` and `validate` are allowed"),
        )),
    }
}

/// The pictures that a folder of `shearbed fit` or `shearbed validate` keeps as data, with their names; none for a
/// folder of runs.
pub(super) fn kept(dir: &Path) -> Result<Option<Vec<(String, Figure)>>, Failure> {
    let Ok(Some(record)) = Record::read(dir) else {
        // `runs_in` reports what is wrong with the record.
        return Ok(None);
    };
    match record.origin.command.as_str() {
        "fit" if !record.files.contains_key(FIGURES) => {
            let why = format!("{FIGURES} is not in it: a fit without --over, or of an older version, keeps no picture");
            Err(FileError::whole(dir, why).into())
        }
        "fit" => json(dir, FIGURES, &record).map(Some),
        "validate" => {
            let report: Report = json(dir, "report.json", &record)?;
            Ok(Some(report.figures.into_iter().map(|kept| (kept.name, kept.figure)).collect()))
        }
        _ => Ok(None),
    }
}

/// The file with the pictures of a fit as data.
pub(crate) const FIGURES: &str = "figures.json";

/// The parts of a report that are read.
#[derive(serde::Deserialize)]
struct Report {
    figures: Vec<ReportFigure>,
}

fn name(dir: &Path) -> String {
    let own = dir.canonicalize().unwrap_or(dir.to_owned());
    own.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// The points of a sweep: all of its grid and no other. An error if the sweep is not finished.
fn points(dir: &Path, record: &Record) -> Result<Vec<Run>, Failure> {
    if !record.files.contains_key("sweep.csv") {
        let why = "the sweep is not finished: the same `shearbed sweep` goes on with it";
        return Err(FileError::whole(dir, why).into());
    }
    let refused = |name: &str, what: String| {
        FileError::whole(dir.join(name), format!("{what}; run the sweep again, with --force"))
    };
    let grid: Value = json(dir, "sweep.json", record)?;
    if grid != record.origin.inputs {
        return Err(refused("sweep.json", format!("is of another sweep than {RECORD}")).into());
    }
    let scene = scene(dir, "sweep.json", &grid)?;
    let axes: Vec<Axis> = serde_json::from_value(grid["over"].clone())
        .map_err(|error| refused("sweep.json", format!("over: is no grid of this version: {error}")))?;
    let count = sweep::count(&axes).ok_or_else(|| refused("sweep.json", "has too many points".into()))?;
    // Their numbers have as many digits, so that they are in order.
    let names: BTreeSet<_> = (0..count).map(|k| format!("{}/{RECORD}", sweep::point_name(k, count))).collect();
    if let Some(name) = names.iter().find(|name| !record.files.contains_key(*name)) {
        return Err(refused(RECORD, format!("{name} is not listed")).into());
    }
    let is_own = |name: &String| names.contains(name) || ["sweep.csv", EXTREMES, "sweep.json"].contains(&name.as_str());
    if let Some(name) = record.files.keys().find(|name| !is_own(name)) {
        return Err(refused(RECORD, format!("{name} is listed, and the sweep has {count} points")).into());
    }
    let point = |(k, name): (usize, &String)| {
        let record: Record = json(dir, name, record)?;
        let pairs = sweep::pairs(&axes, &sweep::at(&axes, k));
        let mut inputs = grid.clone();
        inputs[POINT] = value!(pairs);
        if record.origin.inputs != inputs {
            return Err(refused(name, "is of another point".into()).into());
        }
        let dir = dir.join(sweep::point_name(k, count));
        Ok(Run { label: names::point(&pairs), point: Some(pairs), scene: scene.clone(), dir, record })
    };
    names.iter().enumerate().map(point).collect()
}

/// The scene in a record, the file `name`.
fn scene(dir: &Path, name: &str, record: &Value) -> Result<Scene, Failure> {
    let scene = serde_json::from_value(record["scene"].clone());
    let why = |error| format!("scene: is no scene of this version: {error}");
    Ok(scene.map_err(|error| FileError::whole(dir.join(name), why(error)))?)
}

/// Parses a JSON file, checked to be unchanged.
fn json<T: serde::de::DeserializeOwned>(dir: &Path, name: &str, record: &Record) -> Result<T, Failure> {
    let path = dir.join(name);
    let bytes = bounded::bytes(&path, MOST_BYTES).map_err(|error| FileError::unreadable(&path, &error))?;
    let checked = record.check(name, &Sum::of(&bytes));
    let parsed =
        checked.and_then(|()| serde_json::from_slice(&bytes).map_err(|error| format!("is no record: {error}")));
    Ok(parsed.map_err(|why| FileError::whole(path, why))?)
}
