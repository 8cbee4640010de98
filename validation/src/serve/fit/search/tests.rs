use super::*;
use crate::methods::least_squares::emulator::Replica;
use crate::serve::fit::tests::searched;

/// Of a straight line, along which χ² rises as a square.
#[test]
fn a_closer_box_is_three_quarters_as_wide() {
    let model = |values: &[f64]| {
        let value = values[0];
        Ok(Replica::whole(move |_| Ok(vec![[value; 3]; 4])))
    };
    let data: Vec<_> = (0..4).map(|k| Datum { value: 0.0, u: 0.2, ..Datum::place(0, "x1", f64::from(k)) }).collect();
    let fit = searched(&data, &["a.rate=-9:9"], &model, 3);
    let width = |far: f64| {
        let sides = other_sides(&fit, &whole(&fit.ranges), far, WORTH).0;
        sides[0].1 - sides[0].0
    };
    // Five standard deviations of 0.1 to either side, and 3.75.
    assert!((width(FAR) - 1.0).abs() < 1e-3 && (width(NEAR) - 0.75).abs() < 1e-3, "{} {}", width(FAR), width(NEAR));
}

/// A share s of the variance at n replicas becomes s/(s + (1 − s) k) at k n replicas.
#[test]
fn replicas_for_a_share_are_enough_and_a_tenth_more() {
    // From 0.2 to 0.1: k = 0.25 · 9 = 2.25.
    assert_eq!(enough(100, 0.2, 0.1), 249);
    // At most ten times as many, also for a share of 1.
    assert_eq!(enough(100, 0.9, 0.1), 1001);
    assert_eq!(enough(100, 1.0, 0.5), 1001);
}
