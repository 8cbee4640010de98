//! The orientation tensor ⟨pppp⟩: its 15 distinct components.

use super::{Mean, axis, range_of_product};

#[rustfmt::skip]
const COLUMNS: &[&str] = &[
    "a1111", "a1112", "a1113", "a1122", "a1123", "a1133", "a1222", "a1223", "a1233", "a1333", "a2222", "a2223", "a2233",
    "a2333", "a3333",
];

/// The components of the double trace, which is 1, as (index, multiplicity).
const TRACES: [(usize, f64); 6] = [(0, 1.0), (10, 1.0), (14, 1.0), (3, 2.0), (5, 2.0), (12, 2.0)];

pub(super) const MEAN: Mean = Mean {
    name: "orientation_tensor_4",
    label: "mean of p_i p_j p_k p_l",
    columns: COLUMNS,
    symbols: &[
        "a_1111", "a_1112", "a_1113", "a_1122", "a_1123", "a_1133", "a_1222", "a_1223", "a_1233", "a_1333", "a_2222",
        "a_2223", "a_2233", "a_2333", "a_3333",
    ],
    range: |column| range_of_product(COLUMNS[column]),
    add: |block, sums| {
        for (sum, column) in sums.iter_mut().zip(COLUMNS) {
            let [a, b, c, d] = [0, 1, 2, 3].map(|k| &block.p[axis(column, k)]);
            sum.add_each(block.len, |i| a[i] * b[i] * (c[i] * d[i]));
        }
    },
    trace: Some(("⟨pppp⟩", |sums| TRACES.iter().map(|(k, times)| times * sums[*k].value).sum())),
    ..Mean::ANY
};
