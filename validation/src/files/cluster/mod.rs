//! Shares work among the ranks of an MPI job, with the feature `mpi`; without it there is one rank, and everything here
//! is no more than a loop.
//!
//! Every rank runs the same command on the same input and makes the same calls of [`share`] and [`from_root`] in the
//! same order. Only rank 0, the root, writes and prints. A job's result does not depend on the rank that runs it, and
//! results are returned in the order of jobs, so the root has the same bits as a single process. A rank that fails
//! reports why and ends all others ([`Joined::fail`]).

#[cfg(not(feature = "mpi"))]
mod alone;
#[cfg(feature = "mpi")]
mod ranks;
mod replicas;

#[cfg(not(feature = "mpi"))]
pub use alone::{Joined, from_root, is_root, share, size};
#[cfg(feature = "mpi")]
pub use ranks::{Joined, from_root, is_root, share, size};
pub use replicas::{ensemble, extend};

use crate::files::build::BUILD;
use crate::files::difference::difference;
use crate::files::text::{self, complain};
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Value, json};
use std::process::ExitCode;

/// Compares the inputs of all ranks. Every command calls this before anything else, so that ranks with different inputs
/// do not wait for each other. The error, on the root, names the rank and the key.
pub fn agree(command: &str, mut input: Value) -> Result<(), String> {
    input["command"] = command.into();
    input["build"] = json!(BUILD);
    let all = share(size(), |_| Ok::<_, String>(input.clone()), |_, _| Ok(()))?;
    from_root(|| all_as_first(&all.unwrap_or_default()))
}

/// Fails unless all ranks have the input of the first.
fn all_as_first(inputs: &[Value]) -> Result<(), String> {
    for (rank, input) in inputs.iter().enumerate() {
        if let Some((key, there, here)) = difference(input, &inputs[0]) {
            return Err(format!(
                "rank {rank} has another input: {key} is {there} there and {here} on rank 0; the same on every rank is \
                 allowed"
            ));
        }
    }
    Ok(())
}

/// Runs all jobs in this process. Calls `arrived` with each result in order, and returns the results in order.
pub fn in_order<T: Serialize + DeserializeOwned, E>(
    jobs: usize,
    job: impl Fn(usize) -> Result<T, E>,
    mut arrived: impl FnMut(usize, &T) -> Result<(), E>,
) -> Result<Option<Vec<T>>, E> {
    let done = |k| {
        let result = job(k)?;
        arrived(k, &result)?;
        Ok(result)
    };
    (0..jobs).map(done).collect::<Result<_, E>>().map(Some)
}

/// Reports why this process failed, and returns its exit code.
pub fn failed(message: &str, code: u8) -> ExitCode {
    complain(&format!("error: {}\n", text::message(message)));
    ExitCode::from(code)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rank_with_another_input_is_named_with_its_key() {
        let input = |seed: u64| json!({ "command": "run", "scene": { "ensemble": { "seed": seed } } });
        assert_eq!(all_as_first(&[]), Ok(()));
        assert_eq!(all_as_first(&[input(1), input(1)]), Ok(()));
        let error = all_as_first(&[input(1), input(1), input(2), input(3)]).unwrap_err();
        let expected = "rank 2 has another input: scene.ensemble.seed is 2 there and 1 on rank 0";
        assert!(error.starts_with(expected), "{error}");
        let error = all_as_first(&[input(1), json!({ "command": "plan" })]).unwrap_err();
        assert!(error.contains(r#"command is "plan" there and "run" on rank 0"#), "{error}");
    }
}
