//! `shearbed.json`: which command wrote a folder, from which inputs, and the folder's files with their checksums.
//!
//! Every folder of results has this file, including points of a sweep and exported problems. It decides about
//! overwriting ([`super::ResultFolder`]), and lets `plot` and `compare` detect files that were changed since.

use super::Output;
use super::beneath::beneath;
use crate::files::bounded;
use crate::files::difference::difference;
use crate::files::text::{json, shortened};
use cap_std::fs::Dir;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeMap;
use std::io::{self, ErrorKind};
use std::path::Path;

/// The name of the file, which is written last.
pub const RECORD: &str = "shearbed.json";
const FORMAT: u32 = 1;
const MOST_BYTES: u64 = 64 << 20;

/// A command and everything on which its results depend; checkpoints have one too.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Origin {
    /// Name of the command, such as `run`.
    pub command: String,
    /// An object of inputs; files are represented by their checksums.
    pub inputs: Value,
}

impl Origin {
    /// A command with its inputs.
    pub fn new(command: &str, inputs: Value) -> Self {
        // Converted by text, because it will be compared with inputs that were written and read again.
        let inputs = serde_json::from_str(&inputs.to_string()).unwrap_or(inputs);
        Self { command: command.to_owned(), inputs }
    }

    /// The first difference from the inputs `now`, in words: `scene.m was 3 and is 4 now`.
    pub fn difference(&self, now: &Self) -> Option<String> {
        let shown = |value: &Value| match value {
            Value::Object(all) if all.len() > 3 => format!("of {} files", all.len()),
            Value::Array(all) if all.len() > 3 || all.iter().any(Value::is_object) => {
                format!("of {} entries", all.len())
            }
            value => shortened(&value.to_string()).into_owned(),
        };
        let words =
            |(key, was, is): (String, Value, Value)| format!("{key} was {} and is {} now", shown(&was), shown(&is));
        if self.command == now.command {
            difference(&self.inputs, &now.inputs).map(words)
        } else {
            Some(format!("command was \"{}\" and is \"{}\" now", self.command, now.command))
        }
    }
}

/// The contents of `shearbed.json`.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Record {
    format: u32,
    /// The command that wrote the folder, and its inputs.
    #[serde(flatten)]
    pub origin: Origin,
    /// Length and checksum of each file by its name; for points of a sweep only their records are listed.
    pub files: BTreeMap<String, Sum>,
    /// While `files` are moved into place: the earlier files that they replace.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    replaces: Option<BTreeMap<String, Sum>>,
}

/// The length and the checksum (CRC-32 as eight hexadecimal digits) of a file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Sum {
    /// Length in bytes.
    pub bytes: u64,
    /// Checksum as eight hexadecimal digits.
    pub crc32: String,
}

impl Sum {
    /// The sum of a file's contents.
    pub fn of(contents: &[u8]) -> Self {
        Self::from_parts(contents.len() as u64, crc32fast::hash(contents))
    }

    /// The sum of a file of `bytes` bytes with the checksum `crc32`.
    pub fn from_parts(bytes: u64, crc32: u32) -> Self {
        let crc32 = format!("{crc32:08x}");
        Self { bytes, crc32 }
    }
}

impl Record {
    /// The record of `files` written from `origin`.
    pub fn new<C: AsRef<[u8]>>(origin: &Origin, files: &[(String, C)]) -> Self {
        let sum = |(name, contents): &(String, C)| (name.clone(), Sum::of(contents.as_ref()));
        let files = files.iter().map(sum).collect();
        Self { format: FORMAT, origin: origin.clone(), files, replaces: None }
    }

    /// The record while its files replace `earlier` ones.
    pub(super) fn replacing(&self, earlier: BTreeMap<String, Sum>) -> Self {
        Self { replaces: Some(earlier), ..self.clone() }
    }

    /// The names of all files that are listed.
    pub fn names(&self) -> impl Iterator<Item = &String> {
        self.files.keys().chain(self.replaces.iter().flat_map(BTreeMap::keys))
    }

