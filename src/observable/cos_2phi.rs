//! ⟨cos 2φ⟩ = ⟨(p₁² − p₂²)/(p₁² + p₂²)⟩: −1 along the flow, 1 along the gradient. A rod along the vorticity axis, where
//! φ is undefined, counts as 0.

use super::{Block, Observe, Sum};

pub(super) struct Cos2Phi;

impl Observe for Cos2Phi {
    fn name(&self) -> &'static str {
        "cos_2phi"
    }

    fn label(&self) -> &'static str {
        "mean of cos 2φ"
    }

    fn columns(&self) -> &[&'static str] {
        &["cos_2phi"]
    }

    fn symbol(&self, _column: usize) -> String {
        "⟨cos 2φ⟩".into()
    }

    fn range(&self, _column: usize) -> [f64; 2] {
        [-1.0, 1.0]
    }

    fn add(&self, block: &Block, sums: &mut [Sum]) {
        let [p1, p2, _] = &block.p;
        sums[0].add_each(block.len, |i| {
            let [a, b] = [p1[i] * p1[i], p2[i] * p2[i]];
            if a + b > 0.0 { (a - b) / (a + b) } else { 0.0 }
        });
    }
}
