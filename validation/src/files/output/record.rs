//! `shearbed.json`: which command wrote a folder of results, from what input, and its files with their checksums.
//!
//! By it the one rule of overwriting is held: what a command did not write itself, or wrote from other input, stays without
//! `--force`.

use super::{Claim, Output, OutputError, PATIENCE, appear};
use crate::files::bounded;
use crate::files::build::BUILD;
use crate::files::difference::difference;
use crate::files::text::Shown;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::io::{self, ErrorKind};
use std::path::{Component, Path};

/// The name of the file, which is written last.
pub const RECORD: &str = "shearbed.json";
/// The format that is written and read.
const FORMAT: u32 = 1;
/// The longest record.
const MOST_BYTES: u64 = 64 << 20;

/// What commands left as their record before there was this one, and what a point of a sweep has.
const OTHERS: [&str; 7] =
    ["run.json", "fit.json", "sweep.json", "converge.json", "report.json", "grade.json", "point.json"];

/// What stands in `shearbed.json`.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Record {
    format: u32,
    /// The command that wrote the folder.
    pub command: String,
    /// The version of the program, and what else the results depend on; input files by their checksums.
    pub inputs: Value,
    /// The folder's files by their names; those of a sweep's points stand in its `point.json`.
    pub files: BTreeMap<String, Sum>,
}

/// The length and the checksum (CRC-32 as eight hexadecimal digits) of a file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Sum {
    /// Its length.
    pub bytes: u64,
    /// Its checksum.
    pub crc32: String,
}

impl Sum {
    /// The sum of a file's contents.
    pub fn of(contents: &[u8]) -> Self {
        Self::from_parts(contents.len() as u64, crc32fast::hash(contents))
    }

    /// The sum of a file of so many bytes and this checksum.
    pub fn from_parts(bytes: u64, crc32: u32) -> Self {
        let crc32 = format!("{crc32:08x}");
        Self { bytes, crc32 }
    }
}

/// The sums of files by their names.
pub fn sums<C: AsRef<[u8]>>(files: &[(String, C)]) -> BTreeMap<String, Sum> {
    let sum = |(name, contents): &(String, C)| (name.clone(), Sum::of(contents.as_ref()));
    files.iter().map(sum).collect()
}

impl Record {
    /// The record of a folder; none where there is no such file, or no such folder.
    ///
    /// # Errors
    ///
    /// Why the file cannot be read, without its name.
    pub fn read(dir: &Path) -> Result<Option<Self>, String> {
        let text = match bounded::text(&dir.join(RECORD), MOST_BYTES) {
            Err(error) if absent(&error) => return Ok(None),
            text => text.map_err(|error| format!("cannot be read: {error}"))?,
        };
        let record: Self = serde_json::from_str(&text)
            .map_err(|error| format!("is no record of results that `shearbed` wrote: {error}"))?;
        match record.format {
            FORMAT => Ok(Some(record)),
            other => {
                Err(format!("has the format {other}, of another version of shearbed; {FORMAT} is allowed"))
            }
        }
    }

    /// Whether a file of the folder is as it was written; of a name that is not listed nothing is known.
    fn state(&self, dir: &Path, name: &str) -> io::Result<State> {
        let path = dir.join(name);
        match (self.files.get(name), fs::symlink_metadata(&path)) {
            (_, Err(error)) if absent(&error) => Ok(State::Absent),
            (_, Err(error)) => Err(error),
            (None, _) => Ok(State::Foreign),
            (Some(sum), Ok(_)) => match bounded::length_and_crc32(&path, sum.bytes) {
                Ok((bytes, crc32)) if Sum::from_parts(bytes, crc32) == *sum => Ok(State::AsWritten),
                Err(error) if !matches!(error.kind(), ErrorKind::FileTooLarge | ErrorKind::InvalidInput) => {
                    Err(error)
                }
                _ => Ok(State::Changed),
            },
        }
    }
}

/// What lies under a name in a folder with a record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    Absent,
    AsWritten,
    Changed,
    Foreign,
}

/// That nothing can be written below a file is for the writer to say.
fn absent(error: &io::Error) -> bool {
    matches!(error.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory)
}

/// Why a folder or a file was left as it is.
#[derive(Debug)]
pub enum Refused {
    /// It holds something else: its name, what that is, and what to do.
    Other(String),
    /// It cannot be written.
    Output(OutputError),
}

impl From<OutputError> for Refused {
    fn from(error: OutputError) -> Self {
        Self::Output(error)
    }
}

