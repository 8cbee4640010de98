//! Read access to the state of a suspension.

use super::Suspension;
use crate::model::work::Counters;
use nalgebra::Vector3;

impl Suspension {
    /// Random numbers of the stream of replacements per replaced rod.
    pub(crate) fn numbers_per_replacement(&self) -> u128 {
        self.liquid.numbers()
    }

    /// The work done so far.
    pub fn counters(&self) -> &Counters {
        &self.counters
    }

    /// Steps taken so far.
    pub fn tick(&self) -> u64 {
        self.tick
    }

    /// The sides H₁, H₂ and H₃ of the control volume, in mean rod lengths.
    pub fn sides_in_lengths(&self) -> [f64; 3] {
        self.sides
    }

    /// The rods' positions in mean rod lengths: three arrays of coordinates.
    pub fn positions_in_lengths(&self) -> &[Vec<f64>; 3] {
        &self.positions
    }

    /// The current direction of every rod.
    pub fn directions(&self) -> Vec<Vector3<f64>> {
        (0..self.rods.count()).map(|rod| self.rods.direction(rod, self.tick)).collect()
    }

    /// The length of every rod over the mean.
    pub fn lengths(&self) -> Vec<f64> {
        (0..self.rods.count()).map(|rod| self.rods.length(rod)).collect()
    }

    /// The aspect ratio of every rod.
    pub fn aspect_ratios(&self) -> Vec<f64> {
        (0..self.rods.count()).map(|rod| self.rods.aspect_ratio(rod)).collect()
    }
}
