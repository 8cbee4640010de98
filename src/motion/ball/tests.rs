//! Tests every operation against 300-bit arithmetic: the exact result lies within the ball's error bound.

use super::super::functions::{cosh_sinh_over, exp, exp_and_power, sin_cos};
use super::*;
use dashu_float::FBig;
use dashu_float::round::mode::HalfEven;
use proptest::prelude::*;

type Big = FBig<HalfEven>;

const BITS: usize = 300;

fn big(x: f64) -> Big {
    Big::try_from(x).unwrap().with_precision(BITS).value()
}

fn middle(ball: Ball) -> Big {
    big(ball.hi) + big(ball.lo)
}

/// A number within the ball: its middle plus `share` of its error.
fn within(ball: Ball, share: f64) -> Big {
    middle(ball) + big(share) * big(ball.error)
}

/// The distance of `exact` from the middle, in units of the error; 0 if they are equal.
fn off(ball: Ball, exact: &Big) -> f64 {
    assert!(ball.error >= 0.0, "{ball:?}");
    let apart = middle(ball) - exact;
    let apart = if apart < big(0.0) { -apart } else { apart };
    if apart == big(0.0) { 0.0 } else { (apart / big(ball.error)).to_f64().value() }
}

/// Balls of every kind: doubles and sums of two, with errors from 0 to a thousandth and sizes from 10⁻²⁰ to 10²⁰.
fn ball() -> impl Strategy<Value = Ball> {
    ball_of(-20..20)
}

/// Balls with sizes of these powers of ten.
fn ball_of(powers: std::ops::Range<i32>) -> impl Strategy<Value = Ball> {
    let size = (-1.0f64..1.0, powers).prop_map(|(x, power)| x * 10f64.powi(power));
    let low = prop_oneof![Just(0.0), -0.5f64..0.5];
    let error = prop_oneof![Just(0.0), (-35i32..-3).prop_map(|power| 10f64.powi(power))];
    (size, low, error).prop_map(|(hi, low, error)| Ball {
        hi,
        lo: low * f64::EPSILON * hi * 0.49,
        error: error * hi.abs(),
    })
}

fn share() -> impl Strategy<Value = f64> {
    prop_oneof![Just(-1.0), Just(1.0), -1.0f64..1.0]
}

/// The largest allowed distance in units of the error; the error itself is rounded up.
const ONE: f64 = 1.0;

