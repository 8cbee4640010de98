//! The number of threads of a command.

use super::{Failure, whole};
use shearbed_validation::files::text::complain;
use std::sync::atomic::{AtomicBool, Ordering};

const MAX_THREADS: u64 = 1024;

/// Rayon's own setting, which is used without `--threads`.
const VARIABLE: &str = "RAYON_NUM_THREADS";

/// The option of every command that runs replicas.
#[derive(clap::Args)]
pub(super) struct Threads {
    /// Threads to run on; the results do not depend on it [default: one for each core]
    #[arg(long = "threads", value_name = "K", value_parser = whole(1, MAX_THREADS), allow_negative_numbers = true)]
    pub(super) given: Option<u64>,
}

/// Refuses a number of threads in the environment that is not allowed.
pub(super) fn check() -> Result<(), Failure> {
    of_environment().map(drop)
}

/// The number of threads for a command: `given`, or that of the environment, or one for each core.
pub(super) fn count(given: Option<u64>) -> Result<u64, Failure> {
    let cores = || std::thread::available_parallelism().map_or(1, |cores| cores.get() as u64);
    Ok(given.or(of_environment()?).unwrap_or_else(|| cores().min(MAX_THREADS)))
}

/// Parses the variable; 0 and an empty text mean one thread for each core, as for rayon.
fn of_environment() -> Result<Option<u64>, Failure> {
    let text = std::env::var_os(VARIABLE).unwrap_or_default().to_string_lossy().into_owned();
    match text.parse() {
        _ if text.is_empty() => Ok(None),
        Ok(0) => Ok(None),
        Ok(count) if count <= MAX_THREADS => Ok(Some(count)),
        _ => Err(Failure::Input(format!(
            "{VARIABLE} = {text} is not allowed: expected a whole number from 1 to {MAX_THREADS}"
        ))),
    }
}

/// True once no thread could be had.
static NONE_LEFT: AtomicBool = AtomicBool::new(false);

/// Makes a panic for want of a thread, of rayon's common pool or of a progress bar, a message like others.
pub(super) fn watch() {
    let others = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        let words = panic.to_string();
        let none_left = ["failed to spawn thread", "global thread pool"].iter().any(|part| words.contains(part));
        if none_left && !NONE_LEFT.swap(true, Ordering::Relaxed) {
            complain(&format!("error: the system gives no more threads; allowed: {ALLOWED}\n"))
        } else {
            others(panic)
        }
    }));
}

/// What to do where the system gives no more threads.
const ALLOWED: &str = "fewer (--threads 1, RAYON_NUM_THREADS=1), or a higher limit of processes (ulimit -u)";

/// The exit code of a panic: 2 for want of a thread.
pub fn code_of_panic() -> u8 {
    if NONE_LEFT.load(Ordering::Relaxed) { 2 } else { 101 }
}

/// Calls `work` on this number of threads.
pub(super) fn on_threads<T: Send>(threads: Option<u64>, work: impl FnOnce() -> T + Send) -> Result<T, Failure> {
    let count = count(threads)? as usize;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build();
    let pool = pool.map_err(|error| Failure::Input(format!("--threads {count}: {error}; allowed: {ALLOWED}")))?;
    Ok(pool.install(work))
}
