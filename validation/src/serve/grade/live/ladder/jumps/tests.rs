use super::super::climb::reached;
use super::super::tests::{TOLERANCE, ladder, rung};
use super::*;
use std::cell::Cell;

#[test]
fn the_order_by_which_errors_fall_is_that_of_those_above_the_tolerance() {
    for order in [1, 2, 4] {
        let all = ladder(|k| ((0.3 * 2f64.powi(-k * order)).max(1e-9), 1.0));
        let found = falling_order(&all, TOLERANCE);
        assert!((found - f64::from(order)).abs() < 1e-9, "{order}: {found}");
    }
}

/// The judgement on a program with the error `error(steps, count)`, where `count` is the number of requests.
fn judged(error: impl Fn(u64, u32) -> f64) -> End {
    let count = Cell::new(0);
    let ask = |setting: Setting| -> Result<Rung, Asked> {
        count.set(count.get() + 1);
        Ok(rung(setting, error(setting.steps().unwrap(), count.get()), 0.0))
    };
    let mut rungs = Vec::new();
    for k in 0..24 {
        rungs.push(ask(Setting::Steps(8 << k)).unwrap());
        if reached(&rungs, TOLERANCE) {
            return super::judged(&rungs, TOLERANCE, 1, ask);
        }
    }
    panic!("the tolerance is not reached");
}

#[test]
fn what_comes_right_over_many_numbers_of_steps_is_a_method() {
    let of_order = |order: f64| move |steps: u64| (0.5 * (steps as f64 / 16.0).powf(-order)).min(0.57);
    for order in [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 14.0] {
        let right = of_order(order);
        assert_eq!(judged(|steps, _| right(steps)), End::Reached, "{order}");
        // Unstable with fewer than some 200 steps: errors grow by a factor per step.
        let unstable = |steps: u64| right(steps) + 1e-12 * 1.5f64.powi(200 - steps as i32);
        assert_eq!(judged(|steps, _| unstable(steps)), End::Reached, "{order}");
        // Not finite, or too long, where it is unstable.
        for wrong in [f64::NAN, f64::INFINITY, 1e30] {
            let found = judged(|steps, _| if steps < 16 { wrong } else { right(steps) });
            assert_eq!(found, End::Reached, "{order} {wrong}");
        }
        // An accidental zero at a rung.
        let crossing = |steps: u64| right(steps) * (1.0 - 64.0 / steps as f64).abs();
        assert_eq!(judged(|steps, _| crossing(steps)), End::Reached, "{order}");
    }
}

#[test]
fn answers_that_are_wrong_at_some_numbers_of_steps_are_no_methods() {
    for order in [2.0, 4.0, 5.0, 8.0] {
        let right = |steps: u64| 0.5 * (steps as f64 / 16.0).powf(-order);
        let jumps = |found: End| matches!(&found, End::Jumps(words) if words.contains("does not jump"));
        for wrong in [1.2, f64::NAN] {
            let below = judged(|steps, _| if steps < 512 && steps > 8 { wrong } else { right(steps) });
            assert!(jumps(below), "{order} {wrong}");
            let third = judged(|steps, asked| if asked % 3 == 0 && steps > 100 { wrong } else { right(steps) });
            assert!(order > 5.0 || jumps(third), "{order} {wrong}");
        }
        let once = judged(|steps, _| if steps == 512 { 1.2 } else { right(steps) });
        assert!(order > 4.0 || jumps(once), "{order}");
        // The last of an odd number of steps is lost.
        assert!(jumps(judged(|steps, _| if steps % 2 == 1 { 0.4 } else { right(steps) })), "{order}");
        // Right when the same is asked again: what came first counts.
        let spoilt = Cell::new(false);
        let first = judged(|steps, _| if steps == 512 && !spoilt.replace(true) { 1.2 } else { right(steps) });
        assert!(order > 4.0 || jumps(first), "{order}");
    }
}

/// From 180 to 200 steps an explicit method may pass its limit of stability: of 20 steps at once no jump is known. One
/// that is right with fewer steps again is no method's.
#[test]
fn over_several_steps_at_once_a_method_may_become_stable() {
    let judged_by = |unit: u64, error: &dyn Fn(u64) -> f64| {
        let ask = |setting: Setting| Ok(rung(setting, error(setting.steps().unwrap()), 0.0));
        let rungs: Vec<_> = (0..8).map(|k| ask(Setting::Steps(40 << k)).unwrap()).collect();
        super::judged(&rungs, 1e-12, unit, ask)
    };
    let right = |steps: u64| 1e5 * (steps as f64).powi(-4);
    let unstable = |steps: u64| if steps < 200 { 0.16 } else { right(steps) };
    assert_eq!(judged_by(20, &unstable), End::Reached);
    assert!(matches!(judged_by(1, &unstable), End::Jumps(_)));
    let once = |steps: u64| if steps == 320 { 0.16 } else { right(steps) * 1e-2 };
    assert!(matches!(judged_by(20, &once), End::Jumps(_)));
}

#[test]
fn a_tolerance_far_worse_than_both_its_neighbours_is_no_methods() {
    let judged_where = |spoilt: &dyn Fn(i32) -> bool, error: f64| {
        let of = |k: i32| if spoilt(k) { error } else { 3.0 * 10f64.powi(-k) };
        let rungs: Vec<_> = (2..=9).map(|k| rung(Setting::Tolerance(10f64.powi(-k)), of(k), 0.0)).collect();
        super::judged(&rungs, TOLERANCE, 1, |_| Err(Asked::Says("it is not asked".to_owned())))
    };
    let judged = |spoilt: i32, error: f64| judged_where(&|k| k == spoilt, error);
    assert_eq!(judged(0, 0.0), End::Reached);
    // Coarse tolerances miss the motion.
    assert_eq!(judged(2, 1.5), End::Reached);
    assert_eq!(judged(4, 0.03), End::Reached);
    assert!(matches!(judged(6, 1.2), End::Jumps(_)));
    // So may all of them, but not those from which any program follows it.
    assert_eq!(judged_where(&|k| k <= 5, 1.2), End::Reached);
    for last in [6, 7] {
        assert!(matches!(judged_where(&|k| k <= last, 1.2), End::Jumps(_)), "{last}");
    }
}
