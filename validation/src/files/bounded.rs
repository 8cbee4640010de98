//! The only way in which files are read: regular files alone, without waiting, and up to a size limit.
//!
//! A file may be a link to an endless device or a pipe without a writer, may grow while it is read, and may have been
//! written by a stranger or edited since this program wrote it. Nothing else in this crate opens a file for reading (a
//! folder is opened once, to be synchronised): clippy forbids it (`clippy.toml`).

use cap_std::fs::Dir;
use std::fs::{File, FileType, OpenOptions};
use std::io::{self, Read};
use std::path::Path;
use std::string::FromUtf8Error;

/// Opens a regular file for reading, following links, without waiting for a writer of a pipe.
///
/// # Errors
///
/// Those of the system, and `InvalidInput` if the file is not a regular one; the message names its kind: a pipe, a
/// device, a socket or a folder.
pub fn open(path: &Path) -> io::Result<File> {
    open_with(path, OpenOptions::new().read(true))
}

/// Opens a regular file with `options`, also for writing, following links, without waiting for the other end of a pipe.
///
/// # Errors
///
/// Those of the system, and `InvalidInput` if the file is not a regular one; the message names its kind.
#[expect(clippy::disallowed_methods, reason = "every other function of this crate opens files by this one")]
pub fn open_with(path: &Path, options: &mut OpenOptions) -> io::Result<File> {
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::custom_flags(options, NONBLOCK);
    match options.open(path) {
        Ok(file) => {
            regular(&file)?;
            Ok(file)
        }
        // For a pipe without a reader or a socket the system says "No such device or address".
        Err(error) => match std::fs::metadata(path).map(|found| found.file_type()) {
            Ok(kind) if !kind.is_file() => Err(not_regular(kind)),
            _ => Err(error),
        },
    }
}

/// Opens a regular file in a folder for reading, without leaving the folder by a link.
///
/// # Errors
///
/// Those of [`open`].
pub fn open_in(dir: &Dir, name: &Path) -> io::Result<File> {
    let mut options = cap_std::fs::OpenOptions::new();
    #[cfg(unix)]
    cap_std::fs::OpenOptionsExt::custom_flags(&mut options, NONBLOCK);
    let file = dir.open_with(name, options.read(true))?.into_std();
    regular(&file)?;
    Ok(file)
}

/// Fails if an open file is not a regular one.
///
/// # Errors
///
/// `InvalidInput`, with the kind of the file.
pub fn regular(file: &File) -> io::Result<()> {
    let kind = file.metadata()?.file_type();
    if kind.is_file() { Ok(()) } else { Err(not_regular(kind)) }
}

fn not_regular(kind: FileType) -> io::Error {
    let message = format!("it is {}; a regular file is needed", name(kind));
    io::Error::new(io::ErrorKind::InvalidInput, message)
}

/// Reads a regular file of at most `most` bytes, which are counted while they are read.
///
/// # Errors
///
/// Those of [`open`], and `FileTooLarge` for a longer file, of which at most `most` + 1 bytes are held in memory.
pub fn bytes(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    let mut file = open(path)?.take(most.saturating_add(1));
    let mut bytes = Vec::new();
    file.read_to_end(&mut bytes)?;
    if bytes.len() as u64 <= most { Ok(bytes) } else { Err(too_long(most)) }
}

fn too_long(most: u64) -> io::Error {
    let message = format!("it is longer than the {} that are allowed", size(most));
    io::Error::new(io::ErrorKind::FileTooLarge, message)
}

/// The length and the checksum (CRC-32) of a regular file of at most `most` bytes.
///
/// # Errors
///
/// Those of [`bytes`].
pub fn length_and_crc32(path: &Path, most: u64) -> io::Result<(u64, u32)> {
    length_and_crc32_of(open(path)?, most)
}

/// The same of an open file.
///
/// # Errors
///
/// Those of [`bytes`].
pub fn length_and_crc32_of(mut file: File, most: u64) -> io::Result<(u64, u32)> {
    let (mut length, mut sum) = (0, crc32fast::Hasher::new());
    let mut block = vec![0; 1 << 16];
    loop {
        let read = match file.read(&mut block) {
            Ok(0) => return Ok((length, sum.finalize())),
            Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
            read => read?,
        };
        length += read as u64;
        if length > most {
            return Err(too_long(most));
        }
        sum.update(&block[..read]);
    }
}

/// Reads a regular file of at most `most` bytes as UTF-8 text.
///
/// # Errors
///
/// Those of [`bytes`], and `InvalidData` with the place of the first byte that is not UTF-8.
pub fn text(path: &Path, most: u64) -> io::Result<String> {
    String::from_utf8(bytes(path, most)?).map_err(|error| {
        let valid = &error.as_bytes()[..error.utf8_error().valid_up_to()];
        let line = 1 + valid.iter().filter(|byte| **byte == b'\n').count();
        io::Error::new(io::ErrorKind::InvalidData, format!("line {line}: {}", not_utf8(&error)))
    })
}

/// Which byte of a line is the first that is not UTF-8, counted from 1, and how to mend the file.
pub fn not_utf8(error: &FromUtf8Error) -> String {
    let (bytes, at) = (error.as_bytes(), error.utf8_error().valid_up_to());
    let in_line = bytes[..at].iter().rev().take_while(|byte| **byte != b'\n').count() + 1;
    format!(
        "byte {in_line}, 0x{:02X}, is not UTF-8 text: save the file as UTF-8; from Latin-1: \
         iconv -f LATIN1 -t UTF-8",
        bytes[at]
    )
}

/// Opening a pipe or a device returns at once.
#[cfg(unix)]
const NONBLOCK: i32 = rustix::fs::OFlags::NONBLOCK.bits() as i32;

fn size(bytes: u64) -> String {
    match bytes {
        bytes if bytes >= 1_000_000 => format!("{} MB", bytes / 1_000_000),
        bytes => format!("{bytes} bytes"),
    }
}

fn name(kind: FileType) -> &'static str {
    #[cfg(unix)]
    if std::os::unix::fs::FileTypeExt::is_fifo(&kind) {
        return "a pipe";
    } else if std::os::unix::fs::FileTypeExt::is_socket(&kind) {
        return "a socket";
    }
    if kind.is_dir() { "a folder" } else { "a device" }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn a_file_is_read_up_to_its_limit_and_no_further() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("file");
        fs::write(&path, "12345").unwrap();
        assert_eq!(bytes(&path, 5).unwrap(), b"12345");
        assert_eq!(text(&path, u64::MAX).unwrap(), "12345");
        assert_eq!(length_and_crc32(&path, 5).unwrap(), (5, crc32fast::hash(b"12345")));
        for error in [bytes(&path, 4).unwrap_err(), length_and_crc32(&path, 4).unwrap_err()] {
            assert_eq!(error.to_string(), "it is longer than the 4 bytes that are allowed");
        }
        fs::write(&path, b"a\nb\xff").unwrap();
        let error = text(&path, 9).unwrap_err().to_string();
        assert!(error.starts_with("line 2: byte 2, 0xFF, is not UTF-8 text: save the file as UTF-8"), "{error}");
    }
}
