//! Errors in files of measured points.

use crate::files::bounded;
use crate::files::text::Shown;
use std::fmt;
use std::io;
use std::path::Path;

/// An error in a file: the place, the content, and what is allowed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DataError {
    /// The file or folder.
    pub file: String,
    /// Number of the line, from 1; `None` if the error is of the whole file.
    pub line: Option<usize>,
    /// The key or column, its value and what is allowed.
    pub message: String,
}

impl DataError {
    /// An error about a whole file or folder.
    pub fn whole(file: &Path, message: impl Into<String>) -> Self {
        Self { file: file.shown(), line: None, message: message.into() }
    }

    /// An error in a line.
    pub fn at(file: &str, line: usize, message: impl Into<String>) -> Self {
        Self { file: file.to_owned(), line: Some(line), message: message.into() }
    }
}

impl fmt::Display for DataError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.line {
            Some(line) => write!(f, "{}:{line}: {}", self.file, self.message),
            None => write!(f, "{}: {}", self.file, self.message),
        }
    }
}

impl std::error::Error for DataError {}

/// The error of a file that cannot be read.
pub(super) fn unreadable(file: &Path, error: &io::Error) -> DataError {
    DataError::whole(file, format!("cannot be read: {error}"))
}

/// Size limit in bytes of a file of measured points.
pub const MOST_BYTES: u64 = 64 << 20;

/// The text of a file in UTF-8, without a byte-order mark.
pub fn read_text(path: &Path) -> Result<String, DataError> {
    let text = bounded::text(path, MOST_BYTES).map_err(|error| unreadable(path, &error))?;
    let text = text.strip_prefix('\u{feff}').map_or(text.clone(), str::to_owned);
    if text.trim().is_empty() {
        return Err(DataError::at(&path.shown(), 1, "the file is empty"));
    }
    Ok(text)
}
