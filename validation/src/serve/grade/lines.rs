//! Lines of a text file with their numbers, read one by one in bounded memory.

use crate::files::bounded;
use crate::serve::problems::ReadError;
use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};

/// The largest length of a line in bytes: a row of numbers has a few hundred.
const LONGEST: usize = 1 << 16;

/// Features that a text from Windows may have: a byte order mark, and CR LF at line ends.
///
/// By default both are refused: a program that reads such a file later would take them for part of a name or a value.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LineEnds {
    /// LF only.
    #[default]
    Unix,
    /// CR LF or LF, with or without a byte order mark; both are removed.
    Windows,
}

/// The lines of a file that are not blank.
pub struct Lines {
    path: PathBuf,
    reader: BufReader<File>,
    number: u64,
    ends: LineEnds,
}

impl Lines {
    /// Opens a file.
    pub fn open(path: &Path, ends: LineEnds) -> Result<Self, ReadError> {
        let failed = |error: std::io::Error| ReadError::whole(path, format!("cannot be read: {error}"));
        Ok(Self {
            path: path.to_owned(),
            reader: BufReader::new(bounded::open(path).map_err(failed)?),
            number: 0,
            ends,
        })
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
    pub fn error(&self, column: usize, message: impl Into<String>) -> ReadError {
        ReadError::at(&self.path, self.number, column as u64, message)
    }

    /// The next line that is not blank; `None` at the end.
    pub fn next_line(&mut self) -> Result<Option<String>, ReadError> {
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
            let text = String::from_utf8(bytes).map_err(|_| self.error(0, "no UTF-8 text"))?;
            let text = self.plain(&text)?;
            if !text.trim().is_empty() {
                return Ok(Some(text.to_owned()));
            }
        }
    }

    /// The line without its end and byte order mark, or an error if they are not allowed.
    fn plain<'a>(&self, line: &'a str) -> Result<&'a str, ReadError> {
        let windows = self.ends == LineEnds::Windows;
        let line = line.strip_suffix('\n').unwrap_or(line);
        let line = match line.strip_prefix('\u{feff}').filter(|_| self.number == 1) {
            Some(_) if !windows => return Err(self.error(1, MARKED)),
            Some(line) => line,
            None => line,
        };
        match line.strip_suffix('\r') {
            Some(line) if !windows => {
                let last = line.split([',', ';', '\t']).count();
                Err(self.error(last, CARRIED))
            }
            Some(line) => Ok(line),
            None => Ok(line),
        }
    }
}

const MARKED: &str =
    "begins with a byte order mark: write UTF-8 without it (in Python encoding=\"utf-8\"), or give --windows-text";
const CARRIED: &str =
    "ends in CR LF: write LF alone (csv.writer of Python has lineterminator=\"\\n\"), or give --windows-text";

/// Parses a field as a number. NaN and infinities written as such are valid; a number too large for a double
/// is an error.
pub fn number(field: &str) -> Result<f64, String> {
    match field.parse::<f64>() {
        Ok(value) if value.is_infinite() && field.contains(|c: char| c.is_ascii_digit()) => {
            Err(format!("{field} is too large for a double"))
        }
        Ok(value) => Ok(value),
        Err(_) => {
            let start: String = field.chars().take(40).collect();
            Err(format!("{start:?} is not a number"))
        }
    }
}
