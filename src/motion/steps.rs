//! Motion in a sequence of flows: the product of their maps.

use super::ball::Ball;
use super::general::{General, Square, at_size_one, product};
use crate::model::flow::VelocityGradient;

#[derive(Clone, Debug)]
pub(super) struct Steps(Vec<Step>);

#[derive(Clone, Debug)]
struct Step {
    flow: General,
    /// The strain at which this flow begins.
    from: Ball,
    /// The map of all earlier flows, up to a factor.
    before: Square,
}

impl Steps {
    /// The motion in `flows`, at least one, each with its strain.
    pub fn new(flows: &[(VelocityGradient, f64)], aspect_ratio: f64) -> Self {
        let mut from = Ball::ZERO;
        let mut before = [0, 1, 2].map(|i| [0, 1, 2].map(|j| if i == j { Ball::ONE } else { Ball::ZERO }));
        let step = |(flow, strain): &(VelocityGradient, f64)| {
            let step = Step { flow: General::new(flow, aspect_ratio), from, before };
            from = from + Ball::exact(*strain);
            before = step.map(from);
            step
        };
        Self(flows.iter().map(step).collect())
    }

    /// The map q = M p from strain 0, up to a factor. The last flow continues beyond its strain.
    pub fn map(&self, strain: Ball) -> Square {
        let begun = |step: &&Step| (strain - step.from).hi >= 0.0;
        self.0.iter().rev().find(begun).unwrap_or(&self.0[0]).map(strain)
    }
}

impl Step {
    fn map(&self, strain: Ball) -> Square {
        let here = self.flow.map(self.flow.time_of_strain(strain - self.from));
        at_size_one(product(|i, k| here[i][k], |k, j| self.before[k][j]))
    }
}
