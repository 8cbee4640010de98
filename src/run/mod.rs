//! Runs replicas, from a plan to means and standard errors.
//!
//! [`run_replica`] runs one; [`ensemble`] runs all over threads and adds them up in order, so that results do not
//! depend on the threads; [`own`] takes an observable of the caller; [`resume`] goes on with a stopped replica;
//! [`memory`] foretells bytes. It may use every other part, and none uses it.

pub mod ensemble;
pub mod memory;
pub mod own;
pub mod resume;
#[cfg(test)]
mod tests;

use crate::model::chunks::{CHUNK, of_chunks};
use crate::model::work::Counters;
use crate::observable::fault::{self, Fault};
use crate::observable::{BLOCK, Channel, Observable, Observe, Sum, width};
use crate::plan::{Plan, Stage};
use crate::run::resume::{Halfway, Placed};
use crate::scene::Error;
use crate::suspension::Suspension;
use crate::suspension::diffusion::Diffusion;
use crate::suspension::rods::{Rods, Selected};
use crate::suspension::snapshot::Snapshot;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// The sums of one replica.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Replica {
    observables: Vec<Observable>,
    pub(crate) rods: usize,
    /// The unit of its stresses, μ G n⟨a³⟩ in Pa.
    stress_pa: Option<f64>,
    /// Sums over rods: per output, the channels of all observables of the plan, one after the other.
    pub(crate) sums: Vec<Sum>,
    /// All rods at the outputs for which the scene asks for them.
    pub snapshots: Vec<Snapshot>,
    /// Counts of the work done.
    pub counters: Counters,
}

impl Replica {
    /// Checks that the replica fits the plan.
    ///
    /// # Errors
    ///
    /// A sentence that says what does not fit.
    pub fn check(&self, plan: &Plan) -> Result<(), &'static str> {
        let own = self.observables == plan.observables()
            && self.rods == plan.scene().particles.count
            && self.stress_pa == plan.scene().stress_pa()
            && self.sums.len() == plan.outputs() * width(&self.observables);
        let spread = plan.runs(Stage::RodErrors);
        if !own || !self.sums.iter().all(|sum| sum.is_over(self.rods, spread)) {
            return Err("its sums are not those of this scene");
        }
        if !Snapshot::all_fit(&self.snapshots, plan.rods_outputs().len() as u64, plan) {
            return Err("its rods are not those of this scene");
        }
        Ok(())
    }

    /// Drops the standard errors over rods, as a plan of several replicas needs none. Means do not change.
    pub fn drop_rod_errors(&mut self) {
        self.sums.iter_mut().for_each(|sum| sum.spread = None);
    }

    /// The mean of `channel` over the rods at `output`; `None` if the scene does not observe it or has no such output.
    pub fn mean(&self, channel: Channel, output: usize) -> Option<f64> {
        let place = channel.place(&self.observables)?;
        let sum = self.sums.get(output * width(&self.observables) + place)?;
        let unit = self.stress_pa.filter(|_| channel.observable.needs_viscosity()).unwrap_or(1.0);
        Some(unit * (sum.value / self.rods as f64))
    }
}

/// Runs one replica. Its bits depend only on the scene, the seed and `replica`.
///
/// # Errors
///
/// If a kick overflows, or if a direction or a sum is not a valid result.
pub fn run_replica(plan: &Plan, replica: u64) -> Result<Replica, Error> {
    go_on(plan, replica, None, |_| ())
}

/// Runs one replica from its start, or from the state `from`. Calls `look` between steps (for free rods, between
/// outputs) with a function that returns the current state. The bits are those of [`run_replica`].
///
/// # Errors
///
/// As [`run_replica`], and if `from` does not fit this plan.
pub fn go_on(
    plan: &Plan,
    replica: u64,
    from: Option<Halfway>,
    mut look: impl FnMut(&dyn Fn() -> Halfway),
) -> Result<Replica, Error> {
    if let Some(from) = &from {
        let refused = |cause| Error::Misfit { replica, cause };
        from.check(plan).map_err(refused)?;
    }
    let observables = plan.observables();
    let built_in = observables.iter().map(|observable| &**observable).collect();
    let mut recorder = Recorder::new(plan, replica, built_in, Sum::none(plan.runs(Stage::RodErrors)));
    let rods = from.and_then(|from| {
        recorder.done = from.outputs(plan);
        recorder.sums[..from.sums.len()].copy_from_slice(&from.sums);
        recorder.snapshots = from.snapshots;
        from.rods
    });
    let mut counters = recorder.run(rods, &mut look)?;
    counters.directions = (plan.outputs() * plan.scene().particles.count) as u64;
    Ok(Replica {
        rods: plan.scene().particles.count,
        stress_pa: plan.scene().stress_pa(),
        sums: recorder.sums,
        snapshots: recorder.snapshots,
        observables,
        counters,
    })
}

