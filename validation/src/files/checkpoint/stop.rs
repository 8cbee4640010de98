//! The last action before a signal ends the program.

use crate::files::locked;
use crate::files::text::Shown;
use std::path::Path;
use std::sync::{Arc, Mutex};

type Last = Box<dyn FnOnce() -> Option<String> + Send>;

static LAST: Mutex<Option<Last>> = Mutex::new(None);

/// Sets the last action before a signal ends the program, replacing the previous one. It returns a message on how to
/// resume, if possible.
pub fn on_stop(last: impl FnOnce() -> Option<String> + Send + 'static) {
    *locked(&LAST) = Some(Box::new(last));
}

/// Sets the last action as `last`, on what holds the checkpoint at `path`, as long as that exists. The reference is
/// weak, so that the file is released when the work is over.
pub fn on_stop_of<T: Send + Sync + 'static>(
    holder: &Arc<T>,
    path: &Path,
    last: impl FnOnce(&T) -> String + Send + 'static,
) {
    let (holder, path) = (Arc::downgrade(holder), path.to_owned());
    on_stop(move || match holder.upgrade() {
        Some(holder) => Some(last(&holder)),
        None => stays(&path),
    });
}

/// Runs the last action, at most once, and returns its message.
pub fn last_words() -> Option<String> {
    let last = locked(&LAST).take();
    last.and_then(|last| last())
}

/// The message that a checkpoint is kept; `None` if there is no such file.
pub fn stays(path: &Path) -> Option<String> {
    path.exists().then(|| format!("{} stays as it is, and the same command goes on from there", path.shown()))
}
