//! The rods' directions: each rod stores its direction after its last collision, and the exact motion gives the
//! direction at any later time. A free rod takes no steps.

mod draw;
mod motion;

use crate::model::chunks::{CHUNK, over_chunks};
use crate::model::diffusion::turned;
use crate::model::random::ahead;
use crate::model::stress::Body;
use crate::model::work::Counters;
use crate::motion::couette;
use crate::observable::fault::Fault;
use crate::observable::{BLOCK, Block};
use crate::plan::{Plan, Stage};
use draw::{draw_directions, draw_lengths, draw_shapes};
pub(crate) use motion::bytes_per_output;
use motion::{Motion, choose_motion, map_of, mapped, turn_free};
use nalgebra::{UnitVector3, Vector3};
use rand::RngExt;
use rand_pcg::Pcg64Dxsm;

/// Directions and aspect ratios of one replica's rods, as structure of arrays.
#[derive(Clone, Debug)]
pub(crate) struct Rods {
    /// Each rod's direction at its tick `since`; the current one if the motion goes by steps.
    p: [Vec<f64>; 3],
    /// The tick of each direction. Empty if no rod can collide: then it is 0 for every rod.
    since: Vec<u32>,
    shapes: Shapes,
    /// Lengths over the mean; empty if all are equal, or if the plan needs none.
    lengths: Vec<f64>,
    /// 1/⟨a³⟩, with a over the mean.
    per_cube: f64,
    body: Body,
    motion: Motion,
}

#[derive(Clone, Debug)]
enum Shapes {
    Shared(f64),
    Each(Vec<f64>),
}

/// A block of rods as [`Rods::select`] selects it and [`Rods::orient`] turns it.
pub(crate) struct Selected {
    pub block: Block,
    /// In plane Couette flow, turns of each rod in one period of the mean rod.
    turns: [f64; BLOCK],
}

impl Default for Selected {
    fn default() -> Self {
        Self { block: Block::default(), turns: [0.0; BLOCK] }
    }
}

impl Rods {
    /// Draws the rods of a replica; the counters hold the numbers of repeated draws.
    pub fn draw(plan: &Plan, replica: u64) -> (Self, Counters) {
        let (shapes, aspect_ratios_redrawn) = draw_shapes(plan, replica);
        let (lengths, lengths_redrawn) = draw_lengths(plan, replica);
        let motion = choose_motion(plan, &shapes);
        let since = if plan.runs(Stage::Contacts) { vec![0; plan.scene().particles.count] } else { Vec::new() };
        let rods = Self {
            p: draw_directions(plan, replica),
            since,
            shapes,
            per_cube: lengths.len() as f64 / lengths.iter().map(|length| length.powi(3)).sum::<f64>(),
            lengths,
            body: plan.scene().particles.body(),
            motion,
        };
        let counters = Counters { aspect_ratios_redrawn, lengths_redrawn, ..Counters::default() };
        (rods, counters)
    }

    pub fn count(&self) -> usize {
        self.p[0].len()
    }

    #[inline]
    fn of_several_shapes(&self) -> bool {
        matches!(self.shapes, Shapes::Each(_))
    }

    pub fn aspect_ratio(&self, rod: usize) -> f64 {
        match &self.shapes {
            Shapes::Shared(r) => *r,
            Shapes::Each(r) => r[rod],
        }
    }

    /// The length of `rod` over the mean.
    #[inline]
    pub fn length(&self, rod: usize) -> f64 {
        self.lengths.get(rod).copied().unwrap_or(1.0)
    }

    /// Every rod's length over the mean; empty if all are equal.
    pub fn lengths(&self) -> &[f64] {
        &self.lengths
    }

    /// True if a collision turned `rod` in the step that ends after `tick`.
    pub fn turned_after(&self, rod: usize, tick: u64) -> bool {
        u64::from(self.since[rod]) > tick
    }

    /// Sets the direction of `rod` at `tick` to `p`.
    pub fn set(&mut self, rod: usize, p: &UnitVector3<f64>, tick: u64) {
        for (axis, value) in self.p.iter_mut().zip([p.x, p.y, p.z]) {
            axis[rod] = value;
        }
        self.since[rod] = tick as u32;
    }

    /// Each rod's direction after its last collision, and the tick of that direction.
    pub fn state(&self) -> ([Vec<f64>; 3], Vec<u32>) {
        (self.p.clone(), self.since.clone())
    }

    /// Restores the result of [`Rods::state`].
    pub fn restore(&mut self, p: [Vec<f64>; 3], since: Vec<u32>) {
        self.p = p;
        self.since = since;
    }

    /// The direction of an interacting rod at `tick`.
    pub fn direction(&self, rod: usize, tick: u64) -> Vector3<f64> {
        let p = self.p.each_ref().map(|axis| axis[rod]);
        let Motion::Couette(clock, _) = &self.motion else {
            return p.into();
        };
        let r = self.aspect_ratio(rod);
        let phase = clock.phase(self.elapsed(rod, tick), clock.periods(self.of_several_shapes(), r));
        couette(p, r, phase).into()
    }

