//! Means of |p_i| (eq. 4; without absolute values, random rods would give 0).

use super::{Block, Observe, Sum};

pub(super) struct Projections;

impl Observe for Projections {
    fn name(&self) -> &'static str {
        "projections"
    }

    fn label(&self) -> &'static str {
        "mean projection on an axis"
    }

    fn columns(&self) -> &[&'static str] {
        &["x1", "x2", "x3"]
    }

    fn symbol(&self, column: usize) -> String {
        ["X̄₁", "X̄₂", "X̄₃"][column].into()
    }

    fn range(&self, _column: usize) -> [f64; 2] {
        [0.0, 1.0]
    }

    fn add(&self, block: &Block, sums: &mut [Sum]) {
        for (sum, p) in sums.iter_mut().zip(&block.p) {
            sum.add_each(block.len, |i| p[i].abs());
        }
    }
}
