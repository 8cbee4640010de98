//! The rotation of an axis: Jeffery's motion, and the moves of a rod in a collision.

use super::mistake::{Mistake, either};
use nalgebra::{Matrix3, Rotation3, Unit, Vector3};

pub(super) fn vector(x: [f64; 3]) -> Vector3<f64> {
    Vector3::from(x)
}

pub(super) fn matrix(rows: [[f64; 3]; 3]) -> Matrix3<f64> {
    Matrix3::from_fn(|i, j| rows[i][j])
}

/// W + Lambda D, the matrix that makes Jeffery's equation linear, 1/s.
pub(super) fn jeffery_matrix(gradient: Matrix3<f64>, lambda: f64) -> Matrix3<f64> {
    let spin = (gradient - gradient.transpose()) / 2.0;
    let strain = (gradient + gradient.transpose()) / 2.0;
    spin + strain * lambda
}

pub(super) fn shape_factor(aspect_ratio: f64) -> f64 {
    (aspect_ratio * aspect_ratio - 1.0) / (aspect_ratio * aspect_ratio + 1.0)
}

/// Jeffery's pdot = W p + Lambda (D p - p (p.D.p)) of a free rod, 1/s (A.1 for a unit vector).
pub fn jeffery(p: [f64; 3], aspect_ratio: f64, gradient_per_s: [[f64; 3]; 3]) -> [f64; 3] {
    // p.(W + Lambda D).p = Lambda p.D.p because W is antisymmetric.
    let q = jeffery_matrix(matrix(gradient_per_s), shape_factor(aspect_ratio)) * vector(p);
    (q - vector(p) * vector(p).dot(&q)).into()
}

/// sin theta of an axis; exactly 0 at both poles, unlike sin(acos(p_3)) at p_3 = -1.
pub(super) fn sin_theta(p: [f64; 3]) -> f64 {
    p[0].hypot(p[1])
}

/// phi and theta of an axis, rad.
pub(super) fn angles_rad(p: [f64; 3]) -> [f64; 2] {
    [p[1].atan2(p[0]), sin_theta(p).atan2(p[2])]
}

pub(super) fn axis([phi, theta]: [f64; 2]) -> [f64; 3] {
    let sin = theta.sin();
    [sin * phi.cos(), sin * phi.sin(), theta.cos()]
}

/// phidot' and thetadot' (A.13), rad/s; `w` is V'_r / r.
fn angle_rates_per_s([phi, theta]: [f64; 2], w: [f64; 3], made: Option<Mistake>) -> [f64; 2] {
    let (sin, cos) = theta.sin_cos();
    // the printed equation exchanges sin and cos, and does not divide by sin
    let (sin, cos, divisor) = either(made, Mistake::PrintedA13, (cos, sin, 1.0), (sin, cos, sin));
    let along = w[0] * phi.cos() + w[1] * phi.sin();
    let across = -w[0] * phi.sin() + w[1] * phi.cos();
    [across / divisor, along * cos - w[2] * sin]
}

/// A.14: phi' = phi + phidot' dt, theta' = theta + thetadot' dt.
pub(super) fn moved_by_angles(p: [f64; 3], pdot: [f64; 3], dt_s: f64, made: Option<Mistake>) -> [f64; 3] {
    let [phi, theta] = angles_rad(p);
    let [phi_dot, theta_dot] = angle_rates_per_s([phi, theta], pdot, made);
    axis([phi + phi_dot * dt_s, theta + theta_dot * dt_s])
}

/// The axis turned about p x pdot by |pdot| dt.
pub(super) fn rotated(p: [f64; 3], pdot: [f64; 3], dt_s: f64) -> [f64; 3] {
    turned(p, p, pdot, dt_s)
}

/// `axis` turned about p x rate by |rate| dt, where `rate` is normal to p.
pub(super) fn turned(axis: [f64; 3], p: [f64; 3], rate: [f64; 3], dt_s: f64) -> [f64; 3] {
    let Some(about) = Unit::try_new(vector(p).cross(&vector(rate)), 0.0) else {
        return axis;
    };
    let turn = Rotation3::from_axis_angle(&about, vector(rate).norm() * dt_s);
    (turn * vector(axis)).normalize().into()
}

/// Means of |p_i| (eq. 4; the modulus because p and -p are the same rod).
pub fn mean_projections(orientations: &[[f64; 3]]) -> [f64; 3] {
    let sum = |i: usize| orientations.iter().map(|p| p[i].abs()).sum::<f64>();
    [0, 1, 2].map(|i| sum(i) / orientations.len() as f64)
}
