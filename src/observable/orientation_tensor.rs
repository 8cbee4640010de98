//! The orientation tensor ⟨pp⟩.

use super::{Mean, axis, range_of_product};

const COLUMNS: &[&str] = &["a11", "a22", "a33", "a12", "a13", "a23"];

pub(super) const MEAN: Mean = Mean {
    name: "orientation_tensor",
    label: "mean of p_i p_j",
    columns: COLUMNS,
    symbols: &["a_11", "a_22", "a_33", "a_12", "a_13", "a_23"],
    range: |column| range_of_product(COLUMNS[column]),
    add: |block, sums| {
        for (sum, column) in sums.iter_mut().zip(COLUMNS) {
            let [a, b] = [0, 1].map(|k| &block.p[axis(column, k)]);
            sum.add_each(block.len, |i| a[i] * b[i]);
        }
    },
    trace: Some(("⟨pp⟩", |sums| sums[..3].iter().map(|sum| sum.value).sum())),
    ..Mean::ANY
};
