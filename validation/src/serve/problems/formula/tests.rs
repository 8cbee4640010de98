//! Formulas by second ways: the derivative of the exact motion, limits in closed form, and laws.

use super::*;
use crate::oracle::reference::big::{double, length};
use crate::oracle::reference::motion::{Motion, Unit, image};
use nalgebra::Vector3;

/// ṗ is the derivative at t = 0 of the exact motion, q/|q| with a matrix exponential.
#[test]
fn pdot_is_the_derivative_of_the_exact_motion() {
    const WIDE: Bits = Bits(400);
    let step = 1e-20;
    for problem in PROBLEMS.iter().filter(|problem| problem.formula == Formula::Pdot) {
        for row in (problem.inputs)(&problem.formula) {
            let l = inputs::gradient(&row);
            let gradient_per_s = std::array::from_fn(|i| std::array::from_fn(|j| l[(i, j)]));
            let motion = Motion { gradient_per_s, aspect_ratio: row[12] };
            let at = |time: f64| {
                let map = motion.map(&WIDE.of(time), Unit::Second, WIDE).unwrap();
                let q = image(&map, &[0, 1, 2].map(|i| WIDE.of(row[i])));
                let size = length(&q);
                q.map(|x| x / &size)
            };
            let (before, after) = (at(-step), at(step));
            let asked = pdot(&row);
            let off = |sign: f64| {
                let each = (0..3).map(|i| {
                    let slope = (&after[i] - &before[i]) / WIDE.of(2.0 * step);
                    double(&(slope - WIDE.of(sign) * &asked[i])).abs()
                });
                crate::oracle::worst(each)
            };
            // |p| is 1 to a rounding, and the formula takes p as it is.
            assert!(off(1.0) < 2e-15, "{} {row:?}: {:e}", problem.name, off(1.0));
            assert!(off(-1.0) > 1e-4 || asked.iter().all(|x| double(x).abs() < 1e-3));
        }
    }
}

#[test]
fn inputs_are_exact_and_their_flows_have_no_divergence() {
    for problem in &*PROBLEMS {
        let rows = (problem.inputs)(&problem.formula);
        for row in &rows {
            if problem.formula != Formula::Pdot {
                let a = tensor(row);
                assert_eq!(a.trace(), 1.0);
                assert!(a.symmetric_eigenvalues().min() > -1e-6, "{a}");
            } else {
                assert!((Vector3::from_row_slice(&row[..3]).norm() - 1.0).abs() < 4.0 * f64::EPSILON);
            }
            if row.len() > 6 {
                assert_eq!(inputs::gradient(row).trace(), 0.0);
            }
        }
        assert!(rows.len() >= 30);
    }
}

fn certified(name: &str) -> Vec<Vec<f64>> {
    let built = crate::serve::problems::named(name).unwrap();
    built.loaded(name.into()).certified.rows.iter().map(|row| row[1..].to_vec()).collect()
}

/// Aligned rods and rods random in a plane have one a_ijkl, which these closures must give; rods random in space too.
#[test]
fn closures_are_exact_at_the_corners_where_they_claim_to_be() {
    let place = |name: &str| FOURTH.iter().position(|column| *column == name).unwrap();
    // The rows after the random ones: aligned along 1 and along 2, random in the planes 12 and 23, random in space.
    let corner = |name: &str, row: usize, column: &str| certified(name)[30 + row][place(column)];
    for name in ["closure-quadratic", "closure-hybrid", "closure-natural"] {
        assert!((corner(name, 0, "a1111") - 1.0).abs() < 2e-12, "{name}");
        assert!((corner(name, 1, "a2222") - 1.0).abs() < 2e-12, "{name}");
    }
    for (column, value) in [("a1111", 0.375), ("a1122", 0.125), ("a1212", 0.125), ("a3333", 0.0)] {
        assert!((corner("closure-natural", 2, column) - value).abs() < 4e-12, "{column}");
        assert!((corner("closure-quadratic", 2, column) - value).abs() > 0.1 || value == 0.0, "{column}");
    }
    // a_ij there is a third to 1e-6.
    for name in ["closure-linear", "closure-hybrid", "closure-natural", "closure-ibof"] {
        let off = (corner(name, 4, "a1212") - 1.0 / 15.0).abs();
        assert!(off < if name == "closure-ibof" { 1e-2 } else { 1e-5 }, "{name}: {off:e}");
    }
}

/// Laws of certified values that no formula was given: a_ijkk = a_ij, da_ii/dt = 0.
#[test]
fn certified_values_have_the_traces_that_they_must_have() {
    for problem in PROBLEMS.iter().filter(|problem| problem.formula != Formula::Pdot) {
        let (rows, inputs) = (certified(&problem.name), (problem.inputs)(&problem.formula));
        for (values, input) in rows.iter().zip(&inputs) {
            let off = if matches!(problem.formula, Formula::Dadt { .. }) {
                values[..3].iter().sum::<f64>().abs()
            } else {
                let sum = |columns: [&str; 3]| {
                    let at = |column: &str| FOURTH.iter().position(|other| *other == column).unwrap();
                    columns.iter().map(|column| values[at(column)]).sum::<f64>()
                };
                let first = sum(["a1111", "a1122", "a1133"]) - input[0];
                first.abs().max((sum(["a1112", "a2212", "a3312"]) - input[3]).abs())
            };
            assert!(off < 5e-12, "{}: {off:e}", problem.name);
        }
    }
}