/// Runs free rods by their exact motion straight to each output. A block of rods is read once for many outputs.
fn straight(
    plan: &Plan,
    replica: u64,
    recorder: &mut Recorder,
    look: &mut impl FnMut(&dyn Fn() -> Halfway),
) -> Result<Counters, Error> {
    let (rods, counters) = Rods::draw(plan, replica);
    for first in (recorder.done..plan.outputs()).step_by(OUTPUTS) {
        let outputs = first..plan.outputs().min(first + OUTPUTS);
        recorder.record(outputs, &rods, |first, output, selected| rods.orient(first, output as u64, selected))?;
        look(&|| recorder.halfway(None));
    }
    recorder.snapshots = (recorder.asked().into_iter())
        .map(|output| {
            Snapshot::of_free(&rods, replica, output).map_err(|fault| refused(plan, replica, 0, output, fault))
        })
        .collect::<Result<_, _>>()?;
    Ok(counters)
}

/// Runs free rods with rotary diffusion from output to output. A stopped run takes its steps again from the start.
fn diffused(
    plan: &Plan,
    mut diffusion: Diffusion,
    recorder: &mut Recorder,
    look: &mut impl FnMut(&dyn Fn() -> Halfway),
) -> Result<Counters, Error> {
    let (asked, ticks) = (recorder.asked(), plan.ticks());
    let mut snapshots = Vec::new();
    for output in 0..plan.outputs() {
        diffusion.step_to(ticks(output));
        let rods = &diffusion.rods;
        if output >= recorder.done {
            recorder.record(output..output + 1, rods, |first, _, selected| rods.orient(first, 0, selected))?;
            look(&|| recorder.halfway(None));
        }
        if asked.binary_search(&output).is_ok() {
            let snapshot = Snapshot::of_free(rods, recorder.replica, output);
            snapshots.push(snapshot.map_err(|fault| recorder.refused(0, output, fault))?);
        }
    }
    recorder.snapshots = snapshots;
    Ok(diffusion.counters)
}

/// Number of outputs for which a block of rods is read once.
const OUTPUTS: usize = 64;

/// Runs interacting rods by steps from output to output.
fn stepped(
    plan: &Plan,
    mut suspension: Suspension,
    recorder: &mut Recorder,
    look: &mut impl FnMut(&dyn Fn() -> Halfway),
) -> Result<Counters, Error> {
    let (asked, ticks) = (recorder.asked(), plan.ticks());
    for output in recorder.done..plan.outputs() {
        while suspension.tick() < ticks(output) {
            suspension.step()?;
            look(&|| recorder.halfway(Some(suspension.placed())));
        }
        let (rods, tick) = (&suspension.rods, suspension.tick());
        recorder.record(output..output + 1, rods, |first, _, selected| rods.orient(first, tick, selected))?;
        if asked.binary_search(&output).is_ok() {
            let snapshot = Snapshot::of_suspension(&suspension, recorder.replica, output);
            let snapshot = snapshot.map_err(|fault| recorder.refused(0, output, fault))?;
            recorder.snapshots.push(snapshot);
        }
    }
    Ok(suspension.counters)
}

/// The sums of observables over the rods of one replica, each observable with its place among them.
struct Recorder<'a> {
    plan: &'a Plan,
    replica: u64,
    observables: Vec<(&'a dyn Observe, usize)>,
    width: usize,
    empty: Sum,
    /// True for an observable of the caller: all rods are summed in order, and none is kept.
    own: bool,
    sums: Vec<Sum>,
    /// Number of outputs done, counted from the first.
    done: usize,
    snapshots: Vec<Snapshot>,
}

