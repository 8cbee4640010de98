//! Mean projections on the planes x₁x₂, x₂x₃, x₁x₃ (eq. 21, with φ in the second factor).

use super::{Block, Observe, Sum};

pub(super) struct PlanarProjections;

impl Observe for PlanarProjections {
    fn name(&self) -> &'static str {
        "planar_projections"
    }

    fn label(&self) -> &'static str {
        "mean projection on a plane"
    }

    fn columns(&self) -> &[&'static str] {
        &["x1x2", "x2x3", "x1x3"]
    }

    fn range(&self, _column: usize) -> [f64; 2] {
        [0.0, 1.0]
    }

    fn add(&self, block: &Block, sums: &mut [Sum]) {
        let [p1, p2, p3] = &block.p;
        for (sum, (a, b)) in sums.iter_mut().zip([(p1, p2), (p2, p3), (p1, p3)]) {
            sum.add_each(block.len, |i| (a[i] * a[i] + b[i] * b[i]).sqrt());
        }
    }
}
