//! One process, without MPI.

use super::failed;
use crate::files::text::complain;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::process::ExitCode;

/// This process.
pub struct Joined;

impl Joined {
    /// Warns where a launcher of MPI started several processes, each of which runs the whole command.
    pub fn new() -> Result<Self, String> {
        let set = |name: String| std::env::var(name).ok()?.parse::<u64>().ok();
        // Set by Open MPI, and by MPICH, Intel MPI and Slurm's PMI.
        for launcher in ["OMPI_COMM_WORLD", "PMI"] {
            let size = set(format!("{launcher}_SIZE")).unwrap_or(1);
            if size > 1 && set(format!("{launcher}_RANK")) == Some(0) {
                complain(&format!(
                    "warning: {launcher}_SIZE = {size}: this build shares no work over ranks, and each of the {size} \
                     processes runs the whole command; start one, or build with --features mpi \
                     (docs/src/user/long-runs.md)\n"
                ));
            }
        }
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
pub fn from_root<T: Serialize + DeserializeOwned, E>(make: impl FnOnce() -> Result<T, E>) -> Result<T, E> {
    make()
}
