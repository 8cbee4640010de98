//! One process, without MPI.

use super::failed;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::process::ExitCode;

/// This process.
pub struct Joined;

impl Joined {
    /// Does nothing, as there are no ranks to join.
    pub fn new() -> Result<Self, String> {
        Ok(Self)
    }

    /// Runs a command; panics are not caught.
    pub fn caught<T>(&self, command: impl FnOnce() -> T) -> Result<T, String> {
        Ok(command())
    }

    /// Reports why the command failed, and returns its exit code.
    pub fn fail(self, message: &str, code: u8) -> ExitCode {
        failed(message, code)
    }

    /// Ends a command that did not fail.
    pub fn end(self) -> ExitCode {
        ExitCode::SUCCESS
    }
}

/// True if this rank writes and prints.
pub fn is_root() -> bool {
    true
}

/// Number of ranks.
pub fn size() -> usize {
    1
}

pub use super::in_order as share;

/// The result of `make`, which runs on the root, on every rank.
pub fn from_root<T, E>(make: impl FnOnce() -> Result<T, E>) -> Result<T, E>
where
    T: Serialize + DeserializeOwned,
{
    make()
}
