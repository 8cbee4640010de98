//! Mean and density of C_b = C/(1 + C) (eq. 13).

use super::{BLOCK, Mean};
use crate::model::orientation::bounded_orbit_constant;

/// Number of bins of the density of C_b over [0, 1].
const BINS: usize = 20;

/// The columns: the mean, and each bin named by its lower end.
#[rustfmt::skip]
const COLUMNS: [&str; 1 + BINS] = [
    "c_b", "density_from_0.00", "density_from_0.05", "density_from_0.10", "density_from_0.15", "density_from_0.20",
    "density_from_0.25", "density_from_0.30", "density_from_0.35", "density_from_0.40", "density_from_0.45",
    "density_from_0.50", "density_from_0.55", "density_from_0.60", "density_from_0.65", "density_from_0.70",
    "density_from_0.75", "density_from_0.80", "density_from_0.85", "density_from_0.90", "density_from_0.95",
];

pub(super) const MEAN: Mean = Mean {
    name: "orbit_constant",
    label: "mean C_b",
    columns: &COLUMNS,
    symbols: &["C_b"],
    range: |column| [0.0, if column == 0 { 1.0 } else { BINS as f64 }],
    add: |block, sums| {
        let [p1, p2, p3] = &block.p;
        let mut bounded = [0.0; BLOCK];
        for (i, c) in bounded[..block.len].iter_mut().enumerate() {
            *c = bounded_orbit_constant([p1[i], p2[i], p3[i]], block.aspect_ratio[i]);
        }
        sums[0].add_each(block.len, |i| bounded[i]);
        for (bin, sum) in sums[1..].iter_mut().enumerate() {
            // A density: the share of rods in the bin over the bin's width.
            let inside = |c: f64| ((c * BINS as f64) as usize).min(BINS - 1) == bin;
            sum.add_each(block.len, |i| if inside(bounded[i]) { BINS as f64 } else { 0.0 });
        }
    },
    needs_couette: true,
    is_density: true,
    ..Mean::ANY
};
