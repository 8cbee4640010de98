//! Reading and writing.
//!
//! - [`bounded`]: the one reader of files, for regular files up to a limit that is counted while reading.
//! - [`output`]: files that appear whole, `shearbed.json` in every folder of results, and the rule for overwriting.
//! - [`csv`]: the one reader of tables, and [`FileError`], with the place.
//! - [`checkpoint`]: runs that go on after an interruption; [`cluster`]: the ranks of an MPI job.
//!
//! This part may use the core's scenes and results, and no other part. To add a file format, write a module that reads
//! through `bounded` and writes through `output`, and add its name to the fuzzing (`examples/fuzz`).

pub mod bounded;
pub mod build;
pub mod checkpoint;
pub mod cluster;
pub mod csv;
pub(crate) mod difference;
mod error;
pub mod output;
pub mod text;

pub use error::FileError;

use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// What a mutex holds, also after a thread that held it has panicked.
pub(crate) fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The entries of a folder, sorted by name.
///
/// # Errors
///
/// A folder that cannot be read.
pub fn entries(folder: &Path) -> Result<Vec<PathBuf>, FileError> {
    let refused = |error: std::io::Error| FileError::unreadable(folder, &error);
    let entries = std::fs::read_dir(folder).map_err(refused)?;
    let mut paths = entries.map(|entry| Ok(entry.map_err(refused)?.path())).collect::<Result<Vec<_>, FileError>>()?;
    paths.sort();
    Ok(paths)
}
