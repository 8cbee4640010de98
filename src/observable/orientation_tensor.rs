//! The orientation tensor ⟨pp⟩.

use super::{Block, Observe, Sum, range_of_product, symbol_of_product};

pub(super) struct OrientationTensor;

impl Observe for OrientationTensor {
    fn name(&self) -> &'static str {
        "orientation_tensor"
    }

    fn label(&self) -> &'static str {
        "mean of p_i p_j"
    }

    fn columns(&self) -> &[&'static str] {
        &["a11", "a22", "a33", "a12", "a13", "a23"]
    }

    fn symbol(&self, column: usize) -> String {
        symbol_of_product(self.columns()[column])
    }

    fn range(&self, column: usize) -> [f64; 2] {
        range_of_product(self.columns()[column])
    }

    fn add(&self, block: &Block, sums: &mut [Sum]) {
        let [p1, p2, p3] = &block.p;
        let pairs = [(p1, p1), (p2, p2), (p3, p3), (p1, p2), (p1, p3), (p2, p3)];
        for (sum, (a, b)) in sums.iter_mut().zip(pairs) {
            sum.add_each(block.len, |i| a[i] * b[i]);
        }
    }

    fn trace(&self, sums: &[Sum]) -> Option<(&'static str, f64)> {
        Some(("⟨pp⟩", sums[..3].iter().map(|sum| sum.value).sum()))
    }
}
