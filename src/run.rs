//! One replica of a scene, from its plan to the sums of its observables.

use crate::border::{self, Fault};
use crate::chunks::{CHUNK, of_chunks};
use crate::observable::{BLOCK, Block, Channel, Observable, Sum};
use crate::plan::{Plan, Stage};
use crate::rods::Rods;
use crate::snapshot::Snapshot;
use crate::suspension::Suspension;
use crate::work::{Counters, RunError};
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// The sums of one replica.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Replica {
    observables: Vec<Observable>,
    rods: usize,
    /// Per output, the channels of every observable of the plan, one after the other: sums over rods.
    pub(crate) sums: Vec<Sum>,
    /// Every rod at each output that the scene asks for them.
    pub snapshots: Vec<Snapshot>,
    /// What was done.
    pub counters: Counters,
}

impl Replica {
    /// The mean of a channel over the rods at an output; `None` where the scene does not observe it or has no such output.
    pub fn mean(&self, channel: Channel, output: usize) -> Option<f64> {
        let place = channel.place(&self.observables)?;
        let sum = self.sums.get(output * width(&self.observables) + place)?;
        Some(sum.value / self.rods as f64)
    }
}

/// Sums per output.
pub(crate) fn width(observables: &[Observable]) -> usize {
    observables.iter().map(|observable| observable.width()).sum()
}

/// Runs one replica. Its bits depend on the scene, the seed and `replica` only.
///
/// # Errors
///
/// A kick that overflows, or a direction or a sum that is no result.
pub fn run_replica(plan: &Plan, replica: u64) -> Result<Replica, RunError> {
    let mut recorder = Recorder::new(plan, replica);
    let mut snapshots = Vec::new();
    let mut counters = match Suspension::new(plan, replica) {
        Some(suspension) => stepped(plan, suspension, &mut recorder, &mut snapshots)?,
        None => straight(plan, replica, &mut recorder, &mut snapshots)?,
    };
    counters.directions = (plan.outputs() * plan.scene().particles.count) as u64;
    Ok(Replica {
        observables: plan.observables(),
        rods: plan.scene().particles.count,
        sums: recorder.sums,
        snapshots,
        counters,
    })
}

/// Free rods: the exact motion straight to each output. A block of rods is read once for many outputs.
fn straight(
    plan: &Plan,
    replica: u64,
    recorder: &mut Recorder,
    snapshots: &mut Vec<Snapshot>,
) -> Result<Counters, RunError> {
    let (rods, aspect_ratios_redrawn) = Rods::draw(plan, replica);
    for first in (0..plan.outputs()).step_by(OUTPUTS) {
        let outputs = first..plan.outputs().min(first + OUTPUTS);
        recorder.record(outputs, |first, output, block| {
            rods.orient(first, output as u64, block)
        })?;
    }
    let asked = plan.rods_outputs().into_iter();
    snapshots.extend(asked.map(|output| Snapshot::of_free(&rods, replica, output)));
    Ok(Counters {
        aspect_ratios_redrawn,
        ..Counters::default()
    })
}

/// Outputs for which a block of rods is read once.
const OUTPUTS: usize = 64;

/// Interacting rods: steps from output to output.
fn stepped(
    plan: &Plan,
    mut suspension: Suspension,
    recorder: &mut Recorder,
    snapshots: &mut Vec<Snapshot>,
) -> Result<Counters, RunError> {
    let asked = plan.rods_outputs();
    for output in 0..plan.outputs() {
        if output > 0 {
            for _ in 0..plan.ticks_per_output() {
                suspension.step()?;
            }
        }
        let (rods, tick) = (&suspension.rods, suspension.tick());
        recorder.record(output..output + 1, |first, _, block| {
            rods.orient(first, tick, block)
        })?;
        if asked.contains(&output) {
            snapshots.push(Snapshot::of_suspension(&suspension, recorder.replica, output));
        }
    }
    Ok(suspension.counters)
}

struct Recorder<'a> {
    plan: &'a Plan,
    replica: u64,
    observables: Vec<(Observable, usize)>,
    width: usize,
    empty: Sum,
    sums: Vec<Sum>,
}

impl<'a> Recorder<'a> {
    fn new(plan: &'a Plan, replica: u64) -> Self {
        let mut width = 0;
        let observables = plan
            .observables()
            .into_iter()
            .map(|observable| {
                let start = width;
                width += observable.width();
                (observable, start)
            })
            .collect();
        let empty = Sum {
            value: 0.0,
            square: plan.keeps(Stage::RodErrors).then_some(0.0),
        };
        Self {
            plan,
            replica,
            observables,
            width,
            empty,
            sums: vec![empty; width * plan.outputs()],
        }
    }

