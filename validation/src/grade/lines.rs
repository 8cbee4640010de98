//! Lines of a text file, read one by one in bounded memory, with their numbers.

use crate::problems::ReadError;
use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};

/// The longest line that is read, in bytes: a row of numbers has a few hundred.
const LONGEST: usize = 1 << 16;

/// The lines of a file that are not blank. A byte order mark and carriage returns are taken off.
pub struct Lines {
    path: PathBuf,
    reader: BufReader<File>,
    number: u64,
}

impl Lines {
    /// Opens a file.
    pub fn open(path: &Path) -> Result<Self, ReadError> {
        let failed = |error: std::io::Error| ReadError::whole(path, format!("cannot be read: {error}"));
        Ok(Self {
            path: path.to_owned(),
            reader: BufReader::new(File::open(path).map_err(failed)?),
            number: 0,
        })
    }

    /// The file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The number of the line that was read last, from 1.
    pub fn number(&self) -> u64 {
        self.number
    }

    /// An error about the line that was read last, at a field from 1; 0 for the whole line.
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
            let text = match self.number {
                1 => text.strip_prefix('\u{feff}').unwrap_or(&text),
                _ => &text,
            };
            if !text.trim().is_empty() {
                return Ok(Some(text.trim_end_matches(['\n', '\r']).to_owned()));
            }
        }
    }
}

/// A field as a number. NaN and infinities that are written as such are answers; a number that is too large for a double
/// is none.
pub fn number(field: &str) -> Result<f64, String> {
    match field.parse::<f64>() {
        Ok(value) if value.is_infinite() && field.contains(|c: char| c.is_ascii_digit()) => {
            Err(format!("{field} is too large for a double"))
        }
        Ok(value) => Ok(value),
        Err(_) => {
            let start: String = field.chars().take(40).collect();
            Err(format!("{start:?} is no number"))
        }
    }
}
