//! The times of a plan in seconds and in strain.

use crate::model::flow::VelocityGradient;
use crate::model::jeffery::strain_per_period;
use crate::scene::{Scene, TimeUnit};

/// A time of a plan in other units.
///
/// ```
/// let period = shearbed::Plan::new(&shearbed::Scene::default())?.elapsed(1.0);
/// assert_eq!(period.strain, shearbed::model::jeffery::strain_per_period(11.6));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Elapsed {
    /// The time in s.
    pub seconds: f64,
    /// The shear strain ∫(2D:D)^½ dt.
    pub strain: f64,
}

/// How a plan's times convert to seconds and strain.
#[derive(Clone, Debug)]
pub(super) enum Timing {
    /// One flow: the length of a period or of a unit of strain.
    Unit(Elapsed),
    /// A sequence of flows: when each begins, and its rate of strain in 1/s.
    Steps(Vec<(Elapsed, f64)>),
}

impl Timing {
    pub fn of(scene: &Scene, flow: &VelocityGradient) -> Self {
        if let Some(steps) = scene.flow.steps() {
            let mut begun = Elapsed { seconds: 0.0, strain: 0.0 };
            let step = steps.iter().map(|step| {
                let rate = step.rate_per_s();
                let step_begun = begun;
                begun.seconds += step.strain / rate;
                begun.strain += step.strain;
                (step_begun, rate)
            });
            return Self::Steps(step.collect());
        }
        let seconds = scene.seconds_per_unit(flow);
        let strain = match (scene.time.unit, flow.shear_rate_per_s()) {
            (TimeUnit::Strain, _) => 1.0,
            (TimeUnit::Period, Some(_)) => strain_per_period(scene.particles.aspect_ratio),
            (TimeUnit::Second, Some(g)) => g.abs(),
            (TimeUnit::Period | TimeUnit::Second, None) => seconds * flow.magnitude_per_s(),
        };
        Self::Unit(Elapsed { seconds, strain })
    }

    pub fn at(&self, time: f64) -> Elapsed {
        match self {
            Self::Unit(unit) => Elapsed { seconds: time * unit.seconds, strain: time * unit.strain },
            Self::Steps(steps) => {
                let begun = steps.partition_point(|(begun, _)| begun.strain <= time).max(1);
                let (begun, rate) = steps[begun - 1];
                Elapsed { seconds: begun.seconds + (time - begun.strain) / rate, strain: time }
            }
        }
    }
}
