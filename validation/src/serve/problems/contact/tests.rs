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
    let tolerance = crate::serve::problems::named("contact-rule").unwrap().problem.tolerance;
    assert_eq!(pairs.len(), SNAPSHOTS);
    let error = worst(&pairs, 1.0);
    assert!(error < tolerance, "{error:e} {tolerance:e}");
    // Wrong variant: Jeffery's ṗ with the wrong sign.
    assert!(worst(&pairs, -1.0) > 0.1);
}

/// By differences in many digits, of the certified answer itself.
fn condition_in_many_digits(pair: &Pair, step: &Big, answer: Answer) -> f64 {
    let small = BITS.of(2f64.powi(-64));
    let of = |pair: &[Big; 14]| touched(pair).map(|rod| answer(&rod, step));
    let norm = |x: &[Big]| double(&x.iter().fold(BITS.of(0.0), |sum, x| sum + x.sqr()).sqrt());
    let exact = pair.map(|x| BITS.of(x));
    let before = of(&exact);
    let mut sums = [0.0; 2];
    for at in 0..exact.len() {
        let mut moved = exact.clone();
        moved[at] += &exact[at] * &small;
        for (rod, after) in of(&moved).iter().enumerate() {
            let change: Vec<_> = (after.iter().zip(&before[rod])).map(|(x, y)| (x - y) / &small).collect();
            sums[rod] += norm(&change) / norm(&before[rod]);
        }
    }
    sums[0].max(sums[1])
}

#[test]
fn condition_numbers_are_those_of_the_certified_answers() {
    let step_s = period_s(ASPECT_RATIO) / 200.0;
    for pair in &pairs()[..20] {
        for (step_s, answer) in [(None, (|rod, _| rod.rate.to_vec()) as Answer), (Some(step_s), angles)] {
            let expected = condition_in_many_digits(pair, &BITS.of(step_s.unwrap_or_default()), answer);
            let found = condition(pair, step_s);
            // ε^(2/3) κ², κ up to a thousand; the tolerance is rounded up to one digit.
            assert!((found / expected - 1.0).abs() < 1e-3, "{found} {expected}");
        }
    }
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
