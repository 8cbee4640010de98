//! How a replica's rods move: what is computed before any of them moves, and the moves of free rods in any flow.

use super::Shapes;
use crate::model::jeffery::strain_per_period;
use crate::model::phase::{Phase, nearest_whole};
use crate::motion::Propagator;
use crate::observable::Block;
use crate::observable::fault::Fault;
use crate::plan::free_motion::{ErrorBound, FreeMotion, MAX_ERROR_RAD, Way, directed, propagator, refused_direction};
use crate::plan::{Clock, Plan, Stage};
use crate::scene::step_maps;
use nalgebra::{Matrix3, UnitVector3, Vector3};
use std::cell::Cell;
use std::sync::Arc;

#[derive(Clone, Debug)]
pub(super) enum Motion {
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

/// Conversion of ticks to phases in plane Couette flow.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ticks {
    per_period: f64,
    /// GT of the mean aspect ratio, with the sign of G.
    strain_per_period: f64,
    sign: f64,
}

impl Ticks {
    /// Turns of a rod of aspect ratio `r`, with the sign of G, in one period of the mean rod; `each` is true if rods
    /// differ in aspect ratio.
    #[inline(always)]
    pub fn periods(&self, each: bool, r: f64) -> f64 {
        if each { self.strain_per_period / strain_per_period(r) } else { self.sign }
    }

    /// The phase after `ticks` of a rod that turns `periods` times per period of the mean rod.
    #[inline(always)]
    pub fn phase(&self, ticks: f64, periods: f64) -> Phase {
        let (whole, rest) = self.parts(ticks);
        self.phase_of(whole, rest, periods)
    }

    /// Whole periods of the mean rod, and the rest, in periods.
    #[inline(always)]
    pub fn parts(&self, ticks: f64) -> (f64, f64) {
        let whole = nearest_whole(ticks / self.per_period);
        (whole, (ticks - whole * self.per_period) / self.per_period)
    }

    /// The phase after these parts, each by itself, so that it loses no digits to the number of turns.
    #[inline(always)]
    pub fn phase_of(&self, whole: f64, rest: f64, periods: f64) -> Phase {
        let turns = whole * periods;
        Phase::of_part(turns - nearest_whole(turns) + rest * periods)
    }
}

/// The map of `rod`: its own, or the one of all rods.
#[inline]
pub(super) fn map_of(maps: &[Matrix3<f64>], rod: usize) -> &Matrix3<f64> {
    maps.get(rod).unwrap_or(&maps[0])
}

#[inline]
pub(super) fn mapped(map: &Matrix3<f64>, p: [f64; 3]) -> [f64; 3] {
    (map * Vector3::from(p)).normalize().into()
}

/// Gives a block of free rods, which are those from `first` on, their directions at an output.
///
/// # Errors
///
/// Returns the first rod of the block whose direction has an error above [`MAX_ERROR_RAD`].
pub(super) fn turn_free(
    way: &Way,
    propagators: &[Propagator],
    first: usize,
    output: usize,
    from: [&[f64]; 3],
    block: &mut Block,
) -> Result<(), Fault> {
    let (mean, span, rounded) = match way {
        Way::Alike(ends) => {
            let end = ends[output % ends.len()];
            block.turn(from, |_, _, _| end);
            return Ok(());
        }
        Way::Maps(maps) => {
            let map = &maps[output % maps.len()];
            block.turn(from, |_, p, _| mapped(map, p));
            return Ok(());
        }
        Way::Each { mean, spans, rounded } => (mean, spans[output], *rounded),
    };
    let unknown = Cell::new(None);
    block.turn(from, |k, p, r| {
        let propagator = propagators.get(first + k).unwrap_or(&propagators[0]);
        let found = if rounded {
            directed(propagator, mean, &UnitVector3::new_unchecked(p.into()), span)
        } else {
            let found = propagator.direction_beside(mean, p, span);
            found.map(|(end, error)| (end, ErrorBound::of_motion(error)))
        };
        let (end, error) = found.unwrap_or(([f64::NAN; 3], ErrorBound::of_motion(f64::INFINITY)));
        if error.rad <= MAX_ERROR_RAD {
            return end;
        }
        unknown.set(unknown.get().or(Some((k, r, error))));
        [f64::NAN; 3]
    });
    unknown.get().map_or(Ok(()), |(rod, r, error)| Err(Fault { rod: Some(rod), cause: refused_direction(r, error) }))
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

pub(super) fn choose_motion(plan: &Plan, shapes: &Shapes) -> Motion {
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
