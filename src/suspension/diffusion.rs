//! Free rods with rotary diffusion, step by step: half a step of diffusion, a step of exact motion, half a step of
//! diffusion (Strang 1968). Of weak order 2 in Δt, as each part is exact or of order 2.

use super::rods::Rods;
use crate::model::diffusion::mean_turn;
use crate::model::random::{Purpose, ahead, stream};
use crate::model::work::Counters;
use crate::plan::{Plan, Stage};
use rand_pcg::Pcg64Dxsm;

pub(crate) struct Diffusion {
    pub rods: Rods,
    pub counters: Counters,
    /// The mean of 1 − cos of a turn in half a step.
    mean: f64,
    random: Pcg64Dxsm,
}

impl Diffusion {
    /// The rods at t = 0; `None` if they do not diffuse.
    pub fn new(plan: &Plan, replica: u64) -> Option<Self> {
        let scene = plan.scene();
        if !plan.runs(Stage::Diffusion) {
            return None;
        }
        let (rods, counters) = Rods::draw(plan, replica);
        let half_s = 0.5 * plan.elapsed(1.0).seconds / scene.steps_per_unit() as f64;
        let mean = mean_turn(scene.particles.rotary_diffusion_per_s, half_s);
        Some(Self { rods, counters, mean, random: stream(scene.ensemble.seed, replica, Purpose::Diffusion) })
    }

    /// Steps until `tick`. Each rod has four random numbers a step of its own, so that the order of rods does not
    /// matter.
    pub fn step_to(&mut self, tick: u64) {
        let each = 2 * self.rods.count() as u128;
        while self.counters.steps < tick {
            let now = self.counters.steps;
            let half = |half: u128| ahead(&self.random, (2 * u128::from(now) + half) * each);
            let (before, after) = (half(0), half(1));
            self.rods.turn_at_random(self.mean, &before);
            self.rods.advance(now);
            self.rods.turn_at_random(self.mean, &after);
            self.counters.steps += 1;
        }
    }
}
