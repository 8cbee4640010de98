//! Mean projections on the planes x₁x₂, x₂x₃, x₁x₃ (eq. 21, with φ in the second factor).

use super::Mean;

pub(super) const MEAN: Mean = Mean {
    name: "planar_projections",
    label: "mean projection on a plane",
    columns: &["x1x2", "x2x3", "x1x3"],
    range: |_| [0.0, 1.0],
    add: |block, sums| {
        let [p1, p2, p3] = &block.p;
        for (sum, (a, b)) in sums.iter_mut().zip([(p1, p2), (p2, p3), (p1, p3)]) {
            sum.add_each(block.len, |i| (a[i] * a[i] + b[i] * b[i]).sqrt());
        }
    },
    ..Mean::ANY
};
