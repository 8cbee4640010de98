//! The mean of φ folded into [0, π/2] (eq. 18), in radians.

use super::Mean;
use crate::model::orientation::folded_phi;
use std::f64::consts::FRAC_PI_2;

pub(super) const MEAN: Mean = Mean {
    name: "mean_angle",
    label: "mean angle φ (rad)",
    columns: &["phi"],
    symbols: &["φ̄ (rad)"],
    range: |_| [0.0, FRAC_PI_2],
    add: |block, sums| sums[0].add_each(block.len, |i| folded_phi(block.p[0][i], block.p[1][i])),
    ..Mean::ANY
};
