//! Saves a replica in the middle of its work and resumes it, with the same bits as if it had not stopped.
//!
//! The saved state is what the plan, the seed and the replica's number do not determine: the sums so far and, for
//! interacting rods, directions, positions and counts of work. Random streams are not saved: the counts contain how
//! many numbers were drawn.

use crate::model::random::{Purpose, ahead, stream};
use crate::model::work::Counters;
use crate::observable::{Sum, width};
use crate::plan::{Plan, Stage};
use crate::suspension::Suspension;
use crate::suspension::snapshot::Snapshot;
use serde::{Deserialize, Serialize};

/// The state of a replica in the middle of its work.
///
/// ```
/// use shearbed::scene::{Interaction, Scene};
/// let scene = Scene { interaction: Some(Interaction::default()), ..Scene::default() };
/// let plan = shearbed::Plan::new(&scene)?;
/// let mut kept = None;
/// let whole = shearbed::run::go_on(&plan, 0, None, |state| kept = Some(state()))?;
/// assert_eq!(shearbed::run::go_on(&plan, 0, kept, |_| ())?, whole);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Halfway {
    pub(crate) sums: Vec<Sum>,
    /// All rods at those of these outputs for which the scene asks for them; empty for free rods until the end.
    pub(crate) snapshots: Vec<Snapshot>,
    pub(crate) rods: Option<Placed>,
}

/// The state of interacting rods at a tick.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Placed {
    counters: Counters,
    /// Each rod's direction at its tick `since`.
    directions: [Vec<f64>; 3],
    since: Vec<u32>,
    /// Positions in mean rod lengths.
    positions: [Vec<f64>; 3],
}

/// Largest deviation of a squared length from 1: far above round-off, far below the resolution of any mean.
const LENGTH: f64 = 1e-9;

impl Halfway {
    /// The largest number of bytes that a state of this plan holds.
    pub fn bytes(plan: &Plan) -> u64 {
        let sums = plan.outputs() * width(&plan.observables()) * size_of::<Sum>();
        // For free rods it holds neither directions nor snapshots.
        let of_rod = if plan.runs(Stage::Translation) {
            48 + 4 + plan.rods_outputs().len() * Snapshot::bytes_per_rod(plan)
        } else {
            0
        };
        (sums + plan.scene().particles.count * of_rod) as u64
    }

    /// Drops the standard errors over rods, as a plan of several replicas needs none. Means do not change.
    pub fn drop_rod_errors(&mut self) {
        self.sums.iter_mut().for_each(|sum| sum.spread = None);
    }

    /// Number of outputs done.
    pub(crate) fn outputs(&self, plan: &Plan) -> usize {
        self.sums.len() / width(&plan.observables()).max(1)
    }

    /// Checks that the state fits a replica of the plan.
    ///
    /// # Errors
    ///
    /// A sentence that says what does not fit.
    pub fn check(&self, plan: &Plan) -> Result<(), &'static str> {
        let width = width(&plan.observables());
        let (rods, spread) = (plan.scene().particles.count, plan.runs(Stage::RodErrors));
        let whole = self.sums.len().is_multiple_of(width.max(1)) && self.outputs(plan) <= plan.outputs();
        if !whole || !self.sums.iter().all(|sum| sum.is_over(rods, spread)) {
            return Err("its sums are not those of this scene");
        }
        let reached = |output: &&usize| plan.runs(Stage::Translation) && **output < self.outputs(plan);
        let asked = plan.rods_outputs().iter().filter(reached).count() as u64;
        if !Snapshot::all_fit(&self.snapshots, asked, plan) {
            return Err("its rods are not at the times of this scene");
        }
        match &self.rods {
            Some(placed) if plan.runs(Stage::Translation) => placed.check(plan, self.outputs(plan)),
            None if !plan.runs(Stage::Translation) => Ok(()),
            _ => Err("it has saved rods and the scene asks for none, or the other way round"),
        }
    }
}

impl Placed {
    /// The suspension in the saved state; `None` for a plan that takes no steps.
    pub(crate) fn suspension(self, plan: &Plan, replica: u64) -> Option<Suspension> {
        let mut suspension = Suspension::new(plan, replica)?;
        let rng = |purpose, drawn: u128| ahead(&stream(plan.scene().ensemble.seed, replica, purpose), drawn);
        let Self { counters, directions, since, positions } = self;
        if let Some(draws) = &mut suspension.draws {
            *draws = rng(Purpose::Collisions, counters.draws.into());
        }
        let drawn = suspension.numbers_per_replacement() * u128::from(counters.replacements);
        suspension.replacements = rng(Purpose::Replacements, drawn);
        suspension.rods.restore(directions, since);
        suspension.positions = positions;
        suspension.tick = counters.steps;
        suspension.counters = counters;
        Some(suspension)
    }

    fn check(&self, plan: &Plan, outputs: usize) -> Result<(), &'static str> {
        let count = plan.scene().particles.count;
        let tick = self.counters.steps;
        let ticks = plan.ticks();
        // After the last output there is no step.
        let (last, next) = (outputs.checked_sub(1).map_or(0, &ticks), ticks(outputs.min(plan.outputs() - 1)));
        if !(last..=next).contains(&tick) {
            return Err("its outputs are not those of its steps");
        }
        let most = tick.saturating_mul(count as u64);
        let drawn = if plan.runs(Stage::CollisionDraws) { most } else { 0 };
        if self.counters.draws != drawn || self.counters.replacements > most {
            return Err("its random numbers are not those of its steps");
        }
        let dated = if plan.runs(Stage::Contacts) { count } else { 0 };
        let axes = || self.directions.iter().chain(&self.positions);
        if self.since.len() != dated || axes().any(|axis| axis.len() != count) {
            return Err("its number of rods is not the scene's");
        }
        let [p1, p2, p3] = &self.directions;
        let mut squares = p1.iter().zip(p2).zip(p3).map(|((a, b), c)| a * a + b * b + c * c);
        if !squares.all(|square| (square - 1.0).abs() <= LENGTH) {
            return Err("it has a direction whose length is not 1");
        }
        if self.since.iter().any(|since| u64::from(*since) > tick) {
            return Err("it has a collision after its last step");
        }
        let sides = plan.scene().volume().map_or([f64::INFINITY; 3], |volume| volume.sides());
        let within = |(axis, side): (&Vec<f64>, f64)| axis.iter().all(|x| (0.0..=side).contains(x));
        if !self.positions.iter().zip(sides).all(within) {
            return Err("a position in it is outside the control volume");
        }
        Ok(())
    }
}

impl Suspension {
    pub(crate) fn placed(&self) -> Placed {
        let (directions, since) = self.rods.state();
        Placed { counters: self.counters, directions, since, positions: self.positions.clone() }
    }
}
