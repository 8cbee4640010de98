//! Work over the ranks of an MPI job, with the feature `mpi`; without it there is one rank, and nothing here does
//! more than a loop.
//!
//! Every rank runs the same command on the same input and comes to the same calls of [`share`] and [`from_root`] in
//! the same order. Rank 0, the root, alone writes and prints. A job's result does not depend on the rank that makes
//! it, and results come back in the order of jobs: so the root goes on with the bits that one process has. A rank
//! that fails says why and ends all others ([`Joined::fail`]).

#[cfg(not(feature = "mpi"))]
mod alone;
#[cfg(feature = "mpi")]
mod ranks;
mod replicas;

#[cfg(not(feature = "mpi"))]
pub use alone::{Joined, from_root, is_root, share, size};
#[cfg(feature = "mpi")]
pub use ranks::{Joined, from_root, is_root, share, size};
pub use replicas::ensemble;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Deserializer, Serialize};
use std::io::Write;
use std::process::ExitCode;

/// Does every job in this process. `arrived` is called with each result in order; so are the results.
pub fn in_order<T, E>(
    jobs: usize,
    job: impl Fn(usize) -> Result<T, E>,
    mut arrived: impl FnMut(usize, &T) -> Result<(), E>,
) -> Result<Option<Vec<T>>, E>
where
    T: Serialize + DeserializeOwned,
{
    let done = |k| {
        let result = job(k)?;
        arrived(k, &result)?;
        Ok(result)
    };
    (0..jobs).map(done).collect::<Result<_, E>>().map(Some)
}

/// Says why this process failed; its exit code. Where even this cannot be written, the exit code has to say it.
pub fn failed(message: &str, code: u8) -> ExitCode {
    let _ = writeln!(std::io::stderr(), "error: {message}");
    ExitCode::from(code)
}

/// Reads a text that is written in the source, and so lives as long as the program: it comes from another rank. The
/// few that there are stay in memory.
pub fn text_of_the_source<'de, D: Deserializer<'de>>(reader: D) -> Result<&'static str, D::Error> {
    let text = String::deserialize(reader)?;
    Ok(text.leak())
}
