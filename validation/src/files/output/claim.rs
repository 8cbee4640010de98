//! A folder that one process at a time writes to. Below it no link is followed.

use super::beneath::{beneath, opened};
use super::record::{RECORD, Record, Sum};
use super::stage::{PATIENCE, Stage, fill, lock, report};
use super::{OutputError, at};
use cap_std::ambient_authority;
use cap_std::fs::Dir;
use std::collections::BTreeMap;
use std::fs::File;
use std::io;
use std::path::{Component, Path, PathBuf};
use std::time::Duration;

/// The record while files are being replaced, as it is called in the hidden folder.
const BEGUN: &str = ".begun";

/// An open folder with a lock: no other process that claims the folder writes there.
pub struct Claim {
    path: PathBuf,
    pub(super) dir: Dir,
    /// Kept open, as closing releases the lock.
    _lock: File,
}

impl Claim {
    /// Claims a folder, waiting up to `patience` for other processes; `None` if there is none.
    pub fn open(path: &Path, patience: Duration) -> Result<Option<Self>, OutputError> {
        let dir = match Dir::open_ambient_dir(path, ambient_authority()) {
            Err(error) if error.kind() == io::ErrorKind::NotFound && !path.is_symlink() => return Ok(None),
            dir => dir.map_err(at(path))?,
        };
        let lock = lock(&dir, patience).map_err(at(path))?;
        report(&dir, path);
        Ok(Some(Self { path: path.to_owned(), dir, _lock: lock }))
    }

    /// Claims a folder, or writes it with `files` if there is none; true if it is new.
    pub fn open_or_appear<C: AsRef<[u8]>>(
        path: &Path,
        patience: Duration,
        files: &[(String, C)],
    ) -> Result<(Self, bool), OutputError> {
        loop {
            if let Some(claim) = Self::open(path, patience)? {
                return Ok((claim, false));
            }
            if let Some(claim) = Self::appear(path, files)? {
                return Ok((claim, true));
            }
        }
    }

    /// Writes a new folder under a hidden name, with the missing ones above it. They appear with all files by one move;
    /// `None` if somebody else has made one of them meanwhile.
    fn appear<C: AsRef<[u8]>>(path: &Path, files: &[(String, C)]) -> Result<Option<Self>, OutputError> {
        let (above, missing) = existing(path);
        let mut missing = missing.components();
        let first = match missing.next() {
            Some(Component::Normal(first)) => first,
            // Made since the caller looked.
            None if path.exists() => return Ok(None),
            _ => return Err(at(path)(io::ErrorKind::InvalidFilename.into())),
        };
        let below = missing.as_path();
        let dir = Dir::open_ambient_dir(above, ambient_authority()).map_err(at(path))?;
        report(&dir, above);
        let stage = Stage::new(&dir).map_err(at(path))?;
        let inner = || {
            if below.as_os_str().is_empty() {
                Ok((stage.dir.try_clone()?, stage.lock.try_clone()?))
            } else {
                stage.dir.create_dir_all(below)?;
                let inner = stage.dir.open_dir(below)?;
                let lock = lock(&inner, PATIENCE)?;
                Ok((inner, lock))
            }
        };
        let (dir, lock) = inner().map_err(at(path))?;
        fill(&dir, path, files)?;
        match stage.appear(Path::new(first)) {
            Ok(()) => Ok(Some(Self { path: path.to_owned(), dir, _lock: lock })),
            Err(_) if above.join(first).exists() => Ok(None),
            Err(error) => Err(at(path)(error)),
        }
    }

    /// Writes `files` and their record in place of `earlier` ones, and removes the files `gone`. All are written to the
    /// disk under a hidden name, then moved. Meanwhile, and after a kill or an error, the record lists both, and says
    /// by that it is incomplete.
    pub fn write<C: AsRef<[u8]>>(
        &self,
        record: &Record,
        files: &[(String, C)],
        earlier: BTreeMap<String, Sum>,
        gone: &[String],
    ) -> Result<(), OutputError> {
        let stage = Stage::new(&self.dir).map_err(at(&self.path))?;
        let (name, begun) = record.replacing(earlier).file();
        fill(&stage.dir, &self.path, files)?;
        fill(&stage.dir, &self.path, &[(BEGUN.to_owned(), begun), record.file()])?;
        let names = || files.iter().map(|(name, _)| name);
        names().chain([&name]).try_for_each(|name| self.is_free(name))?;
        self.place(&stage, BEGUN, RECORD)?;
        names().try_for_each(|name| self.place(&stage, name, name))?;
        gone.iter().try_for_each(|name| self.remove(name))?;
        self.place(&stage, RECORD, RECORD)
    }

