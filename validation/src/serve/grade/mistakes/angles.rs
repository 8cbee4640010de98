//! Mistakes of programs in the angles φ and θ.

use super::{IN_THE_START, Mistake, Setting, curve, right_map};
use nalgebra::Vector3;

/// θ at the end from θ at the start and the growth of tan θ.
type Tilt = fn(f64, f64) -> f64;

pub(super) fn all() -> Vec<Mistake> {
    const ATAN: &str = "atan for atan2, φ only in −π/2 to π/2";
    // d ln|tan θ|/dt is the same for all θ, and that of |tan(θ/2)| half of it where sin θ stands for sin 2θ.
    let tilts: [(&str, Tilt); 5] = [
        ("twice the θ̇", |theta, growth| tilted(theta, growth.powi(2))),
        ("half the θ̇", |theta, growth| tilted(theta, growth.sqrt())),
        ("four times the θ̇", |theta, growth| tilted(theta, growth.powi(4))),
        ("θ̇ with the wrong sign", |theta, growth| tilted(theta, 1.0 / growth)),
        ("sin θ for sin 2θ in θ̇", |theta, growth| 2.0 * tilted(0.5 * theta, growth.sqrt())),
    ];
    let mut all: Vec<_> = tilts.map(|(name, tilt)| curve(name, move |s, p, time| tipped(s, p, time, tilt))).into();
    all.push(curve(ATAN, |s, p, time| Some(in_front(&(right_map(s, time)? * p)))));
    all.push(curve(&format!("{ATAN}{IN_THE_START}"), |s, p, time| Some(right_map(s, time)? * in_front(p))));
    all.push(curve("|p_i| for each p_i", |s, p, time| Some((right_map(s, time)? * p).abs())));
    all.extend((0..3).map(|k| {
        curve(&format!("|p_{0}| for p_{0}", k + 1), move |s, p, time| {
            let mut q = right_map(s, time)? * p;
            q[k] = q[k].abs();
            Some(q)
        })
    }));
    all
}

/// θ whose tangent has grown.
fn tilted(theta: f64, growth: f64) -> f64 {
    (growth * theta.sin()).atan2(theta.cos())
}

/// The right φ with another θ, where the vorticity axis stays: elsewhere φ̇ depends on θ.
fn tipped(setting: &Setting, p: &Vector3<f64>, time_s: f64, tilt: Tilt) -> Option<Vector3<f64>> {
    let l = &setting.gradient_per_s;
    if [l.m13, l.m23, l.m31, l.m32] != [0.0; 4] {
        return None;
    }
    let map = right_map(setting, time_s)?;
    let q = map * p;
    let [start, end] = [p, &q].map(|p| p.x.hypot(p.y));
    if start == 0.0 {
        return Some(q);
    }
    let (sin, cos) = tilt(start.atan2(p.z), end / start / map.m33).sin_cos();
    Some(Vector3::new(sin * q.x / end, sin * q.y / end, cos))
}

/// The rod whose φ is that of atan: p_1 is not below 0.
fn in_front(p: &Vector3<f64>) -> Vector3<f64> {
    if p.x < 0.0 { Vector3::new(-p.x, -p.y, p.z) } else { *p }
}
