//! One replica of a scene, from its plan to the sums of its observables.

use crate::chunks::{CHUNK, of_chunks};
use crate::observable::{BLOCK, Block, Observable, Sum};
use crate::plan::{Plan, Stage};
use crate::rods::Rods;
use crate::suspension::Suspension;
use crate::work::{Counters, RunError};
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// The sums of one replica.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Replica {
    /// Per output, the channels of every observable of the plan, one after the other: sums over rods.
    pub sums: Vec<Sum>,
    /// What was done.
    pub counters: Counters,
}

/// Runs one replica. Its bits depend on the scene, the seed and `replica` only.
pub fn run_replica(plan: &Plan, replica: u64) -> Result<Replica, RunError> {
    let mut recorder = Recorder::new(plan);
    let mut counters = match Suspension::new(plan, replica) {
        Some(suspension) => stepped(plan, suspension, &mut recorder)?,
        None => straight(plan, replica, &mut recorder),
    };
    counters.directions = (plan.outputs() * plan.scene().particles.count) as u64;
    Ok(Replica {
        sums: recorder.sums,
        counters,
    })
}

/// Free rods: the exact motion straight to each output. A block of rods is read once for many outputs.
fn straight(plan: &Plan, replica: u64, recorder: &mut Recorder) -> Counters {
    let (rods, aspect_ratios_redrawn) = Rods::draw(plan, replica);
    for first in (0..plan.outputs()).step_by(OUTPUTS) {
        recorder.record(&rods, first..plan.outputs().min(first + OUTPUTS), |output| {
            output as u64
        });
    }
    Counters {
        aspect_ratios_redrawn,
        ..Counters::default()
    }
}

/// Outputs for which a block of rods is read once.
const OUTPUTS: usize = 64;

/// Interacting rods: steps from output to output.
fn stepped(plan: &Plan, mut suspension: Suspension, recorder: &mut Recorder) -> Result<Counters, RunError> {
    for output in 0..plan.outputs() {
        if output > 0 {
            for _ in 0..plan.ticks_per_output() {
                suspension.step()?;
            }
        }
        let tick = suspension.tick();
        recorder.record(&suspension.rods, output..output + 1, |_| tick);
    }
    Ok(suspension.counters)
}

struct Recorder {
    observables: Vec<(Observable, usize)>,
    width: usize,
    empty: Sum,
    sums: Vec<Sum>,
}

impl Recorder {
    fn new(plan: &Plan) -> Self {
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
            observables,
            width,
            empty,
            sums: vec![empty; width * plan.outputs()],
        }
    }

    /// Sums the observables of all rods at these outputs. Large runs: sums over chunks, and then their sum in order.
    fn record(&mut self, rods: &Rods, outputs: Range<usize>, tick: impl Fn(usize) -> u64 + Sync) {
        let mut sums = std::mem::take(&mut self.sums);
        let own = &mut sums[self.width * outputs.start..self.width * outputs.end];
        if rods.count() <= CHUNK {
            self.add(rods, 0..rods.count(), outputs, &tick, own);
        } else {
            let parts = of_chunks(rods.count(), |part| {
                let mut sums = vec![self.empty; own.len()];
                self.add(rods, part, outputs.clone(), &tick, &mut sums);
                sums
            });
            for part in parts {
                own.iter_mut().zip(&part).for_each(|(sum, part)| sum.merge(part));
            }
        }
        self.sums = sums;
    }

    fn add(
        &self,
        rods: &Rods,
        part: Range<usize>,
        outputs: Range<usize>,
        tick: impl Fn(usize) -> u64,
        sums: &mut [Sum],
    ) {
        let mut block = Block::default();
        for first in part.step_by(BLOCK) {
            for (output, sums) in outputs.clone().zip(sums.chunks_mut(self.width)) {
                rods.orient(first, tick(output), &mut block);
                for (observable, start) in &self.observables {
                    observable.add(&block, &mut sums[*start..][..observable.width()]);
                }
            }
        }
    }
}
