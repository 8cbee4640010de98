//! The mean of φ folded into [0, π/2] (eq. 18), in radians.

use super::{Block, Observe, Sum};
use crate::model::orientation::folded_phi;

pub(super) struct MeanAngle;

impl Observe for MeanAngle {
    fn name(&self) -> &'static str {
        "mean_angle"
    }

    fn label(&self) -> &'static str {
        "mean angle φ (rad)"
    }

    fn columns(&self) -> &[&'static str] {
        &["phi"]
    }

    fn symbol(&self, _column: usize) -> String {
        "φ̄ (rad)".into()
    }

    fn range(&self, _column: usize) -> [f64; 2] {
        [0.0, std::f64::consts::FRAC_PI_2]
    }

    fn add(&self, block: &Block, sums: &mut [Sum]) {
        let [p1, p2, _] = &block.p;
        sums[0].add_each(block.len, |i| folded_phi(p1[i], p2[i]));
    }
}
