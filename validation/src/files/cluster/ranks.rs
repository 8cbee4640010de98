//! The ranks of an MPI job. Only one thread at a time calls MPI; jobs use their own threads.

use super::{failed, in_order};
use mpi::environment::{Universe, is_initialized};
use mpi::topology::SimpleCommunicator;
use mpi::traits::{Communicator, CommunicatorCollectives, Destination, MatchedReceiveVec, Root, Source};
use mpi::{Tag, Threading};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::ExitCode;
use std::sync::atomic::{AtomicI32, Ordering};
use std::thread::sleep;
use std::time::Duration;

/// The MPI job that this process has joined.
pub struct Joined(Universe);

/// Sleep of an idle rank between two polls. Waiting inside MPI would keep a core busy.
const IDLE: Duration = Duration::from_millis(1);

/// Delay of a failing rank, so that the root fails first: bad input fails on all ranks, and should be reported once.
const COURTESY: Duration = Duration::from_secs(2);

/// Tags go from 1 to this: MPI guarantees tags up to 32 767.
const LAST_TAG: i32 = 32_000;

impl Joined {
    /// Joins the job started by `mpirun`, or a job of this process alone.
    pub fn new() -> Result<Self, String> {
        match mpi::initialize_with_threading(Threading::Serialized) {
            Some((universe, granted)) if granted >= Threading::Serialized => Ok(Self(universe)),
            Some((_, granted)) => {
                Err(format!("MPI: the thread level Serialized is needed, and this library grants {granted:?}"))
            }
            None => Err("MPI: cannot be started".to_owned()),
        }
    }

    /// Runs a command; a panic, which has printed its message, becomes an error: if the process ended, the other ranks
    /// would wait.
    pub fn caught<T>(&self, command: impl FnOnce() -> T) -> Result<T, String> {
        catch_unwind(AssertUnwindSafe(command)).map_err(|_| "the program broke off".to_owned())
    }

    /// Reports why the command failed, and ends all ranks with this exit code.
    pub fn fail(self, message: &str, code: u8) -> ExitCode {
        let Some(world) = world() else {
            return failed(message, code);
        };
        if world.rank() != 0 {
            sleep(COURTESY);
        }
        let (rank, size) = (world.rank(), world.size());
        failed(&format!("rank {rank} of {size}: {message}"), code);
        world.abort(code.into())
    }

    /// Ends a command that did not fail, after waiting for all ranks.
    pub fn end(self) -> ExitCode {
        let mut barrier = self.0.world().immediate_barrier();
        while let Err(waiting) = barrier.test() {
            barrier = waiting;
            sleep(IDLE);
        }
        ExitCode::SUCCESS
    }
}

/// All ranks; `None` if there is only one.
fn world() -> Option<SimpleCommunicator> {
    // A test that calls the library has not joined a job.
    let joined = is_initialized().then(SimpleCommunicator::world);
    joined.filter(|world| world.size() > 1)
}

/// True if this rank writes and prints.
pub fn is_root() -> bool {
    world().is_none_or(|world| world.rank() == 0)
}

/// Number of ranks.
pub fn size() -> usize {
    world().map_or(1, |world| world.size() as usize)
}

/// Runs every job once: rank k runs the jobs k, k + size and so on. Calls `arrived` on the root with each result, in
/// any order. Returns all results in order on the root, `None` on the other ranks.
pub fn share<T: Serialize + DeserializeOwned, E>(
    jobs: usize,
    job: impl Fn(usize) -> Result<T, E>,
    mut arrived: impl FnMut(usize, &T) -> Result<(), E>,
) -> Result<Option<Vec<T>>, E> {
    let Some(world) = world() else {
        return in_order(jobs, job, arrived);
    };
    let (rank, size) = (world.rank() as usize, world.size() as usize);
    let tag = next_tag();
    let mine = (rank..jobs).step_by(size);
    if rank != 0 {
        for k in mine {
            let message = encoded(&(k, job(k)?));
            world.process_at_rank(0).send_with_tag(&message[..], tag);
        }
        return Ok(None);
    }
    let mut all: Vec<Option<T>> = (0..jobs).map(|_| None).collect();
    let mut missing = jobs;
    let mut take = |k: usize, result: T| {
        arrived(k, &result)?;
        all[k] = Some(result);
        missing -= 1;
        Ok(missing)
    };
    let mut left = jobs;
    for k in mine {
        left = take(k, job(k)?)?;
        while let Some((k, result)) = received(&world, tag) {
            left = take(k, result)?;
        }
    }
    while left > 0 {
        match received(&world, tag) {
            Some((k, result)) => left = take(k, result)?,
            None => sleep(IDLE),
        }
    }
    Ok(Some(all.into_iter().flatten().collect()))
}

/// The result of `make`, which runs on the root, on every rank.
pub fn from_root<T: Serialize + DeserializeOwned, E>(make: impl FnOnce() -> Result<T, E>) -> Result<T, E> {
    let Some(world) = world() else {
        return make();
    };
    let root = world.process_at_rank(0);
    let made = if world.rank() == 0 { Some(make()?) } else { None };
    let mut bytes = made.as_ref().map_or_else(Vec::new, encoded);
    let mut length = bytes.len() as u64;
    root.broadcast_into(&mut length);
    bytes.resize(length as usize, 0);
    root.broadcast_into(&mut bytes[..]);
    Ok(made.unwrap_or_else(|| decoded(&bytes)))
}

/// A new tag for each call: a rank may be some calls ahead of the root.
fn next_tag() -> Tag {
    static CALLS: AtomicI32 = AtomicI32::new(0);
    1 + CALLS.fetch_add(1, Ordering::Relaxed).rem_euclid(LAST_TAG)
}

/// The index of a job and its result, if one has arrived.
fn received<T: DeserializeOwned>(world: &SimpleCommunicator, tag: Tag) -> Option<(usize, T)> {
    let found = world.any_process().immediate_matched_probe_with_tag(tag);
    let (bytes, _) = found?.matched_receive_vec::<u8>();
    Some(decoded(&bytes))
}

/// Encodes as MessagePack with field names; all bits of numbers are preserved, including NaN.
fn encoded<T: Serialize>(value: &T) -> Vec<u8> {
    rmp_serde::to_vec_named(value).unwrap_or_else(|error| panic!("plain data can be sent: {error}"))
}

fn decoded<T: DeserializeOwned>(bytes: &[u8]) -> T {
    rmp_serde::from_slice(bytes).unwrap_or_else(|error| panic!("the same program sent it: {error}"))
}
