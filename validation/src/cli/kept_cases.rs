//! The cases that `validate` has finished, kept so that they need not run again.

use super::{Failure, alone, print};
use crate::accept::Verdict;
use crate::case::{Control, Judged};
use crate::checkpoint::{Checkpoint, on_stop};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// An outcome without what the case says of itself.
pub(super) type Found = (Verdict, Vec<Judged>, Vec<Control>, f64);

/// Finished cases by name, and the file that has them.
pub(super) struct Kept {
    file: Checkpoint,
    found: Mutex<BTreeMap<String, Found>>,
}

impl Kept {
    /// Goes on from `file` where it holds cases of the same input and build.
    pub(super) fn open(path: &Path, input: Value, quiet: bool) -> Result<Self, Failure> {
        alone(path)?;
        let file = Checkpoint::open(path, "validate", input)?;
        let found: BTreeMap<String, Found> = file.read()?.unwrap_or_default();
        file.write(&found)?;
        let path = path.display().to_string();
        if !found.is_empty() && !quiet {
            print(&format!(
                "goes on from {path}: {} cases are finished\n",
                found.len()
            ))?;
        }
        on_stop(move || {
            Some(format!(
                "finished cases are kept in {path}, and the same command goes on from there"
            ))
        });
        let found = Mutex::new(found);
        Ok(Self { file, found })
    }

    /// How a case ended, where it is finished.
    pub(super) fn found(&self, name: &str) -> Option<Found> {
        self.all().get(name).cloned()
    }

    /// Keeps how a case ended.
    pub(super) fn keep(&self, name: &str, found: &Found) -> Result<(), Failure> {
        let mut all = self.all();
        if all.insert(name.to_owned(), found.clone()).as_ref() == Some(found) {
            return Ok(());
        }
        Ok(self.file.write(&*all)?)
    }

    fn all(&self) -> MutexGuard<'_, BTreeMap<String, Found>> {
        self.found.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
