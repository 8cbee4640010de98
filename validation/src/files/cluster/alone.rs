//! One process, without MPI.

use super::failed;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::process::ExitCode;

/// The process.
pub struct Joined;

impl Joined {
    /// Nothing to join.
    pub fn new() -> Result<Self, String> {
        Ok(Self)
    }

    /// Runs a command; a panic goes on.
    pub fn caught<T>(&self, command: impl FnOnce() -> T) -> Result<T, String> {
        Ok(command())
    }

    /// Says why the command failed; its exit code.
    pub fn fail(self, message: &str, code: u8) -> ExitCode {
        failed(message, code)
    }

    /// The end of a command that did not fail.
    pub fn end(self) -> ExitCode {
        ExitCode::SUCCESS
    }
}

/// Whether this rank writes and prints.
pub fn is_root() -> bool {
    true
}

/// How many ranks there are.
pub fn size() -> usize {
    1
}

pub use super::in_order as share;

/// What the root makes, on every rank.
pub fn from_root<T, E>(make: impl FnOnce() -> Result<T, E>) -> Result<T, E>
where
    T: Serialize + DeserializeOwned,
{
    make()
}
