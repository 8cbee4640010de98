//! Writes sets of files such that a set appears as a whole or not at all, and that two processes do not mix their
//! files.

mod beneath;
mod claim;
mod folder;
mod record;
mod replaced;
mod seal;
mod stage;
#[cfg(test)]
mod tests;

pub use claim::Claim;
pub use folder::ResultFolder;
pub use record::{Origin, RECORD, Record, Sum};
pub use replaced::{Part, Replaced};
pub use seal::sealed;
pub use stage::stop;
use stage::{PATIENCE, Stage};

use crate::files::bounded;
use crate::files::text::Shown;

use cap_std::ambient_authority;
use cap_std::fs::Dir;
#[cfg(target_os = "linux")]
use rustix::io::Errno;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// A file's name, possibly with a folder such as `curves/fig5.csv`, and its contents.
pub type Output = (String, String);

/// The reason why a file or folder could not be written.
#[derive(Debug, thiserror::Error)]
#[error("{}: cannot be written: {reason}", path.shown())]
pub struct OutputError {
    /// The file or folder.
    pub path: PathBuf,
    /// The system's reason.
    pub reason: io::Error,
}

/// The reason why a file or folder was left unchanged: its name, its contents or why it cannot be written, and what to
/// do.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub struct Refused(pub String);

impl From<OutputError> for Refused {
    fn from(error: OutputError) -> Self {
        Self(error.to_string())
    }
}

fn at(path: &Path) -> impl FnOnce(io::Error) -> OutputError {
    let path = path.to_owned();
    |reason| OutputError { path, reason }
}

/// Checks, for commands that work long before they write, that a folder can be made and filled in `dir`, or if it does
/// not exist in the folder above it, that files can have these names, and that there is room for `bytes` bytes. Fails
/// if another process is writing in the folder.
pub fn probe<'a>(dir: &Path, bytes: u64, names: impl IntoIterator<Item = &'a str>) -> Result<(), OutputError> {
    if let Some(claim) = Claim::open(dir, PATIENCE)? {
        names.into_iter().chain([RECORD]).try_for_each(|name| claim.is_free(name))?;
    }
    let (above, _) = claim::existing(dir);
    let folder = Dir::open_ambient_dir(above, ambient_authority()).map_err(at(dir))?;
    let stage = Stage::new(&folder).map_err(at(dir))?;
    stage::fill(&stage.dir, dir, &[("folder/file", "")].map(|(name, text)| (name.to_owned(), text)))
        .map_err(|error| at(dir)(error.reason))?;
    drop(stage);
    has_room(above, bytes).map_err(|error| {
        let needed = format!("{error}; {:.1} MB are to be written there", 1e-6 * bytes as f64);
        at(dir)(io::Error::new(error.kind(), needed))
    })
}

/// Allocates `bytes` bytes for an unnamed file, of which nothing remains, even after a kill; compares them with the
/// free space where the file system cannot allocate.
fn has_room(dir: &Path, bytes: u64) -> io::Result<()> {
    let file = tempfile::tempfile_in(dir)?;
    #[cfg(target_os = "linux")]
    match rustix::fs::fallocate(&file, rustix::fs::FallocateFlags::empty(), 0, bytes.max(1)) {
        Err(Errno::OPNOTSUPP | Errno::NOSYS | Errno::INVAL) => {}
        allocated => return Ok(allocated?),
    }
    #[cfg(unix)]
    {
        let system = rustix::fs::fstatvfs(&file)?;
        if system.f_bavail.saturating_mul(system.f_frsize) < bytes {
            return Err(io::ErrorKind::StorageFull.into());
        }
    }
    drop(file);
    Ok(())
}

/// Writes one file, as a whole or not at all, following links of this name. An existing file with other contents is
/// replaced only with `force`, or if it is an unedited picture of this program; a file with the same contents is left.
/// True if it replaced such a picture.
///
/// # Errors
///
/// If there is a file with other contents, or no regular file (its kind is named), or if the file cannot be written.
pub fn write_one(path: &Path, contents: &[u8], force: bool) -> Result<bool, Refused> {
    let target = followed(path);
    let name = target.file_name().and_then(|name| name.to_str());
    let name = name.ok_or_else(|| at(path)(io::ErrorKind::InvalidFilename.into()))?;
    let folder = folder_of(&target);
    let at_file = |error: OutputError| at(path)(error.reason);
    // Checked before the claim: in a folder that is not writable, such as /dev, the reason is the kind of the file.
    may_write(path, contents, force)?;
    let new = [(name.to_owned(), contents)];
    let (claim, is_new) = Claim::open_or_appear(folder, PATIENCE, &new).map_err(at_file)?;
    if is_new || !may_write(path, contents, force)? {
        return Ok(false);
    }
    let replaces = is_own_picture(path);
    claim.write_file(name, contents).map_err(at_file)?;
    Ok(replaces)
}

/// False if the file has these contents already.
///
/// # Errors
///
/// If it has others, is no unedited picture of this program and there is no `force`, or if it is no regular file.
pub fn may_write(path: &Path, contents: &[u8], force: bool) -> Result<bool, Refused> {
    match holds(path, contents).map_err(at(path))? {
        Some(true) => Ok(false),
        Some(false) if !force && !is_own_picture(path) => {
            Err(folder::in_the_way(path, "is here already, with other contents", folder::OTHER_OUT))
        }
        _ => Ok(true),
    }
}

/// True if there is an unedited picture of this program at `path`.
fn is_own_picture(path: &Path) -> bool {
    const MOST_BYTES: u64 = 64 << 20;
    bounded::bytes(path, MOST_BYTES).is_ok_and(|picture| seal::is_unedited(&picture))
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

/// The place of a file, by which two names of it are one.
pub fn place(path: &Path) -> PathBuf {
    let target = followed(path);
    let folder = folder_of(&target);
    let folder = folder.canonicalize().unwrap_or_else(|_| folder.to_owned());
    target.file_name().map_or(folder.clone(), |name| folder.join(name))
}

/// The folder of a file.
fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
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
