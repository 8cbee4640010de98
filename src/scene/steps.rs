//! How many steps a period takes by default, and which step is too long.

use super::Scene;
use crate::jeffery::strain_per_period;

/// Steps per period come in multiples of this, so that the default outputs fall on steps.
const MULTIPLE: u64 = 50;

/// The longest strain per step GΔt that resolves the motion of interacting rods: it leaves X̄₁ an error of 0.003 at most
/// (measured, `docs/time-step.md`). 0.37 for short rods, 4.4/r_e for longer ones, 0.09 for the longest.
pub fn resolved_strain(aspect_ratio: f64) -> f64 {
    (4.4 / aspect_ratio).clamp(0.09, 0.37)
}

impl Scene {
    /// Steps per period of the mean aspect ratio, given or by default [`Scene::resolving_steps_per_period`].
    pub fn steps_per_period(&self) -> u64 {
        self.time
            .steps_per_period
            .unwrap_or_else(|| self.resolving_steps_per_period())
    }

    /// The strain GΔt of one step.
    pub fn strain_per_step(&self) -> f64 {
        strain_per_period(self.particles.aspect_ratio) / self.steps_per_period() as f64
    }

    /// The smallest multiple of 50 (and of the outputs per period, where they are given) with GΔt of at most
    /// [`resolved_strain`] of the rods' mean r_e: 200 at r_e = 11.6. `u64::MAX` where there is no such number.
    pub fn resolving_steps_per_period(&self) -> u64 {
        let outputs = self.time.outputs_per_period.unwrap_or(1).max(1);
        let unit = (outputs / common_divisor(outputs, MULTIPLE)).saturating_mul(MULTIPLE);
        let strain = strain_per_period(self.particles.aspect_ratio);
        let resolved = resolved_strain(self.particles.mean_aspect_ratio());
        let multiples = (strain / (resolved * unit as f64)).ceil().max(1.0) as u64;
        let steps = multiples.saturating_mul(unit);
        // The quotient above is rounded, and may have come out as a whole number that is just too small.
        match strain / steps as f64 <= resolved {
            true => steps,
            false => steps.saturating_add(unit),
        }
    }
}

fn common_divisor(a: u64, b: u64) -> u64 {
    match b {
        0 => a,
        _ => common_divisor(b, a % b),
    }
}
