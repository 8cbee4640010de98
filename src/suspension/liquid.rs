//! The motion of the liquid: the rods' rates, relative velocities, and positions.

use crate::model::jeffery::{couette_rate, rate};
use crate::model::volume::{COUETTE_NUMBERS, ControlVolume, INFLOW_NUMBERS, Inflow};
use crate::plan::Plan;
use nalgebra::Vector3;
use rand_pcg::Pcg64Dxsm;

#[derive(Clone, Debug)]
pub(super) enum Liquid {
    /// Flow u_2 = ±x_1, with time in 1/|G|; rods are replaced by eq. 14.
    Couette { volume: ControlVolume, sign: f64 },
    /// Any gradient of trace 0, with time in units of the inverse of its largest component.
    Any(Box<Inflow>),
}

impl Liquid {
    /// The liquid of a scene, and the length of a step in its unit of time.
    pub fn of(plan: &Plan, volume: ControlVolume) -> (Self, f64) {
        let (flow, steps) = (plan.flow(), plan.scene().steps_per_unit() as f64);
        if let Some(shear_rate_per_s) = flow.shear_rate_per_s() {
            let sign = shear_rate_per_s.signum();
            return (Self::Couette { volume, sign }, plan.elapsed(1.0).strain / steps);
        }
        let rate_per_s = flow.per_s().amax();
        let (gradient, step) = (flow.per_s() / rate_per_s, plan.elapsed(1.0).seconds * rate_per_s / steps);
        (Self::Any(Box::new(Inflow::new(&volume, gradient, step))), step)
    }

    /// ṗ of a free rod.
    pub fn rate(&self, p: &Vector3<f64>, shape_factor: f64) -> Vector3<f64> {
        match self {
            Self::Couette { sign, .. } => couette_rate(p, shape_factor, *sign),
            Self::Any(inflow) => rate(inflow.gradient(), p, shape_factor),
        }
    }

    /// The velocity of the liquid at one point relative to another, which differ by `separation`.
    pub fn velocity(&self, separation: &Vector3<f64>) -> Vector3<f64> {
        match self {
            Self::Couette { sign, .. } => Vector3::new(0.0, sign * separation.x, 0.0),
            Self::Any(inflow) => inflow.gradient() * separation,
        }
    }

    /// Moves every rod over a step and replaces those that leave. Returns the number of rods replaced.
    pub fn carry(&self, positions: &mut [Vec<f64>; 3], step: f64, rng: &mut Pcg64Dxsm) -> u64 {
        match self {
            Self::Couette { volume, sign } => volume.advance(positions, step, *sign, rng),
            Self::Any(inflow) => inflow.advance(positions, rng),
        }
    }

    /// Random numbers of the stream per replaced rod.
    pub fn numbers(&self) -> u128 {
        match self {
            Self::Couette { .. } => COUETTE_NUMBERS,
            Self::Any(_) => INFLOW_NUMBERS,
        }
    }
}
