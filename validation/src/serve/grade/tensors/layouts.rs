//! Six components in another order, with factors, or in other axes.

use super::{Near, apart};
use crate::serve::grade::answer::Answer;
use crate::serve::problems::formula::paired;
use std::f64::consts::SQRT_2;

/// A way to write the six components of a symmetric tensor.
pub(super) struct Layout {
    /// The layout, to stand after "this is the curve of".
    pub(super) name: &'static str,
    /// What is right.
    pub(super) advice: &'static str,
    /// The place in the answer of 11, 22, 33, 12, 13, 23.
    places: [usize; 6],
    /// The factors on 12, 13 and 23; of a_ijkl on these k, l.
    factors: [f64; 3],
    /// True if a_ijkl has the factors also on i, j.
    on_rows: bool,
}

const ORDER: &str = "the columns are 11, 22, 33, 12, 13, 23; the names of the columns say another order";
const PLAIN: &str = "a12, a13 and a23 are ⟨p_i p_j⟩, without a factor";
const AXES: &str = "1 = gradient, 2 = flow, 3 = vorticity: the order of the program's axes can be given";

const fn order(name: &'static str, advice: &'static str, places: [usize; 6]) -> Layout {
    Layout { name, advice, places, factors: [1.0; 3], on_rows: true }
}

const fn factors(name: &'static str, factors: [f64; 3]) -> Layout {
    Layout { name, advice: PLAIN, places: [0, 1, 2, 3, 4, 5], factors, on_rows: true }
}

/// Layouts of other programs, and mistakes.
pub(super) const LAYOUTS: [Layout; 16] = [
    order("columns in Voigt's order 11, 22, 33, 23, 13, 12", ORDER, [0, 1, 2, 5, 4, 3]),
    order("columns in the order 11, 22, 33, 12, 23, 13", ORDER, [0, 1, 2, 3, 5, 4]),
    order("columns in the order 11, 22, 33, 23, 12, 13", ORDER, [0, 1, 2, 4, 5, 3]),
    order("columns in the order 11, 22, 33, 13, 12, 23", ORDER, [0, 1, 2, 4, 3, 5]),
    order("columns in the order 11, 12, 13, 22, 23, 33", ORDER, [0, 3, 5, 1, 2, 4]),
    factors("2 a_12 for a_12 (engineering shear)", [2.0; 3]),
    factors("√2 a_12 for a_12 (Mandel's notation)", [SQRT_2; 3]),
    factors("a_12/2 for a_12", [0.5; 3]),
    factors("a_12, a_13 and a_23 with the wrong sign", [-1.0; 3]),
    factors("a_12 with the wrong sign", [-1.0, 1.0, 1.0]),
    Layout { on_rows: false, ..factors("2 a_ij12 for a_ij12 (a table that contracts without a 2)", [2.0; 3]) },
    order("axes in the order flow,gradient,vorticity", AXES, [1, 0, 2, 3, 5, 4]),
    order("axes in the order vorticity,flow,gradient", AXES, [2, 1, 0, 5, 4, 3]),
    order("axes in the order gradient,vorticity,flow", AXES, [0, 2, 1, 4, 3, 5]),
    order("axes in the order flow,vorticity,gradient", AXES, [2, 0, 1, 4, 5, 3]),
    order("axes in the order vorticity,gradient,flow", AXES, [1, 2, 0, 5, 3, 4]),
];

impl Layout {
    /// The rows of an answer in this layout; `None` if one has other columns.
    pub(super) fn rows(&self, rows: &[Vec<f64>]) -> Option<Vec<Vec<f64>>> {
        rows.iter().map(|row| self.read(row)).collect()
    }

    /// A row of an answer in this layout, as 11, 22, 33, 12, 13, 23, or a_ijkl as pairs of these; `None` for
    /// others.
    fn read(&self, row: &[f64]) -> Option<Vec<f64>> {
        let factor = |k: usize| if k < 3 { 1.0 } else { self.factors[k - 3] };
        let on_row = |k: usize| if self.on_rows { factor(k) } else { 1.0 };
        match row.len() {
            6 => Some((0..6).map(|k| row[self.places[k]] / on_row(k)).collect()),
            21 => {
                let pairs = (0..6).flat_map(|j| (j..6).map(move |k| (j, k)));
                let value = |(j, k)| row[paired(self.places[j], self.places[k])] / (on_row(j) * factor(k));
                Some(pairs.map(value).collect())
            }
            _ => None,
        }
    }
}

/// How far rows are from themselves in the layout of this name.
pub(super) fn of_layout(rows: &[Vec<f64>], name: &str) -> Option<f64> {
    let layout = LAYOUTS.iter().find(|layout| layout.name == name)?;
    Some(apart(rows, &layout.rows(rows)?))
}

/// The right values in other layouts; each of `curves` is a name and the values that a code writes.
pub(super) fn in_other_layouts(curves: &[(Near, Vec<Vec<f64>>)], answer: &Answer, most: f64) -> Vec<Near> {
    let of = |layout: &Layout| {
        let rows = layout.rows(&answer.rows)?;
        let near = curves.iter().filter_map(|(near, curve)| {
            let distance = apart(&rows, curve);
            let name = if near.name.is_empty() {
                layout.name.to_owned()
            } else {
                format!("{}, in {}", near.name, layout.name)
            };
            let (suspects, advice) = (vec![layout.name.to_owned()], layout.advice);
            (distance <= most).then(|| Near { distance, name, suspects, advice, changes: near.changes + 1 })
        });
        Some(near.collect::<Vec<_>>())
    };
    LAYOUTS.iter().filter_map(of).flatten().collect()
}
