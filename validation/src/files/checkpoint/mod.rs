//! Checkpoints: the state of an unfinished command in one file, from which the same command resumes.
//!
//! A line with the format's number, a line of JSON with the command and its inputs, the state in MessagePack, and the
//! CRC-32 of all this in four bytes. The file is replaced as a whole: an interruption leaves the old one or the new
//! one.

mod replicas;
mod saved;
mod stop;
#[cfg(test)]
mod tests;

pub use replicas::Replicas;
pub use saved::{Progress, without_replicas};
pub use stop::{last_words, on_stop, on_stop_of, stays};

use crate::files::build::BUILD;
use crate::files::output::{Origin, OutputError, Part, Refused, Replaced};
use crate::files::text::Shown;
use crc32fast::Hasher;
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Value, json};
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read, Seek, Write};
use std::path::Path;

/// The start of every checkpoint, before the number of its format.
const HEAD: &str = "shearbed checkpoint ";
const FORMAT: u32 = 3;
/// Size in bytes of the checksum at the end.
const SUM: u64 = 4;
/// Size limits in bytes of the first and the second line.
const LINES: [u64; 2] = [64, 1 << 20];

/// The checkpoint of one command; no other process writes the file as long as this exists.
pub struct Checkpoint {
    file: Replaced,
    origin: Origin,
}

impl Checkpoint {
    /// Claims the file for a command, this build and `inputs`, an object with everything else on which the results
    /// depend.
    pub fn open(path: &Path, command: &str, mut inputs: Value) -> Result<Self, Refused> {
        inputs["build"] = json!(BUILD);
        Ok(Self { file: Replaced::claim(path)?, origin: Origin::new(command, inputs) })
    }

    /// The path of the file.
    pub fn path(&self) -> &Path {
        self.file.path()
    }

    /// The state in the file; `None` if there is no file.
    pub fn read<T: DeserializeOwned>(&self) -> Result<Option<T>, Refused> {
        let file = self.file.open().map_err(|error| self.refused(&format!("cannot be read: {error}")))?;
        file.map(|file| self.state(file).map_err(|why| self.refused(&why))).transpose()
    }

    /// Replaces the state in the file.
    pub fn write(&self, state: &impl Serialize) -> Result<(), OutputError> {
        self.begin(state)?.finish()
    }

    /// Writes the state beside the file; [`Part::finish`] moves it into place.
    fn begin(&self, state: &impl Serialize) -> Result<Part<'_>, OutputError> {
        self.file.write(|file| {
            let mut file = Summed(file, Hasher::new());
            writeln!(file, "{HEAD}{FORMAT}\n{}", serde_json::to_string(&self.origin)?)?;
            rmp_serde::encode::write_named(&mut file, state).map_err(cause)?;
            let sum = file.1.finalize();
            file.0.write_all(&sum.to_be_bytes())
        })
    }

    /// The error that this file cannot be used, with the reason and what to do next.
    pub fn refused(&self, why: &str) -> Refused {
        Refused(format!(
            "--checkpoint {}: {why}; give another name, or remove it to start over; nothing was changed",
            self.path().shown()
        ))
    }

    fn state<T: DeserializeOwned>(&self, file: File) -> Result<T, String> {
        let unread = |error: io::Error| format!("cannot be read: {error}");
        let length = file.metadata().map_err(unread)?.len().saturating_sub(SUM);
        let mut file = BufReader::new(file);
        let first = line(&mut file, LINES[0]).map_err(unread)?;
        let format = first.strip_prefix(HEAD).ok_or("is no checkpoint of shearbed")?;
        if format != FORMAT.to_string() {
            return Err(format!("has the format {format}, of another version of shearbed; {FORMAT} is allowed"));
        }
        file.rewind().map_err(unread)?;
        let mut sum = Summed(io::sink(), Hasher::new());
        io::copy(&mut file.by_ref().take(length), &mut sum).map_err(unread)?;
        let mut kept = [0; SUM as usize];
        file.read_exact(&mut kept).map_err(unread)?;
        let (kept, found) = (u32::from_be_bytes(kept), sum.1.finalize());
        if kept != found {
            return Err(format!("is damaged: its checksum is {kept:08x}, and that of its contents {found:08x}"));
        }
        file.rewind().map_err(unread)?;
        let mut file = file.take(length);
        line(&mut file, LINES[0]).map_err(unread)?;
        let origin = line(&mut file, LINES[1]).map_err(unread)?;
        let broken = |error: &dyn std::fmt::Display| format!("is damaged: {error}");
        let origin: Origin = serde_json::from_str(&origin).map_err(|error| broken(&error))?;
        if let Some(difference) = origin.difference(&self.origin) {
            return Err(format!("is of other work: {difference}"));
        }
        let state = rmp_serde::from_read(&mut file).map_err(|error| broken(&error))?;
        match file.fill_buf().map_err(unread)? {
            [] => Ok(state),
            _ => Err(broken(&"bytes follow its state")),
        }
    }
}

/// The system's error behind an error of the encoder, such as a full disk; the encoder's own message if there is none.
fn cause(error: rmp_serde::encode::Error) -> io::Error {
    let mut below: Option<&(dyn std::error::Error + 'static)> = Some(&error);
    while let Some(found) = below {
        if let Some(system) = found.downcast_ref::<io::Error>() {
            return match system.raw_os_error() {
                Some(code) => io::Error::from_raw_os_error(code),
                None => io::Error::new(system.kind(), system.to_string()),
            };
        }
        below = found.source();
    }
    io::Error::other(error)
}

/// The next line, of at most `most` bytes, without its line end.
fn line(file: &mut impl BufRead, most: u64) -> io::Result<String> {
    let mut bytes = Vec::new();
    file.take(most).read_until(b'\n', &mut bytes)?;
    bytes.pop_if(|last| *last == b'\n');
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// A writer that also computes the checksum of its output.
struct Summed<W>(W, Hasher);

impl<W: Write> Write for Summed<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.0.write(bytes)?;
        self.1.update(&bytes[..written]);
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}
