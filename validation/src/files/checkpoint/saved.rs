//! The contents of the checkpoint of a run.

use super::Checkpoint;
use crate::files::output::Refused;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use shearbed::run::Replica;
use shearbed::run::ensemble::Tally;
use shearbed::run::resume::Halfway;
use shearbed::scene::MAX_REPLICAS;
use shearbed::{Plan, Scene};
use std::collections::BTreeMap;
use std::fmt;

/// The contents of a checkpoint of a run.
#[derive(Serialize, Deserialize)]
pub(super) struct Saved {
    /// Number of replicas that the last command requested.
    pub(super) asked: u64,
    /// The sum of the first replicas.
    pub(super) tally: Tally,
    /// Finished replicas that wait for earlier ones.
    pub(super) done: BTreeMap<u64, Replica>,
    /// The last states of replicas in work.
    pub(super) halfway: BTreeMap<u64, Halfway>,
}

/// The progress of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Number of finished replicas.
    pub done: u64,
    /// Number of replicas saved in the middle of their work.
    pub halfway: usize,
    /// Number of replicas of the whole run.
    pub all: u64,
}

impl fmt::Display for Progress {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { done, halfway, all } = self;
        write!(f, "{done} of {all} replicas are done, {halfway} halfway")
    }
}

/// The scene without its number of replicas: everything on which a single replica depends.
pub fn without_replicas(scene: &Scene) -> Value {
    let mut scene = json!(scene.resolved());
    if let Some(ensemble) = scene["ensemble"].as_object_mut() {
        ensemble.remove("replicas");
    }
    scene
}

impl Saved {
    /// The contents of a file, to be continued up to the plan's replicas; an empty state if there is no file.
    ///
    /// # Errors
    ///
    /// If the file has more replicas than the plan, or is damaged.
    pub(super) fn read(file: &Checkpoint, plan: &Plan) -> Result<Self, Refused> {
        let all = plan.scene().ensemble.replicas;
        let mut saved: Self = file.read()?.unwrap_or_else(|| Self {
            asked: all,
            tally: Tally::new(plan),
            done: BTreeMap::new(),
            halfway: BTreeMap::new(),
        });
        let has = saved.tally.replicas();
        if all < has {
            return Err(file.refused(&format!(
                "has the sum of {has} replicas, of which the first {all} cannot be separated; --replicas {has} or \
                 more goes on from it"
            )));
        }
        let begun = has > 0 || !(saved.done.is_empty() && saved.halfway.is_empty());
        if all == 1 && saved.asked > 1 && begun {
            return Err(file.refused(
                "is of several replicas and lacks the standard errors over the rods of one; --replicas 2 or more goes \
                 on from it",
            ));
        }
        if all > 1 {
            saved.done.values_mut().for_each(Replica::drop_rod_errors);
            saved.halfway.values_mut().for_each(Halfway::drop_rod_errors);
        }
        saved.asked = all;
        let misfit = |why: &str| file.refused(&format!("is damaged: {why}"));
        saved.tally.check(plan).map_err(misfit)?;
        // Replicas beyond this plan's that an earlier command began are kept for a later one.
        let most = if all > 1 { plan.with_replicas(MAX_REPLICAS) } else { plan.clone() };
        let left = has..most.scene().ensemble.replicas;
        if !saved.done.keys().chain(saved.halfway.keys()).all(|replica| left.contains(replica)) {
            return Err(misfit("it has a replica that this run has finished"));
        }
        saved.done.values().try_for_each(|done| done.check(&most)).map_err(misfit)?;
        saved.halfway.values().try_for_each(|halfway| halfway.check(&most)).map_err(misfit)?;
        Ok(saved)
    }

    /// Moves finished replicas whose turn it is into the sum, up to `all` replicas.
    pub(super) fn add_up(&mut self, all: u64) {
        while self.tally.replicas() < all
            && let Some(next) = self.done.remove(&self.tally.replicas())
        {
            self.tally.add(next);
        }
    }

    /// The progress of a run of `all` replicas.
    pub(super) fn progress(&self, all: u64) -> Progress {
        Progress {
            done: self.tally.replicas() + self.done.range(..all).count() as u64,
            halfway: self.halfway.range(..all).count(),
            all,
        }
    }
}
