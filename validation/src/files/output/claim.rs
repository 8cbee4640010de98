//! The lock on a folder, which lets only one process at a time write there.

use super::{OutputError, RECORD, at, refill};
use crate::files::bounded;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// The locked file; the system releases the lock when the process ends in any way.
pub(super) const LOCK: &str = ".shearbed-lock";
/// Folder of an incomplete set of files.
const PART: &str = ".shearbed-part";
/// Folder of a complete set of files, to be moved one folder up.
const READY: &str = ".shearbed-ready";
/// Prefix of lock and temporary files.
const OURS: &str = ".shearbed-";

/// Limit of how often other processes may make the folder and remove it again between two steps of one claim.
const OTHERS: usize = 1000;

/// A lock on a folder: no other process that claims the folder writes there.
#[derive(Debug)]
pub struct Claim {
    dir: PathBuf,
    /// True if the folder did not exist before.
    made: bool,
    lock: Option<Lock>,
}

/// A locked file.
#[derive(Debug)]
pub(super) struct Lock {
    path: PathBuf,
    /// Kept open, as closing releases the lock.
    _file: File,
}

/// Held while a set of files is written.
static WRITING: Mutex<()> = Mutex::new(());
/// Paths of all locks of this process.
static LOCKS: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

fn held<T>(mutex: &'static Mutex<T>) -> MutexGuard<'static, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// True if a process of this program works in a folder, or was killed there.
pub(super) fn is_locked(dir: &Path) -> bool {
    fs::symlink_metadata(dir.join(LOCK)).is_ok()
}

/// Keeps [`stop`] waiting.
pub(super) fn writing() -> MutexGuard<'static, ()> {
    held(&WRITING)
}

/// Waits until no files are being written, then ends the process, so that no set of files is incomplete.
pub(crate) fn stop(code: i32) -> ! {
    let _writing = writing();
    for lock in held(&LOCKS).iter() {
        // A lock file that cannot be removed here is taken over by the next claim.
        let _ = fs::remove_file(lock);
    }
    std::process::exit(code)
}

impl Claim {
    /// Claims a folder, which is created if it does not exist, waiting up to `patience` for other processes. Then repairs what
    /// a killed process left there: a complete set of files is moved into place, an incomplete one is removed.
    pub fn new(dir: &Path, patience: Duration) -> Result<Self, OutputError> {
        let made = !dir.exists();
        let busy = "another shearbed is at work in this folder; wait for it, or give another --out";
        let lock = Lock::new(dir, LOCK, patience, |reason| {
            let reason = match reason.kind() {
                io::ErrorKind::WouldBlock => io::Error::new(reason.kind(), busy),
                io::ErrorKind::Unsupported => {
                    io::Error::new(reason.kind(), format!("{reason}; give another --out"))
                }
                _ => reason,
            };
            at(dir)(reason)
        })?;
        let claim = Self { dir: dir.to_owned(), made, lock: Some(lock) };
        let _writing = writing();
        claim.put_right()?;
        Ok(claim)
    }

    /// Writes all files. They are written to the disk under a hidden name; then old files with these names are removed, and the new
    /// ones moved into place, JSON last and after it the folder's record. So files of two sets are never side by side, and a process
    /// killed in between leaves a set without its record, which the next claim completes. At last the files `left_over` of an earlier
    /// set are removed.
    pub fn write_all<C: AsRef<[u8]>>(
        &self,
        files: &[(String, C)],
        left_over: &[String],
    ) -> Result<(), OutputError> {
        let _writing = writing();
        let part = self.dir.join(PART);
        fs::create_dir_all(&part).map_err(at(&self.dir))?;
        let ready = refill(&part, &self.dir, files)
            .and_then(|()| self.no_folder_in_the_way(files))
            .and_then(|()| fs::rename(&part, self.dir.join(READY)).map_err(at(&self.dir)));
        if ready.is_err() {
            // The first error is the one to report.
            let _ = fs::remove_dir_all(&part);
            return ready;
        }
        self.move_into_place()?;
        left_over.iter().try_for_each(|name| self.remove(name))
    }

