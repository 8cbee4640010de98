//! What a run did, counted, and why one stopped.

#[cfg(test)]
mod tests;

use serde::{Deserialize, Serialize};

/// Why a run stopped.
///
/// ```
/// use shearbed::work::RunError;
/// let stopped = RunError::Misfit { replica: 3, cause: "it has another number of rods" };
/// assert!(stopped.to_string().starts_with("replica 3 cannot go on"));
/// ```
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RunError {
    /// A rod's direction would have become NaN or infinite.
    #[error("rod {rod} would become non-finite in step {step} of replica {replica}, seed {seed}: {cause}")]
    NonFinite {
        /// The rod's index.
        rod: usize,
        /// The step, from 0.
        step: u64,
        /// The scene's seed.
        seed: u64,
        /// The replica, from 0.
        replica: u64,
        /// What happened.
        cause: String,
    },
    /// A state to go on from that is of no replica of the plan.
    #[error("replica {replica} cannot go on from where it was kept: {cause}")]
    Misfit {
        /// The replica, from 0.
        replica: u64,
        /// What of it does not fit.
        cause: &'static str,
    },
    /// What would have left the run is no result.
    #[error(
        "{}output {output} ({time_name} = {time}) of replica {replica}, seed {seed}: {cause}",
        rod.map_or(String::new(), |rod| format!("rod {rod}, "))
    )]
    NoResult {
        /// The rod's index, where it is one rod's fault.
        rod: Option<usize>,
        /// The output, from 0.
        output: usize,
        /// `t_over_T` or `strain`.
        time_name: &'static str,
        /// The output's time.
        time: f64,
        /// The scene's seed.
        seed: u64,
        /// The replica, from 0.
        replica: u64,
        /// What is wrong with it.
        cause: String,
    },
}

/// What was done: counts of work, the same on every machine.
///
/// ```
/// use shearbed::scene::{Interaction, Scene};
/// let scene = Scene { interaction: Some(Interaction::default()), ..Scene::default() };
/// let results = shearbed::ensemble::run(&shearbed::Plan::new(&scene)?)?;
/// let done = results.counters;
/// assert!(done.collisions <= done.candidates && done.draws == 100 * done.steps);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Counters {
    /// Time steps.
    pub steps: u64,
    /// Random numbers R drawn for collisions (eq. 8).
    pub draws: u64,
    /// Pairs of rods of which one was told to be too far away in low precision.
    pub pairs_screened: u64,
    /// Cells looked into.
    pub cells: u64,
    /// Distances between rods computed.
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
        self.steps += other.steps;
        self.draws += other.draws;
        self.pairs_screened += other.pairs_screened;
        self.cells += other.cells;
        self.distances += other.distances;
        self.candidates += other.candidates;
        self.collisions += other.collisions;
        self.replacements += other.replacements;
        self.directions += other.directions;
        self.aspect_ratios_redrawn += other.aspect_ratios_redrawn;
        self.lengths_redrawn += other.lengths_redrawn;
    }
}
