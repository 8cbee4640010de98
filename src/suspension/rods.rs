//! The rods' directions: each rod stores its direction after its last collision, and the exact motion gives the
//! direction at any later time. A free rod takes no steps.

mod draw;

use crate::model::chunks::{CHUNK, over_chunks};
use crate::model::diffusion::turned;
use crate::model::jeffery::strain_per_period;
use crate::model::phase::{Phase, nearest_whole};
use crate::model::random::ahead;
use crate::model::stress::Body;
use crate::model::work::Counters;
use crate::motion::{Propagator, couette};
use crate::observable::fault::Fault;
use crate::observable::{BLOCK, Block};
use crate::plan::free_motion::{FreeMotion, MAX_ERROR_RAD, Way, directed, propagator, refused_direction};
use crate::plan::{Clock, Plan, Stage};
use crate::scene::step_maps;
use draw::{draw_directions, draw_lengths, draw_shapes};
use nalgebra::{Matrix3, UnitVector3, Vector3};
use rand::RngExt;
use rand_pcg::Pcg64Dxsm;
use std::cell::Cell;
use std::sync::Arc;

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

#[derive(Clone, Debug)]
enum Motion {
    /// Plane Couette flow: phases from ticks. Rods that take no steps have a list of their outputs' times in ticks if
    /// these are not whole.
    Couette(Ticks, Vec<f64>),
    /// Rods of one aspect ratio in plane Couette flow that take no steps: the phase of all of them at each output.
    InPhase(Vec<Phase>),
    /// Any other flow with interacting rods, or rods that diffuse: the map q = M p of one step, one per rod or one for
    /// all.
    Steps(Vec<Matrix3<f64>>),
    /// Free rods in any other flow: the plan's motion, with a propagator per rod, or one for all, where it moves each
    /// rod by itself.
    Free { motion: Arc<FreeMotion>, propagators: Vec<Propagator> },
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
    /// Returns the first rod of the block whose direction has an error above [`MAX_ERROR_RAD`].
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
            Motion::Free { motion, propagators } => match &motion.way {
                Way::Alike(ends) => {
                    let end = ends[tick as usize % ends.len()];
                    block.turn(from, |_, _, _| end);
                }
                Way::Maps(maps) => {
                    let map = &maps[tick as usize % maps.len()];
                    block.turn(from, |_, p, _| mapped(map, p));
                }
                Way::Each { mean, spans, rounded } => {
                    let span = spans[tick as usize];
                    let of_rod = |rod: usize| match &propagators[..] {
                        [all] => all,
                        each => &each[rod],
                    };
                    let unknown = Cell::new(None);
                    block.turn(from, |k, p, r| {
                        let propagator = of_rod(first + k);
                        let found = if *rounded {
                            let start = UnitVector3::new_unchecked(p.into());
                            directed(propagator, mean, &start, span)
                        } else {
                            let found = propagator.direction_beside(mean, p, span);
                            found.map(|(end, error)| (end, error, 0.0))
                        };
                        let (end, error, of_start) = found.unwrap_or(([f64::NAN; 3], f64::INFINITY, 0.0));
                        if error <= MAX_ERROR_RAD {
                            return end;
                        }
                        unknown.set(unknown.get().or(Some((k, r, error, of_start))));
                        [f64::NAN; 3]
                    });
                    if let Some((rod, r, error, of_start)) = unknown.get() {
                        return Err(Fault { rod: Some(rod), cause: refused_direction(r, error, of_start) });
                    }
                }
            },
        }
        Ok(())
    }

    /// Ticks from the last collision of `rod` to `tick`.
    fn elapsed(&self, rod: usize, tick: u64) -> f64 {
        let since = self.since.get(rod).copied().map_or(0, u64::from);
        (tick - since) as f64
    }
}

/// Conversion of ticks to phases in plane Couette flow.
#[derive(Clone, Copy, Debug)]
struct Ticks {
    per_period: f64,
    /// GT of the mean aspect ratio, with the sign of G.
    strain_per_period: f64,
    sign: f64,
}

