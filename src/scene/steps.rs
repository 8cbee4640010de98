//! The time steps of interacting rods: their default number and their largest length.

use super::{Scene, TimeUnit};
use crate::model::flow::VelocityGradient;
use crate::model::jeffery::strain_per_period;
use crate::motion::Propagator;
use nalgebra::Matrix3;

/// Steps per period come in multiples of this, so that the default outputs fall on steps.
const MULTIPLE: u64 = 50;

/// The longest strain between default outputs, about that of a default step: a flip takes a strain of about 2 at any
/// r_e, and lines between outputs follow the peaks of the means.
const OUTPUT_STRAIN: f64 = 0.4;

/// The same of free rods, whose outputs cost little: a turn of |p_i| between two of them is cut by (0.2/2)²/2 = 0.5 %.
const FREE_OUTPUT_STRAIN: f64 = 0.2;

/// The most default outputs per period.
const MOST_OUTPUTS: u64 = 1000;

/// The longest strain per step GΔt that resolves the motion of interacting rods, with an error of X̄₁ of at most 0.003
/// (measured, `docs/src/theory/time-step.md`): 0.37 for short rods, 4.4/r_e for longer ones, 0.09 for the longest.
pub fn resolved_strain(aspect_ratio: f64) -> f64 {
    (4.4 / aspect_ratio).clamp(0.09, 0.37)
}

/// The longest step of rods that diffuse: a strain, or twice an angle, of 0.1, and D_r Δt = 0.02.
const DIFFUSING: [f64; 2] = [0.1, 0.02];

/// Relative deviation of a given time from that of an output or a step: a third in six digits is meant as one.
const NEAR: f64 = 1e-5;

/// The whole number within [`NEAR`] of `place`, or `None`.
pub(crate) fn nearest(place: f64) -> Option<u64> {
    ((place - place.round()).abs() <= NEAR).then_some(place.round() as u64)
}

impl Scene {
    /// True if rods take time steps, unless they cannot collide.
    pub(crate) fn steps(&self) -> bool {
        self.interaction.is_some() || self.diffuses()
    }

    pub(crate) fn diffuses(&self) -> bool {
        self.particles.rotary_diffusion_per_s > 0.0
    }

    /// The longest motion of a step that is resolved: [`resolved_strain`], or less with diffusion.
    pub(crate) fn resolved_motion(&self) -> f64 {
        if self.diffuses() { DIFFUSING[0] } else { resolved_strain(self.particles.mean_aspect_ratio()) }
    }

    /// Outputs per unit of time that do not exceed the default: the fewest fifties a period with a strain of at most
    /// [`OUTPUT_STRAIN`] or [`FREE_OUTPUT_STRAIN`] between them, 10 a unit of strain.
    pub(crate) fn default_outputs(&self) -> u64 {
        match self.time.unit {
            TimeUnit::Period => match self.least_outputs() {
                u64::MAX => MULTIPLE,
                least => least.next_multiple_of(MULTIPLE),
            },
            TimeUnit::Strain => 10,
            // Rounded up to whole outputs a second.
            TimeUnit::Second => self.flow.gradient().map_or(1, |flow| {
                let rate_per_s = flow.shear_rate_per_s().map_or_else(|| flow.magnitude_per_s(), f64::abs);
                (10.0 * rate_per_s).ceil().max(1.0) as u64
            }),
        }
    }

    /// The fewest outputs a period that follow flips which 50 a period would miss, those of free or long rods;
    /// `u64::MAX` for others.
    pub(crate) fn least_outputs(&self) -> u64 {
        let strain = if self.steps() { OUTPUT_STRAIN } else { FREE_OUTPUT_STRAIN };
        let least = (self.flow_per_unit() / strain).ceil() as u64;
        let would_miss = self.time.unit == TimeUnit::Period && least > MULTIPLE;
        if would_miss { least.min(MOST_OUTPUTS) } else { u64::MAX }
    }

    /// The number of outputs, including that at t = 0 unless the scene gives their times.
    pub(crate) fn outputs(&self) -> usize {
        if !self.output.times.is_empty() {
            return self.output.times.len();
        }
        let all = self.time.duration * self.outputs_per_unit() as f64;
        // The slack allows for a product that was rounded down.
        1 + (all * (1.0 + 4.0 * f64::EPSILON)).floor() as usize
    }

    /// Outputs per unit of time, or 1 if the scene gives the outputs' times.
    pub(crate) fn outputs_each(&self) -> u64 {
        if self.output.times.is_empty() { self.outputs_per_unit() } else { 1 }
    }

    /// The times of the outputs, times [`Scene::outputs_each`]: whole numbers unless the scene gives the times.
    pub(crate) fn output_times(&self) -> impl Iterator<Item = f64> {
        (0..self.outputs()).map(|output| self.output_time(output))
    }

    fn output_time(&self, output: usize) -> f64 {
        self.output.times.get(output).copied().unwrap_or(output as f64)
    }

    /// The index of the output at `time`; `None` if no output is within 1e-5 of the output interval, or of the time
    /// itself where the scene gives the times.
    pub(crate) fn output_at(&self, time: f64) -> Option<usize> {
        if !self.output.times.is_empty() {
            return self.output.times.iter().position(|output| (output - time).abs() <= NEAR * time);
        }
        nearest(time * self.outputs_per_unit() as f64)
            .filter(|output| *output < self.outputs() as u64)
            .map(|k| k as usize)
    }

