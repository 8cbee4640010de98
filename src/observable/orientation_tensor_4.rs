//! The orientation tensor ⟨pppp⟩: its 15 distinct components.

use super::{Block, Observe, Sum, range_of_product, symbol_of_product};

/// The distinct components, each as two indices into the pairs 11, 22, 33, 12, 13, 23.
const QUADS: [[usize; 2]; 15] = [
    [0, 0],
    [0, 3],
    [0, 4],
    [0, 1],
    [0, 5],
    [0, 2],
    [3, 1],
    [3, 5],
    [3, 2],
    [4, 2],
    [1, 1],
    [1, 5],
    [1, 2],
    [5, 2],
    [2, 2],
];

/// The components of the double trace, which is 1, as (index, multiplicity).
const TRACES: [(usize, f64); 6] = [(0, 1.0), (10, 1.0), (14, 1.0), (3, 2.0), (5, 2.0), (12, 2.0)];

pub(super) struct OrientationTensor4;

impl Observe for OrientationTensor4 {
    fn name(&self) -> &'static str {
        "orientation_tensor_4"
    }

    fn label(&self) -> &'static str {
        "mean of p_i p_j p_k p_l"
    }

    fn columns(&self) -> &[&'static str] {
        &[
            "a1111", "a1112", "a1113", "a1122", "a1123", "a1133", "a1222", "a1223", "a1233", "a1333", "a2222", "a2223",
            "a2233", "a2333", "a3333",
        ]
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
        for (sum, [one, other]) in sums.iter_mut().zip(QUADS) {
            let ((a, b), (c, d)) = (pairs[one], pairs[other]);
            sum.add_each(block.len, |i| a[i] * b[i] * (c[i] * d[i]));
        }
    }

    fn trace(&self, sums: &[Sum]) -> Option<(&'static str, f64)> {
        Some(("⟨pppp⟩", TRACES.iter().map(|(k, times)| times * sums[*k].value).sum()))
    }
}
