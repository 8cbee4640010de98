//! The rule for overwriting, for all commands: without `--force`, files that a command did not write itself, or that
//! were changed since, are left as they are.

use super::beneath::beneath;
use super::record::{Origin, RECORD, Record, State, Sum};
use super::stage::RESULTS;
use super::{Claim, Output, PATIENCE, Refused, at};
use crate::files::build::BUILD;
use crate::files::locked;
use crate::files::text::Shown;
use cap_std::ambient_authority;
use cap_std::fs::Dir;
use serde_json::Value;
use std::collections::BTreeMap;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// The error that a file would be overwritten, and what to do next.
pub(super) fn in_the_way(path: &Path, what: &str, other: &str) -> Refused {
    Refused(format!("{}: {what}; --force overwrites it, {other} leaves it; nothing was changed", path.shown()))
}

/// The option by which most commands take another folder or file.
pub(super) const OTHER_OUT: &str = "another --out";

/// A folder for the results of one command; it need not exist yet.
#[derive(Debug)]
pub struct ResultFolder {
    dir: PathBuf,
    origin: Origin,
    /// True if files may be overwritten whoever wrote them.
    pub(crate) force: bool,
    /// What was here to begin with.
    before: Option<Origin>,
    /// True if results of the same command from other inputs stay too.
    from_same_input: bool,
    /// How to give the command another folder, for messages.
    other: &'static str,
}

impl ResultFolder {
    /// `inputs` is an object with everything on which the results depend; the program's version is added.
    pub fn new(dir: &Path, command: &str, mut inputs: Value, force: bool) -> Self {
        inputs["version"] = BUILD.version.into();
        Self {
            dir: dir.to_owned(),
            origin: Origin::new(command, inputs),
            before: Record::read(dir).ok().flatten().map(|record| record.origin),
            force,
            from_same_input: false,
            other: OTHER_OUT,
        }
    }

    /// Adapts messages to a command that takes its folder as an argument, without `--out`.
    pub fn as_argument(self) -> Self {
        Self { other: "another folder", ..self }
    }

    /// Keeps results of the same command from other inputs too.
    pub fn from_same_input(self) -> Self {
        Self { from_same_input: true, ..self }
    }

    /// The path of the folder.
    pub fn dir(&self) -> &Path {
        &self.dir
    }

    /// The command and its inputs.
    pub fn origin(&self) -> &Origin {
        &self.origin
    }

    /// True if this command wrote the folder from the same inputs.
    pub fn is_own(&self) -> bool {
        self.own().is_some_and(|record| record.origin == self.origin)
    }

    /// Fails if files with these names must not be written. They may be written if none exists, or if this command
    /// wrote the folder before and the files have not been changed since, nor made read-only; with
    /// [`Self::from_same_input`], or if they appeared after [`Self::new`], from the same inputs.
    ///
    /// # Errors
    ///
    /// Names the file that would be overwritten, the command that wrote it, and what to do next.
    pub fn check<N: AsRef<str>>(&self, names: &[N]) -> Result<(), Refused> {
        if self.force {
            return Ok(());
        }
        let (record, command) = (self.dir.join(RECORD), &self.origin.command);
        let in_the_way = |path: &Path, what: &str| in_the_way(path, what, self.other);
        let dir = match Dir::open_ambient_dir(&self.dir, ambient_authority()) {
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(()),
            dir => dir.map_err(at(&self.dir))?,
        };
        let found = Record::read(&self.dir).map_err(|why| in_the_way(&record, &why))?;
        let is_there = |name: &str| match beneath(&dir, name) {
            Ok(Some((folder, last))) => folder.symlink_metadata(last).is_ok(),
            Ok(None) => false,
            Err(_) => true,
        };
        let mut names = names.iter().map(|name| (name.as_ref(), self.dir.join(name.as_ref())));
        let Some(found) = found else {
            return match names.find(|(name, _)| is_there(name)) {
                Some((_, path)) => {
                    Err(in_the_way(&path, &format!("is here already, and no {RECORD} says that this command wrote it")))
                }
                None => Ok(()),
            };
        };
        if found.origin.command != *command {
            let what = format!("results of `shearbed {}` are here", found.origin.command);
            return Err(in_the_way(&record, &what));
        }
        // Another process that replaces results may have begun later, and have reported success.
        let is_later = self.before.as_ref() != Some(&found.origin);
        if let Some(difference) = found.origin.difference(&self.origin).filter(|_| self.from_same_input || is_later) {
            let since = if is_later { " since" } else { "" };
            let what = format!("results of `shearbed {command}` from other input are here{since}: {difference}");
            return Err(in_the_way(&record, &what));
        }
        names.try_for_each(|(name, path)| {
            let why = match found.state(&dir, name) {
                Ok(State::Absent | State::AsWritten(_)) => return Ok(()),
                Ok(State::ReadOnly) => "is read-only".into(),
                Ok(State::Changed) => format!("was changed after `shearbed {command}` wrote it"),
                Ok(State::Foreign) => format!("was not written by `shearbed {command}`"),
                Err(error) => format!("cannot be read: {error}"),
            };
            Err(in_the_way(&path, &why))
        })
    }

    /// Writes files and their record, if the command may. They appear together; files that it wrote there before under
    /// other names are removed, unless they have been changed. The first difference from the inputs of earlier results
    /// of this command that were replaced, if these had others.
    ///
    /// # Errors
    ///
    /// Those of [`Self::check`], or if writing fails; then nothing has changed.
    pub fn write(&self, files: &[Output]) -> Result<Option<String>, Refused> {
        let mut are_there = locked(&RESULTS);
        let replaced = self.replace(files)?;
        *are_there = true;
        Ok(replaced)
    }

    fn replace(&self, files: &[Output]) -> Result<Option<String>, Refused> {
        let record = Record::new(&self.origin, files);
        let names: Vec<String> = files.iter().map(|(name, _)| name.clone()).collect();
        let all = [files, &[record.file()]].concat();
        let (claim, is_new) = Claim::open_or_appear(&self.dir, PATIENCE, &all)?;
        if is_new {
            return Ok(None);
        }
        self.check(&names)?;
        let earlier = self.earlier(&claim);
        let left_over: Vec<_> = earlier.keys().filter(|name| !names.contains(name)).cloned().collect();
        let replaced = self.own().and_then(|record| record.origin.difference(&self.origin));
        claim.write(&record, files, earlier, &left_over)?;
        Ok(replaced)
    }

    /// Writes files into the first of `<folder>-2` to `<folder>-99` that does not exist, and names it: what has been
    /// worked for is not lost where the folder was changed meanwhile.
    pub fn write_beside(&self, files: &[Output]) -> Option<PathBuf> {
        let name = self.dir.file_name()?.to_str()?;
        let mut beside = (2..100).map(|k| self.dir.with_file_name(format!("{name}-{k}")));
        let dir = beside.find(|dir| dir.symlink_metadata().is_err())?;
        let folder = Self { dir, origin: self.origin.clone(), before: None, ..*self };
        folder.write(files).ok().map(|_| folder.dir)
    }

    /// The record of earlier results of this command in the folder.
    fn own(&self) -> Option<Record> {
        Record::read(&self.dir).ok().flatten().filter(|record| record.origin.command == self.origin.command)
    }

    /// The unchanged files that the folder's record lists, if this command wrote them: left beside new results, they
    /// would be mistaken for them. Those of another command stay, also with `--force`.
    pub(crate) fn earlier(&self, claim: &Claim) -> BTreeMap<String, Sum> {
        self.own().map(|record| record.unchanged(&claim.dir)).unwrap_or_default()
    }
}
