//! The replicas of a run, kept while they run.
//!
//! Replicas are begun in order, each in a pool of threads of its own: so few wait to be added up, and none waits in the
//! middle of a step for another one, as it might in one pool for all.

use super::{Checkpoint, on_stop, stays};
use crate::files::output::{OutputError, Refused};
use serde::{Deserialize, Serialize};
use serde_json::json;
use shearbed::Error;
use shearbed::run::ensemble::Tally;
use shearbed::run::resume::Halfway;
use shearbed::run::{Replica, go_on};
use shearbed::{Plan, Results};
use std::collections::BTreeMap;
use std::fmt;
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::Duration;

/// How long the end of the program waits for replicas to say where they are; who is later is kept as last told.
const PATIENCE: Duration = Duration::from_secs(10);

/// What a checkpoint of a run holds.
#[derive(Serialize, Deserialize)]
struct Kept {
    /// The first replicas, added up.
    tally: Tally,
    /// Replicas that are done and wait for one before them.
    done: BTreeMap<u64, Replica>,
    /// Replicas in work, where they were when last asked.
    halfway: BTreeMap<u64, Halfway>,
}

/// How far a run has come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Replicas that are done.
    pub done: u64,
    /// Replicas that were left in the middle.
    pub halfway: usize,
    /// Replicas of the whole run.
    pub all: u64,
}

impl fmt::Display for Progress {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { done, halfway, all } = self;
        write!(f, "{done} of {all} replicas are done, {halfway} halfway")
    }
}

struct State {
    kept: Kept,
    /// Something of it is not in the file.
    new: bool,
    /// The next replica to begin.
    next: u64,
    /// The replicas in work, and in which round of questions each has answered last.
    in_work: BTreeMap<u64, u64>,
    /// The first replica that stopped.
    stopped: Option<(u64, Error)>,
    ended: bool,
}

/// A run with a checkpoint.
pub struct Replicas {
    plan: Plan,
    file: Checkpoint,
    every: Duration,
    /// Rounds of questions so far.
    round: AtomicU64,
    state: Mutex<State>,
    /// An answer, or the end.
    told: Condvar,
}

impl Replicas {
    /// Goes on from `file` where it holds something, and keeps the run there from now on, at least so often. What cannot be
    /// written is known before the work.
    pub fn open(plan: &Plan, path: &Path, every: Duration) -> Result<Arc<Self>, Refused> {
        let file = Checkpoint::open(path, "run", json!({ "scene": plan.scene().resolved() }))?;
        let kept: Option<Kept> = file.read()?;
        let kept = kept.unwrap_or_else(|| Kept {
            tally: Tally::new(plan),
            done: BTreeMap::new(),
            halfway: BTreeMap::new(),
        });
        let misfit = |why: &str| file.refused(&format!("is damaged: {why}"));
        kept.tally.check(plan).map_err(misfit)?;
        let left = kept.tally.replicas()..plan.scene().ensemble.replicas;
        if !kept.done.keys().chain(kept.halfway.keys()).all(|replica| left.contains(replica)) {
            return Err(misfit("a replica in it is not left to be done"));
        }
        kept.done.values().try_for_each(|done| done.check(plan)).map_err(misfit)?;
        kept.halfway.values().try_for_each(|halfway| halfway.check(plan)).map_err(misfit)?;
        file.write(&kept)?;
        let replicas = Arc::new(Self {
            plan: plan.clone(),
            every,
            round: AtomicU64::new(0),
            state: Mutex::new(State {
                next: kept.tally.replicas(),
                kept,
                new: false,
                in_work: BTreeMap::new(),
                stopped: None,
                ended: false,
            }),
            told: Condvar::new(),
            file,
        });
        // Weak: the file is let go of when the run is over.
        let (last, path) = (Arc::downgrade(&replicas), path.to_owned());
        on_stop(move || match last.upgrade() {
            Some(replicas) => Some(replicas.last_words()),
            None => stays(&path),
        });
        Ok(replicas)
    }

    /// Its file.
    pub fn path(&self) -> &Path {
        self.file.path()
    }

    /// How far the run has come.
    pub fn progress(&self) -> Progress {
        self.progress_of(&self.state().kept)
    }

    fn progress_of(&self, kept: &Kept) -> Progress {
        Progress {
            done: kept.tally.replicas() + kept.done.len() as u64,
            halfway: kept.halfway.len(),
            all: self.plan.scene().ensemble.replicas,
        }
    }

