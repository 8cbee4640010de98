//! Textbook steps in angles and in p (Hairer, Nørsett & Wanner, Solving Ordinary Differential Equations I, II.1).

use super::Integrator;
use std::ops::{Add, Mul};

/// Euler's step y + h f(y).
#[inline]
pub fn explicit_euler<Y>(f: impl Fn(Y) -> Y, y: Y, h: f64) -> Y
where
    Y: Copy + Add<Output = Y> + Mul<f64, Output = Y>,
{
    y + f(y) * h
}

/// The classical Runge–Kutta step of order 4.
#[inline]
pub fn rk4<Y>(f: impl Fn(Y) -> Y, y: Y, h: f64) -> Y
where
    Y: Copy + Add<Output = Y> + Mul<f64, Output = Y>,
{
    let k1 = f(y);
    let k2 = f(y + k1 * (0.5 * h));
    let k3 = f(y + k2 * (0.5 * h));
    let k4 = f(y + k3 * h);
    y + (k1 + (k2 + k3) * 2.0 + k4) * (h / 6.0)
}

pub(super) fn all() -> [Integrator; 4] {
    [
        Integrator::in_angles("explicit Euler in angles", 1, |problem, angles, h| {
            explicit_euler(|y| problem.angle_rates(&y), angles, h)
        }),
        Integrator::in_angles("RK4 in angles", 4, |problem, angles, h| rk4(|y| problem.angle_rates(&y), angles, h)),
        Integrator::in_p("RK4 in p", 4, |problem, p, h| rk4(|y| problem.rate(&y), p, h)),
        Integrator::in_p("projected RK4 in p", 4, |problem, p, h| rk4(|y| problem.rate(&y), p, h).normalize())
            .keeping_length(),
    ]
}
