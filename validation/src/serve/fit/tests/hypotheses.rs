//! Tests of hypotheses: against the textbook for a straight model, and the rate at which a true one is rejected for a
//! curved model.

use super::*;
use crate::serve::fit::{Hypothesis, Tested};

const TIMES: usize = 20;
const NOISE: f64 = 0.02;
const REPLICAS: u64 = 30;

/// A curve of two sets with a rate each, decaying or straight.
type Curve = fn(rate: f64, time: f64) -> f64;

fn decay(rate: f64, time: f64) -> f64 {
    0.2 + 0.5 * (-rate * time).exp()
}

fn straight(rate: f64, time: f64) -> f64 {
    rate * (0.5 + time)
}

fn places() -> impl Iterator<Item = (usize, f64)> {
    (0..2).flat_map(|set| (0..TIMES).map(move |k| (set, 0.1 * (k + 1) as f64)))
}

fn points(curve: Curve, rates: [f64; 2], seed: u64) -> Vec<Datum> {
    let curve = places().map(|(set, time)| (set, time, curve(rates[set], time)));
    noisy(curve, NOISE, &mut Pcg64Dxsm::seed_from_u64(seed))
}

/// The fit over one fixed box.
fn fit(curve: Curve, rates: [f64; 2], seed: u64) -> Fit {
    let data = points(curve, rates, seed);
    let sides = vec![(0.3_f64.ln(), 1.8_f64.ln()), (0.3, 1.8)];
    let model = |values: &[f64]| {
        let values = values.to_vec();
        Ok(Replica::whole(move |replica| {
            let offset = 0.02 * normal(&mut Pcg64Dxsm::seed_from_u64(1_000_003 * seed + replica));
            Ok(places().map(|(set, time)| [curve(values[set], time) + offset; 3]).collect())
        }))
    };
    over_box(&data, &Rods::none(2), &["1:a.rate=0.2:2", "2:a.rate=0.3:1.8"], &sides, &model, REPLICAS)
}

fn tested(fit: &Fit, text: &str) -> Tested {
    Hypothesis::parse(text).unwrap().test(fit).unwrap()
}

#[test]
fn a_straight_model_has_the_tests_of_the_textbook() {
    let fit = fit(straight, [1.0, 1.005], 1);
    let [a, b] = [0, 1].map(|axis| fit.value(axis, fit.best.place[axis]));
    let covariance = fit.covariance();
    // Wald's test, which equals the likelihood ratio for a linear model.
    let value = tested(&fit, "2:a.rate=1.01");
    let expected = (b - 1.01_f64).powi(2) / covariance[(1, 1)];
    assert!((value.rise_of_chi2 / expected - 1.0).abs() < 0.05, "{value:?} {expected}");
    assert_eq!((value.difference, value.beyond_the_box), (None, false));
    let law = ChiSquared::new(1.0).unwrap();
    assert_eq!(value.p_value, law.sf(value.rise_of_chi2));

    let square = covariance[(0, 0)] + covariance[(1, 1)] - 2.0 * covariance[(0, 1)];
    let both = tested(&fit, "1:a.rate=2:a.rate");
    let expected = (a - b).powi(2) / square;
    assert!((both.rise_of_chi2 / expected - 1.0).abs() < 0.05, "{both:?} {expected}");
    let found = both.difference.unwrap();
    assert_eq!(found.estimate, a - b);
    let u = square.sqrt();
    let ends = [found.low_95, found.low_68, found.high_68, found.high_95];
    for (end, deviations) in ends.iter().zip([-1.959_964, -0.994_458, 0.994_458, 1.959_964]) {
        assert!((end - (a - b + deviations * u)).abs() < 0.03 * u, "{end} {} {u}", a - b);
    }
    let turned = tested(&fit, "2:a.rate=1:a.rate");
    assert!((turned.rise_of_chi2 - both.rise_of_chi2).abs() < 1e-3 * both.rise_of_chi2);
    assert!((turned.difference.unwrap().high_95 + found.low_95).abs() < 0.01 * u);

    // A value far away, outside the last box.
    let far = tested(&fit, "1:a.rate=1.95");
    assert!(far.beyond_the_box && far.p_value == 1e-6, "{far:?}");
}

/// The rise of χ² under a true hypothesis has the law of χ² with one degree of freedom: its mean is 1 and its variance
/// 2, which shows a wrong rise in half as many fits as the share of them that is rejected. A wrong hypothesis is
/// rejected nearly always.
#[test]
fn a_true_hypothesis_is_rejected_as_often_as_the_level_says() {
    // A rise twice as large, with which 16 % of true hypotheses would be rejected at the level of 5 %.
    const EFFECT: f64 = 0.9;
    // A share of rejected hypotheses between 4 and 6 %.
    const ALLOWANCE: f64 = 0.08;
    let count = enough(2_f64.sqrt(), EFFECT) as u64;
    let of = |rates: [f64; 2], count: u64| {
        let one = |k: u64| tested(&fit(decay, rates, 100 + k), "1:a.rate=2:a.rate");
        (0..count).into_par_iter().map(one).collect::<Vec<_>>()
    };
    let alike = of([0.8, 0.8], count);
    let verdict = |factor: f64| {
        let rises: Vec<f64> = alike.iter().map(|found| factor * found.rise_of_chi2).collect();
        judge(&mean(&rises, (1.0, 2_f64.sqrt()), ALLOWANCE, EFFECT))
    };
    assert_eq!(verdict(1.0), Verdict::Pass);
    // Controls: a rise three times as large, and rates that differ.
    assert_eq!(verdict(3.0), Verdict::Fail);
    let apart = of([1.2, 0.8], 20);
    assert!(apart.iter().filter(|found| found.p_value < 0.05).count() > 15, "{apart:?}");
    for found in alike.iter().filter_map(|found| Some((found.p_value, found.difference?))) {
        let (p, difference) = found;
        // The interval contains 0 exactly if the test does not reject.
        assert_eq!((difference.low_95..=difference.high_95).contains(&0.0), p >= 0.05, "{found:?}");
    }
}

#[test]
fn what_is_no_hypothesis_is_refused_with_what_is_allowed() {
    let ranges = ["1:a.rate=0.1:4", "2:a.rate=0.1:4", "a.b=1:2", "4:a.rate=5:6"];
    let ranges = ranges.map(|text| Range::parse(text).unwrap());
    let checked = |text: &str| Hypothesis::parse(text)?.check(&ranges).map_err(|error| error.to_string());
    for (text, named) in [
        ("alpha", "KEY=VALUE"),
        ("a.b=x", "\"x\" is no value"),
        ("a.b=inf", "\"inf\" is no value"),
        ("1:a.rate=1:a.rate", "SET:KEY=OTHER:KEY"),
        ("1:a.rate=2:a.b", "\"2:a.b\" is no value"),
        ("a b=1", "no key"),
        ("a.c=1", "a.c is not fitted; it must be one of 1:a.rate, 2:a.rate, a.b, 4:a.rate"),
        ("1:a.rate=3:a.rate", "3:a.rate is not fitted"),
        ("1:a.rate=4:a.rate", "have no value in common"),
        ("a.b=3", "3 is outside the range, 1 to 2"),
    ] {
        let error = checked(text).unwrap_err();
        assert!(error.contains(named), "{text}: {error}");
    }
    for text in ["a.b=1", "2:a.rate=0.5", "2:a.rate = 1:a.rate"] {
        assert_eq!(checked(text), Ok(()), "{text}");
    }
}
