//! Why measured points were refused.

use crate::text;
use std::fmt;
use std::path::Path;

/// A file that was refused: where, what is there, and what is allowed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DataError {
    /// The file or folder.
    pub file: String,
    /// The line at fault, from 1; `None` where the whole file is.
    pub line: Option<usize>,
    /// The key or column, its value and what is allowed.
    pub message: String,
}

impl DataError {
    /// An error about a whole file or folder.
    pub(crate) fn whole(file: &Path, message: impl Into<String>) -> Self {
        Self {
            file: file.display().to_string(),
            line: None,
            message: message.into(),
        }
    }

    /// An error in a line.
    pub(crate) fn at(file: &str, line: usize, message: impl Into<String>) -> Self {
        Self {
            file: file.to_owned(),
            line: Some(line),
            message: message.into(),
        }
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

/// The longest file of measured points.
const MOST_BYTES: u64 = 64 << 20;

/// The text of a file in UTF-8, without a byte-order mark.
pub(crate) fn read_text(path: &Path) -> Result<String, DataError> {
    let bytes = text::read(path, MOST_BYTES)
        .map_err(|error| DataError::whole(path, format!("cannot be read: {error}")))?;
    let text = String::from_utf8(bytes).map_err(|error| {
        let before = &error.as_bytes()[..error.utf8_error().valid_up_to()];
        let line = 1 + before.iter().filter(|byte| **byte == b'\n').count();
        let message = "not a text in UTF-8, as a data file must be";
        DataError::at(&path.display().to_string(), line, message)
    })?;
    let text = text.strip_prefix('\u{feff}').map_or(text.clone(), str::to_owned);
    if text.trim().is_empty() {
        return Err(DataError::at(&path.display().to_string(), 1, "the file is empty"));
    }
    Ok(text)
}
