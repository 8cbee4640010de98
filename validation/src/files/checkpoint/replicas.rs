//! Runs replicas with a checkpoint.
//!
//! Replicas start in order, each in its own pool of threads. So only few finished replicas wait for their turn in the
//! sum, and none waits in the middle of a step for another one, as could happen in a common pool.

use super::saved::{Progress, Saved, without_replicas};
use super::{Checkpoint, on_stop_of};
use crate::files::locked;
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
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

/// The longest wait for the states of replicas when a signal ends the program; for slower replicas the last state is
/// saved.
const PATIENCE: Duration = Duration::from_secs(10);

struct State {
    saved: Saved,
    /// The number of replicas of the current run: no replica from this index on begins.
    all: u64,
    /// After this time no replica begins, except the first two.
    deadline: Option<Instant>,
    /// True if the file does not contain the whole state.
    new: bool,
    /// Index of the next replica to begin.
    next: u64,
    /// The replicas in work, with the last round of requests that each has answered.
    in_work: BTreeMap<u64, u64>,
    /// The first replica that failed, with its error.
    stopped: Option<(u64, Error)>,
    ended: bool,
}

/// A run with a checkpoint.
pub struct Replicas {
    plan: Plan,
    file: Checkpoint,
    every: Duration,
    /// Number of rounds of requests so far.
    round: AtomicU64,
    state: Mutex<State>,
    /// Notified by an answer of a replica, and by the end.
    changed: Condvar,
}

impl Replicas {
    /// Opens the checkpoint at `path`, to be written at least every `every`, for at most the plan's replicas. A
    /// checkpoint with fewer replicas of the same scene is continued; if there is none, [`Self::write`] makes it.
    ///
    /// # Errors
    ///
    /// If the checkpoint is of another scene or seed, has more replicas, or is damaged.
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
        on_stop_of(&replicas, path, Self::last_words);
        Ok(replicas)
    }

    /// The path of the file.
    pub fn path(&self) -> &Path {
        self.file.path()
    }

    /// Writes the state as it was opened to the file.
    ///
    /// # Errors
    ///
    /// If the file cannot be written.
    pub fn write(&self) -> Result<(), OutputError> {
        self.file.write(&locked(&self.state).saved)
    }

    /// The progress of the run.
    pub fn progress(&self) -> Progress {
        let state = locked(&self.state);
        state.saved.progress(state.all)
    }

    /// The number of replicas in the sum.
    pub fn replicas(&self) -> u64 {
        locked(&self.state).saved.tally.replicas()
    }

    /// The sum of the replicas so far.
    pub fn tally(&self) -> Tally {
        locked(&self.state).saved.tally.clone()
    }

    /// Runs the plan's remaining replicas. Calls `finished` after each replica, and `saved` after each checkpoint with
    /// new contents, including the last one at the end of the run, or with the reason why writing failed; then the run
    /// ends after that call. The results are the bits of [`shearbed::run::ensemble::run`].
    pub fn run(
        &self,
        threads: usize,
        finished: impl Fn() + Sync,
        saved: impl Fn(Result<Progress, OutputError>) + Sync,
    ) -> Result<Results, Error> {
        self.run_to(threads, (self.plan.scene().ensemble.replicas, None), finished, saved)?;
        Ok(self.tally().results(&self.plan))
    }

    /// Like `run` for the first `all` replicas; after the deadline none begins, except the first two.
    pub fn run_to(
        &self,
        threads: usize,
        (all, deadline): (u64, Option<Instant>),
        finished: impl Fn() + Sync,
        saved: impl Fn(Result<Progress, OutputError>) + Sync,
    ) -> Result<(), Error> {
        {
            let mut state = locked(&self.state);
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
                            // In the common pool, where it only answers more slowly.
                            Err(_) => self.work(finished),
                        }
                    })
                })
                .collect();
            let saver = scope.spawn(|| self.save_regularly(&saved));
            let ends: Vec<_> = workers.into_iter().map(|worker| worker.join()).collect();
            locked(&self.state).ended = true;
            self.changed.notify_all();
            let mut ends = ends.into_iter().chain([saver.join()]);
            if let Some(panic) = ends.find_map(Result::err) {
                std::panic::resume_unwind(panic);
            }
        });
        self.save_and_report(&saved);
        locked(&self.state).stopped.take().map_or(Ok(()), |(_, error)| Err(error))
    }

    /// Runs replicas, one after the other, until none is left.
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

    /// The next replica, the state from which it resumes, and the last round of requests that it need not answer.
    fn begin(&self) -> Option<(u64, Option<Halfway>, u64)> {
        let mut state = locked(&self.state);
        // A replica that was finished before its turn may be in the sum by now.
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
        let mut state = locked(&self.state);
        // The old state is removed first, because there is memory for only one.
        state.saved.halfway.remove(&replica);
        state.saved.halfway.insert(replica, halfway());
        state.new = true;
        state.in_work.insert(replica, round);
        self.changed.notify_all();
    }

    fn end(&self, replica: u64, end: Result<Replica, Error>) {
        let mut state = locked(&self.state);
        state.in_work.remove(&replica);
        match end {
            Ok(end) => {
                state.saved.halfway.remove(&replica);
                state.saved.done.insert(replica, end);
                state.new = true;
            }
            Err(error) if state.stopped.as_ref().is_none_or(|(first, _)| replica < *first) => {
                state.stopped = Some((replica, error));
            }
            Err(_) => {}
        }
        let all = state.all;
        state.saved.add_up(all);
        self.changed.notify_all();
    }

    /// Saves at regular intervals until the run has ended.
    fn save_regularly(&self, saved: &impl Fn(Result<Progress, OutputError>)) {
        loop {
            let wait = self.changed.wait_timeout_while(locked(&self.state), self.every, |state| !state.ended);
            if wait.unwrap_or_else(PoisonError::into_inner).0.ended {
                return;
            }
            self.save_and_report(saved);
        }
    }

    fn save_and_report(&self, saved: &impl Fn(Result<Progress, OutputError>)) {
        if let Some(result) = self.save(None).map(|(progress, is_new)| is_new.then_some(progress)).transpose() {
            saved(result);
        }
    }

    /// Checkpoints every replica: requests their states, waits up to `patience` for the answers, and writes the file if
    /// there is anything new. Returns the progress in the file, and true if it was written.
    fn save(&self, patience: Option<Duration>) -> Result<(Progress, bool), OutputError> {
        let mut state = locked(&self.state);
        let round = self.round.fetch_add(1, Ordering::Relaxed) + 1;
        let silent = |state: &mut State| !state.ended && state.in_work.values().any(|answered| *answered < round);
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
        // The lock is released, so that replicas do not wait for a slow disk.
        drop(state);
        if let Err(error) = part.finish() {
            locked(&self.state).new = true;
            return Err(error);
        }
        Ok((progress, true))
    }

    /// Saves before the program ends; returns a message that says how to resume.
    fn last_words(&self) -> String {
        let path = self.file.path().shown();
        match self.save(Some(PATIENCE)) {
            Ok((progress, _)) => {
                format!("{progress}; the run is saved in {path}, and the same command goes on from there")
            }
            Err(error) => {
                format!("{error}; the earlier state stays in {path}, and the same command goes on from there")
            }
        }
    }
}
