use super::*;

fn mean(mean: f64, se: f64, allowance: f64) -> Verdict {
    judge(&Rule::Mean { mean, se, samples: 400, reference: 1.0, allowance, effect: 0.1, because: "".into() })
}

#[test]
fn a_mean_needs_closeness_and_enough_data() {
    assert_eq!(mean(1.02, 0.01, 0.0), Verdict::Pass);
    assert_eq!(mean(1.06, 0.01, 0.0), Verdict::Fail);
    assert_eq!(mean(1.06, 0.01, 0.03), Verdict::Pass);
    assert_eq!(mean(1.02, 0.1, 0.0), Verdict::Underpowered);
    assert_eq!(mean(2.0, 0.1, 0.0), Verdict::Fail, "little data is no excuse for a large error");
    assert_eq!(mean(f64::NAN, 0.01, 0.0), Verdict::Fail);
}

/// A mean of 400 values that must exceed 0, with an effect of 0.1.
fn above_zero(mean: f64, se: f64) -> Rule {
    Rule::Above { mean, se, samples: 400, bound: 0.0, effect: 0.1, because: "".into() }
}

#[test]
fn a_difference_needs_to_be_seen() {
    let above = |mean, se| judge(&above_zero(mean, se));
    assert_eq!(above(0.1, 0.01), Verdict::Pass);
    assert_eq!(above(0.02, 0.01), Verdict::Fail);
    assert_eq!(above(0.02, 0.1), Verdict::Underpowered);
    // Below the bound by four standard errors: underpowered; by six: a failure.
    assert_eq!(above(-0.4, 0.1), Verdict::Underpowered);
    assert_eq!(above(-0.6, 0.1), Verdict::Fail);
    assert_eq!(above(0.0, 0.0), Verdict::Fail, "values that are all at the bound do not exceed it");
    assert_eq!(above(f64::NAN, f64::NAN), Verdict::Fail);
    assert_eq!(above(f64::NAN, 0.01), Verdict::Fail);
}

/// The margin of a mean that is not above its bound.
#[test]
fn a_failure_has_a_margin_where_its_values_scatter_and_is_certain_where_they_do_not() {
    let margin = |mean, se| above_zero(mean, se).margin().unwrap();
    assert_eq!(margin(0.0, 0.0), f64::INFINITY);
    // A large sample fails unless its mean is above by `student`, a small one only if its mean is below by that.
    let large = margin(0.0, 0.01);
    assert!((4.0..6.0).contains(&large), "{large}");
    assert!((margin(0.0, 0.1) + large).abs() < 0.2);
    assert!(margin(-0.01, 0.01) > large && margin(-0.1, 0.1) > margin(0.0, 0.1));
}

#[test]
fn tolerances_are_closed_and_nan_fails() {
    assert_eq!(judge(&Rule::exact(0.0)), Verdict::Pass);
    assert_eq!(judge(&Rule::exact(f64::MIN_POSITIVE)), Verdict::Fail);
    assert_eq!(judge(&Rule::within(-2.0, 2.0, "")), Verdict::Pass);
    assert_eq!(judge(&Rule::within(f64::NAN, 2.0, "")), Verdict::Fail);
}

#[test]
fn a_p_value_needs_samples() {
    let p =
        |p, samples| judge(&Rule::PValue { p, samples, enough: 100, level: LEVEL, distance: None, because: "".into() });
    assert_eq!(p(0.5, 100), Verdict::Pass);
    assert_eq!(p(0.5, 99), Verdict::Underpowered);
    assert_eq!(p(1e-7, 1000), Verdict::Fail);
}

fn distance(distance: Option<f64>, samples: u64) -> Rule {
    Rule::PValue { p: 0.0, samples, enough: 1, level: LEVEL, distance, because: "".into() }
}

fn of_a_million(mean: f64, reference: f64) -> Rule {
    Rule::Mean { mean, se: 0.5, samples: 1_000_000, reference, allowance: 1.0, effect: 100.0, because: "".into() }
}

/// Tests which rules are statistical, and their contributions to the budget.
#[test]
fn the_false_alarms_of_each_rule_by_hand() {
    for (rule, expected) in [
        // The mean may be far off, or its scatter.
        (of_a_million(1.0, 1.0), 4e-6),
        // The effect may be missed, or the scatter too large.
        (above_zero(1.0, 0.1), 6e-6),
        (distance(None, 10), 2e-6),
        (Rule::exact(0.0), 0.0),
    ] {
        assert!((rule.false_alarm() - expected).abs() < 1e-18, "{rule:?}");
        assert_eq!(rule.is_statistical(), expected > 0.0, "{rule:?}");
    }
}

/// For many values the noncentral t distribution is Gaussian: the margin is the distance of a statistic from its
/// critical value.
#[test]
fn margins_by_hand() {
    let critical = student(LEVEL, 1_000_000);
    let near = |margin: Option<f64>, expected: f64| {
        let margin = margin.unwrap();
        assert!((margin - expected).abs() < 1e-3, "{margin} {expected}");
    };
    // Seven off, one of them allowed, with standard errors of ½.
    near(of_a_million(10.0, 3.0).margin(), 12.0 - critical);
    near(of_a_million(-4.0, 3.0).margin(), 12.0 - critical);
    let below = Rule::Above { mean: 1.0, se: 0.5, samples: 1_000_000, bound: 3.0, effect: 100.0, because: "".into() };
    near(below.margin(), critical + 4.0);
    // Massart's bound: twice √n d beyond that of the level.
    let margin = |samples| distance(Some(0.5), samples).margin().unwrap();
    assert!((margin(400) - margin(100) - 10.0).abs() < 1e-12);
    let at_the_level = distance(Some(massart(LEVEL) / 10.0), 100);
    assert!(at_the_level.margin().unwrap().abs() < 1e-12);
    assert_eq!((distance(None, 10).margin(), Rule::exact(1.0).margin()), (None, None));
}

/// The size of a sample and the miss rate of its rule are consistent.
#[test]
fn a_size_is_that_of_its_miss() {
    for (level, miss) in [(LEVEL, MISS), (0.05, 0.02)] {
        for samples in [16, 100, 1_000_000] {
            let needed = needed_noncentrality(level, miss, samples);
            let missed = upper_tail(-noncentral(student(level, samples), needed, samples));
            assert!((missed / miss - 1.0).abs() < 1e-6, "{samples}: {missed}");
        }
    }
    // For many values the deviates add up: 4.7534 for 10⁻⁶ on each side, and 4.4652 for 4·10⁻⁶.
    assert!((needed_noncentrality(LEVEL, MISS, 1_000_000) - 9.2186).abs() < 1e-3);
    // (½ ln 10⁶)^½ + (½ ln 5·10⁵)^½ = 5.18974 over 0.1, squared.
    assert_eq!(kolmogorov_samples(0.1), 2694);
}