    /// The direction that an interacting rod at `tick` has after a free step.
    pub fn after_step(&self, rod: usize, tick: u64) -> Vector3<f64> {
        match &self.motion {
            Motion::Steps(maps) => mapped(map_of(maps, rod), self.p.each_ref().map(|axis| axis[rod])).into(),
            _ => self.direction(rod, tick + 1),
        }
    }

    /// If the motion goes by steps: moves all rods that did not collide over the step that starts at `tick`.
    pub fn advance(&mut self, tick: u64) {
        let Self { p, since, motion: Motion::Steps(maps), .. } = self else {
            return;
        };
        over_chunks(p, |chunk, [p1, p2, p3]| {
            let axes = p1.iter_mut().zip(p2).zip(p3);
            for (rod, ((p1, p2), p3)) in (chunk * CHUNK..).zip(axes) {
                if since.get(rod).is_none_or(|since| u64::from(*since) <= tick) {
                    [*p1, *p2, *p3] = mapped(map_of(maps, rod), [*p1, *p2, *p3]);
                }
            }
        });
    }

    /// Turns every rod at random, with two numbers of `random` each: see [`turned`].
    pub fn turn_at_random(&mut self, mean: f64, random: &Pcg64Dxsm) {
        over_chunks(&mut self.p, |chunk, [p1, p2, p3]| {
            let mut random = ahead(random, 2 * (chunk * CHUNK) as u64);
            for ((p1, p2), p3) in p1.iter_mut().zip(p2).zip(p3) {
                [*p1, *p2, *p3] = turned([*p1, *p2, *p3], mean, [random.random(), random.random()]);
            }
        });
    }

    /// Selects the rods from `first` on, at most [`BLOCK`]: their aspect ratios, weights, stress and turns. Directions
    /// are those of the block before.
    pub fn select(&self, first: usize, Selected { block, turns }: &mut Selected) {
        block.len = BLOCK.min(self.count() - first);
        block.body = self.body;
        let rods = first..first + block.len;
        match &self.shapes {
            Shapes::Shared(r) => block.aspect_ratio[..block.len].fill(*r),
            Shapes::Each(r) => block.aspect_ratio[..block.len].copy_from_slice(&r[rods.clone()]),
        }
        if let Motion::Couette(clock, _) = &self.motion {
            let each = self.of_several_shapes();
            for (turns, r) in turns.iter_mut().zip(&block.aspect_ratio) {
                *turns = clock.periods(each, *r);
            }
        }
        if let Some(lengths) = self.lengths.get(rods) {
            for (weight, length) in block.weight.iter_mut().zip(lengths) {
                *weight = self.per_cube * length.powi(3);
            }
        }
    }

    /// Gives the block of `selected`, which are the rods from `first` on, their directions at `tick` (in flows other
    /// than plane Couette flow, `tick` is the output).
    ///
    /// # Errors
    ///
    /// Returns the first rod of the block whose direction has an error above
    /// [`MAX_ERROR_RAD`](crate::plan::free_motion::MAX_ERROR_RAD).
    pub fn orient(&self, first: usize, tick: u64, selected: &mut Selected) -> Result<(), Fault> {
        let Selected { block, turns } = selected;
        let (rods, turns) = (first..first + block.len, &*turns);
        let from = self.p.each_ref().map(|axis| &axis[rods.clone()]);
        match &self.motion {
            Motion::InPhase(phases) => {
                let (r, phase) = (block.aspect_ratio[0], phases[tick as usize]);
                block.turn(
                    from,
                    #[inline(always)]
                    move |_, p, _| couette(p, r, phase),
                );
            }
            Motion::Couette(clock, times) if self.since.is_empty() => {
                let ticks = times.get(tick as usize).copied().unwrap_or(tick as f64);
                let (clock, (whole, rest)) = (*clock, clock.parts(ticks));
                block.turn(
                    from,
                    #[inline(always)]
                    move |k, p, r| couette(p, r, clock.phase_of(whole, rest, turns[k])),
                );
            }
            Motion::Couette(clock, _) => {
                let (clock, mut elapsed) = (*clock, [0.0; BLOCK]);
                for (elapsed, since) in elapsed.iter_mut().zip(&self.since[rods]) {
                    // There are at most 10⁹ steps, and no rod is ahead of `tick`.
                    *elapsed = f64::from((tick as u32).wrapping_sub(*since) as i32);
                }
                block.turn(
                    from,
                    #[inline(always)]
                    move |k, p, r| couette(p, r, clock.phase(elapsed[k], turns[k])),
                );
            }
            Motion::Steps(_) => block.turn(from, |_, p, _| p),
            Motion::Free { motion, propagators } => {
                return turn_free(&motion.way, propagators, first, tick as usize, from, block);
            }
        }
        Ok(())
    }

    /// Ticks from the last collision of `rod` to `tick`.
    fn elapsed(&self, rod: usize, tick: u64) -> f64 {
        let since = self.since.get(rod).copied().map_or(0, u64::from);
        (tick - since) as f64
    }
}
