//! Graded programs end with this one.

use std::collections::BTreeSet;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// The process groups that run now, to be killed where this program is ended by a signal.
static RUNNING: Mutex<BTreeSet<u32>> = Mutex::new(BTreeSet::new());

pub(super) fn running() -> MutexGuard<'static, BTreeSet<u32>> {
    RUNNING.lock().unwrap_or_else(PoisonError::into_inner)
}

/// From now on, kills every program that was started before an interrupt, a hang-up or a request to end ends this one.
#[cfg(unix)]
pub fn end_with_this_program() -> std::io::Result<()> {
    use rustix::process::{Pid, Signal, kill_process_group};
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    let mut signals = signal_hook::iterator::Signals::new([SIGHUP, SIGINT, SIGTERM])?;
    std::thread::spawn(move || {
        if let Some(signal) = signals.forever().next() {
            for group in running().iter().filter_map(|id| Pid::from_raw(*id as i32)) {
                let _ = kill_process_group(group, Signal::KILL);
            }
            std::process::exit(128 + signal);
        }
    });
    Ok(())
}

/// There are no such signals.
#[cfg(not(unix))]
pub fn end_with_this_program() -> std::io::Result<()> {
    Ok(())
}