impl Ticks {
    /// Turns of a rod of aspect ratio `r`, with the sign of G, in one period of the mean rod; `each` is true if rods
    /// differ in aspect ratio.
    #[inline(always)]
    fn periods(&self, each: bool, r: f64) -> f64 {
        if each { self.strain_per_period / strain_per_period(r) } else { self.sign }
    }

    /// The phase after `ticks` of a rod that turns `periods` times per period of the mean rod.
    #[inline(always)]
    fn phase(&self, ticks: f64, periods: f64) -> Phase {
        let (whole, rest) = self.parts(ticks);
        self.phase_of(whole, rest, periods)
    }

    /// Whole periods of the mean rod, and the rest, in periods.
    #[inline(always)]
    fn parts(&self, ticks: f64) -> (f64, f64) {
        let whole = nearest_whole(ticks / self.per_period);
        (whole, (ticks - whole * self.per_period) / self.per_period)
    }

    /// The phase after these parts, each by itself, so that it loses no digits to the number of turns.
    #[inline(always)]
    fn phase_of(&self, whole: f64, rest: f64, periods: f64) -> Phase {
        let turns = whole * periods;
        Phase::of_part(turns - nearest_whole(turns) + rest * periods)
    }
}

/// The map of `rod`: its own, or the one of all rods.
#[inline]
fn map_of(maps: &[Matrix3<f64>], rod: usize) -> &Matrix3<f64> {
    maps.get(rod).unwrap_or(&maps[0])
}

#[inline]
fn mapped(map: &Matrix3<f64>, p: [f64; 3]) -> [f64; 3] {
    (map * Vector3::from(p)).normalize().into()
}

/// True if all rods have the same phase at an output: rods of one aspect ratio that take no steps, in plane Couette
/// flow by periods.
fn in_phase(plan: &Plan) -> bool {
    let periods = matches!(plan.clock(), Clock::Periods { .. });
    plan.flow().shear_rate_per_s().is_some()
        && periods
        && ![Stage::Translation, Stage::Diffusion].iter().any(|stage| plan.runs(*stage))
        && !plan.runs(Stage::AspectRatios)
}

/// The times that the scene of a plan without steps gives for its outputs.
fn own_times(plan: &Plan) -> &[f64] {
    if plan.runs(Stage::Translation) { &[] } else { &plan.scene().output.times }
}

/// The bytes that a replica's rods hold for each output.
pub(crate) fn bytes_per_output(plan: &Plan) -> usize {
    if in_phase(plan) { size_of::<Phase>() } else { size_of_val(own_times(plan)) / plan.outputs() }
}

fn choose_motion(plan: &Plan, shapes: &Shapes) -> Motion {
    let (flow, diffuses) = (plan.flow(), plan.runs(Stage::Diffusion));
    if let (Some(g), Clock::Periods { ticks }, false) = (flow.shear_rate_per_s(), plan.clock(), diffuses) {
        let strain = strain_per_period(plan.scene().particles.aspect_ratio);
        let clock = Ticks { per_period: ticks as f64, strain_per_period: strain * g.signum(), sign: g.signum() };
        if in_phase(plan) {
            let phases = plan.scene().output_times().map(|time| clock.phase(time, clock.sign));
            return Motion::InPhase(phases.collect());
        }
        return Motion::Couette(clock, own_times(plan).to_vec());
    }
    let Some(motion) = plan.free().cloned() else {
        let shapes = match shapes {
            Shapes::Shared(r) => std::slice::from_ref(r),
            Shapes::Each(all) => all,
        };
        // The plan has checked that these maps exist.
        let maps = step_maps(plan.scene(), flow, shapes).flatten();
        return Motion::Steps(maps.map(|(map, _)| map).collect());
    };
    let propagators = match (&motion.way, shapes) {
        (Way::Each { .. }, Shapes::Each(aspect_ratios)) => {
            aspect_ratios.iter().map(|&r| propagator(plan.scene(), flow, r)).collect()
        }
        (Way::Each { .. }, Shapes::Shared(r)) => vec![propagator(plan.scene(), flow, *r)],
        _ => Vec::new(),
    };
    Motion::Free { motion, propagators }
}