    /// The record as a file.
    pub fn file(&self) -> Output {
        let text = json(self).unwrap_or_else(|error| format!("{{\"error\": \"{error}\"}}\n"));
        (RECORD.to_owned(), text)
    }

    /// The record of a folder; `None` if there is no such file or folder.
    ///
    /// # Errors
    ///
    /// The reason why the file cannot be read, without its name.
    pub fn read(dir: &Path) -> Result<Option<Self>, String> {
        let text = match bounded::text(&dir.join(RECORD), MOST_BYTES) {
            Err(error) if absent(&error) => return Ok(None),
            text => text.map_err(|error| format!("cannot be read: {error}"))?,
        };
        let record: Self = serde_json::from_str(&text)
            .map_err(|error| format!("is no record of results that `shearbed` wrote: {error}"))?;
        match record.format {
            FORMAT => Ok(Some(record)),
            other => Err(format!("has the format {other}, of another version of shearbed; {FORMAT} is allowed")),
        }
    }

    /// Fails if a file of the folder has another sum than the record lists, or if the folder is incomplete; the error
    /// does not contain the file's name.
    pub fn check(&self, name: &str, sum: &Sum) -> Result<(), String> {
        self.is_complete()?;
        match self.files.get(name) {
            Some(listed) if listed == sum => Ok(()),
            Some(_) => Err(format!(
                "was changed after it was written: its checksum is not that of {RECORD}; run the command that wrote it \
                 again, with --force"
            )),
            None => Err(format!("is not listed in the folder's {RECORD}")),
        }
    }

    /// Fails if the folder's command was stopped while it replaced files there; the error does not contain the folder's
    /// name.
    pub fn is_complete(&self) -> Result<(), String> {
        match self.replaces {
            None => Ok(()),
            Some(_) => Err(format!(
                "is of an incomplete folder: `shearbed {}` was stopped while it replaced files there; run it again",
                self.origin.command
            )),
        }
    }

    /// The listed files that have not been changed.
    pub(super) fn unchanged(&self, dir: &Dir) -> BTreeMap<String, Sum> {
        let as_written = |name: &String| match self.state(dir, name) {
            Ok(State::AsWritten(sum)) => Some((name.clone(), sum)),
            _ => None,
        };
        self.names().filter_map(as_written).collect()
    }

    /// The state of a file of the folder compared with the record. No link is followed.
    pub(super) fn state(&self, dir: &Dir, name: &str) -> io::Result<State> {
        let Some((folder, last)) = beneath(dir, name)? else {
            return Ok(State::Absent);
        };
        let found = match folder.symlink_metadata(&last) {
            Err(error) if absent(&error) => return Ok(State::Absent),
            found => found?,
        };
        let listed = [Some(&self.files), self.replaces.as_ref()].into_iter().flatten();
        let listed: Vec<_> = listed.filter_map(|files| files.get(name)).collect();
        let most = listed.iter().map(|sum| sum.bytes).max();
        match most {
            None => Ok(State::Foreign),
            Some(_) if found.permissions().readonly() => Ok(State::ReadOnly),
            Some(most) if found.is_file() && found.len() <= most => {
                let (bytes, crc32) = bounded::length_and_crc32_of(bounded::open_in(&folder, &last)?, most)?;
                let sum = Sum::from_parts(bytes, crc32);
                Ok(if listed.contains(&&sum) { State::AsWritten(sum) } else { State::Changed })
            }
            Some(_) => Ok(State::Changed),
        }
    }
}

/// The state of a file in a folder with a record.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum State {
    Absent,
    AsWritten(Sum),
    ReadOnly,
    Changed,
    Foreign,
}

/// True if there is no such file. A file in place of a folder and a name that cannot be count too: the writer reports
/// them.
fn absent(error: &io::Error) -> bool {
    matches!(error.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory | ErrorKind::InvalidFilename)
}
