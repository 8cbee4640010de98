//! A single file that one process replaces repeatedly, always as a whole.

use super::claim::{Lock, writing};
use super::{OutputError, at};
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::MutexGuard;
use std::time::Duration;

/// A file that no other process replaces while this exists. Its lock and the file being written are hidden beside it; a killed process
/// may leave them, and the next one takes them over.
#[derive(Debug)]
pub struct Replaced {
    path: PathBuf,
    part: PathBuf,
    _lock: Lock,
}

impl Replaced {
    /// Claims a file, which need not exist; creates its folder if that does not exist.
    pub fn claim(path: &Path) -> Result<Self, OutputError> {
        let not_a_file = || io::Error::new(io::ErrorKind::InvalidInput, "the name of a file is allowed");
        let name = path.file_name().ok_or_else(not_a_file).map_err(at(path))?;
        let name = name.to_string_lossy();
        let parent = path.parent().filter(|dir| !dir.as_os_str().is_empty());
        let dir = parent.unwrap_or(Path::new("."));
        let lock = Lock::new(dir, &format!(".checkpoint-{name}.lock"), Duration::ZERO, |reason| {
            at(path)(match reason.kind() {
                io::ErrorKind::WouldBlock => io::Error::new(
                    reason.kind(),
                    "another shearbed is at work with this file; wait for it, or give another",
                ),
                _ => reason,
            })
        })?;
        Ok(Self { path: path.to_owned(), part: dir.join(format!(".checkpoint-{name}.part")), _lock: lock })
    }

    /// The path of the file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Writes new contents, which `Part::finish` moves into place: at every moment either the old or the new file is there, complete
    /// and on the disk.
    pub fn write(
        &self,
        write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> Result<Part<'_>, OutputError> {
        let writing = writing();
        // An obstacle at the place of the new file stays.
        let part = anew(&self.part).map_err(at(&self.path))?;
        let written = || {
            let mut file = BufWriter::new(part);
            write(&mut file)?;
            file.into_inner().map_err(io::IntoInnerError::into_error)
        };
        match written() {
            Ok(file) => Ok(Part { of: self, file, _writing: writing }),
            Err(error) => Err(self.given_up(error)),
        }
    }

    fn given_up(&self, error: io::Error) -> OutputError {
        // The first error is the one to report.
        let _ = fs::remove_file(&self.part);
        at(&self.path)(error)
    }
}

/// A new file in place of the remains of a killed process; fails if there is no regular file but a link or a pipe, for example.
fn anew(path: &Path) -> io::Result<File> {
    match fs::symlink_metadata(path) {
        Ok(found) if found.is_file() => fs::remove_file(path)?,
        Ok(_) => {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            let why = format!("{name} beside it is in the way: it is no regular file; remove it");
            return Err(io::Error::new(io::ErrorKind::InvalidInput, why));
        }
        Err(_) => {}
    }
    File::create_new(path)
}

/// New contents that are not yet in place. Nothing else is written meanwhile.
pub struct Part<'a> {
    of: &'a Replaced,
    file: File,
    _writing: MutexGuard<'static, ()>,
}

impl Part<'_> {
    /// Writes the contents to the disk and moves them into place.
    pub fn finish(self) -> Result<(), OutputError> {
        let Replaced { path, part, .. } = self.of;
        let moved = self.file.sync_all().and_then(|()| fs::rename(part, path));
        moved.map_err(|error| self.of.given_up(error))?;
        // If a folder cannot be synchronised, the system decides when the name reaches the disk.
        let _ = part.parent().map(synchronise);
        Ok(())
    }
}

/// Writes the names in a folder to the disk.
#[expect(
    clippy::disallowed_methods,
    reason = "a folder, which bounded::open refuses, and which nothing waits for"
)]
fn synchronise(dir: &Path) -> io::Result<()> {
    File::open(dir)?.sync_all()
}
