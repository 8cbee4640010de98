//! Finished runs of a fit in a checkpoint, so that an interrupted fit need not run them again. A run is the same
//! whenever it is asked for, so the fit goes on to the same bits.

use crate::files::checkpoint::{Checkpoint, on_stop_of};
use crate::files::locked;
use crate::files::output::{OutputError, Refused};
use crate::files::text::Shown;
use crate::methods::least_squares::emulator::Predictions;
use serde_json::Value;
use shearbed::plan::counted;
use std::collections::{BTreeMap, HashMap};
use std::fmt;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::Path;
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// Predictions by what a run depends on but the replica, then by replica.
type Found = HashMap<u64, BTreeMap<u64, Predictions>>;

struct State {
    found: Found,
    /// The last time at which the file had all of them.
    written: Instant,
}

impl State {
    fn count(&self) -> usize {
        self.found.values().map(BTreeMap::len).sum()
    }
}

/// The runs that a checkpoint has.
pub struct Runs {
    file: Checkpoint,
    every: Duration,
    state: Mutex<State>,
}

impl Runs {
    /// Opens the checkpoint at `path`, to be written at least every `every`, or makes it. `inputs` are the scenes:
    /// other points, ranges and numbers of replicas may use its runs.
    ///
    /// # Errors
    ///
    /// If the checkpoint is of other work, is damaged, or cannot be written.
    pub fn open(path: &Path, every: Duration, inputs: Value) -> Result<Arc<Self>, Refused> {
        let file = Checkpoint::open(path, "fit", inputs)?;
        let found: Found = file.read()?.unwrap_or_default();
        file.write(&found).map_err(|error| file.refused(&error.to_string()))?;
        let runs = Arc::new(Self { file, every, state: Mutex::new(State { found, written: Instant::now() }) });
        on_stop_of(&runs, path, Self::last_words);
        Ok(runs)
    }

    /// The number of runs.
    pub fn count(&self) -> usize {
        locked(&self.state).count()
    }

    /// Writes all runs to the file.
    ///
    /// # Errors
    ///
    /// If the file cannot be written.
    pub fn write(&self) -> Result<(), OutputError> {
        self.write_state(&mut locked(&self.state))
    }

    /// The result of a run, by `key` and replica: that of the file, or of `run`.
    pub(super) fn run(
        &self,
        key: u64,
        replica: u64,
        run: impl FnOnce() -> Result<Predictions, String>,
    ) -> Result<Predictions, String> {
        if let Some(found) = locked(&self.state).found.get(&key).and_then(|found| found.get(&replica)) {
            return Ok(found.clone());
        }
        let found = run()?;
        let mut state = locked(&self.state);
        state.found.entry(key).or_default().insert(replica, found.clone());
        if state.written.elapsed() >= self.every {
            self.write_state(&mut state).map_err(|error| error.to_string())?;
        }
        Ok(found)
    }

    fn write_state(&self, state: &mut State) -> Result<(), OutputError> {
        self.file.write(&state.found)?;
        state.written = Instant::now();
        Ok(())
    }

    fn last_words(&self) -> String {
        let path = self.file.path().shown();
        let mut state = locked(&self.state);
        match self.write_state(&mut state) {
            Ok(()) => {
                let runs = counted(state.count() as u64, "run");
                format!("saved in {path}: {runs}; the same command goes on from there")
            }
            Err(error) => format!("{error}; earlier runs stay in {path}, and the same command goes on from there"),
        }
    }
}

impl fmt::Debug for Runs {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} runs", self.count())
    }
}

/// A key of everything that a run depends on. The same build gives the same key; a checkpoint is of one build.
pub(super) fn key(depends_on: impl Hash) -> u64 {
    let mut hasher = DefaultHasher::new();
    depends_on.hash(&mut hasher);
    hasher.finish()
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;
    use std::cell::Cell;

    #[test]
    fn a_run_that_the_file_has_does_not_run_again() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("fit.ckpt");
        let open = |inputs: &str| Runs::open(&path, Duration::from_secs(60), json!({ "scene": inputs }));
        let begun = Cell::new(0);
        let asked = |runs: &Runs, key: u64, replica: u64| {
            let run = || {
                begun.set(begun.get() + 1);
                Ok(vec![(0, [key as f64, replica as f64, 0.1 + 0.2])])
            };
            runs.run(key, replica, run).unwrap()
        };
        let runs = open("a").unwrap();
        let first = asked(&runs, 7, 3);
        assert_eq!((asked(&runs, 7, 3), begun.get(), runs.count()), (first.clone(), 1, 1));
        asked(&runs, 7, 4);
        asked(&runs, 8, 3);
        assert_eq!((begun.get(), runs.count()), (3, 3));
        runs.write().unwrap();
        drop(runs);
        assert!(open("b").unwrap_err().to_string().contains("is of other work"));
        let runs = open("a").unwrap();
        assert_eq!((asked(&runs, 7, 3), begun.get(), runs.count()), (first, 3, 3));
        // A failed run is none.
        assert_eq!(runs.run(9, 1, || Err("no".into())), Err("no".into()));
        assert_eq!(runs.count(), 3);
    }
}
