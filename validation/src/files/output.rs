//! Writes sets of files such that a set appears as a whole or not at all, and that two processes do not mix their files.

mod claim;
mod folder;
mod record;
mod replaced;
#[cfg(test)]
mod tests;

pub use claim::Claim;
pub(crate) use claim::stop;
pub use folder::ResultFolder;
pub use record::{Origin, RECORD, Record, Sum};
pub use replaced::{Part, Replaced};

use crate::files::bounded;
use crate::files::text::Shown;

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// A file's name, possibly with a folder such as `curves/fig5.csv`, and its contents.
pub type Output = (String, String);

/// The reason why a file or folder could not be written.
#[derive(Debug)]
pub struct OutputError {
    /// The file or folder.
    pub path: PathBuf,
    /// The system's reason.
    pub reason: io::Error,
}

impl std::fmt::Display for OutputError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}: cannot be written: {}", self.path.shown(), self.reason)
    }
}

impl std::error::Error for OutputError {}

/// The reason why a file or folder was left unchanged: its name, its contents or why it cannot be written, and what to do.
#[derive(Debug)]
pub struct Refused(pub String);

impl From<OutputError> for Refused {
    fn from(error: OutputError) -> Self {
        Self(error.to_string())
    }
}

impl std::fmt::Display for Refused {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

fn at(path: &Path) -> impl FnOnce(io::Error) -> OutputError {
    let path = path.to_owned();
    |reason| OutputError { path, reason }
}

/// How long a writer waits for another one; writing a set of files takes far less.
const PATIENCE: Duration = Duration::from_secs(20);

/// Checks, for commands that work long before they write, that `bytes` bytes can be written in `dir`, or if it does not exist
/// in the folder above it. They are written to an unnamed file, of which nothing remains, even after a kill. Fails if another
/// process is writing in the folder; repairs what a killed process left there.
pub fn probe(dir: &Path, bytes: u64) -> Result<(), OutputError> {
    if dir.is_dir() {
        Claim::new(dir, PATIENCE)?;
    }
    let here = Path::new(".");
    let existing = dir.ancestors().find(|folder| folder.exists());
    let existing = existing.filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(here);
    let mut file = tempfile::tempfile_in(existing).map_err(at(dir))?;
    // The bytes are noise, which no file system compresses.
    let mut noise = 1_u32;
    let block: Vec<u8> = std::iter::repeat_with(|| {
        noise = noise.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (noise >> 24) as u8
    })
    .take(1 << 16)
    .collect();
    let blocks = bytes.div_ceil(block.len() as u64);
    (0..blocks).try_for_each(|_| file.write_all(&block)).and_then(|()| file.sync_all()).map_err(|error| {
        let needed = format!("{error}; {:.1} MB are to be written there", 1e-6 * bytes as f64);
        at(dir)(io::Error::new(error.kind(), needed))
    })
}

/// Writes all files into `dir`, which is created if it does not exist. A new folder appears with all of them; in an existing
/// folder the files of two sets are never side by side (see [`Claim::write_all`]). An error before the final step leaves all
/// existing files unchanged.
pub fn write_all<C: AsRef<[u8]>>(dir: &Path, files: &[(String, C)]) -> Result<(), OutputError> {
    if !dir.exists() && appear(dir, files)? {
        return Ok(());
    }
    Claim::new(dir, PATIENCE)?.write_all(files, &[])
}

/// Writes one file, as a whole or not at all, following links. An existing file with other contents is replaced only with `force`;
/// a file with the same contents is left.
///
/// # Errors
///
/// If there is a file with other contents, or no regular file (its kind is named), or if the file cannot be written.
pub fn write_one(path: &Path, contents: &[u8], force: bool) -> Result<(), Refused> {
    let target = followed(path);
    let name = target.file_name().map(|name| name.to_string_lossy().into_owned());
    let name = name.ok_or_else(|| at(path)(io::ErrorKind::InvalidFilename.into()))?;
    let folder = target.parent().filter(|folder| !folder.as_os_str().is_empty());
    let folder = folder.unwrap_or(Path::new("."));
    let at_file = |error: OutputError| at(path)(error.reason);
    let files = [(name, contents)];
    if !folder.exists() && appear(folder, &files).map_err(at_file)? {
        return Ok(());
    }
    // Checked before the claim: in a folder that is not writable, such as /dev, the reason is the kind of the file.
    holds(&target, contents).map_err(at(path))?;
    let claim = Claim::new(folder, PATIENCE).map_err(at_file)?;
    match holds(&target, contents).map_err(at(path))? {
        Some(true) => Ok(()),
        Some(false) if !force => {
            Err(folder::in_the_way(path, "is here already, with other contents", folder::OTHER_OUT))
        }
        _ => Ok(claim.write_all(&files, &[]).map_err(at_file)?),
    }
}

/// True if the regular file at `path` has these contents; `None` if there is no file.
fn holds(path: &Path, contents: &[u8]) -> io::Result<Option<bool>> {
    match bounded::length_and_crc32(path, contents.len() as u64) {
        Ok((bytes, crc32)) => Ok(Some(Sum::from_parts(bytes, crc32) == Sum::of(contents))),
        Err(error) if error.kind() == io::ErrorKind::FileTooLarge => Ok(Some(false)),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
        Err(error) => Err(error),
    }
}

/// The file that links lead to, whether it exists or not.
pub fn followed(path: &Path) -> PathBuf {
    let mut path = path.to_owned();
    // Circular links have no end; as many are followed as Linux does.
    for _ in 0..40 {
        let Ok(next) = fs::read_link(&path) else {
            break;
        };
        path = path.parent().unwrap_or(Path::new("")).join(next);
    }
    path
}

/// Writes a new folder beside its place, under a hidden name, and moves it there; false where somebody else made one in
/// between. What a killed process left under the hidden name is replaced; what is not of this program's making is refused.
fn appear<C: AsRef<[u8]>>(dir: &Path, files: &[(String, C)]) -> Result<bool, OutputError> {
    let Some(name) = dir.file_name() else {
        return Ok(false);
    };
    let part = dir.with_file_name(format!(".{}.shearbed-part", name.to_string_lossy()));
    own(&part, claim::is_locked)?;
    let claim = Claim::new(&part, PATIENCE).map_err(|error| at(dir)(error.reason))?;
    let _writing = claim::writing();
    let moved = refill(&part, dir, files).and_then(|()| match fs::rename(&part, dir) {
        Ok(()) => Ok(true),
        Err(_) if dir.exists() => Ok(false),
        Err(error) => Err(at(dir)(error)),
    });
    match moved {
        Ok(true) => claim.moved_to(dir),
        _ => {
            // The first error is the one to report. The lock goes last, for files without one are taken for a user's.
            let _ = refill::<&[u8]>(&part, dir, &[]);
            drop(claim);
            let _ = fs::remove_dir(&part);
        }
    }
    moved
}

/// Refuses what stands in the place of a hidden folder of this program without being one: a link, which leads elsewhere, or a
/// folder that holds files and is not `marked` as this program's.
fn own(part: &Path, marked: impl Fn(&Path) -> bool) -> Result<(), OutputError> {
    let empty = || fs::read_dir(part).is_ok_and(|mut entries| entries.next().is_none());
    let own = match fs::symlink_metadata(part) {
        // Twice: between the first two looks another process may have begun or ended its work there.
        Ok(found) if found.is_dir() => [marked(part), empty(), marked(part), empty()].contains(&true),
        Ok(_) => false,
        Err(_) => true,
    };
    let why =
        "this name is kept for files that are being written, and what is there is not shearbed's; move it";
    own.then_some(()).ok_or_else(|| at(part)(io::Error::new(io::ErrorKind::AlreadyExists, why)))
}

/// Writes a new folder of files inside one that is claimed. It appears whole or not at all; what a killed process left
/// of it is replaced.
pub fn write_folder(dir: &Path, files: &[Output]) -> Result<(), OutputError> {
    let name = dir.file_name().unwrap_or_default().to_string_lossy();
    let part = dir.with_file_name(format!(".{name}.shearbed-part"));
    let _writing = claim::writing();
    // In a folder that is claimed, what has this name and is no link is half of an earlier set.
    own(&part, Path::is_dir)?;
    fs::create_dir_all(&part).map_err(at(dir))?;
    let written = refill(&part, dir, files).and_then(|()| fs::rename(&part, dir).map_err(at(dir)));
    if written.is_err() {
        // The first error is the one to report.
        let _ = fs::remove_dir_all(&part);
    }
    written
}

/// Empties the folder `part` except for a lock, and writes files there, to the disk. Errors name the folder `dir`, to which the
/// files belong.
fn refill<C: AsRef<[u8]>>(part: &Path, dir: &Path, files: &[(String, C)]) -> Result<(), OutputError> {
    let empty = || {
        for entry in fs::read_dir(part)? {
            let entry = entry?;
            let path = entry.path();
            if entry.file_type()?.is_dir() {
                fs::remove_dir_all(&path)?;
            } else if !path.ends_with(claim::LOCK) {
                fs::remove_file(&path)?;
            }
        }
        Ok(())
    };
    empty().map_err(at(dir))?;
    for (name, contents) in files {
        let write = || {
            if let Some((folder, _)) = name.split_once('/') {
                fs::create_dir_all(part.join(folder))?;
            }
            let mut file = File::create_new(part.join(name))?;
            file.write_all(contents.as_ref())?;
            file.sync_all()
        };
        write().map_err(at(&dir.join(name)))?;
    }
    Ok(())
}
