//! Counts of the work done by a run.

use serde::{Deserialize, Serialize};

/// Counts of the work done by a run, the same on every machine.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Counters {
    /// Time steps.
    pub steps: u64,
    /// Random numbers R drawn for collisions (eq. 8).
    pub draws: u64,
    /// Pairs to which a quick test in fewer digits was applied.
    pub pairs_screened: u64,
    /// Cells of the grid searched.
    pub cells: u64,
    /// Distances between rods computed in double precision.
    pub distances: u64,
    /// Pairs with P_c > R.
    pub candidates: u64,
    /// Pairs that collided.
    pub collisions: u64,
    /// Rods replaced in the control volume (eq. 14).
    pub replacements: u64,
    /// Directions computed for outputs.
    pub directions: u64,
    /// Aspect ratios drawn again because they fell on the wrong side of 1.
    pub aspect_ratios_redrawn: u64,
    /// Lengths drawn again because they were not positive.
    pub lengths_redrawn: u64,
}

impl Counters {
    /// Adds another run's counts.
    pub fn add(&mut self, other: &Self) {
        let mut other = *other;
        self.all().into_iter().zip(other.all()).for_each(|(own, other)| *own += *other);
    }

    #[rustfmt::skip]
    fn all(&mut self) -> [&mut u64; 11] {
        let Self {
            steps, draws, pairs_screened, cells, distances, candidates, collisions, replacements, directions,
            aspect_ratios_redrawn, lengths_redrawn,
        } = self;
        [
            steps, draws, pairs_screened, cells, distances, candidates, collisions, replacements, directions,
            aspect_ratios_redrawn, lengths_redrawn,
        ]
    }
}