    /// Sums the observables of all rods at these outputs; `orient(first, output, block)` fills a block with the
    /// directions of the rods from `first` on. Large runs: sums over chunks, and then their sum in order.
    fn record(
        &mut self,
        outputs: Range<usize>,
        orient: impl Fn(usize, usize, &mut Block) + Sync,
    ) -> Result<(), RunError> {
        let count = self.plan.scene().particles.count;
        let mut sums = std::mem::take(&mut self.sums);
        let own = &mut sums[self.width * outputs.start..self.width * outputs.end];
        if count <= CHUNK {
            self.add(0..count, outputs.clone(), &orient, own)?;
        } else {
            let parts = of_chunks(count, |part| {
                let mut sums = vec![self.empty; own.len()];
                self.add(part, outputs.clone(), &orient, &mut sums)?;
                Ok(sums)
            });
            for part in parts {
                own.iter_mut().zip(&part?).for_each(|(sum, part)| sum.merge(part));
            }
        }
        for (output, sums) in outputs.zip(own.chunks(self.width)) {
            for (observable, start) in &self.observables {
                border::trace(*observable, &sums[*start..], count)
                    .map_err(|fault| self.refused(0, output, fault))?;
            }
        }
        self.sums = sums;
        Ok(())
    }

    fn add(
        &self,
        part: Range<usize>,
        outputs: Range<usize>,
        orient: impl Fn(usize, usize, &mut Block),
        sums: &mut [Sum],
    ) -> Result<(), RunError> {
        let mut block = Block::default();
        for first in part.step_by(BLOCK) {
            for (output, sums) in outputs.clone().zip(sums.chunks_mut(self.width)) {
                orient(first, output, &mut block);
                let refused = |fault| self.refused(first, output, fault);
                border::directions(&block).map_err(refused)?;
                for (observable, start) in &self.observables {
                    let sums = &mut sums[*start..][..observable.width()];
                    observable.add(&block, sums);
                    border::sums(*observable, &block, sums).map_err(refused)?;
                }
            }
        }
        Ok(())
    }

    /// The error of a fault in a block whose first rod is `first`.
    fn refused(&self, first: usize, output: usize, fault: Fault) -> RunError {
        RunError::NoResult {
            rod: fault.rod.map(|rod| first + rod),
            output,
            time_name: self.plan.time_name(),
            time: self.plan.times()[output],
            seed: self.plan.scene().ensemble.seed,
            replica: self.replica,
            cause: fault.cause,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene_file;

    fn plan(count: usize, replicas: u64) -> Plan {
        let text = format!(
            "title = \"t\"\n[flow]\nshear_rate_per_s = 1\n[particles]\ncount = {count}\nlength_mm = 1\n\
             aspect_ratio = 5\norientation = \"isotropic\"\n[time]\nperiods = 2\noutputs_per_period = 4\n\
             [ensemble]\nreplicas = {replicas}\nseed = 7\n[output]\n\
             observables = [\"projections\", \"orbit_constant\", \"orientation_tensor\"]\n"
        );
        Plan::new(&scene_file::parse("s.toml", &text).unwrap()).unwrap()
    }

    /// A run whose propagation puts a rod along `wrong` at an output.
    fn broken(count: usize, rod: usize, at: usize, wrong: [f64; 3]) -> Result<(), RunError> {
        let plan = plan(count, 2);
        let (rods, _) = Rods::draw(&plan, 1);
        Recorder::new(&plan, 1).record(0..plan.outputs(), |first, output, block| {
            rods.orient(first, output as u64, block);
            if output == at && (first..first + block.len).contains(&rod) {
                (0..3).for_each(|axis| block.p[axis][rod - first] = wrong[axis]);
            }
        })
    }

    #[test]
    fn a_broken_propagation_stops_the_run_and_names_rod_output_and_replica() {
        // In the first block and the last, on one thread and on many.
        for (count, rod) in [(300, 0), (300, 299), (1, 0), (CHUNK + 200, CHUNK + 131)] {
            assert_eq!(broken(count, rod, 5, [0.6, 0.0, 0.8]), Ok(()));
            for wrong in [[0.0; 3], [f64::NAN; 3], [0.6, 0.8, 0.1]] {
                let error = broken(count, rod, 5, wrong).unwrap_err();
                let start =
                    format!("rod {rod}, output 5 (t_over_T = 1.25) of replica 1, seed 7: its direction");
                assert!(error.to_string().starts_with(&start), "{error}");
                assert!(error.to_string().contains("r_e = 5"), "{error}");
            }
        }
    }

    #[test]
    fn of_several_wrong_rods_the_first_is_named_whatever_the_threads() {
        let plan = plan(3 * CHUNK, 1);
        let recorder = |_| {
            Recorder::new(&plan, 0)
                .record(0..1, |_, _, block| block.len = BLOCK)
                .unwrap_err()
        };
        let errors: Vec<_> = (0..4).map(recorder).collect();
        assert!(errors.iter().all(|error| *error == errors[0]));
        assert!(
            errors[0].to_string().starts_with("rod 0, output 0 "),
            "{}",
            errors[0]
        );
    }
}
