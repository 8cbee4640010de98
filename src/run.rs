//! One replica of a scene, from its plan to the sums of its observables.

use crate::observable::{BLOCK, Block, Sum};
use crate::plan::{Plan, Stage};
use crate::rods::Rods;
use crate::suspension::Suspension;
use crate::work::{Counters, RunError};

/// The sums of one replica.
#[derive(Clone, Debug, PartialEq)]
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

/// Free rods: the exact motion straight to each output, a block of rods at a time.
fn straight(plan: &Plan, replica: u64, recorder: &mut Recorder) -> Counters {
    let (rods, aspect_ratios_redrawn) = Rods::draw(plan, replica);
    for first in (0..rods.count()).step_by(BLOCK) {
        for output in 0..plan.outputs() {
            recorder.add(&rods, first, output as u64, output);
        }
    }
    Counters {
        aspect_ratios_redrawn,
        ..Counters::default()
    }
}

/// Interacting rods: steps from output to output.
fn stepped(plan: &Plan, mut suspension: Suspension, recorder: &mut Recorder) -> Result<Counters, RunError> {
    for output in 0..plan.outputs() {
        if output > 0 {
            for _ in 0..plan.ticks_per_output() {
                suspension.step()?;
            }
        }
        for first in (0..suspension.rods.count()).step_by(BLOCK) {
            recorder.add(&suspension.rods, first, suspension.tick(), output);
        }
    }
    Ok(suspension.counters)
}

struct Recorder {
    observables: Vec<(crate::Observable, usize)>,
    width: usize,
    sums: Vec<Sum>,
    block: Block,
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
            sums: vec![empty; width * plan.outputs()],
            block: Block::default(),
        }
    }

    fn add(&mut self, rods: &Rods, first: usize, tick: u64, output: usize) {
        rods.orient(first, tick, &mut self.block);
        let sums = &mut self.sums[output * self.width..][..self.width];
        for (observable, start) in &self.observables {
            observable.add(&self.block, &mut sums[*start..][..observable.width()]);
        }
    }
}
