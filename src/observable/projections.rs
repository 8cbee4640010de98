//! Means of |p_i| (eq. 4; without absolute values, random rods would give 0).

use super::Mean;

pub(super) const MEAN: Mean = Mean {
    name: "projections",
    label: "mean projection on an axis",
    columns: &["x1", "x2", "x3"],
    symbols: &["X̄₁", "X̄₂", "X̄₃"],
    range: |_| [0.0, 1.0],
    add: |block, sums| {
        for (sum, p) in sums.iter_mut().zip(&block.p) {
            sum.add_each(block.len, |i| p[i].abs());
        }
    },
    ..Mean::ANY
};