    /// Runs what is left. `finished` is called after each replica; `saved` after each checkpoint with something new, the last
    /// one at the end of the run, or with the reason why it could not be written: the run ends after that call. The results are
    /// the bits of [`shearbed::run::ensemble::run`].
    pub fn run(
        &self,
        threads: usize,
        finished: impl Fn() + Sync,
        saved: impl Fn(Result<Progress, OutputError>) + Sync,
    ) -> Result<Results, Error> {
        let Progress { done, all, .. } = self.progress();
        let left = all - done;
        let at_once = (threads as u64).min(left) as usize;
        thread::scope(|scope| {
            let workers: Vec<_> = (0..at_once)
                .map(|k| {
                    let own = (threads - k).div_ceil(at_once);
                    let finished = &finished;
                    scope.spawn(move || {
                        match rayon::ThreadPoolBuilder::new().num_threads(own).build() {
                            Ok(pool) => pool.install(|| self.work(finished)),
                            // In the pool of all, where it is only slower to answer.
                            Err(_) => self.work(finished),
                        }
                    })
                })
                .collect();
            let keeper = scope.spawn(|| self.keep(&saved));
            let ends: Vec<_> = workers.into_iter().map(|worker| worker.join()).collect();
            self.state().ended = true;
            self.told.notify_all();
            let mut ends = ends.into_iter().chain([keeper.join()]);
            if let Some(panic) = ends.find_map(Result::err) {
                std::panic::resume_unwind(panic);
            }
        });
        self.save_and_tell(&saved);
        let mut state = self.state();
        match state.stopped.take() {
            Some((_, error)) => Err(error),
            None => Ok(state.kept.tally.clone().results(&self.plan)),
        }
    }

    /// Runs one replica after the other.
    fn work(&self, finished: &(impl Fn() + Sync)) {
        while let Some((replica, from, mut answered)) = self.begin() {
            let end = go_on(&self.plan, replica, from, |state| {
                let asked = self.round.load(Ordering::Relaxed);
                if asked > answered {
                    answered = asked;
                    self.answer(replica, asked, state);
                }
            });
            self.end(replica, end);
            finished();
        }
    }

    /// The next replica, where it was left, and the round of questions that need not be answered.
    fn begin(&self) -> Option<(u64, Option<Halfway>, u64)> {
        let mut state = self.state();
        // What was done before its turn may be added up by now.
        state.next = state.next.max(state.kept.tally.replicas());
        while state.kept.done.contains_key(&state.next) {
            state.next += 1;
        }
        let replica = state.next;
        if state.stopped.is_some() || replica >= self.plan.scene().ensemble.replicas {
            return None;
        }
        state.next += 1;
        let round = self.round.load(Ordering::Relaxed);
        state.in_work.insert(replica, round);
        Some((replica, state.kept.halfway.get(&replica).cloned(), round))
    }

    fn answer(&self, replica: u64, round: u64, halfway: &dyn Fn() -> Halfway) {
        let mut state = self.state();
        // First the old one: there is memory for one.
        state.kept.halfway.remove(&replica);
        state.kept.halfway.insert(replica, halfway());
        state.new = true;
        state.in_work.insert(replica, round);
        self.told.notify_all();
    }

    fn end(&self, replica: u64, end: Result<Replica, Error>) {
        let mut state = self.state();
        state.in_work.remove(&replica);
        match end {
            Ok(end) => {
                state.kept.halfway.remove(&replica);
                state.kept.done.insert(replica, end);
                state.new = true;
            }
            Err(error) => {
                let first = state.stopped.as_ref().is_none_or(|(first, _)| replica < *first);
                if first {
                    state.stopped = Some((replica, error));
                }
            }
        }
        let Kept { tally, done, .. } = &mut state.kept;
        while let Some(next) = done.remove(&tally.replicas()) {
            tally.add(next);
        }
        self.told.notify_all();
    }

    /// Saves again and again until the run has ended.
    fn keep(&self, saved: &impl Fn(Result<Progress, OutputError>)) {
        loop {
            let wait = self.told.wait_timeout_while(self.state(), self.every, |state| !state.ended);
            if wait.unwrap_or_else(PoisonError::into_inner).0.ended {
                return;
            }
            self.save_and_tell(saved);
        }
    }

    fn save_and_tell(&self, saved: &impl Fn(Result<Progress, OutputError>)) {
        match self.save(None) {
            Ok((_, false)) => (),
            Ok((progress, true)) => saved(Ok(progress)),
            Err(error) => saved(Err(error)),
        }
    }

    /// Asks every replica in work where it is, waits for the answers, at most so long, and writes all down where something is
    /// new. What the file holds then, and whether it was written.
    fn save(&self, patience: Option<Duration>) -> Result<(Progress, bool), OutputError> {
        let mut state = self.state();
        let round = self.round.fetch_add(1, Ordering::Relaxed) + 1;
        let silent =
            |state: &mut State| !state.ended && state.in_work.values().any(|answered| *answered < round);
        state = match patience {
            None => self.told.wait_while(state, silent).unwrap_or_else(PoisonError::into_inner),
            Some(patience) => {
                let wait = self.told.wait_timeout_while(state, patience, silent);
                wait.unwrap_or_else(PoisonError::into_inner).0
            }
        };
        let progress = self.progress_of(&state.kept);
        if !state.new {
            return Ok((progress, false));
        }
        let part = self.file.begin(&state.kept)?;
        state.new = false;
        // The disk may be slow: replicas need not wait for it.
        drop(state);
        if let Err(error) = part.finish() {
            self.state().new = true;
            return Err(error);
        }
        Ok((progress, true))
    }

    /// Saves before the program ends, and says how to go on.
    fn last_words(&self) -> String {
        let path = self.file.path().display();
        match self.save(Some(PATIENCE)) {
            Ok((progress, _)) => {
                format!("{progress}; the run is kept in {path}, and the same command goes on from there")
            }
            Err(error) => {
                format!("{error}; what {path} has from before stays, and the same command goes on from there")
            }
        }
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