    pub(super) fn write_file(&self, name: &str, contents: &[u8]) -> Result<(), OutputError> {
        let stage = Stage::new(&self.dir).map_err(at(&self.path))?;
        fill(&stage.dir, &self.path, &[(name.to_owned(), contents)])?;
        self.place(&stage, name, name)
    }

    /// Writes a new folder, such as `points/3`. It appears with all files by one move.
    pub fn write_folder<C: AsRef<[u8]>>(&self, name: &str, files: &[(String, C)]) -> Result<(), OutputError> {
        let path = self.path.join(name);
        let (above, last) = self.made(name).map_err(at(&path))?;
        let stage = Stage::new(&above).map_err(at(&path))?;
        fill(&stage.dir, &path, files)?;
        stage.appear(Path::new(&last)).map_err(at(&path))
    }

    pub(super) fn remove(&self, name: &str) -> Result<(), OutputError> {
        self.within(name, |folder, last| folder.remove_file(last))
    }

    /// Removes a folder with all that is in it, by one move.
    pub fn remove_folder(&self, name: &str) -> Result<(), OutputError> {
        self.within(name, |folder, last| folder.rename(last, &Stage::new(folder)?.dir, "gone"))
    }

    /// Does something to a file or folder, if it is there.
    fn within(&self, name: &str, does: impl Fn(&Dir, &Path) -> io::Result<()>) -> Result<(), OutputError> {
        match beneath(&self.dir, name).and_then(|found| found.map_or(Ok(()), |(folder, last)| does(&folder, &last))) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => Err(at(&self.path.join(name))(error)),
            _ => Ok(()),
        }
    }

    /// Warns of what killed processes left in a folder of this one.
    pub fn report(&self, name: &str) {
        if let Ok(Some((above, last))) = beneath(&self.dir, name)
            && above.symlink_metadata(&last).is_ok_and(|found| found.is_dir())
            && let Ok(dir) = above.open_dir(last)
        {
            report(&dir, &self.path.join(name));
        }
    }

    /// Fails if a file cannot have this name: a folder has it, or one above it is a link or a file.
    pub(super) fn is_free(&self, name: &str) -> Result<(), OutputError> {
        let is_free = || match beneath(&self.dir, name)? {
            Some((folder, last)) if folder.symlink_metadata(&last).is_ok_and(|found| found.is_dir()) => {
                Err(io::ErrorKind::IsADirectory.into())
            }
            _ => Ok(()),
        };
        is_free().map_err(at(&self.path.join(name)))
    }

    fn place(&self, stage: &Stage, from: &str, name: &str) -> Result<(), OutputError> {
        let place = || {
            let (folder, last) = self.made(name)?;
            stage.dir.rename(from, &folder, last)
        };
        place().map_err(at(&self.path.join(name)))
    }

    /// The folder that contains `name`, which is made if it does not exist, and the last part of the name.
    fn made(&self, name: &str) -> io::Result<(Dir, PathBuf)> {
        let (mut dir, path) = (self.dir.try_clone()?, Path::new(name));
        for part in path.parent().into_iter().flat_map(Path::components) {
            match dir.create_dir(part) {
                Err(error) if error.kind() != io::ErrorKind::AlreadyExists => return Err(error),
                _ => dir = opened(&dir, part)?,
            }
        }
        Ok((dir, path.file_name().map(PathBuf::from).unwrap_or_default()))
    }
}

/// The part of a path that exists, and the rest.
pub(super) fn existing(path: &Path) -> (&Path, &Path) {
    let there = path.ancestors().find(|above| above.exists());
    there.map_or((Path::new("."), path), |above| (above, path.strip_prefix(above).unwrap_or(path)))
}
