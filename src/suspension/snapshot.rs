//! The rods of one replica at one output, for scenes that ask for them.

#[cfg(test)]
mod tests;

use crate::observable::BLOCK;
use crate::observable::fault::Fault;
use crate::plan::{Plan, Stage};
use crate::scene::Scene;
use crate::suspension::Suspension;
use crate::suspension::rods::{Rods, Selected};
use serde::{Deserialize, Serialize};

/// Every rod of one replica at one output, as structure of arrays.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Snapshot {
    /// Index of the replica, from 0.
    pub replica: u64,
    /// Index of the output, from 0.
    pub output: usize,
    /// The components p₁, p₂ and p₃ of the directions.
    pub p: [Vec<f64>; 3],
    /// Equivalent aspect ratios r_e.
    pub aspect_ratio: Vec<f64>,
    /// Lengths over the mean; `None` if all are equal.
    pub length: Option<Vec<f64>>,
    /// Coordinates of the rods' centres in the control volume, in mean rod lengths; `None` for free rods, which have no
    /// position.
    pub place_in_lengths: Option<[Vec<f64>; 3]>,
    /// True if the rod collided in the step that ended at this output; free rods never do.
    pub collided: Vec<bool>,
}

impl Snapshot {
    /// The length of `rod` in mm; `scene` is that of the snapshot.
    pub fn length_mm(&self, scene: &Scene, rod: usize) -> f64 {
        scene.particles.length_mm * self.length.as_ref().map_or(1.0, |lengths| lengths[rod])
    }

    /// The position of the centre of `rod` in the control volume in mm; `None` for free rods.
    pub fn place_mm(&self, scene: &Scene, rod: usize) -> Option<[f64; 3]> {
        let (places, sides) = (self.place_in_lengths.as_ref()?, scene.sides_mm()?);
        // Rounding must not put a rod outside.
        let place = |axis: usize| (places[axis][rod] * scene.particles.length_mm).min(sides[axis]);
        Some(std::array::from_fn(place))
    }

    /// Bytes per rod of a snapshot of the plan: direction, aspect ratio and whether it collided; its position if rods
    /// interact; its length if lengths differ.
    pub(crate) fn bytes_per_rod(plan: &Plan) -> usize {
        let placed = if plan.runs(Stage::Translation) { 3 } else { 0 };
        let numbers = 4 + placed + usize::from(plan.runs(Stage::Lengths));
        numbers * size_of::<f64>() + 1
    }

    /// True if there are `count` snapshots and all fit the plan.
    pub(crate) fn all_fit(snapshots: &[Self], count: u64, plan: &Plan) -> bool {
        snapshots.len() as u64 == count && snapshots.iter().all(|snapshot| snapshot.fits(plan))
    }

    fn fits(&self, plan: &Plan) -> bool {
        let count = plan.scene().particles.count;
        let places = self.place_in_lengths.iter().flatten();
        let mut axes = (self.p.iter().chain(places).chain(&self.length)).chain([&self.aspect_ratio]);
        let whole = |axis: &Vec<f64>| axis.len() == count && axis.iter().all(|x| x.is_finite());
        self.place_in_lengths.is_some() == plan.runs(Stage::Translation)
            && self.length.is_some() == plan.runs(Stage::Lengths)
            && axes.all(whole)
            && self.collided.len() == count
            && plan.rods_outputs().contains(&self.output)
            && self.replica < plan.scene().ensemble.replicas
    }

    /// The snapshot of free rods at `output`; fails if a rod's direction is unknown.
    pub(crate) fn of_free(rods: &Rods, replica: u64, output: usize) -> Result<Self, Fault> {
        Self::of(rods, replica, output, output as u64)
    }

    /// The snapshot of `suspension` in its current state, which is at `output`.
    pub(crate) fn of_suspension(suspension: &Suspension, replica: u64, output: usize) -> Result<Self, Fault> {
        let (rods, tick) = (&suspension.rods, suspension.tick());
        let collided = |rod| tick > 0 && rods.turned_after(rod, tick - 1);
        Ok(Self {
            place_in_lengths: Some(suspension.positions_in_lengths().clone()),
            collided: (0..rods.count()).map(collided).collect(),
            ..Self::of(rods, replica, output, tick)?
        })
    }

    fn of(rods: &Rods, replica: u64, output: usize, tick: u64) -> Result<Self, Fault> {
        let count = rods.count();
        let mut p = [(); 3].map(|()| Vec::with_capacity(count));
        let mut selected = Selected::default();
        for first in (0..count).step_by(BLOCK) {
            rods.select(first, &mut selected);
            rods.orient(first, tick, &mut selected)
                .map_err(|fault| Fault { rod: fault.rod.map(|rod| first + rod), ..fault })?;
            let block = &selected.block;
            for (axis, from) in p.iter_mut().zip(&block.p) {
                axis.extend_from_slice(&from[..block.len]);
            }
        }
        Ok(Self {
            replica,
            output,
            p,
            aspect_ratio: (0..count).map(|rod| rods.aspect_ratio(rod)).collect(),
            length: (!rods.lengths().is_empty()).then(|| rods.lengths().to_vec()),
            place_in_lengths: None,
            collided: vec![false; count],
        })
    }
}