proptest! {
    #![proptest_config(crate::fixed_seed(1000))]

    /// Products are tested down to the smallest doubles.
    #[test]
    fn sums_and_products_hold_the_exact_ones(a in ball(), b in ball(), s in share(), t in share(),
        power in prop_oneof![Just(0i32), -900i32..0]) {
        let small = b.scaled(libm::scalbn(1.0, power));
        prop_assert!(off(a * small, &(within(a, s) * within(small, t))) <= ONE, "{a:?} * {small:?}");
        let (x, y) = (within(a, s), within(b, t));
        prop_assert!(off(a + b, &(&x + &y)) <= ONE, "{a:?} + {b:?}");
        prop_assert!(off(a - b, &(&x - &y)) <= ONE, "{a:?} - {b:?}");
        prop_assert!(off(a * b, &(&x * &y)) <= ONE, "{a:?} * {b:?}");
    }

    #[test]
    fn sums_that_cancel_hold_the_exact_ones(a in ball(), b in ball(), s in share(), t in share()) {
        let b = Ball { hi: -a.hi, lo: b.lo * a.hi / b.hi.abs().max(1e-300), error: b.error * a.hi.abs() };
        prop_assert!(off(a + b, &(within(a, s) + within(b, t))) <= ONE, "{a:?} + {b:?}");
    }

    /// Quotients are tested down to the smallest doubles.
    #[test]
    fn quotients_hold_the_exact_ones(a in ball(), b in ball(), s in share(), t in share(),
        power in prop_oneof![Just(0i32), 0i32..900]) {
        let b = b.scaled(libm::scalbn(1.0, power));
        prop_assume!(b.least() > 0.0);
        prop_assert!(off(a.over(b), &(within(a, s) / within(b, t))) <= ONE, "{a:?} / {b:?}");
    }

    /// Tested down to the smallest doubles; in the usual range scaling has no rounding.
    #[test]
    fn scaled_ones_hold_the_exact_ones(a in ball_of(-20..20), s in share(), power in -1060i32..900) {
        let scaled = a.scaled(libm::scalbn(1.0, power));
        let exact = within(a, s) * big(2.0).powi(power.into());
        prop_assert!(scaled.is_zero() && a.is_zero() || off(scaled, &exact) <= ONE, "{a:?} {scaled:?}");
        prop_assert!(power < -800 || scaled.error == a.error * libm::scalbn(1.0, power));
        prop_assert_eq!(a.shifted(power), scaled);
        // A power of two that is not a double.
        let far = a.shifted(-3000 - power);
        prop_assert!(far.hi == 0.0 && far.error == if a.is_zero() { 0.0 } else { UNDERFLOW }, "{far:?}");
    }

    #[test]
    fn roots_hold_the_exact_ones(a in ball(), s in share()) {
        let a = if a.hi < 0.0 { -a } else { a };
        let x = within(a, s);
        prop_assume!(x > big(0.0));
        prop_assert!(off(a.sqrt(), &x.sqrt()) <= ONE, "root of {a:?}");
    }

    #[test]
    fn exponentials_hold_the_exact_ones(a in ball_of(-20..5), s in share()) {
        let a = Ball { hi: -a.hi.abs(), lo: if a.hi < 0.0 { a.lo } else { -a.lo }, error: a.error };
        let exact = within(a, s).exp();
        prop_assert!(off(exp(a), &exact) <= ONE, "e to {a:?}");
        let (value, power) = exp_and_power(a);
        let exact = exact * big(2.0).powi((-power).into());
        prop_assert!(off(value, &exact) <= ONE, "e to {a:?}: {value:?} and {power}");
        prop_assert!(a.hi < -3000.0 || (0.5..=2.0).contains(&value.hi));
    }

    #[test]
    fn sines_and_cosines_hold_the_exact_ones(a in ball_of(-20..18), s in share()) {
        let angle = within(a, s) * big(1.0).atan() * big(8.0);
        let (sin, cos) = sin_cos(a);
        // At quarter turns, 300 bits of π leave a small rest where the exact value is 0.
        let zero = |exact: &Big| exact.to_f64().value().abs() < 1e-60;
        let holds = |value: Ball, exact: &Big| off(value, exact) <= ONE || value.is_zero() && zero(exact);
        prop_assert!(holds(sin, &angle.sin()), "sine of {a:?} turns");
        prop_assert!(holds(cos, &angle.cos()), "cosine of {a:?} turns");
    }

    #[test]
    fn hyperbolic_functions_hold_the_exact_ones(a in ball_of(-13..0), s in share()) {
        let a = if a.hi < 0.0 { -a } else { a };
        prop_assume!(a.hi > 1e-15);
        let root = within(a, s).sqrt();
        let (up, down) = (root.exp(), (-&root).exp());
        let (cosh, sinh) = cosh_sinh_over(a);
        prop_assert!(off(cosh, &((&up + &down) / big(2.0))) <= ONE, "cosh √{a:?}");
        prop_assert!(off(sinh, &((up - down) / big(2.0) / root)) <= ONE, "sinh √{a:?}");
    }

    #[test]
    fn an_error_is_no_wider_than_it_must_be(a in ball(), b in ball()) {
        // A thousand roundings of 106 bits beside the operands' errors: a bound as wide as double precision's would
        // fail.
        let rounding = 1e3 * 2f64.powi(-106);
        let (x, y) = (a.error / a.hi.abs(), b.error / b.hi.abs());
        prop_assert!((a * b).error <= (1.01 * (x + y) + x * y + rounding) * (a.hi * b.hi).abs());
        prop_assert!((a + b).error <= 1.01 * (a.error + b.error) + rounding * (a.hi.abs() + b.hi.abs()));
        prop_assert!(a.over(b).error <= (1.02 * (x + y) + rounding) * (a.hi / b.hi).abs());
    }

    #[test]
    fn an_error_of_a_function_is_no_wider_than_it_must_be(a in ball_of(-13..0)) {
        let a = if a.hi < 0.0 { -a } else { a };
        let rounding = 1e3 * 2f64.powi(-106);
        let root = a.sqrt();
        prop_assert!(root.error <= (1.01 * a.error / a.hi + rounding) * root.hi, "{root:?}");
        let power = exp(-a);
        prop_assert!(power.error <= 1.01 * a.error + rounding, "{power:?}");
        let (sin, cos) = sin_cos(a);
        prop_assert!(sin.error.max(cos.error) <= 6.3 * a.error + rounding, "{sin:?} {cos:?}");
        // The derivatives of both functions by z are below 0.6 here.
        let (cosh, sinh) = cosh_sinh_over(a);
        prop_assert!(cosh.error.max(sinh.error) <= 0.6 * a.error + 2.0 * rounding, "{cosh:?} {sinh:?}");
    }
}