impl<'a> Recorder<'a> {
    fn new(plan: &'a Plan, replica: u64, observables: Vec<&'a dyn Observe>, empty: Sum) -> Self {
        let mut width = 0;
        let mut placed = Vec::new();
        for observable in observables {
            placed.push((observable, width));
            width += observable.columns().len();
        }
        Self {
            plan,
            replica,
            observables: placed,
            width,
            empty,
            own: false,
            sums: vec![empty; width * plan.outputs()],
            done: 0,
            snapshots: Vec::new(),
        }
    }

    /// Runs the replica from its start, or from `rods`; `look` as in [`go_on`].
    fn run(&mut self, rods: Option<Placed>, look: &mut impl FnMut(&dyn Fn() -> Halfway)) -> Result<Counters, Error> {
        let (plan, replica) = (self.plan, self.replica);
        let suspension = match rods {
            Some(rods) => rods.suspension(plan, replica),
            None => Suspension::new(plan, replica),
        };
        match (suspension, Diffusion::new(plan, replica)) {
            (Some(suspension), _) => stepped(plan, suspension, self, look),
            (None, Some(diffusion)) => diffused(plan, diffusion, self, look),
            (None, None) => straight(plan, replica, self, look),
        }
    }

    /// The outputs at which every rod is kept.
    fn asked(&self) -> Vec<usize> {
        if self.own { Vec::new() } else { self.plan.rods_outputs() }
    }

    /// The state so far, with `rods` if they interact.
    fn halfway(&self, rods: Option<Placed>) -> Halfway {
        Halfway { sums: self.sums[..self.done * self.width].to_vec(), snapshots: self.snapshots.clone(), rods }
    }

    /// Sums the observables of all rods at `outputs`. `orient(first, output, selected)` gives the selected rods, those
    /// from `first` on, their directions, or returns the rod whose direction is unknown. Large runs sum over chunks,
    /// and then add these sums in order.
    fn record(
        &mut self,
        outputs: Range<usize>,
        rods: &Rods,
        orient: impl Fn(usize, usize, &mut Selected) -> Result<(), Fault> + Sync,
    ) -> Result<(), Error> {
        let count = self.plan.scene().particles.count;
        let done = outputs.end;
        let mut sums = std::mem::take(&mut self.sums);
        let own = &mut sums[self.width * outputs.start..self.width * outputs.end];
        if self.own || count <= CHUNK {
            self.add(0..count, outputs.clone(), rods, &orient, own)?;
        } else {
            let parts = of_chunks(count, |part| {
                let mut sums = vec![self.empty; own.len()];
                self.add(part, outputs.clone(), rods, &orient, &mut sums)?;
                Ok(sums)
            });
            for part in parts {
                own.iter_mut().zip(&part?).for_each(|(sum, part)| sum.merge(part));
            }
        }
        for (output, sums) in outputs.zip(own.chunks(self.width)) {
            for (observable, start) in &self.observables {
                fault::trace(*observable, &sums[*start..], count).map_err(|fault| self.refused(0, output, fault))?;
            }
        }
        self.sums = sums;
        self.done = done;
        Ok(())
    }

    fn add(
        &self,
        part: Range<usize>,
        outputs: Range<usize>,
        rods: &Rods,
        orient: impl Fn(usize, usize, &mut Selected) -> Result<(), Fault>,
        sums: &mut [Sum],
    ) -> Result<(), Error> {
        let mut selected = Selected::default();
        for first in part.step_by(BLOCK) {
            rods.select(first, &mut selected);
            for (output, sums) in outputs.clone().zip(sums.chunks_mut(self.width)) {
                let refused = |fault| self.refused(first, output, fault);
                orient(first, output, &mut selected).map_err(refused)?;
                let block = &selected.block;
                fault::directions(block).map_err(refused)?;
                for (observable, start) in &self.observables {
                    let sums = &mut sums[*start..][..observable.columns().len()];
                    observable.add(block, sums);
                    fault::sums(*observable, block, sums).map_err(refused)?;
                }
            }
        }
        Ok(())
    }

    fn refused(&self, first: usize, output: usize, fault: Fault) -> Error {
        refused(self.plan, self.replica, first, output, fault)
    }
}

/// The error for a `fault` in a block whose first rod is `first`.
fn refused(plan: &Plan, replica: u64, first: usize, output: usize, fault: Fault) -> Error {
    Error::NoResult {
        rod: fault.rod.map(|rod| first + rod),
        output,
        time_name: plan.time_name(),
        time: plan.times()[output],
        seed: plan.scene().ensemble.seed,
        replica,
        cause: fault.cause,
    }
}
