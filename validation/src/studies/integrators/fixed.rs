//! Textbook steps in angles and in p (Hairer, Nørsett & Wanner, Solving Ordinary Differential Equations I, II.1).

use super::{FixedStep, InAngles, Integrator, Problem};
use nalgebra::{Vector2, Vector3};
use std::ops::{Add, Mul};

/// y + h f(y).
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

pub(super) fn all() -> Vec<Box<dyn Integrator>> {
    vec![
        Box::new(InAngles {
            name: "explicit Euler in angles",
            order: 1,
            step: |problem: &Problem, angles: Vector2<f64>, h| {
                explicit_euler(|y| problem.angle_rates(&y), angles, h)
            },
        }),
        Box::new(InAngles {
            name: "RK4 in angles",
            order: 4,
            step: |problem: &Problem, angles: Vector2<f64>, h| rk4(|y| problem.angle_rates(&y), angles, h),
        }),
        Box::new(FixedStep {
            name: "RK4 in p",
            order: 4,
            keeps_length: false,
            step: |problem: &Problem, p: Vector3<f64>, h| rk4(|y| problem.rate(&y), p, h),
        }),
        Box::new(FixedStep {
            name: "projected RK4 in p",
            order: 4,
            keeps_length: true,
            step: |problem: &Problem, p: Vector3<f64>, h| rk4(|y| problem.rate(&y), p, h).normalize(),
        }),
    ]
}