/// A refusal that says how to go on.
pub(super) fn kept(path: &Path, what: &str) -> Refused {
    Refused::Other(format!(
        "{}: {what}; --force overwrites it, another --out leaves it; nothing was changed",
        path.shown()
    ))
}

/// A command that writes results into a folder.
#[derive(Debug)]
pub struct Author {
    command: &'static str,
    inputs: Value,
    force: bool,
}

impl Author {
    /// `inputs` is an object with all that the results depend on; the program's version is added.
    pub fn new(command: &'static str, mut inputs: Value, force: bool) -> Self {
        inputs["version"] = BUILD.version.into();
        // As text: what was written and read again is compared with the same.
        let inputs = serde_json::from_str(&inputs.to_string()).unwrap_or(inputs);
        Self { command, inputs, force }
    }

    /// Whether this command has written a folder, from the same input.
    pub fn has_written(&self, dir: &Path) -> bool {
        let own = |record: Record| record.command == self.command && record.inputs == self.inputs;
        Record::read(dir).is_ok_and(|record| record.is_some_and(own))
    }

    /// The text of the record of these files.
    pub fn record<C: AsRef<[u8]>>(&self, files: &[(String, C)]) -> String {
        let record = Record {
            format: FORMAT,
            command: self.command.to_owned(),
            inputs: self.inputs.clone(),
            files: sums(files),
        };
        let text = serde_json::to_string_pretty(&record);
        text.unwrap_or_else(|error| format!("{{\"error\": \"{error}\"}}")) + "\n"
    }

    /// Whether this command may write files of these names into a folder, which need not be there: where it has written it
    /// before from the same input, and nobody has changed these files since; or where nothing is in the way.
    ///
    /// # Errors
    ///
    /// The file that is in the way, whose it is, and what to do.
    pub fn check<N: AsRef<str>>(&self, dir: &Path, names: &[N]) -> Result<(), Refused> {
        if self.force {
            return Ok(());
        }
        let record = dir.join(RECORD);
        let Some(found) = Record::read(dir).map_err(|why| kept(&record, &why))? else {
            let own = names.iter().map(AsRef::as_ref);
            return match OTHERS.into_iter().chain(own).find(|name| there(dir, name)) {
                Some(name) => Err(kept(
                    &dir.join(name),
                    &format!("is here already, and no {RECORD} says that this command wrote it"),
                )),
                None => Ok(()),
            };
        };
        if found.command != self.command {
            let what = format!("results of `shearbed {}` are kept here", found.command);
            return Err(kept(&record, &what));
        }
        if let Some((key, was, is)) = difference(&found.inputs, &self.inputs) {
            let what = format!(
                "results of `shearbed {}` from other input are kept here: {key} was {was} and is {is} now",
                self.command
            );
            return Err(kept(&record, &what));
        }
        for name in names.iter().map(AsRef::as_ref) {
            let path = dir.join(name);
            let why = match found.state(dir, name) {
                Ok(State::Absent | State::AsWritten) => continue,
                Ok(State::Changed) => format!("was changed after `shearbed {}` wrote it", self.command),
                Ok(State::Foreign) => format!("was not written by `shearbed {}`", self.command),
                Err(error) => format!("cannot be read: {error}"),
            };
            return Err(kept(&path, &why));
        }
        Ok(())
    }

    /// Writes files and their record into a folder, which is made where it does not exist, if the command may. They appear
    /// together, and what it wrote there before under other names goes, unless somebody has changed it.
    ///
    /// # Errors
    ///
    /// Those of [`Author::check`], or what cannot be written; then nothing has changed.
    pub fn write(&self, dir: &Path, mut files: Vec<Output>) -> Result<(), Refused> {
        let record = self.record(&files);
        let names: Vec<String> = files.iter().map(|(name, _)| name.clone()).collect();
        files.push((RECORD.to_owned(), record));
        if !dir.exists() && appear(dir, &files)? {
            return Ok(());
        }
        let claim = Claim::new(dir, PATIENCE)?;
        self.check(dir, &names)?;
        Ok(claim.write_all(&files, &left_over(dir, &names))?)
    }
}

fn there(dir: &Path, name: &str) -> bool {
    fs::symlink_metadata(dir.join(name)).is_ok()
}

