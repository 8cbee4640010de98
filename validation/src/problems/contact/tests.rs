//! The contact rule against the naive reference, and A.13 against the motion of an axis.

use super::*;
use crate::oracle::naive;

/// Rods a and b of the naive reference, which solves for the arms and follows the paper's equations one by one.
fn by_naive(pair: &Pair, sign: f64) -> [[f64; 3]; 2] {
    let vector = |at: usize| [pair[at], pair[at + 1], pair[at + 2]];
    let rate = |at: usize, r: f64| naive::jeffery(vector(at), r, COUETTE).map(|x| sign * x);
    let contact = naive::collide(
        vector(0),
        vector(3),
        rate(3, pair[6]),
        vector(7),
        vector(10),
        rate(10, pair[13]),
        COUETTE,
    );
    let contact = contact.expect("no pair is parallel");
    [contact.pdot_a_per_s, contact.pdot_b_per_s]
}

fn worst(pairs: &[Pair], sign: f64) -> f64 {
    let apart = |pair: &Pair| {
        let found = touched(&pair.map(|x| BITS.of(x)));
        let expected = by_naive(pair, sign);
        (0..2)
            .map(move |rod| {
                let size = double(&length(&found[rod].rate));
                let square = |i: usize| (double(&found[rod].rate[i]) - expected[rod][i]).powi(2);
                (0..3).map(square).sum::<f64>().sqrt() / size
            })
            .fold(0.0, f64::max)
    };
    pairs.iter().map(apart).fold(0.0, f64::max)
}

#[test]
fn the_naive_reference_passes_and_a_wrong_one_fails() {
    let pairs = pairs();
    let tolerance = crate::problems::build("contact-rule").unwrap().problem.tolerance;
    assert_eq!(pairs.len(), SNAPSHOTS);
    let error = worst(&pairs, 1.0);
    assert!(error < tolerance, "{error:e} {tolerance:e}");
    // Wrong variant: Jeffery's ṗ with the wrong sign.
    assert!(worst(&pairs, -1.0) > 0.1);
}

#[test]
fn angles_are_those_of_a_turning_axis() {
    // A.13 corrected says how the angles of p turn when p turns at ṗ′: by differences of atan2 and acos.
    let step = BITS.of(1e-20);
    for pair in &pairs()[..50] {
        for rod in touched(&pair.map(|x| BITS.of(x))) {
            let found = angles(&rod, &step);
            let moved: Vector = [0, 1, 2].map(|i| &rod.p[i] + &rod.rate[i] * &step);
            let theta = (moved[0].sqr() + moved[1].sqr()).sqrt().atan2(&moved[2]);
            let phi = moved[1].atan2(&moved[0]);
            for (angle, expected) in [(&found[2], phi), (&found[3], theta)] {
                // Of second order in the step: 1e-40 times the curvature, some hundreds.
                assert!(double(&(angle - expected)).abs() < 1e-36);
            }
            assert!(double(&found[0]) != 0.0 && double(&found[1]) != 0.0);
        }
    }
}
