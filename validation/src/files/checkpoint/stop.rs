//! What is still to be done when a signal ends the program.

use crate::files::text::Shown;
use std::path::Path;
use std::sync::{Mutex, PoisonError};

type Last = Box<dyn FnOnce() -> Option<String> + Send>;

static LAST: Mutex<Option<Last>> = Mutex::new(None);

/// From now on `last` is called before a signal ends the program; it returns how to go on,
/// where there is something to go on from.
pub(crate) fn on_stop(last: impl FnOnce() -> Option<String> + Send + 'static) {
    *LAST.lock().unwrap_or_else(PoisonError::into_inner) = Some(Box::new(last));
}

/// Calls what was given, once.
pub(crate) fn last_words() -> Option<String> {
    let last = LAST.lock().unwrap_or_else(PoisonError::into_inner).take();
    last.and_then(|last| last())
}

/// That a checkpoint stays, where there is one.
pub(crate) fn stays(path: &Path) -> Option<String> {
    path.exists().then(|| format!("{} stays as it is, and the same command goes on from there", path.shown()))
}
