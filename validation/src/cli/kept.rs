//! What a folder of results holds from an earlier run, so that nothing is overwritten unasked.

use super::Failure;
use crate::difference::difference;
use serde_json::{Value, json};
use shearbed::Plan;
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// The records of the commands that keep results in a folder, and what they are of.
const RECORDS: [(&str, &str); 7] = [
    (RUN, "a run"),
    (FIT, "a fit"),
    (SWEEP, "a sweep"),
    (STUDY, "a study of convergence"),
    (REPORT, "a report"),
    (GRADE, "a grading"),
    ("point.json", "a point of a sweep"),
];

/// The record of `run`.
pub(super) const RUN: &str = "run.json";
/// The record of `fit`.
pub(super) const FIT: &str = "fit.json";
/// The record of `sweep`.
pub(super) const SWEEP: &str = "sweep.json";
/// The record of `converge`.
pub(super) const STUDY: &str = "converge.json";
/// The record of `validate`.
pub(super) const REPORT: &str = "report.json";
/// The record of `grade`.
pub(super) const GRADE: &str = "grade.json";

/// Refuses a folder that holds another scene's results, or those of another seed, number of replicas or version of the
/// program. One without a record holds nothing that is known.
pub(super) fn check_run(out: &Path, plan: &Plan) -> Result<(), Failure> {
    let own = json!({ "version": env!("CARGO_PKG_VERSION"), "scene": plan.scene().resolved() });
    check(out, RUN, &own, |kept| {
        let ensemble = &kept["scene"]["ensemble"];
        format!(
            "another run is kept here: {}, {} replicas, seed {}, version {}",
            kept["scene"]["title"], ensemble["replicas"], ensemble["seed"], kept["version"]
        )
    })
}

/// The same for a fit, whose record holds what was `asked`.
pub(super) fn check_fit(out: &Path, asked: &Value) -> Result<(), Failure> {
    check(out, FIT, asked, |_| "another fit is kept here".into())
}

/// Refuses a folder that holds the record of another command than the one whose `record` is named; an earlier one of its own is
/// replaced. Of another sweep the sweep itself knows.
pub(super) fn check_alone(out: &Path, record: &str) -> Result<(), Failure> {
    match foreign(out, record) {
        None => Ok(()),
        Some((path, whose)) => Err(Failure::Input(format!(
            "{}: {whose} is kept here; another --out leaves it; nothing was changed",
            path.display()
        ))),
    }
}

/// The record of another command than the one of `record`, and what it is of.
fn foreign(out: &Path, record: &str) -> Option<(PathBuf, &'static str)> {
    let others = RECORDS.into_iter().filter(|(name, _)| *name != record);
    let mut paths = others.map(|(name, whose)| (out.join(name), whose));
    paths.find(|(path, _)| path.exists())
}

/// Refuses a folder that holds the record of another command, or a `record` with other values under the keys of `own`.
fn check(out: &Path, record: &str, own: &Value, held: impl Fn(&Value) -> String) -> Result<(), Failure> {
    if let Some((path, whose)) = foreign(out, record) {
        return Err(refused(&path, &format!("{whose} is kept here")));
    }
    let path = out.join(record);
    let text = match fs::read_to_string(&path) {
        Ok(text) => text,
        // That nothing can be written there is for the writer to say.
        Err(error) if matches!(error.kind(), ErrorKind::NotFound | ErrorKind::IsADirectory) => return Ok(()),
        Err(error) if error.kind() == ErrorKind::NotADirectory => return Ok(()),
        Err(error) => return Err(refused(&path, &format!("cannot be read: {error}"))),
    };
    let own_record = RECORDS.iter().find(|(name, _)| *name == record);
    let what = own_record.map_or("results", |(_, whose)| whose);
    let kept: Value = serde_json::from_str(&text)
        .map_err(|error| refused(&path, &format!("is no record of {what}: {error}")))?;
    // As text: what was written and read again is compared with the same.
    let own: Value = serde_json::from_str(&own.to_string()).unwrap_or_default();
    let keys = own.as_object().into_iter().flat_map(|own| own.keys());
    let same: Value = keys.map(|key| (key.clone(), kept[key].clone())).collect();
    match difference(&same, &own) {
        None => Ok(()),
        Some((key, was, is)) => {
            let held = held(&kept);
            Err(refused(
                &path,
                &format!("{held}; {key} was {was} and is {is} now"),
            ))
        }
    }
}

fn refused(path: &Path, what: &str) -> Failure {
    Failure::Input(format!(
        "{}: {what}; --force overwrites it, another --out leaves it; nothing was changed",
        path.display()
    ))
}

/// The files of an earlier run or fit, as their records list them, and these records, without those in `written`: after another
/// run or fit has overwritten the rest, they would pass for its own.
pub(super) fn left_over(out: &Path, written: &[&str]) -> Vec<String> {
    let of = |record: &str| -> Vec<String> {
        let text = fs::read_to_string(out.join(record)).unwrap_or_default();
        let kept: Value = serde_json::from_str(&text).unwrap_or_default();
        let listed = kept["files"].as_array().into_iter().flatten();
        let names = listed.filter_map(Value::as_str).chain([record]);
        names.map(str::to_owned).collect()
    };
    // A record that names a file elsewhere is not ours to follow.
    let own = |name: &String| {
        Path::new(name)
            .file_name()
            .is_some_and(|file| file == name.as_str())
    };
    [RUN, FIT]
        .into_iter()
        .flat_map(of)
        .filter(own)
        .filter(|name| !written.contains(&name.as_str()))
        .collect()
}