/// The files of a folder that its record lists, as they were written, without those in `names`: beside other results they would
/// pass for them.
pub(crate) fn left_over(dir: &Path, names: &[String]) -> Vec<String> {
    let Ok(Some(record)) = Record::read(dir) else {
        return Vec::new();
    };
    // A record that names a file elsewhere is not ours to follow.
    let inside = |name: &str| {
        let mut parts = Path::new(name).components();
        parts.all(|part| matches!(part, Component::Normal(_)))
    };
    let listed = record.files.keys().filter(|name| !names.contains(name));
    listed
        .filter(|name| inside(name) && matches!(record.state(dir, name), Ok(State::AsWritten)))
        .cloned()
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn author(command: &'static str, seed: u64) -> Author {
        Author::new(command, json!({ "seed": seed }), false)
    }

    fn files(names: &[&str]) -> Vec<Output> {
        let file = |name: &&str| ((*name).to_owned(), format!("of {name}\n"));
        names.iter().map(file).collect()
    }

    /// What was refused, without the folder's name before it.
    fn refused(dir: &Path, author: &Author, names: &[&str]) -> String {
        match author.write(dir, files(names)) {
            Err(Refused::Other(message)) => message.replace(&format!("{}/", dir.display()), ""),
            other => panic!("{other:?}"),
        }
    }

    fn names(dir: &Path) -> Vec<String> {
        let entries = fs::read_dir(dir).unwrap();
        let mut names: Vec<_> =
            entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    const WAY: &str = "; --force overwrites it, another --out leaves it; nothing was changed";

    #[test]
    fn a_command_replaces_its_own_files_from_the_same_input_and_no_others() {
        let dir = tempfile::tempdir().unwrap();
        let dir = &dir.path().join("out");
        let own = author("run", 1);
        own.write(dir, files(&["a.csv", "b/c.csv"])).unwrap();
        fs::write(dir.join("user.csv"), "mine").unwrap();
        // Again, and by the record what it no longer writes goes; what is the user's stays.
        own.write(dir, files(&["a.csv"])).unwrap();
        assert_eq!(names(dir), ["a.csv", "b", "shearbed.json", "user.csv"]);
        assert!(!dir.join("b/c.csv").exists());

        let shown = |what: &str| format!("{what}{WAY}");
        assert_eq!(
            refused(dir, &author("fit", 1), &["x.csv"]),
            shown("shearbed.json: results of `shearbed run` are kept here")
        );
        assert_eq!(
            refused(dir, &author("run", 2), &["a.csv"]),
            shown(
                "shearbed.json: results of `shearbed run` from other input are kept here: seed was 1 and is 2 now"
            )
        );
        assert_eq!(
            refused(dir, &own, &["a.csv", "user.csv"]),
            shown("user.csv: was not written by `shearbed run`")
        );
        fs::write(dir.join("a.csv"), "of b.csv\n").unwrap();
        assert_eq!(refused(dir, &own, &["a.csv"]), shown("a.csv: was changed after `shearbed run` wrote it"));
        // What was changed does not go either where it is no longer written.
        own.write(dir, files(&["d.csv"])).unwrap();
        assert_eq!(names(dir), ["a.csv", "b", "d.csv", "shearbed.json", "user.csv"]);
        Author::new("fit", json!({}), true).write(dir, files(&["e.csv"])).unwrap();
        assert_eq!(names(dir), ["a.csv", "b", "e.csv", "shearbed.json", "user.csv"]);
    }

    #[test]
    fn without_a_record_whatever_is_in_the_way_stays() {
        let dir = tempfile::tempdir().unwrap();
        let own = author("run", 1);
        for name in ["a.csv", "sweep.json"] {
            fs::write(dir.path().join(name), "mine").unwrap();
            assert_eq!(
                refused(dir.path(), &own, &["a.csv"]),
                format!("{name}: is here already, and no shearbed.json says that this command wrote it{WAY}")
            );
            assert_eq!(names(dir.path()), [name]);
            fs::remove_file(dir.path().join(name)).unwrap();
        }
        for (text, why) in [
            ("{", "shearbed.json: is no record of results"),
            (
                r#"{"format": 2, "command": "run", "inputs": {}, "files": {}}"#,
                "shearbed.json: has the format 2",
            ),
        ] {
            fs::write(dir.path().join(RECORD), text).unwrap();
            let found = refused(dir.path(), &own, &["a.csv"]);
            assert!(found.starts_with(why), "{found}");
        }
        // A record that lists files elsewhere does not lead there.
        let outside = dir.path().join("outside.csv");
        fs::write(&outside, "of ../outside.csv\n").unwrap();
        let inner = dir.path().join("inner");
        fs::create_dir(&inner).unwrap();
        fs::write(inner.join(RECORD), own.record(&files(&["../outside.csv"]))).unwrap();
        own.write(&inner, files(&["a.csv"])).unwrap();
        assert!(outside.exists());
    }
}
