//! A single file that one process replaces repeatedly, always as a whole.

use super::stage::{Stage, report};
use super::{OutputError, at, folder_of};
use crate::files::{bounded, locked};
use cap_std::ambient_authority;
use cap_std::fs::Dir;
use std::fs::{self, File, TryLockError};
use std::io::{self, BufWriter, Seek, Write};
use std::path::{Path, PathBuf};
use std::sync::Mutex;

/// A file that no other process replaces while this exists.
#[derive(Debug)]
pub struct Replaced {
    path: PathBuf,
    name: String,
    /// The file in place, locked, if there is one.
    file: Mutex<Option<File>>,
}

/// The name of new contents in their hidden folder.
const NEW: &str = "new";

fn busy() -> io::Error {
    let why = "another shearbed is at work with this file; wait for it, or give another";
    io::Error::new(io::ErrorKind::WouldBlock, why)
}

impl Replaced {
    /// Claims a file, which need not exist.
    pub fn claim(path: &Path) -> Result<Self, OutputError> {
        let not_a_file = || io::Error::new(io::ErrorKind::InvalidInput, "the name of a file is allowed");
        let name = path.file_name().and_then(|name| name.to_str()).ok_or_else(not_a_file).map_err(at(path))?;
        let file = loop {
            let file = match bounded::open_with(path, File::options().read(true).write(true)) {
                Err(error) if error.kind() == io::ErrorKind::NotFound => break None,
                file => file.map_err(at(path))?,
            };
            if let Err(TryLockError::WouldBlock) = file.try_lock() {
                return Err(at(path)(busy()));
            }
            // The process that held the lock may have replaced the file.
            if is_at(&file, path) {
                break Some(file);
            }
        };
        Ok(Self { path: path.to_owned(), name: name.to_owned(), file: Mutex::new(file) })
    }

    /// The path of the file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The file, to be read; `None` if there is none.
    pub fn open(&self) -> io::Result<Option<File>> {
        let file = locked(&self.file).as_ref().map(File::try_clone).transpose()?;
        file.map(|mut file| file.rewind().map(|()| file)).transpose()
    }

    /// Writes new contents, which `Part::finish` moves into place: at every moment either the old or the new file is
    /// there, complete and on the disk. Creates the file's folder if that does not exist.
    pub fn write(&self, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<Part<'_>, OutputError> {
        let written = || {
            let parent = folder_of(&self.path);
            fs::create_dir_all(parent)?;
            let above = Dir::open_ambient_dir(parent, ambient_authority())?;
            report(&above, parent);
            let stage = Stage::new(&above)?;
            let mut options = cap_std::fs::OpenOptions::new();
            let file = stage.dir.open_with(NEW, options.read(true).write(true).create_new(true))?;
            let mut file = BufWriter::new(file.into_std());
            write(&mut file)?;
            let file = file.into_inner().map_err(io::IntoInnerError::into_error)?;
            Ok(Part { of: self, file, stage })
        };
        written().map_err(at(&self.path))
    }
}

/// True if an open file is the one at `path`.
#[cfg(unix)]
fn is_at(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let of = |found: fs::Metadata| (found.dev(), found.ino());
    file.metadata().map(of).ok() == fs::metadata(path).map(of).ok()
}

/// Always true: open files are not replaced on this system.
#[cfg(not(unix))]
fn is_at(_: &File, _: &Path) -> bool {
    true
}

/// New contents that are not yet in place. Nothing else is written meanwhile.
pub struct Part<'a> {
    of: &'a Replaced,
    file: File,
    stage: Stage,
}

impl Part<'_> {
    /// Writes the contents to the disk and moves them into place.
    pub fn finish(self) -> Result<(), OutputError> {
        let Self { of, file, stage } = self;
        let mut held = locked(&of.file);
        let moved = || {
            file.sync_all()?;
            // Locked before others see it; where files have no locks, nobody is kept out.
            let _ = file.try_lock();
            match *held {
                Some(_) => stage.place(NEW, &of.name),
                None => stage.place_new(NEW, &of.name),
            }
        };
        moved().map_err(|error| match error.kind() {
            io::ErrorKind::AlreadyExists => at(&of.path)(busy()),
            _ => at(&of.path)(error),
        })?;
        // If a folder cannot be synchronised, the system decides when the name reaches the disk.
        let _ = stage.synchronise();
        *held = Some(file);
        Ok(())
    }
}
