//! The rule for overwriting, for all commands: without `--force`, files that a command did not write itself, or wrote
//! from other inputs, are left unchanged.

use super::beneath::beneath;
use super::record::{Origin, RECORD, Record, State, Sum};
use super::{Claim, Output, PATIENCE, Refused, at};
use crate::files::build::BUILD;
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
    force: bool,
    /// True if results of the same command from other inputs may be replaced too.
    from_any_input: bool,
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
            force,
            from_any_input: false,
            other: OTHER_OUT,
        }
    }

    /// Adapts messages to a command that takes its folder as an argument, without `--out`.
    pub fn as_argument(self) -> Self {
        Self { other: "another folder", ..self }
    }

    /// Allows results of the same command from other inputs to be replaced too.
    pub fn from_any_input(self) -> Self {
        Self { from_any_input: true, ..self }
    }

    /// The path of the folder.
    pub fn dir(&self) -> &Path {
        &self.dir
    }

    /// The command and its inputs.
    pub fn origin(&self) -> &Origin {
        &self.origin
    }

    /// True if files may be overwritten that this command did not write, or wrote from other inputs.
    pub fn has_force(&self) -> bool {
        self.force
    }

    /// True if this command wrote the folder from the same inputs.
    pub fn is_own(&self) -> bool {
        let own = |record: Record| record.origin == self.origin;
        Record::read(&self.dir).is_ok_and(|record| record.is_some_and(own))
    }

    /// The first difference from the inputs of earlier results of this command in the folder.
    pub fn difference(&self) -> Option<String> {
        let found = Record::read(&self.dir).ok()??;
        found.origin.difference(&self.origin).filter(|_| found.origin.command == self.origin.command)
    }

    /// Fails if files with these names must not be written. They may be written if none exists, or if this command
    /// wrote the folder before from the same inputs (or any, with [`Self::from_any_input`]) and the files have not been
    /// changed since.
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
            let what = format!("results of `shearbed {}` are kept here", found.origin.command);
            return Err(in_the_way(&record, &what));
        }
        if let Some(difference) = found.origin.difference(&self.origin).filter(|_| !self.from_any_input) {
            let what = format!("results of `shearbed {command}` from other input are kept here: {difference}");
            return Err(in_the_way(&record, &what));
        }
        names.try_for_each(|(name, path)| {
            let why = match found.state(&dir, name) {
                Ok(State::Absent | State::AsWritten(_)) => return Ok(()),
                Ok(State::Changed) => format!("was changed after `shearbed {command}` wrote it"),
                Ok(State::Foreign) => format!("was not written by `shearbed {command}`"),
                Err(error) => format!("cannot be read: {error}"),
            };
            Err(in_the_way(&path, &why))
        })
    }

    /// Writes files and their record, if the command may. They appear together; files that it wrote there before under
    /// other names are removed, unless they have been changed.
    ///
    /// # Errors
    ///
    /// Those of [`Self::check`], or if writing fails; then nothing has changed.
    pub fn write(&self, files: Vec<Output>) -> Result<(), Refused> {
        let record = Record::new(&self.origin, &files);
        let names: Vec<String> = files.iter().map(|(name, _)| name.clone()).collect();
        loop {
            if let Some(claim) = Claim::open(&self.dir, PATIENCE)? {
                self.check(&names)?;
                let earlier = self.earlier(&claim);
                let left_over: Vec<_> = earlier.keys().filter(|name| !names.contains(name)).cloned().collect();
                return Ok(claim.write(&record, &files, earlier, &left_over)?);
            }
            let all = [&files[..], &[record.file()]].concat();
            if Claim::appear(&self.dir, &all)?.is_some() {
                return Ok(());
            }
        }
    }

    /// The unchanged files that the folder's record lists, if this command wrote them: left beside new results, they
    /// would be mistaken for them. Those of another command stay, also with `--force`.
    pub(crate) fn earlier(&self, claim: &Claim) -> BTreeMap<String, Sum> {
        let record = Record::read(&self.dir).ok().flatten();
        let own = record.filter(|record| record.origin.command == self.origin.command);
        own.map(|record| record.unchanged(&claim.dir)).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;
    use std::fs;

    fn folder(dir: &Path, command: &str, seed: u64) -> ResultFolder {
        ResultFolder::new(dir, command, json!({ "seed": seed }), false)
    }

    fn files(names: &[&str]) -> Vec<Output> {
        let file = |name: &&str| ((*name).to_owned(), format!("of {name}\n"));
        names.iter().map(file).collect()
    }

    /// The error without the folder's name.
    fn refused(folder: &ResultFolder, names: &[&str]) -> String {
        let Refused(message) = folder.write(files(names)).unwrap_err();
        message.replace(&format!("{}/", folder.dir.display()), "")
    }

    fn names(dir: &Path) -> Vec<String> {
        let name = |path: PathBuf| path.file_name().unwrap().to_str().unwrap().to_owned();
        crate::files::entries(dir).unwrap().into_iter().map(name).collect()
    }

    const WAY: &str = "; --force overwrites it, another --out leaves it; nothing was changed";

    #[test]
    fn a_command_replaces_its_own_files_from_the_same_input_and_no_others() {
        let dir = tempfile::tempdir().unwrap();
        let dir = &dir.path().join("out");
        let own = folder(dir, "run", 1);
        own.write(files(&["a.csv", "b/c.csv"])).unwrap();
        fs::write(dir.join("user.csv"), "mine").unwrap();
        // A second write removes files in the record that are no longer written; the user's files stay.
        own.write(files(&["a.csv"])).unwrap();
        assert_eq!(names(dir), ["a.csv", "b", "shearbed.json", "user.csv"]);
        assert!(!dir.join("b/c.csv").exists());

        let kept = "shearbed.json: results of `shearbed run`";
        for (folder, names, what) in [
            (&folder(dir, "fit", 1), &["x.csv"][..], format!("{kept} are kept here")),
            (
                &folder(dir, "run", 2),
                &["a.csv"],
                format!("{kept} from other input are kept here: seed was 1 and is 2 now"),
            ),
            (&own, &["a.csv", "user.csv"], "user.csv: was not written by `shearbed run`".into()),
        ] {
            assert_eq!(refused(folder, names), what + WAY);
        }
        fs::write(dir.join("a.csv"), "of b.csv\n").unwrap();
        assert_eq!(refused(&own, &["a.csv"]), format!("a.csv: was changed after `shearbed run` wrote it{WAY}"));
        // Changed files stay too, even if they are no longer written.
        own.write(files(&["d.csv"])).unwrap();
        assert_eq!(names(dir), ["a.csv", "b", "d.csv", "shearbed.json", "user.csv"]);
        // By force what this command wrote from other input goes, and what another one wrote stays.
        ResultFolder::new(dir, "run", json!({ "seed": 2 }), true).write(files(&["e.csv"])).unwrap();
        assert_eq!(names(dir), ["a.csv", "b", "e.csv", "shearbed.json", "user.csv"]);
        ResultFolder::new(dir, "fit", json!({}), true).write(files(&["f.csv"])).unwrap();
        assert_eq!(names(dir), ["a.csv", "b", "e.csv", "f.csv", "shearbed.json", "user.csv"]);
    }

    #[test]
    fn without_a_record_whatever_is_in_the_way_stays() {
        let dir = tempfile::tempdir().unwrap();
        let own = folder(dir.path(), "run", 1);
        for name in ["a.csv", "b.csv"] {
            fs::write(dir.path().join(name), "mine").unwrap();
            assert_eq!(
                refused(&own, &["a.csv", "b.csv"]),
                format!("{name}: is here already, and no shearbed.json says that this command wrote it{WAY}")
            );
            assert_eq!(names(dir.path()), [name]);
            fs::remove_file(dir.path().join(name)).unwrap();
        }
        for (text, why) in [
            ("{", "shearbed.json: is no record of results"),
            (r#"{"format": 2, "command": "run", "inputs": {}, "files": {}}"#, "shearbed.json: has the format 2"),
        ] {
            fs::write(dir.path().join(RECORD), text).unwrap();
            let found = refused(&own, &["a.csv"]);
            assert!(found.starts_with(why), "{found}");
        }
    }
}
