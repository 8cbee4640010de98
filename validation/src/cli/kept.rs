//! What a folder of results holds from an earlier run, so that nothing is overwritten unasked.

use super::Failure;
use crate::difference::difference;
use serde_json::{Value, json};
use shearbed::Plan;
use std::fs;
use std::io::ErrorKind;
use std::path::Path;

/// Records of other commands, none of which `run` writes.
const OTHERS: [(&str, &str); 3] = [
    ("sweep.json", "a sweep"),
    ("converge.json", "a study of convergence"),
    ("report.json", "a report"),
];

/// Refuses a folder that holds another scene's results, or those of another seed, number of replicas or version of the
/// program. One without a record of a run holds nothing that is known.
pub(super) fn check(out: &Path, plan: &Plan) -> Result<(), Failure> {
    for (name, what) in OTHERS {
        if out.join(name).exists() {
            return Err(refused(&out.join(name), &format!("{what} is kept here")));
        }
    }
    let path = out.join("run.json");
    let text = match fs::read_to_string(&path) {
        Ok(text) => text,
        // That nothing can be written there is for the writer to say.
        Err(error) if matches!(error.kind(), ErrorKind::NotFound | ErrorKind::IsADirectory) => return Ok(()),
        Err(error) if error.kind() == ErrorKind::NotADirectory => return Ok(()),
        Err(error) => return Err(refused(&path, &format!("cannot be read: {error}"))),
    };
    let kept: Value = serde_json::from_str(&text)
        .map_err(|error| refused(&path, &format!("is no record of a run: {error}")))?;
    let own = json!({ "version": env!("CARGO_PKG_VERSION"), "scene": plan.scene().resolved() });
    let same = json!({ "version": kept["version"], "scene": kept["scene"] });
    // As text: what was written and read again is compared with the same.
    let own = serde_json::from_str(&own.to_string()).unwrap_or(own);
    match difference(&same, &own) {
        None => Ok(()),
        Some((key, was, is)) => {
            let ensemble = &kept["scene"]["ensemble"];
            let held = format!(
                "another run is kept here: {}, {} replicas, seed {}, version {}; {key} was {was} and is {is} now",
                kept["scene"]["title"], ensemble["replicas"], ensemble["seed"], kept["version"]
            );
            Err(refused(&path, &held))
        }
    }
}

fn refused(path: &Path, what: &str) -> Failure {
    Failure::Input(format!(
        "{}: {what}; --force overwrites it, another --out leaves it; nothing was changed",
        path.display()
    ))
}

/// The files that a `record` in the folder lists, as `run.json` does, without those in `written`: after another run has
/// overwritten the rest, they would pass for its own.
pub(super) fn left_over(out: &Path, record: &str, written: &[&str]) -> Vec<String> {
    let text = fs::read_to_string(out.join(record)).unwrap_or_default();
    let kept: Value = serde_json::from_str(&text).unwrap_or_default();
    let listed = kept["files"].as_array().into_iter().flatten();
    let names = listed.filter_map(Value::as_str);
    // A record that names a file elsewhere is not ours to follow.
    let own = |name: &&str| Path::new(name).file_name().is_some_and(|file| file == *name);
    names
        .filter(own)
        .filter(|name| !written.contains(name))
        .map(str::to_owned)
        .collect()
}
