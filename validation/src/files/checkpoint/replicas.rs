//! The replicas of a run with a checkpoint.
//!
//! Replicas start in order, each in a pool of threads of its own: so few finished ones wait for their turn in the sum, and none
//! waits in the middle of a step for another one, as it might in one pool for all.

use super::saved::{Progress, Saved, without_replicas};
use super::{Checkpoint, on_stop, stays};
use crate::files::output::{OutputError, Refused};
use crate::files::text::Shown;
use serde_json::json;
use shearbed::Error;
use shearbed::run::ensemble::Tally;
use shearbed::run::resume::Halfway;
use shearbed::run::{Replica, go_on};
use shearbed::{Plan, Results};
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

/// The longest wait for the states of replicas when a signal ends the program; a later one is saved as it last was.
const PATIENCE: Duration = Duration::from_secs(10);

struct State {
    saved: Saved,
    /// The replicas of the run so far: none after them begins.
    all: u64,
    /// No replica begins after it, but for the first two.
    deadline: Option<Instant>,
    /// True if the file lacks some of it.
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
    /// Signals an answer of a replica, or the end.
    changed: Condvar,
}

impl Replicas {
    /// Opens the checkpoint at `path`, to be written at least every `every`, for at most the plan's replicas. One of fewer
    /// replicas of the same scene is gone on with; [`Self::write`] makes the file where there is none.
    ///
    /// # Errors
    ///
    /// A checkpoint of another scene or seed, or of more replicas; a damaged one.
    pub fn open(plan: &Plan, path: &Path, every: Duration) -> Result<Arc<Self>, Refused> {
        let file = Checkpoint::open(path, "run", json!({ "scene": without_replicas(plan.scene()) }))?;
        let saved = Saved::read(&file, plan)?;
        let all = plan.scene().ensemble.replicas;
        let replicas = Arc::new(Self {
            plan: plan.clone(),
            every,
            round: AtomicU64::new(0),
            state: Mutex::new(State {
                next: saved.tally.replicas(),
                saved,
                all,
                deadline: None,
                new: false,
                in_work: BTreeMap::new(),
                stopped: None,
                ended: false,
            }),
            changed: Condvar::new(),
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

    /// Writes the file as it was opened.
    ///
    /// # Errors
    ///
    /// A file that cannot be written.
    pub fn write(&self) -> Result<(), OutputError> {
        self.file.write(&self.state().saved)
    }

    /// The progress of the run.
    pub fn progress(&self) -> Progress {
        let state = self.state();
        state.saved.progress(state.all)
    }

    /// The number of replicas in the sum.
    pub fn replicas(&self) -> u64 {
        self.state().saved.tally.replicas()
    }

    /// The sum of the replicas so far.
    pub fn tally(&self) -> Tally {
        self.state().saved.tally.clone()
    }

    /// Runs the plan's replicas that are left. `finished` is called after each replica; `saved` after each checkpoint with something
    /// new, the last one at the end of the run, or with the reason why it could not be written: the run ends after that call.
    /// The results are the bits of [`shearbed::run::ensemble::run`].
    pub fn run(
        &self,
        threads: usize,
        finished: impl Fn() + Sync,
        saved: impl Fn(Result<Progress, OutputError>) + Sync,
    ) -> Result<Results, Error> {
        self.run_to(threads, (self.plan.scene().ensemble.replicas, None), finished, saved)?;
        Ok(self.tally().results(&self.plan))
    }

    /// The same for the first `all` replicas; after the deadline none begins, but for the first two.
    pub fn run_to(
        &self,
        threads: usize,
        (all, deadline): (u64, Option<Instant>),
        finished: impl Fn() + Sync,
        saved: impl Fn(Result<Progress, OutputError>) + Sync,
    ) -> Result<(), Error> {
        {
            let mut state = self.state();
            state.all = all.min(self.plan.scene().ensemble.replicas);
            state.deadline = deadline;
            state.ended = false;
            state.next = state.saved.tally.replicas();
            let all = state.all;
            state.saved.add_up(all);
        }
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
            let saver = scope.spawn(|| self.save_regularly(&saved));
            let ends: Vec<_> = workers.into_iter().map(|worker| worker.join()).collect();
            self.state().ended = true;
            self.changed.notify_all();
            let mut ends = ends.into_iter().chain([saver.join()]);
            if let Some(panic) = ends.find_map(Result::err) {
                std::panic::resume_unwind(panic);
            }
        });
        self.save_and_report(&saved);
        let mut state = self.state();
        match state.stopped.take() {
            Some((_, error)) => Err(error),
            None => Ok(()),
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
        state.next = state.next.max(state.saved.tally.replicas());
        while state.saved.done.contains_key(&state.next) {
            state.next += 1;
        }
        let replica = state.next;
        let late = replica > 1 && state.deadline.is_some_and(|deadline| Instant::now() >= deadline);
        if state.stopped.is_some() || replica >= state.all || late {
            return None;
        }
        state.next += 1;
        let round = self.round.load(Ordering::Relaxed);
        state.in_work.insert(replica, round);
        Some((replica, state.saved.halfway.get(&replica).cloned(), round))
    }

    fn answer(&self, replica: u64, round: u64, halfway: &dyn Fn() -> Halfway) {
        let mut state = self.state();
        // First the old one: there is memory for one.
        state.saved.halfway.remove(&replica);
        state.saved.halfway.insert(replica, halfway());
        state.new = true;
        state.in_work.insert(replica, round);
        self.changed.notify_all();
    }

    fn end(&self, replica: u64, end: Result<Replica, Error>) {
        let mut state = self.state();
        state.in_work.remove(&replica);
        match end {
            Ok(end) => {
                state.saved.halfway.remove(&replica);
                state.saved.done.insert(replica, end);
                state.new = true;
            }
            Err(error) => {
                let first = state.stopped.as_ref().is_none_or(|(first, _)| replica < *first);
                if first {
                    state.stopped = Some((replica, error));
                }
            }
        }
        let all = state.all;
        state.saved.add_up(all);
        self.changed.notify_all();
    }

    /// Saves again and again until the run has ended.
    fn save_regularly(&self, saved: &impl Fn(Result<Progress, OutputError>)) {
        loop {
            let wait = self.changed.wait_timeout_while(self.state(), self.every, |state| !state.ended);
            if wait.unwrap_or_else(PoisonError::into_inner).0.ended {
                return;
            }
            self.save_and_report(saved);
        }
    }

    fn save_and_report(&self, saved: &impl Fn(Result<Progress, OutputError>)) {
        match self.save(None) {
            Ok((_, false)) => (),
            Ok((progress, true)) => saved(Ok(progress)),
            Err(error) => saved(Err(error)),
        }
    }

    /// Checkpoints every replica: asks each for its state, waits for the answers up to `patience`, and writes the file if
    /// something is new. Returns the progress in the file, and true if it was written.
    fn save(&self, patience: Option<Duration>) -> Result<(Progress, bool), OutputError> {
        let mut state = self.state();
        let round = self.round.fetch_add(1, Ordering::Relaxed) + 1;
        let silent =
            |state: &mut State| !state.ended && state.in_work.values().any(|answered| *answered < round);
        state = match patience {
            None => self.changed.wait_while(state, silent).unwrap_or_else(PoisonError::into_inner),
            Some(patience) => {
                let wait = self.changed.wait_timeout_while(state, patience, silent);
                wait.unwrap_or_else(PoisonError::into_inner).0
            }
        };
        let progress = state.saved.progress(state.all);
        if !state.new {
            return Ok((progress, false));
        }
        let part = self.file.begin(&state.saved)?;
        state.new = false;
        // The disk may be slow: replicas need not wait for it.
        drop(state);
        if let Err(error) = part.finish() {
            self.state().new = true;
            return Err(error);
        }
        Ok((progress, true))
    }

    /// Saves before the program ends; returns how to go on.
    fn last_words(&self) -> String {
        let path = self.file.path().shown();
        match self.save(Some(PATIENCE)) {
            Ok((progress, _)) => {
                format!("{progress}; the run is kept in {path}, and the same command goes on from there")
            }
            Err(error) => {
                format!(
                    "{error}; the earlier state in {path} is kept, and the same command goes on from there"
                )
            }
        }
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
