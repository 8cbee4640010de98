//! Folders below an open one, entered without following a link.

use cap_std::fs::Dir;
use std::io;
use std::path::{Component, Path, PathBuf};

/// The folder below `dir` that contains `name`, and the last part of the name; `None` if there is no such folder.
pub(super) fn beneath(dir: &Dir, name: &str) -> io::Result<Option<(Dir, PathBuf)>> {
    let mut dir = dir.try_clone()?;
    let path = Path::new(name);
    if !path.components().all(|part| matches!(part, Component::Normal(_))) {
        return Err(io::ErrorKind::InvalidFilename.into());
    }
    for part in path.parent().into_iter().flat_map(Path::components) {
        dir = match opened(&dir, part) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
            opened => opened?,
        };
    }
    Ok(path.file_name().map(|last| (dir, PathBuf::from(last))))
}

/// A folder in another one. A link that takes its place after the look is not followed out of `dir` either: `Dir` does
/// not leave it.
pub(super) fn opened(dir: &Dir, name: impl AsRef<Path>) -> io::Result<Dir> {
    match dir.symlink_metadata(&name)? {
        found if found.is_dir() => dir.open_dir(name),
        found => {
            let what = if found.is_symlink() { "a link, which is not followed here" } else { "no folder" };
            let why = format!("{} is {what}; remove it", name.as_ref().display());
            Err(io::Error::new(io::ErrorKind::NotADirectory, why))
        }
    }
}
