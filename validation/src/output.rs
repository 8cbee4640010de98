//! Writing files so that each appears whole or not at all.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use tempfile::{Builder, NamedTempFile};

/// A file's name and its contents.
pub type Output = (String, String);

/// Why nothing was written: the file or folder, and the reason.
#[derive(Debug)]
pub struct OutputError {
    /// What could not be written.
    pub path: PathBuf,
    /// The system's reason.
    pub reason: io::Error,
}

impl std::fmt::Display for OutputError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}: cannot be written: {}", self.path.display(), self.reason)
    }
}

impl std::error::Error for OutputError {}

fn at(path: &Path) -> impl FnOnce(io::Error) -> OutputError {
    let path = path.to_owned();
    |reason| OutputError { path, reason }
}

/// Whether files can be made in `dir`, or where it does not exist in the folder above it. Leaves nothing behind: for a
/// command that works long before it writes.
pub fn probe(dir: &Path) -> Result<(), OutputError> {
    let here = Path::new(".");
    let existing = dir.ancestors().find(|folder| folder.exists());
    let existing = existing
        .filter(|folder| !folder.as_os_str().is_empty())
        .unwrap_or(here);
    temporary(existing).map(drop).map_err(at(dir))
}

/// Writes all files into `dir`, which is made where it does not exist. They are written under temporary names, flushed to
/// disk, and renamed only when all of them are there; on any error nothing that was there has changed.
pub fn write_all(dir: &Path, files: &[Output]) -> Result<(), OutputError> {
    let made = !dir.exists();
    fs::create_dir_all(dir).map_err(at(dir))?;
    let written = write_and_rename(dir, files);
    if written.is_err() && made {
        // Only where it is empty; the first error is the one to report.
        let _ = fs::remove_dir(dir);
    }
    written
}

/// Writes a new folder of files, which appears whole or not at all. An interrupted call leaves a folder with `.part` in
/// its hidden name, which the next call for the same folder replaces.
pub fn write_folder(dir: &Path, files: &[Output]) -> Result<(), OutputError> {
    let name = dir.file_name().unwrap_or_default().to_string_lossy();
    let part = dir.with_file_name(format!(".{name}.part"));
    let write = || {
        if part.exists() {
            fs::remove_dir_all(&part)?;
        }
        fs::create_dir_all(&part)?;
        for (name, contents) in files {
            let mut file = File::create_new(part.join(name))?;
            file.write_all(contents.as_bytes())?;
            file.sync_all()?;
        }
        fs::rename(&part, dir)
    };
    write().map_err(at(dir))
}

/// Removes files of `dir` that are there.
pub fn remove(dir: &Path, names: &[String]) -> Result<(), OutputError> {
    for path in names.iter().map(|name| dir.join(name)) {
        match fs::remove_file(&path) {
            Err(reason) if reason.kind() != io::ErrorKind::NotFound => {
                return Err(OutputError { path, reason });
            }
            _ => (),
        }
    }
    Ok(())
}

fn write_and_rename(dir: &Path, files: &[Output]) -> Result<(), OutputError> {
    let mut ready = Vec::new();
    for (name, contents) in files {
        let target = dir.join(name);
        if target.is_dir() {
            return Err(at(&target)(io::ErrorKind::IsADirectory.into()));
        }
        ready.push((written(dir, contents).map_err(at(&target))?, target));
    }
    for (file, target) in ready {
        file.persist(&target).map_err(|error| at(&target)(error.error))?;
    }
    Ok(())
}

/// A temporary file with the contents, on the disk. It is removed when dropped.
fn written(dir: &Path, contents: &str) -> io::Result<NamedTempFile> {
    let file = temporary(dir)?;
    // The file itself: errors of `NamedTempFile` would name the temporary path.
    file.as_file().write_all(contents.as_bytes())?;
    file.as_file().sync_all()?;
    Ok(file)
}

fn temporary(dir: &Path) -> io::Result<NamedTempFile> {
    // `File::create_new` gives the usual permissions, where a temporary file would be the owner's alone.
    Builder::new()
        .prefix(".shearbed-")
        .make_in(dir, |path| File::create_new(path))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    fn contents(dir: &Path) -> BTreeMap<String, Option<String>> {
        fs::read_dir(dir)
            .unwrap()
            .map(|entry| entry.unwrap())
            .map(|entry| {
                (
                    entry.file_name().into_string().unwrap(),
                    fs::read_to_string(entry.path()).ok(),
                )
            })
            .collect()
    }

    fn output(name: &str, text: &str) -> Output {
        (name.to_owned(), text.to_owned())
    }

    #[test]
    fn all_files_are_written_and_replaced() {
        let dir = tempfile::tempdir().unwrap();
        let inner = dir.path().join("a/b");
        probe(&inner).unwrap();
        assert!(!inner.exists());
        for text in ["old", "new"] {
            write_all(&inner, &[output("x", text), output("y", "")]).unwrap();
        }
        let expected = [("x", "new"), ("y", "")].map(|(name, text)| (name.to_owned(), Some(text.to_owned())));
        assert_eq!(contents(&inner), BTreeMap::from(expected));
    }

    #[test]
    fn a_target_that_is_a_folder_leaves_everything_as_it_was() {
        let dir = tempfile::tempdir().unwrap();
        fs::write(dir.path().join("x"), "old").unwrap();
        fs::create_dir(dir.path().join("y")).unwrap();
        let before = contents(dir.path());
        let error = write_all(
            dir.path(),
            &[output("x", "new"), output("y", "new"), output("z", "new")],
        )
        .unwrap_err();
        assert_eq!(error.path, dir.path().join("y"));
        assert_eq!(contents(dir.path()), before);
    }

    #[test]
    fn a_folder_made_for_files_that_fail_is_removed() {
        let dir = tempfile::tempdir().unwrap();
        let made = dir.path().join("made");
        let error = write_all(&made, &[output("no/such/folder", ""), output("a\0b", "")]).unwrap_err();
        assert_eq!(error.path, made.join("no/such/folder"));
        assert!(!made.exists());
    }

    #[test]
    fn a_folder_that_is_a_file_is_named() {
        let dir = tempfile::tempdir().unwrap();
        let file = dir.path().join("file");
        fs::write(&file, "old").unwrap();
        for dir in [file.clone(), file.join("below")] {
            assert_eq!(probe(&dir).unwrap_err().path, dir);
            assert_eq!(write_all(&dir, &[output("x", "")]).unwrap_err().path, dir);
        }
        assert_eq!(fs::read_to_string(&file).unwrap(), "old");
    }
}
