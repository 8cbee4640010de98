//! Lines of a text with their numbers, read one by one in bounded memory.

use crate::files::FileError;
use crate::files::bounded;
use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};

/// The largest length of a line in bytes: a row of numbers has a few hundred.
const LONGEST: usize = 1 << 16;

/// Features that a text from Windows may have: a byte order mark, and CR LF at line ends.
///
/// A program that is graded may read its file later and take them for part of a name or a value.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LineEnds {
    /// LF only; anything else is an error.
    #[default]
    Unix,
    /// CR LF or LF, with or without a byte order mark; both are removed.
    Windows,
}

/// The lines of a text that are not blank.
pub struct Lines<R = BufReader<File>> {
    path: PathBuf,
    /// What the lines are read from.
    pub(super) reader: R,
    number: u64,
    ends: LineEnds,
}

impl Lines {
    /// Opens a file.
    pub fn open(path: &Path, ends: LineEnds) -> Result<Self, FileError> {
        let file = bounded::open(path).map_err(|error| FileError::unreadable(path, &error))?;
        Ok(Self::new(path, BufReader::new(file), ends))
    }
}

impl<R: BufRead> Lines<R> {
    /// The lines of `reader`; `path` is for messages.
    pub fn new(path: &Path, reader: R, ends: LineEnds) -> Self {
        Self { path: path.to_owned(), reader, number: 0, ends }
    }

    /// The file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The number of the last line read, from 1.
    pub fn number(&self) -> u64 {
        self.number
    }

    /// An error in the last line read, at field `column` from 1; 0 for the whole line.
    pub fn error(&self, column: usize, message: impl Into<String>) -> FileError {
        FileError::at(&self.path, self.number, column as u64, message)
    }

    /// The next line that is not blank; `None` at the end.
    pub fn next_line(&mut self) -> Result<Option<String>, FileError> {
        loop {
            let mut bytes = Vec::new();
            let most = LONGEST as u64 + 1;
            self.number += 1;
            let read = self.reader.by_ref().take(most).read_until(b'\n', &mut bytes);
            match read {
                Ok(0) => return Ok(None),
                Ok(_) if bytes.len() > LONGEST => {
                    return Err(self.error(0, format!("longer than {LONGEST} bytes: no row of numbers")));
                }
                Ok(_) => {}
                Err(error) => return Err(self.error(0, format!("cannot be read: {error}"))),
            }
            let text = String::from_utf8(bytes).map_err(|error| self.error(0, bounded::not_utf8(&error)))?;
            let text = self.plain(&text)?;
            if !text.trim().is_empty() {
                return Ok(Some(text.to_owned()));
            }
        }
    }

    /// The line without its end and byte order mark, or an error if they are not allowed.
    fn plain<'a>(&self, line: &'a str) -> Result<&'a str, FileError> {
        let windows = self.ends == LineEnds::Windows;
        let line = line.strip_suffix('\n').unwrap_or(line);
        let line = match line.strip_prefix('\u{feff}').filter(|_| self.number == 1) {
            Some(_) if !windows => return Err(self.error(1, MARKED)),
            Some(line) => line,
            None => line,
        };
        if line.trim_end_matches('\r').contains('\r') {
            return Err(self.error(0, ALONE));
        }
        match line.strip_suffix('\r') {
            Some(_) if !windows => Err(self.error(line.split([',', ';', '\t']).count(), CARRIED)),
            Some(line) => Ok(line),
            None => Ok(line),
        }
    }
}

const MARKED: &str =
    "begins with a byte order mark: write UTF-8 without it (in Python encoding=\"utf-8\"), or give --windows-text";
const ALONE: &str = "its lines end in CR alone, or one is in a line: write LF at the end of a line and nowhere else";
const CARRIED: &str =
    "ends in CR LF: write LF alone (csv.writer of Python has lineterminator=\"\\n\"), or give --windows-text";
