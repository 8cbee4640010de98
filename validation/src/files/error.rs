//! An error at a place in a file.

use super::text::Shown;
use std::path::{Path, PathBuf};

/// The reason why a file is refused: the place, what is wrong, and what is allowed.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{}{}: {message}", path.shown(), numbers([*line, *column]))]
pub struct FileError {
    /// The file or folder.
    pub path: PathBuf,
    /// The line, from 1; 0 for the whole file.
    pub line: u64,
    /// The column, from 1: the field of a table, the character of JSON; 0 for the whole line.
    pub column: u64,
    /// What is wrong, and what is allowed.
    pub message: String,
}

/// Line and column behind a file's name, such as `:3:1`, as far as they are known.
fn numbers(place: [u64; 2]) -> String {
    place.iter().take_while(|number| **number > 0).map(|number| format!(":{number}")).collect()
}

impl FileError {
    /// An error in a whole file or folder.
    pub fn whole(path: impl AsRef<Path>, message: impl Into<String>) -> Self {
        Self::at(path, 0, 0, message)
    }

    /// An error in a line of a file.
    pub fn line(path: impl AsRef<Path>, line: u64, message: impl Into<String>) -> Self {
        Self::at(path, line, 0, message)
    }

    /// An error at a place in a file.
    pub fn at(path: impl AsRef<Path>, line: u64, column: u64, message: impl Into<String>) -> Self {
        Self { path: path.as_ref().to_owned(), line, column, message: message.into() }
    }

    /// The error of a file that cannot be read.
    pub fn unreadable(path: impl AsRef<Path>, error: &std::io::Error) -> Self {
        Self::whole(path, format!("cannot be read: {error}"))
    }
}
