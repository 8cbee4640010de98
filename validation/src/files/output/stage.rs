//! The one hidden name under which a command writes: a folder with a random name, beside the place of what it writes.

use super::{OutputError, at};
use crate::files::locked;
use crate::files::text::{Shown, complain};
use cap_std::fs::{Dir, OpenOptions};
use std::collections::BTreeSet;
use std::fs::{File, TryLockError};
use std::hash::{BuildHasher, Hasher, RandomState};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// What every hidden name begins with; 16 hexadecimal digits follow.
const PREFIX: &str = ".shearbed-";
/// How long a writer waits for another one; writing a set of files takes far less.
pub(super) const PATIENCE: Duration = Duration::from_secs(20);

/// Held while a hidden folder is there.
static WRITING: Mutex<()> = Mutex::new(());

/// Held while results are being written; true once they are there.
pub(super) static RESULTS: Mutex<bool> = Mutex::new(false);

/// Waits until no files are being written, then ends the process after `last`, so that no hidden folder is left.
/// Returns if the results are there: all that is left to the command is to say so.
pub fn stop(code: i32, last: impl FnOnce()) {
    let are_there = locked(&RESULTS);
    let _writing = locked(&WRITING);
    if !*are_there {
        last();
        std::process::exit(code)
    }
}

/// A hidden folder, which is removed when this is dropped. No signal ends the process meanwhile.
pub(super) struct Stage {
    above: Dir,
    name: String,
    pub(super) dir: Dir,
    /// Says that a process is at work there.
    pub(super) lock: File,
    _writing: MutexGuard<'static, ()>,
}

impl Stage {
    /// Makes a hidden folder in `above` and locks it.
    pub(super) fn new(above: &Dir) -> io::Result<Self> {
        let above = above.try_clone()?;
        let writing = locked(&WRITING);
        let name = format!("{PREFIX}{:016x}", RandomState::new().build_hasher().finish());
        above.create_dir(&name)?;
        let locked = || {
            let dir = above.open_dir(&name)?;
            let lock = lock(&dir, PATIENCE)?;
            Ok((dir, lock))
        };
        match locked() {
            Ok((dir, lock)) => Ok(Self { above, name, dir, lock, _writing: writing }),
            Err(error) => {
                // The first error is the one to report.
                let _ = above.remove_dir(&name);
                Err(error)
            }
        }
    }

    /// Gives the folder its name beside the hidden one.
    pub(super) fn appear(&self, name: &Path) -> io::Result<()> {
        self.above.rename(&self.name, &self.above, name)
    }

    /// Moves a file out of the folder, to another name beside it.
    pub(super) fn place(&self, file: &str, name: &str) -> io::Result<()> {
        self.dir.rename(file, &self.above, name)
    }

    /// The same, only if there is nothing of that name.
    pub(super) fn place_new(&self, file: &str, name: &str) -> io::Result<()> {
        match self.dir.hard_link(file, &self.above, name) {
            Err(error) if error.kind() != io::ErrorKind::AlreadyExists => {
                // A file system without hard links.
                match self.above.symlink_metadata(name) {
                    Ok(_) => Err(io::ErrorKind::AlreadyExists.into()),
                    Err(_) => self.place(file, name),
                }
            }
            linked => linked,
        }
    }

    /// Writes the names beside the folder to the disk.
    pub(super) fn synchronise(&self) -> io::Result<()> {
        self.above.open(".")?.sync_all()
    }
}

impl Drop for Stage {
    fn drop(&mut self) {
        // Gone where it has got another name. With an umask such as 777 an empty folder cannot be opened, but removed.
        let _ = self.above.remove_dir_all(&self.name).or_else(|_| self.above.remove_dir(&self.name));
    }
}

/// Writes new files to a folder, and to the disk. Errors name the file in `shown`, the folder to which the files
/// belong.
pub(super) fn fill<C: AsRef<[u8]>>(dir: &Dir, shown: &Path, files: &[(String, C)]) -> Result<(), OutputError> {
    files.iter().try_for_each(|(name, contents)| {
        let write = || {
            if let Some((folder, _)) = name.rsplit_once('/') {
                dir.create_dir_all(folder)?;
            }
            let mut file = dir.open_with(name, OpenOptions::new().write(true).create_new(true))?;
            file.write_all(contents.as_ref())?;
            file.sync_all()
        };
        write().map_err(at(&shown.join(name)))
    })
}

/// Locks a folder for as long as the returned handle is open, waiting up to `patience` for another process that holds
/// the lock. The system releases it when the process ends in any way. Where folders have no locks, checksums alone keep
/// two sets apart.
pub(super) fn lock(dir: &Dir, patience: Duration) -> io::Result<File> {
    let (file, start) = (dir.open(".")?.into_std(), Instant::now());
    loop {
        match file.try_lock() {
            Err(TryLockError::WouldBlock) if start.elapsed() < patience => sleep(Duration::from_millis(5)),
            Err(TryLockError::WouldBlock) => {
                let busy = "another shearbed is at work in this folder; wait for it, or give another --out";
                return Err(io::Error::new(io::ErrorKind::WouldBlock, busy));
            }
            _ => return Ok(file),
        }
    }
}

/// Warns, once, of each hidden folder in `dir` that a killed process left. Nothing is done about it: it may be
/// another's.
pub(super) fn report(dir: &Dir, path: &Path) {
    static SAID: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());
    let names = dir.entries().into_iter().flatten().flatten().filter_map(|entry| entry.file_name().into_string().ok());
    for name in names {
        let random = name
            .strip_prefix(PREFIX)
            .is_some_and(|random| random.len() == 16 && random.bytes().all(|digit| digit.is_ascii_hexdigit()));
        let is_dir = random && dir.symlink_metadata(&name).is_ok_and(|found| found.is_dir());
        let left_over = path.join(&name);
        let is_left = || dir.open_dir(&name).is_ok_and(|found| is_left(dir, &name, &found));
        if is_dir && is_left() && locked(&SAID).insert(left_over.clone()) {
            complain(&format!(
                "warning: {}: a shearbed that was killed left this folder of unfinished files; remove it\n",
                left_over.shown()
            ));
        }
    }
}

/// True if a killed process left the folder `found`, which had the hidden name when it was opened.
pub(super) fn is_left(dir: &Dir, name: &str, found: &Dir) -> bool {
    // A process at work locks its folder before it writes to it: an empty one may be about to be locked. One that has
    // finished since has given it another name.
    let Ok(_lock) = lock(found, Duration::ZERO) else { return false };
    found.entries().is_ok_and(|mut entries| entries.next().is_some()) && dir.symlink_metadata(name).is_ok()
}
