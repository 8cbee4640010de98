//! The work of a run: its replicas, with a checkpoint or without, a given number or until a rule holds.

use super::Args;
use crate::until::{Ended, Look, Measure};
use crate::{log, scene};
use indicatif::ProgressBar;
use shearbed::run::ensemble::Tally;
use shearbed::{Error, Plan, Results};
use shearbed_validation::files::checkpoint::{Progress, Replicas};
use shearbed_validation::files::cluster;
use shearbed_validation::files::output::OutputError;
use shearbed_validation::files::text::Shown;
use std::time::Instant;

/// The results, and the choice of the number of replicas by `--until-se`; none without it.
type Done = (Results, Option<Ended>);

/// The input of a run's work.
pub(super) struct Work<'a> {
    pub(super) args: &'a Args,
    pub(super) plan: &'a Plan,
    pub(super) bar: &'a ProgressBar,
    pub(super) threads: usize,
}

impl Work<'_> {
    /// Runs the replicas on the threads of the current pool and all ranks; the results on the root.
    pub(super) fn alone(&self) -> Result<Option<Done>, Error> {
        let (plan, until) = (self.plan, &self.args.until);
        let finished = || self.bar.inc(1);
        if until.is_empty() {
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
        let ended = until.grow(plan, (0, self.args.time_limit), add, |ended| self.show(ended))?;
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
    pub(super) fn kept(&self, replicas: &Replicas) -> Result<Done, Error> {
        let (plan, until) = (self.plan, &self.args.until);
        let finished = || self.bar.inc(1);
        let saved = |saved| self.saved(replicas, saved);
        if until.is_empty() {
            return Ok((replicas.run(self.threads, finished, saved)?, None));
        }
        let add = |target: u64, deadline: Option<Instant>, measure: &Measure| -> Result<Look, Error> {
            replicas.run_to(self.threads, (target, deadline), finished, saved)?;
            Ok(measure(&replicas.tally()))
        };
        let from = (replicas.replicas(), self.args.time_limit);
        let ended = until.grow(plan, from, add, |ended| self.show(ended))?;
        Ok((replicas.tally().results(plan), Some(ended)))
    }

    /// Shows on the terminal how far the standard errors are from the rules.
    fn show(&self, ended: &Ended) {
        self.bar.set_length(ended.expected());
        self.bar.set_message(ended.text());
    }

    fn saved(&self, replicas: &Replicas, saved: Result<Progress, OutputError>) {
        match saved {
            Ok(progress) => log(&format!("kept in {}: {progress}", replicas.path().shown()), self.args.writing.quiet),
            Err(error) => {
                let lost = format!("{error}; the run goes on, and what comes is not kept");
                scene::warn("--checkpoint", [&lost]);
            }
        }
    }
}
