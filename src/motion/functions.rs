//! Exponential, sine and cosine of numbers with an error bound.

use super::ball::Ball;
use std::sync::LazyLock;

/// 1/n!.
pub(super) static INVERSE_FACTORIALS: LazyLock<[Ball; 34]> = LazyLock::new(|| {
    let mut all = [Ball::ONE; 34];
    for n in 1..all.len() {
        all[n] = all[n - 1].over(Ball::exact(n as f64));
    }
    all
});

/// A bound on the truncation error of every series here: twice the next term.
const LEFT_OUT: f64 = 1e-33;

/// eˣ for x ≤ 0.
pub(super) fn exp(x: Ball) -> Ball {
    // Below e⁻⁶⁰⁰ the result is negligible beside anything it is added to: 0 with a bound.
    if x.hi < -600.0 {
        return Ball::ZERO.widened(if x.hi + x.error < -590.0 { 1e-250 } else { 1.0 });
    }
    let (value, power) = exp_and_power(x);
    value.scaled(libm::scalbn(1.0, power))
}

/// eˣ for x ≤ 0 as a number between ½ and 2 and a power of two: e^{−1000} underflows, but 2^{1000} times it does not.
pub(super) fn exp_and_power(x: Ball) -> (Ball, i32) {
    if x.is_zero() {
        return (Ball::ONE, 0);
    }
    // Below e⁻³⁰⁰⁰ < 2⁻⁴³²⁸ the result is negligible beside any quotient of two doubles.
    if x.hi < -3000.0 {
        return if x.hi + x.error < -3000.0 {
            (Ball::ZERO.widened(1.0), -4328)
        } else {
            (Ball::ZERO.widened(1.0 + libm::exp(x.hi + x.error)), 0)
        };
    }
    let powers_of_two = (x.hi / std::f64::consts::LN_2).round();
    let rest = x.middle() - Ball::exact(powers_of_two) * Ball::LN_2;
    // |rest| ≤ 0.35, an eighth of it 0.044: 0.044¹⁷/17! < 10⁻³⁷.
    let eighth = rest.scaled(0.125);
    let mut less_one = (1..17).rev().fold(Ball::ZERO, |sum, n| sum * eighth + INVERSE_FACTORIALS[n]) * eighth;
    for _ in 0..3 {
        less_one = less_one.scaled(2.0) + less_one * less_one;
    }
    let value = Ball::ONE + less_one;
    let value = value.widened(value.hi * (LEFT_OUT + libm::expm1(x.error) * (1.0 + 8.0 * f64::EPSILON)));
    (value, powers_of_two as i32)
}

/// The sine and cosine of 2π·`turns`; exact at quarter turns.
pub(super) fn sin_cos(turns: Ball) -> (Ball, Ball) {
    let mut rest = turns.middle();
    let mut quarters = 0.0;
    // Done twice: for large turns the low part is not less than one either.
    for _ in 0..2 {
        let nearest = (4.0 * rest.hi).round();
        rest = rest - Ball::exact(0.25 * nearest);
        quarters += nearest % 4.0;
    }
    let angle = Ball::TAU * rest;
    let z = -(angle * angle);
    // |angle| ≤ π/4: (π/4)³⁰/30! < 10⁻³⁵.
    let sin = horner(z, 29) * angle;
    let cos = horner(z, 28);
    let moved = (std::f64::consts::TAU * 1.001 * turns.error).min(2.0);
    let (sin, cos) = match quarters.rem_euclid(4.0) as u8 {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    };
    let widened = |value: Ball| {
        if value.is_zero() && moved == 0.0 { value } else { value.widened(moved + LEFT_OUT * value.hi.abs()) }
    };
    (widened(sin), widened(cos))
}

/// Σ zᵏ/n! over n = `last`, `last` − 2, … with k counted from the end: the cosine for an even `last`, the sine over its
/// argument for an odd one.
fn horner(z: Ball, last: usize) -> Ball {
    (0..=last).rev().step_by(2).fold(Ball::ZERO, |sum, n| sum * z + INVERSE_FACTORIALS[n])
}

/// cosh √z and sinh √z / √z, computed without a root, for |z| ≤ 1.
pub(super) fn cosh_sinh_over(z: Ball) -> (Ball, Ball) {
    let (cosh, sinh) = (horner(z, 30), horner(z, 31));
    (cosh.widened(LEFT_OUT), sinh.widened(LEFT_OUT))
}
