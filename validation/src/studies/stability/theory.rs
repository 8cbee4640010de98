//! Longest steps GΔt by theory, for some integrators and properties; derived in `docs/src/developer/step-limits.md`.

use super::*;
use crate::methods::integrators::limits::Property;
use std::f64::consts::{FRAC_1_SQRT_2, PI};

/// A theory of a limit: the integrator, its property, and GΔt against r_e.
pub type LimitTheory = (&'static str, Property, fn(f64) -> f64);

/// Every limit that has a theory at all r_e.
pub const THEORIES: [LimitTheory; 6] = [
    ("explicit Euler in angles", Property::Order, euler_order),
    ("implicit midpoint in p", Property::Order, implicit_midpoint_order),
    ("explicit Euler in angles", Property::Turning, euler_turning),
    ("Lie-group midpoint", Property::Turning, euler_turning),
    ("explicit Euler in angles", Property::Side, euler_side),
    ("implicit midpoint in p", Property::Side, implicit_midpoint_one_solution),
];

/// |Λ| = |r_e² − 1|/(r_e² + 1).
fn shape(aspect_ratio: f64) -> f64 {
    let square = aspect_ratio * aspect_ratio;
    ((aspect_ratio - 1.0) * (aspect_ratio + 1.0) / (square + 1.0)).abs()
}

/// Explicit Euler keeps the order of rods in the plane of shear up to 1/Λ.
pub fn euler_order(aspect_ratio: f64) -> f64 {
    1.0 / shape(aspect_ratio)
}

/// Explicit Euler and the Lie-group midpoint rule turn every rod by less than half a turn up to π/max φ̇:
/// π(1 + 1/r_e²) for a rod.
pub fn euler_turning(aspect_ratio: f64) -> f64 {
    2.0 * PI / (1.0 + shape(aspect_ratio))
}

/// Explicit Euler lets no rod cross the plane of shear up to 2/Λ.
pub fn euler_side(aspect_ratio: f64) -> f64 {
    2.0 / shape(aspect_ratio)
}

/// The implicit midpoint rule has one solution in the plane of shear, which keeps the order of rods, up to
/// 2/(Λ(1 − u²)^{3/2}), with u the root of 2u³ − 3u + 1/Λ = 0 in (0, 1/√2]. Infinite if there is no root: 1/Λ > √2,
/// that is r_e < 1 + √2.
pub fn implicit_midpoint_order(aspect_ratio: f64) -> f64 {
    let shape = shape(aspect_ratio);
    let cubic = |u: f64| 2.0 * u.powi(3) - 3.0 * u + 1.0 / shape;
    if cubic(FRAC_1_SQRT_2) > 0.0 {
        return f64::INFINITY;
    }
    // The cubic falls on this interval.
    let u = bisect(0.0, FRAC_1_SQRT_2, 60, |u| cubic(u) > 0.0)[0];
    2.0 / (shape * (1.0 - u * u).powf(1.5))
}

/// The implicit midpoint rule lets no rod cross the plane of shear up to 4/Λ.
pub fn implicit_midpoint_side(aspect_ratio: f64) -> f64 {
    4.0 / shape(aspect_ratio)
}

/// The implicit midpoint rule has one solution on the whole sphere up to the shorter of the two steps: only up to it is
/// it certain that no rod crosses the plane of shear.
pub fn implicit_midpoint_one_solution(aspect_ratio: f64) -> f64 {
    implicit_midpoint_side(aspect_ratio).min(implicit_midpoint_order(aspect_ratio))
}

/// An explicit Runge–Kutta method of order and stages p ≤ 4 in angles keeps the order of rods at least up to
/// GΔtΛ = x with x + … + xᵖ/p! = 1.
pub fn runge_kutta_order_at_least(order: u32, aspect_ratio: f64) -> f64 {
    let growth = |x: f64| {
        let (mut sum, mut term) = (0.0, 1.0);
        for k in 1..=order {
            term *= x / f64::from(k);
            sum += term;
        }
        sum
    };
    bisect(0.0, 1.0, 60, |x| growth(x) < 1.0)[0] / shape(aspect_ratio)
}

/// As r_e → 1, RK4 in p turns every rod by less than half a turn up to 2√6: R(iy) is real at y = √6 = GΔt/2.
pub fn rk4_turning_of_a_sphere() -> f64 {
    2.0 * 6f64.sqrt()
}

/// As r_e → 1, |p| shrinks by RK4 in p up to 4√2 and grows beyond: |R(iy)| = 1 at y = 2√2 = GΔt/2.
pub fn rk4_length_of_a_sphere() -> f64 {
    4.0 * 2f64.sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ends_by_hand() {
        // r_e → ∞: 2u³ − 3u + 1 = (u − 1)(2u² + 2u − 1).
        let u = 0.5 * (3f64.sqrt() - 1.0);
        let long = 2.0 / (1.0 - u * u).powf(1.5);
        assert!((implicit_midpoint_order(1e9) / long - 1.0).abs() < 1e-12);
        assert!((long - 2.4816).abs() < 1e-4);
        // r_e = 1 + √2: Λ = 1/√2, u = 1/√2.
        let last = 1.0 + 2f64.sqrt();
        assert!((implicit_midpoint_order(last + 1e-9) - 8.0).abs() < 1e-3);
        assert_eq!(implicit_midpoint_order(last - 1e-9), f64::INFINITY);
        assert!((euler_turning(2.0) - PI * 1.25).abs() < 1e-14);
        assert!((runge_kutta_order_at_least(1, 2.0) - 1.0 / 0.6).abs() < 1e-12);
        assert!((runge_kutta_order_at_least(2, 2.0) - (3f64.sqrt() - 1.0) / 0.6).abs() < 1e-12);
    }

    #[test]
    fn discs_are_rods_turned_by_a_right_angle() {
        for theory in [euler_order, euler_turning, euler_side, implicit_midpoint_order, implicit_midpoint_side] {
            for r in [1.1, 3.0, 50.0] {
                assert!((theory(r) / theory(1.0 / r) - 1.0).abs() < 1e-12 || theory(r) == f64::INFINITY);
            }
        }
    }

    #[test]
    fn rk4_of_a_sphere_by_its_stability_function() {
        // R(iy) = 1 − y²/2 + y⁴/24 + i(y − y³/6).
        let r = |y: f64| (1.0 - y * y / 2.0 + y.powi(4) / 24.0, y - y.powi(3) / 6.0);
        let (_, imaginary) = r(0.5 * rk4_turning_of_a_sphere());
        let (re, im) = r(0.5 * rk4_length_of_a_sphere());
        assert!(imaginary.abs() < 1e-14 && (re.hypot(im) - 1.0).abs() < 1e-14);
    }
}