    /// The step of an output: a function that gives a whole number for every output that is on a step.
    pub(crate) fn output_steps(&self) -> impl Fn(usize) -> f64 {
        let steps = self.steps_per_unit() as f64 / self.outputs_each() as f64;
        move |output| self.output_time(output) * steps
    }

    /// Steps per unit of time; by default [`Scene::resolving_steps`].
    pub fn steps_per_unit(&self) -> u64 {
        self.time.steps_per_unit.unwrap_or_else(|| self.resolving_steps())
    }

    /// The strain of one step, or twice the angle in rad by which the liquid rotates in it if that is larger; GΔt in
    /// plane Couette flow.
    pub fn motion_per_step(&self) -> f64 {
        self.motion_per_unit() / self.steps_per_unit() as f64
    }

    /// The smallest number of steps (a multiple of the outputs, if given, and of 50 for periods; else a round one) with
    /// a strain per step of at most [`resolved_strain`] of the rods' mean r_e: at r_e = 11.6 200 a period, or 4 a unit
    /// of strain. `u64::MAX` if there is none.
    pub fn resolving_steps(&self) -> u64 {
        let outputs = self.time.outputs_per_unit;
        let unit = match self.time.unit {
            TimeUnit::Strain | TimeUnit::Second => outputs.unwrap_or(1).max(1),
            TimeUnit::Period => {
                let outputs = outputs.unwrap_or(1).max(1);
                (outputs / common_divisor(outputs, MULTIPLE)).saturating_mul(MULTIPLE)
            }
        };
        let motion = self.motion_per_unit();
        let resolved = self.resolved_motion();
        let multiples = (motion / (resolved * unit as f64)).ceil().max(1.0) as u64;
        let steps = multiples.saturating_mul(unit);
        // The rounded quotient may be an integer that is just too small.
        let steps = if motion / steps as f64 <= resolved { steps } else { steps.saturating_add(unit) };
        match (self.time.unit, outputs) {
            (TimeUnit::Strain | TimeUnit::Second, None) => round_above(steps),
            _ => steps,
        }
    }

    /// Seconds per unit of the scene's time: a period of the mean aspect ratio, a unit of strain or a second. NaN if
    /// there is no period.
    pub(crate) fn seconds_per_unit(&self, flow: &VelocityGradient) -> f64 {
        match self.time.unit {
            TimeUnit::Strain => 1.0 / flow.magnitude_per_s(),
            TimeUnit::Second => 1.0,
            TimeUnit::Period => (Propagator::new(flow, self.particles.aspect_ratio).period_s()).unwrap_or(f64::NAN),
        }
    }

    /// The larger of the strain and twice the rotation of the liquid, in rad, per unit of the scene's time; with
    /// diffusion, that which needs as many steps if it needs more.
    pub(crate) fn motion_per_unit(&self) -> f64 {
        let flow = self.flow.gradient().filter(|_| self.diffuses());
        let diffused = flow.map_or(0.0, |flow| {
            self.particles.rotary_diffusion_per_s * self.seconds_per_unit(&flow) * (DIFFUSING[0] / DIFFUSING[1])
        });
        self.flow_per_unit().max(diffused)
    }

    fn flow_per_unit(&self) -> f64 {
        let r = self.particles.aspect_ratio;
        let flow = self.flow.gradient();
        let shear_rate = flow.as_ref().map_or(Some(f64::NAN), VelocityGradient::shear_rate_per_s);
        let (None, Some(flow)) = (shear_rate, flow) else {
            return match self.time.unit {
                TimeUnit::Strain => 1.0,
                TimeUnit::Period => strain_per_period(r),
                TimeUnit::Second => shear_rate.map_or(f64::NAN, f64::abs),
            };
        };
        let (strain_per_s, turn_per_s) = (flow.magnitude_per_s(), flow.turn_per_s());
        match self.time.unit {
            TimeUnit::Strain => (turn_per_s / strain_per_s).max(1.0),
            TimeUnit::Period | TimeUnit::Second => strain_per_s.max(turn_per_s) * self.seconds_per_unit(&flow),
        }
    }
}

/// For each aspect ratio, the map q = M p of one step of the scene's rods, and a bound on its relative error; `None`
/// for steps of a period if the flow has none.
pub(crate) fn step_maps<'a>(
    scene: &Scene,
    flow: &'a VelocityGradient,
    aspect_ratios: &'a [f64],
) -> impl Iterator<Item = Option<(Matrix3<f64>, f64)>> + 'a {
    let steps = scene.steps_per_unit() as f64;
    let span = scene.time.unit.span(1.0, steps);
    let mean = Propagator::general(flow, scene.particles.aspect_ratio);
    let of = move |r: &f64| Propagator::general(flow, *r).map_beside(&mean, span);
    aspect_ratios.iter().map(of)
}

/// The smallest number with one digit, 1, 2, 4, 5 or 8, before zeros that is not below `least`: times of steps and
/// outputs have few decimals then.
fn round_above(least: u64) -> u64 {
    let ten = 10u64.checked_pow(least.max(1).ilog10()).unwrap_or(u64::MAX);
    [1, 2, 4, 5, 8, 10]
        .map(|digit: u64| digit.saturating_mul(ten))
        .into_iter()
        .find(|all| *all >= least)
        .unwrap_or(least)
}

fn common_divisor(a: u64, b: u64) -> u64 {
    match b {
        0 => a,
        _ => common_divisor(b, a % b),
    }
}
