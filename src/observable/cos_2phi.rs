//! ⟨cos 2φ⟩ = ⟨(p₁² − p₂²)/(p₁² + p₂²)⟩: −1 along the flow, 1 along the gradient. A rod along the vorticity axis, where
//! φ is undefined, counts as 0.

use super::Mean;

pub(super) const MEAN: Mean = Mean {
    name: "cos_2phi",
    label: "mean of cos 2φ",
    columns: &["cos_2phi"],
    symbols: &["⟨cos 2φ⟩"],
    range: |_| [-1.0, 1.0],
    add: |block, sums| {
        let [p1, p2, _] = &block.p;
        sums[0].add_each(block.len, |i| {
            let [a, b] = [p1[i] * p1[i], p2[i] * p2[i]];
            if a + b > 0.0 { (a - b) / (a + b) } else { 0.0 }
        });
    },
    ..Mean::ANY
};
