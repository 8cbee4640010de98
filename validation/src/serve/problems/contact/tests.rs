//! The contact rule against the naive reference, and A.13 against the motion of an axis.

use super::certified::{BITS, Touched, Vector, angles, arms, axis, touched};
use super::*;
use crate::oracle::naive;
use crate::oracle::reference::big::{Big, double, length};
use rayon::prelude::*;

/// Rods a and b of the naive reference, which solves for the arms and follows the paper's equations one by one.
fn by_naive(pair: &Pair, sign: f64) -> [[f64; 3]; 2] {
    let vector = |at: usize| [pair[at], pair[at + 1], pair[at + 2]];
    let rate = |at: usize, r: f64| naive::jeffery(vector(at), r, COUETTE).map(|x| sign * x);
    let contact =
        naive::collide(vector(0), vector(3), rate(3, pair[6]), vector(7), vector(10), rate(10, pair[13]), COUETTE);
    let contact = contact.expect("no pair is parallel");
    [contact.pdot_a_per_s, contact.pdot_b_per_s]
}

fn worst(pairs: &[Pair], sign: f64) -> f64 {
    let apart = |pair: &Pair| {
        let found = touched(&pair.map(|x| BITS.of(x)));
        let expected = by_naive(pair, sign);
        crate::oracle::worst((0..2).map(move |rod| {
            let size = double(&length(&found[rod].rate));
            let square = |i: usize| (double(&found[rod].rate[i]) - expected[rod][i]).powi(2);
            (0..3).map(square).sum::<f64>().sqrt() / size
        }))
    };
    crate::oracle::worst(pairs.iter().map(apart))
}

#[test]
fn the_naive_reference_passes_and_a_wrong_one_fails() {
    let pairs = pairs();
    let tolerance = crate::serve::problems::named("contact-rule").unwrap().problem.tolerance;
    assert_eq!(pairs.len(), SNAPSHOTS);
    let error = worst(&pairs, 1.0);
    assert!(error < tolerance, "{error:e} {tolerance:e}");
    // Clipping at a rod's length is seen.
    let reach = pairs.iter().flat_map(|pair| doubles::geometry(pair).arms).map(|arm| arm.abs() / LENGTH_MM);
    assert!(reach.filter(|arm| *arm > 1.0).count() > 50);
    // Wrong variant: Jeffery's ṗ with the wrong sign.
    assert!(worst(&pairs, -1.0) > 0.1);
}

#[test]
fn the_tables_are_computed_anew() {
    let conditions: Vec<_> = pairs().par_iter().map(conditions).collect();
    for (k, ((name, table), problem)) in certify().iter().zip(&*PROBLEMS).enumerate() {
        assert_eq!(*name, problem.name);
        assert!(table == problem.table, "{name}: the table is another one");
        let worst = crate::oracle::worst(conditions.iter().map(|of| of[k]));
        assert_eq!(worst.round(), problem.condition, "{name}");
    }
}

/// A different rounding of sines or arms selects the same pairs.
#[test]
fn no_pair_is_near_where_it_would_be_kept_or_not() {
    let last = pairs()[SNAPSHOTS - 1];
    let mut asked = candidates().take_while(|pair| *pair != last).peekable();
    assert!(asked.peek().is_some());
    for pair in asked {
        let numbers = pair.map(|x| BITS.of(x));
        let [a, b] = [axis(&numbers[3..6]), axis(&numbers[10..13])];
        let exact = arms(&numbers, &a, &b).map(|arm| double(&arm).abs() / LENGTH_MM);
        let sine = doubles::geometry(&pair).sine;
        let near = |value: f64, limit: f64| (value / limit - 1.0).abs() < 1e-9;
        assert!(exact.iter().all(|arm| !near(*arm, 0.1) && !near(*arm, LONGEST_ARM)), "{exact:?}");
        assert!(!near(sine, 0.3) && [pair[5], pair[12]].iter().all(|p3| !near(p3.abs(), 0.978)));
        for (arm, exact) in doubles::geometry(&pair).arms.iter().zip(exact) {
            assert!((arm.abs() / LENGTH_MM - exact).abs() <= 1e-13 * exact.max(1.0) / (sine * sine), "{arm} {exact}");
        }
    }
}

/// For each problem the sum over the pair's numbers of |∂answer/∂x||x|/|answer|, for the worse of the two rods, by
/// differences of the certified answer in extended precision.
fn conditions(pair: &Pair) -> Vec<f64> {
    let small = BITS.of(2f64.powi(-64));
    let norm = |x: &[Big]| double(&x.iter().fold(BITS.of(0.0), |sum, x| sum + x.sqr()).sqrt());
    let exact = pair.map(|x| BITS.of(x));
    let moved = (0..exact.len()).map(|at| {
        let mut moved = exact.clone();
        moved[at] += &exact[at] * &small;
        touched(&moved)
    });
    let (before, moved): (_, Vec<_>) = (touched(&exact), moved.collect());
    let of = |problem: &ContactProblem, rod: usize| -> f64 {
        let before = problem.answer(&before[rod]);
        let change = |after: &[Touched; 2]| {
            let after = problem.answer(&after[rod]);
            let change: Vec<_> = after.iter().zip(&before).map(|(x, y)| (x - y) / &small).collect();
            norm(&change) / norm(&before)
        };
        moved.iter().map(change).sum()
    };
    PROBLEMS.iter().map(|problem| of(problem, 0).max(of(problem, 1))).collect()
}

#[test]
fn angles_are_those_of_a_turning_axis() {
    // A.13 corrected gives the rates of p's angles when p turns at ṗ′: checked by differences of atan2 and acos.
    let step = BITS.of(1e-20);
    for pair in &pairs()[..50] {
        for rod in touched(&pair.map(|x| BITS.of(x))) {
            let found = angles(&rod, &step);
            let moved: Vector = [0, 1, 2].map(|i| &rod.p[i] + &rod.rate[i] * &step);
            let theta = (moved[0].sqr() + moved[1].sqr()).sqrt().atan2(&moved[2]);
            let phi = moved[1].atan2(&moved[0]);
            for (angle, expected) in [(&found[2], phi), (&found[3], theta)] {
                // The error is of second order in the step: 1e-40 times the curvature, some hundreds.
                assert!(double(&(angle - expected)).abs() < 1e-36);
            }
            assert!(double(&found[0]) != 0.0 && double(&found[1]) != 0.0);
        }
    }
}
