use super::*;
use crate::methods::least_squares::emulator::Replica;
use crate::serve::fit::tests::searched;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Dxsm;

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
        let sides = other_sides(&fit, &whole(&fit.ranges), far).0;
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

/// Of a plane with noise the lowest degree is taken, with fewer terms that follow it; of a wave the highest.
#[test]
fn polynomials_have_the_degree_that_the_model_needs() {
    let terms = |bend: f64, scatter: f64| {
        let model = move |values: &[f64]| {
            let (x, y) = (values[0], values[1]);
            // Noise of its own at each place, as that of collisions.
            let noise = move |replica: u64, k: u64| {
                let seed = x.to_bits() ^ y.to_bits().rotate_left(17) ^ replica.rotate_left(40) ^ k;
                scatter * (Pcg64Dxsm::seed_from_u64(seed).random::<f64>() - 0.5)
            };
            let at = move |t: f64| t * x + (1.0 - t) * y + bend * (3.0 * (x + y * t)).sin();
            Ok(Replica::whole(move |replica| Ok((0..6).map(|k| [at(k as f64 / 5.0) + noise(replica, k); 3]).collect())))
        };
        let data: Vec<_> =
            (0..6).map(|k| Datum { value: 0.0, u: 0.4, ..Datum::place(0, "x1", f64::from(k)) }).collect();
        searched(&data, &["a.x=-1:1", "a.y=-1:1"], &model, 50).emulator.mean().nrows()
    };
    // Terms of degree 4 and 6 in two parameters.
    assert_eq!([terms(0.0, 1.0), terms(0.3, 0.0)], [15, 28]);
}
