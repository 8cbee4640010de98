//! Values that a check shares with its controls, computed once: a control that is a wrong formula needs no run of its
//! own.

use crate::judge::case::Effort;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

/// Values by their keys, for the seed and the effort of one run.
pub struct Shared<K, T>(Mutex<Stored<K, T>>);

struct Stored<K, T> {
    run: (u64, bool),
    values: BTreeMap<K, Arc<T>>,
}

impl<K: Ord, T> Default for Shared<K, T> {
    fn default() -> Self {
        Self::new()
    }
}

impl<K: Ord, T> Shared<K, T> {
    /// An empty store.
    pub const fn new() -> Self {
        Self(Mutex::new(Stored { run: (0, false), values: BTreeMap::new() }))
    }

    /// The value for `key`, computed by `work_out` if it is missing. It must depend only on key and effort; another run
    /// clears it.
    pub fn get(&self, effort: &Effort, key: K, work_out: impl FnOnce() -> T) -> Arc<T> {
        let locked = || {
            let mut stored = self.0.lock().unwrap_or_else(PoisonError::into_inner);
            let run = (effort.seed, effort.full);
            if stored.run != run {
                stored.run = run;
                stored.values.clear();
            }
            stored
        };
        if let Some(value) = locked().values.get(&key) {
            return Arc::clone(value);
        }
        // Not under the lock: while it waits, a thread may be given another thread's work, which may need the lock too.
        let value = Arc::new(work_out());
        locked().values.insert(key, Arc::clone(&value));
        value
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_key_and_effort_is_worked_out_once() {
        let shared = Shared::new();
        let mut runs = 0;
        for (seed, full, key) in
            [(1, false, 0), (1, false, 0), (1, false, 1), (2, false, 0), (2, true, 0), (2, true, 0)]
        {
            let effort = Effort { full, seed, data: None };
            let value = shared.get(&effort, key, || {
                runs += 1;
                (seed, key)
            });
            assert_eq!(*value, (seed, key));
        }
        assert_eq!(runs, 4);
    }
}
