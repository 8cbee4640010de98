//! Shares the replicas of one scene among ranks.

use super::{share, size};
use shearbed::Error;
use shearbed::run::ensemble::{self, Tally};
use shearbed::{Plan, Results};
use std::ops::Range;

/// Runs every replica of a plan; each rank runs its share on the threads of the current rayon pool and calls `finished`
/// after each of its replicas. Returns the results on the root, bit for bit those of [`shearbed::run::ensemble::run`],
/// and `None` on the other ranks.
pub fn ensemble(plan: &Plan, finished: impl Fn() + Sync) -> Result<Option<Results>, Error> {
    let mut tally = Tally::new(plan);
    let root = extend(plan, &mut tally, 0..plan.scene().ensemble.replicas, finished)?;
    Ok(root.then(|| tally.results(plan)))
}

/// Like `ensemble`, but adds the next `replicas` of a plan to the root's `tally`. Returns true on the root.
pub fn extend(plan: &Plan, tally: &mut Tally, replicas: Range<u64>, finished: impl Fn() + Sync) -> Result<bool, Error> {
    let mut root = true;
    ensemble::extend(plan, tally, replicas, |replicas| {
        let count = replicas.end - replicas.start;
        let parts = (size() as u64).min(count);
        let cut = |part: u64| replicas.start + part * count / parts;
        let run = |part| {
            let part = part as u64;
            ensemble::replicas_of(plan, cut(part)..cut(part + 1), &finished)
        };
        let all = share(parts as usize, run, |_, _| Ok(()))?;
        root = all.is_some();
        Ok(all.into_iter().flatten().flatten().collect())
    })?;
    Ok(root)
}
