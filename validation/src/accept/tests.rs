use super::*;

fn mean(mean: f64, se: f64, allowance: f64) -> Verdict {
    judge(&Rule::Mean {
        mean,
        se,
        samples: 400,
        reference: 1.0,
        allowance,
        effect: 0.1,
        because: "".into(),
    })
}

#[test]
fn a_mean_needs_closeness_and_enough_data() {
    assert_eq!(mean(1.02, 0.01, 0.0), Verdict::Pass);
    assert_eq!(mean(1.06, 0.01, 0.0), Verdict::Fail);
    assert_eq!(mean(1.06, 0.01, 0.03), Verdict::Pass);
    assert_eq!(mean(1.02, 0.1, 0.0), Verdict::Underpowered);
    assert_eq!(
        mean(2.0, 0.1, 0.0),
        Verdict::Fail,
        "little data is no excuse for a large error"
    );
    assert_eq!(mean(f64::NAN, 0.01, 0.0), Verdict::Fail);
}

/// A mean of 400 values that is to exceed 0, and by 0.1 surely does.
fn above_zero(mean: f64, se: f64) -> Rule {
    Rule::Above {
        mean,
        se,
        samples: 400,
        bound: 0.0,
        effect: 0.1,
        because: "".into(),
    }
}

#[test]
fn a_difference_needs_to_be_seen() {
    let above = |mean, se| judge(&above_zero(mean, se));
    assert_eq!(above(0.1, 0.01), Verdict::Pass);
    assert_eq!(above(0.02, 0.01), Verdict::Fail);
    assert_eq!(above(0.02, 0.1), Verdict::Underpowered);
    // Below the bound by four of its errors: hidden; by six: a failure.
    assert_eq!(above(-0.4, 0.1), Verdict::Underpowered);
    assert_eq!(above(-0.6, 0.1), Verdict::Fail);
    assert_eq!(above(f64::NAN, f64::NAN), Verdict::Fail);
    assert_eq!(above(f64::NAN, 0.01), Verdict::Fail);
}

/// How surely a mean that is not above its bound is seen again.
#[test]
fn a_failure_has_a_margin_where_its_values_scatter_and_is_certain_where_they_do_not() {
    let margin = |mean, se| above_zero(mean, se).margin().unwrap();
    assert_eq!(margin(0.0, 0.0), f64::INFINITY);
    // A large sample fails unless its mean is above by `student`, a small one only where it is below by that.
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
    let p = |p, samples| {
        judge(&Rule::PValue {
            p,
            samples,
            enough: 100,
            distance: None,
            because: "".into(),
        })
    };
    assert_eq!(p(0.5, 100), Verdict::Pass);
    assert_eq!(p(0.5, 99), Verdict::Underpowered);
    assert_eq!(p(1e-7, 1000), Verdict::Fail);
}