#[test]
fn the_most_and_the_least_are_ends_of_the_ball() {
    for (hi, error) in [(3.0, 0.0), (-3.0, 0.5), (1e-200, 1e-201), (2.0, 2.0), (0.25, 1.0)] {
        let ball = Ball { hi, lo: 0.0, error };
        let (most, least) = (hi.abs() + error, (hi.abs() - error).max(0.0));
        // The bounds are beyond the ball's ends, by no more than a few roundings.
        assert!(ball.most() >= most && ball.most() <= most * (1.0 + 1e-15), "{ball:?}");
        assert!(ball.least() <= least && ball.least() >= least * (1.0 - 1e-15), "{ball:?}");
    }
}

#[test]
fn what_is_exact_stays_exact() {
    let (third, half) = (Ball::ONE.over(Ball::exact(3.0)), Ball::exact(0.5));
    assert!(third.error > 0.0 && !third.is_zero());
    assert!((third - third.middle()).error > 0.0);
    assert_eq!((half + half, half * half), (Ball::ONE, Ball::exact(0.25)));
    assert!((half - half).is_zero() && (half * Ball::ZERO).is_zero() && Ball::ZERO.over(half).is_zero());
    assert_eq!(Ball::ONE.over(half), Ball::exact(2.0));
    assert!(Ball::ZERO.over(third).is_zero());
    for dividend in [Ball::ONE, Ball::ZERO] {
        for divisor in [Ball::ZERO, Ball::exact(1e-9).widened(1e-9)] {
            let most = dividend.over(divisor).most();
            assert!(most.is_infinite() || most.is_nan(), "{dividend:?} {divisor:?}");
        }
    }
    // The quotient of these doubles is a double, but one of them has an error.
    let six = Ball::exact(6.0);
    assert!(six.widened(1e-3).over(half).error > 1e-3 && six.over(half.widened(1e-3)).error > 1e-2);
}

#[test]
fn the_constants_are_those_of_300_bits() {
    assert!(off(Ball::TAU, &(big(1.0).atan() * big(8.0))) <= ONE);
    assert!(off(Ball::LN_2, &big(2.0).ln()) <= ONE);
}

#[test]
fn the_root_of_what_may_be_nothing_is_as_wide_as_it_must_be() {
    for (middle, error) in [(0.0, 1e-20), (0.0, 1.0), (0.0, 1e10), (1e-3, 2e-3)] {
        let root = Ball::exact(middle).widened(error).sqrt();
        let most = (middle + error).sqrt();
        assert_eq!((root.hi, root.lo), (0.0, 0.0));
        assert!(root.error >= most && root.error < 1.5 * most, "{root:?} {most}");
    }
}

#[test]
fn what_is_as_good_as_nothing_is_known_to_be_that_small() {
    let small = exp(Ball::exact(-601.0).widened(5.0));
    assert!(small.hi == 0.0 && small.error >= (-596.0f64).exp() && small.error <= 1e-250, "{small:?}");
    let wide = exp(Ball::exact(-601.0).widened(50.0));
    assert!(wide.hi == 0.0 && wide.error >= (-551.0f64).exp(), "{wide:?}");
    let known = exp(Ball::exact(-599.0));
    // The argument has lost the digits of 600, and the doublings lose a factor of eight more.
    assert!(known.hi > 0.0 && known.error < 1e-27 * known.hi, "{known:?}");
}