    fn remove(&self, name: impl AsRef<Path>) -> Result<(), OutputError> {
        let path = self.dir.join(name);
        match fs::remove_file(&path) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => Err(at(&path)(error)),
            _ => Ok(()),
        }
    }

    fn no_folder_in_the_way<C>(&self, files: &[(String, C)]) -> Result<(), OutputError> {
        let mut targets = files.iter().map(|(name, _)| self.dir.join(name));
        match targets.find(|target| target.is_dir()) {
            Some(target) => Err(at(&target)(io::ErrorKind::IsADirectory.into())),
            None => Ok(()),
        }
    }

    fn move_into_place(&self) -> Result<(), OutputError> {
        let ready = self.dir.join(READY);
        let mut names = names(&ready).map_err(at(&self.dir))?;
        names.sort_by_key(|name| {
            let json = name.extension().is_some_and(|ending| ending == "json");
            (name == Path::new(RECORD), json, name.clone())
        });
        names.iter().rev().try_for_each(|name| self.remove(name))?;
        for name in names {
            let target = self.dir.join(&name);
            let folder = target.parent().unwrap_or(&self.dir);
            fs::create_dir_all(folder)
                .and_then(|()| fs::rename(ready.join(&name), &target))
                .map_err(at(&target))?;
        }
        fs::remove_dir_all(&ready).map_err(at(&self.dir))
    }

    fn put_right(&self) -> Result<(), OutputError> {
        // A link leads to files that are not this program's.
        if fs::symlink_metadata(self.dir.join(READY)).is_ok_and(|ready| ready.is_dir()) {
            self.move_into_place()?;
        }
        for entry in fs::read_dir(&self.dir).map_err(at(&self.dir))? {
            let entry = entry.map_err(at(&self.dir))?;
            let name = entry.file_name().to_string_lossy().into_owned();
            let path = entry.path();
            if name.starts_with(OURS) && name != LOCK {
                let removed = match entry.file_type().is_ok_and(|kind| kind.is_dir()) {
                    true => fs::remove_dir_all(&path),
                    false => fs::remove_file(&path),
                };
                removed.map_err(at(&path))?;
            }
        }
        Ok(())
    }

    /// Updates a claim whose folder was renamed to `dir`.
    pub(super) fn moved_to(mut self, dir: &Path) {
        if let Some(lock) = &mut self.lock {
            lock.moved_to(dir.join(LOCK));
        }
        self.dir = dir.to_owned();
    }
}

impl Drop for Claim {
    fn drop(&mut self) {
        drop(self.lock.take());
        if self.made {
            // Succeeds only if nothing was written.
            let _ = fs::remove_dir(&self.dir);
        }
    }
}

impl Lock {
    /// Makes and locks the file `name` in a folder, which is created if it does not exist. Waits up to `patience` for another process that
    /// holds the lock, then fails with `WouldBlock`; fails with `Unsupported` if the file system has no locks.
    pub(super) fn new(
        dir: &Path,
        name: &str,
        patience: Duration,
        at: impl Fn(io::Error) -> OutputError,
    ) -> Result<Self, OutputError> {
        let start = Instant::now();
        let path = dir.join(name);
        let mut gone = 0;
        let file = loop {
            match fs::create_dir_all(dir) {
                // Another process has just removed the folder; a third may have made it again. If it is no folder, this fails.
                Err(error)
                    if error.kind() == io::ErrorKind::AlreadyExists
                        && dir.symlink_metadata().map_or(true, |found| found.is_dir()) =>
                {
                    continue;
                }
                made => made.map_err(&at)?,
            }
            let mut options = OpenOptions::new();
            options.write(true).create(true).truncate(false);
            let file = match bounded::open_with(&path, &mut options) {
                // The folder has just been removed, and may exist again. A link to nowhere remains an error, and some file systems, such as
                // /proc, say this of every new file.
                Err(error)
                    if error.kind() == io::ErrorKind::NotFound && !path.is_symlink() && gone < OTHERS =>
                {
                    gone += 1;
                    continue;
                }
                Err(error) if error.kind() == io::ErrorKind::InvalidInput => {
                    let why = format!("{name}: {error}, or none; remove it");
                    return Err(at(io::Error::new(error.kind(), why)));
                }
                file => file.map_err(&at)?,
            };
            match file.try_lock() {
                // The process that held the file may have removed it: then the lock has no effect.
                Ok(()) if is_there(&file) => break file,
                Ok(()) => continue,
                Err(TryLockError::WouldBlock) if start.elapsed() < patience => {
                    sleep(Duration::from_millis(5))
                }
                Err(TryLockError::WouldBlock) => return Err(at(io::ErrorKind::WouldBlock.into())),
                Err(TryLockError::Error(error)) => {
                    let why = format!("this file system does not support locks: {error}");
                    return Err(at(io::Error::new(io::ErrorKind::Unsupported, why)));
                }
            }
        };
        held(&LOCKS).push(path.clone());
        Ok(Self { path, _file: file })
    }

    /// Updates the path of a renamed file.
    fn moved_to(&mut self, path: PathBuf) {
        held(&LOCKS).retain(|held| *held != self.path);
        self.path = path;
    }
}

impl Drop for Lock {
    fn drop(&mut self) {
        // Removed while it is locked, so that no other process can hold it.
        let _ = fs::remove_file(&self.path);
        held(&LOCKS).retain(|held| *held != self.path);
    }
}

/// True if an open file has not been removed.
#[cfg(unix)]
fn is_there(file: &File) -> bool {
    use std::os::unix::fs::MetadataExt;
    file.metadata().is_ok_and(|metadata| metadata.nlink() > 0)
}

/// Always true: open files cannot be removed on this system.
#[cfg(not(unix))]
fn is_there(_: &File) -> bool {
    true
}

/// The files in a folder and its subfolders, as paths relative to it.
fn names(dir: &Path) -> io::Result<Vec<PathBuf>> {
    let mut found = Vec::new();
    for entry in fs::read_dir(dir)? {
        let entry = entry?;
        let name = PathBuf::from(entry.file_name());
        match entry.file_type()?.is_dir() {
            true => found.extend(names(&entry.path())?.into_iter().map(|below| name.join(below))),
            false => found.push(name),
        }
    }
    Ok(found)
}
