//! The core's motion of free rods at the extremes of plane Couette flow.

use super::*;
use crate::judge::statistics::larger;
use shearbed::model::flow::VelocityGradient;
use shearbed::motion::Propagator;

/// A function that returns the direction of a rod of aspect ratio r at the shear rate G after a number of periods.
pub type Motion = dyn Fn(f64, f64, &UnitVector3<f64>, f64) -> Vector3<f64>;

/// The core's propagator; NaN if it has none.
pub fn exact(aspect_ratio: f64, shear_rate_per_s: f64, p: &UnitVector3<f64>, turns: f64) -> Vector3<f64> {
    let end = VelocityGradient::plane_couette(shear_rate_per_s)
        .and_then(|flow| Propagator::new(&flow, aspect_ratio).after_turns(p, turns));
    end.map_or(Vector3::repeat(f64::NAN), UnitVector3::into_inner)
}

const SHEAR_RATES: [f64; 3] = [1e-30, 0.5, 1e30];

pub const TURNS: [f64; 14] =
    [1e-9, 1e-6, 1e-3, 0.25, 1.0 / 3.0, 0.37, 0.5, 1.0, 10.0, 1e3, 1e6, 1e8, 1e8 + 0.25, 1e8 + 0.37];

/// The largest errors over shear rates, durations and starts; NaN is kept.
#[derive(Clone, Copy, Debug)]
pub struct Worst {
    pub length: f64,
    pub orbit: f64,
    /// The angle to the closed form over the bound of [`map::round_off_at_once`].
    pub angle: f64,
}

pub fn worst(aspect_ratio: f64, motion: &Motion) -> Worst {
    let mut worst = Worst { length: 0.0, orbit: 0.0, angle: 0.0 };
    for turns in TURNS {
        for (_, end) in map::places(aspect_ratio) {
            let start = end.before(turns).direction(aspect_ratio);
            let bound = map::round_off_at_once(aspect_ratio, turns);
            for shear_rate_per_s in SHEAR_RATES {
                let p = motion(aspect_ratio, shear_rate_per_s, &start, turns);
                let angle = crate::methods::integrators::apart_rad(&p, &end.direction(aspect_ratio));
                worst.length = larger(worst.length, (p.norm() - 1.0).abs());
                worst.orbit = larger(worst.orbit, end.orbit_error(&p, aspect_ratio));
                worst.angle = larger(worst.angle, angle / bound);
            }
        }
    }
    worst
}
