//! Observables of your own, beside those that a scene file can name.

#[cfg(test)]
mod tests;

use crate::observable::{Observe, Sum};
use crate::plan::Plan;
use crate::run::Recorder;
use crate::run::ensemble::{Column, Tally, batch, in_batches};
use crate::scene::Error;
use rayon::prelude::*;

/// Runs every replica of the plan, as [`crate::run::ensemble::run`] does, and returns the columns of your own
/// observable `own`, with a value for each of [`Plan::times`]. The bits are the same for any number of threads.
///
/// # Errors
///
/// As [`crate::run::ensemble::run`], and if a value is not finite.
pub fn observe(plan: &Plan, own: &dyn Observe) -> Result<Vec<Column>, Error> {
    let names = own.columns();
    let width = names.len();
    let mut tally = Tally::of(plan.outputs() * width);
    in_batches(batch(plan, width), 0..plan.scene().ensemble.replicas, |replicas| {
        let run = replicas.into_par_iter();
        let run = run.map(|replica| one(plan, own, replica));
        for sums in run.collect::<Result<Vec<_>, _>>()? {
            tally.add_sums(plan.scene().particles.count, &sums);
        }
        Ok(())
    })?;
    let column = |(place, name): (usize, &&str)| tally.column_of(plan, own, (*name).to_owned(), place, width);
    Ok(names.iter().enumerate().map(column).collect())
}

/// The sums of one replica, output by output.
fn one(plan: &Plan, own: &dyn Observe, replica: u64) -> Result<Vec<Sum>, Error> {
    let mut recorder = Recorder { own: true, ..Recorder::new(plan, replica, vec![own], Sum::none(true)) };
    recorder.run(None, &mut |_| ())?;
    Ok(recorder.sums)
}
