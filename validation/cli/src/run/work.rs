//! The work of a run: its replicas, with a checkpoint or without, a given number or until a rule holds.

use super::{Args, Run};
use crate::until::{Ended, Look, Measure};
use crate::{Failure, log, on_threads, scene};
use shearbed::run::ensemble::Tally;
use shearbed::{Error, Results};
use shearbed_validation::files::checkpoint::{Progress, Replicas};
use shearbed_validation::files::cluster;
use shearbed_validation::files::output::OutputError;
use shearbed_validation::files::text::Shown;
use std::time::Instant;

/// The results, and the choice of the number of replicas by rules for standard errors; none without them.
pub(super) type Done = (Results, Option<Ended>);

/// Writes the checkpoint for the first time, and prints how much of the run it contains.
pub(super) fn begin(args: &Args, replicas: &Replicas) -> Result<(), Failure> {
    replicas.write()?;
    let progress = replicas.progress();
    let Progress { done, halfway, .. } = progress;
    if done == 0 && halfway == 0 {
        return Ok(());
    }
    let progress = if args.until.is_empty() {
        progress.to_string()
    } else {
        format!("{done} replicas are done, {halfway} halfway")
    };
    args.writing.print(&format!("goes on from {}: {progress}\n", replicas.path().shown()))
}

impl Run<'_> {
    /// Runs the replicas, or those that the checkpoint lacks; the results on the root. A run that stops writes nothing,
    /// so that earlier results stay.
    pub(super) fn replicas(&self) -> Result<Option<Done>, Failure> {
        let results = match &self.checkpoint {
            Some(replicas) => self.kept(replicas).map(Some),
            None => on_threads(self.args.threads.given, || self.alone())?,
        };
        self.bar.finish_and_clear();
        results.map_err(|error| Failure::Input(format!("{}: {error}", self.named.source)))
    }

    /// Runs the replicas on the threads of the current pool and all ranks; the results on the root.
    fn alone(&self) -> Result<Option<Done>, Error> {
        let Run { plan, args, .. } = self;
        let finished = || self.bar.inc(1);
        if args.until.is_empty() {
            return Ok(cluster::ensemble(plan, finished)?.map(|results| (results, None)));
        }
        let mut tally = Tally::new(plan);
        let mut done = 0;
        let add = |target: u64, deadline: Option<Instant>, measure: &Measure| -> Result<Look, Error> {
            while done < target {
                // The root decides for all ranks.
                let end = cluster::from_root(|| Ok::<_, Error>(self.end_of_part(done, target, deadline)))?;
                if end == done {
                    break;
                }
                cluster::extend(plan, &mut tally, done..end, finished)?;
                done = end;
            }
            cluster::from_root(|| Ok(measure(&tally)))
        };
        let ended = args.until.grow(plan, (0, args.time_limit, self.most_h()), add, |ended| self.show(ended))?;
        Ok(cluster::is_root().then(|| (tally.results(plan), Some(ended))))
    }

    /// The total of replicas to reach before the clock is checked again: the target if there is no time limit, and no
    /// more than `done` after the deadline. Two replicas run in any case.
    fn end_of_part(&self, done: u64, target: u64, deadline: Option<Instant>) -> u64 {
        match deadline {
            None => target,
            Some(deadline) if done > 1 && Instant::now() >= deadline => done,
            Some(_) => target.min(done + (self.threads * cluster::size()) as u64),
        }
    }

    /// Runs the replicas that are missing in a checkpoint.
    fn kept(&self, replicas: &Replicas) -> Result<Done, Error> {
        let Run { plan, args, .. } = self;
        self.bar.inc(replicas.progress().done);
        let finished = || self.bar.inc(1);
        let saved = |saved| self.saved(replicas, saved);
        if args.until.is_empty() {
            return Ok((replicas.run(self.threads, finished, saved)?, None));
        }
        let add = |target: u64, deadline: Option<Instant>, measure: &Measure| -> Result<Look, Error> {
            replicas.run_to(self.threads, (target, deadline), finished, saved)?;
            Ok(measure(&replicas.tally()))
        };
        let from = (replicas.replicas(), args.time_limit, self.most_h());
        let ended = args.until.grow(plan, from, add, |ended| self.show(ended))?;
        Ok((replicas.tally().results(plan), Some(ended)))
    }

    /// The hours that replicas may be added without being asked; a time limit is an answer.
    fn most_h(&self) -> f64 {
        self.args.time_limit.map_or(self.args.long.most_h(), |_| f64::INFINITY)
    }

    /// Shows on the terminal how far the standard errors are from the rules.
    fn show(&self, ended: &Ended) {
        self.bar.set_length(ended.expected());
        self.bar.set_message(ended.text());
    }

    fn saved(&self, replicas: &Replicas, saved: Result<Progress, OutputError>) {
        match saved {
            Ok(progress) => log(&format!("saved in {}: {progress}", replicas.path().shown()), self.args.writing.quiet),
            Err(error) => {
                scene::warn("--checkpoint", [&format!("{error}; the run goes on, later work is not saved")]);
            }
        }
    }
}
