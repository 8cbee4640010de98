//! The motion of a free rod in a flow that is steady or turns, and what it makes of a direction: the curves of known
//! mistakes take thousands of maps for one answer.

use crate::integrators::apart_rad;
use nalgebra::{Matrix3, Rotation3, Vector3};
use shearbed::model::flow::VelocityGradient;
use shearbed::model::orientation::from_angles;
use shearbed::motion::{Propagator, Span};

/// The flow and the aspect ratio of a free rod.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    /// L at t = 0 in 1/s, with the spin.
    pub gradient_per_s: Matrix3<f64>,
    /// S of a flow that turns, L(t) = Q (L − S) Qᵀ + S with Q = exp(St), in 1/s; 0 in a steady one.
    pub spin_per_s: Matrix3<f64>,
    /// r_e.
    pub aspect_ratio: f64,
}

impl Setting {
    /// A = W + ΛD in 1/s, of ṗ = Ap − p(p·Ap), at t = 0.
    pub fn rates_per_s(&self) -> Matrix3<f64> {
        let (w, d) = halves(&self.gradient_per_s);
        w + shape(self.aspect_ratio) * d
    }
}

/// W and D of L.
pub fn halves(l: &Matrix3<f64>) -> (Matrix3<f64>, Matrix3<f64>) {
    (0.5 * (l - l.transpose()), 0.5 * (l + l.transpose()))
}

/// The correct motion.
pub struct Motion {
    seen_turning: Propagator,
    spin_per_s: Matrix3<f64>,
}

impl Motion {
    /// The motion of a rod of this aspect ratio in this flow; `None` if the gradient is not finite.
    pub fn of(setting: &Setting) -> Option<Self> {
        let flow = VelocityGradient::new(setting.gradient_per_s - setting.spin_per_s)?;
        let seen_turning = Propagator::new(&flow, setting.aspect_ratio);
        Some(Self { seen_turning, spin_per_s: setting.spin_per_s })
    }

    /// The map over a time, with determinant 1 in an incompressible flow; `None` if it is not finite.
    pub fn map(&self, time_s: f64) -> Option<Matrix3<f64>> {
        let (map, _) = self.seen_turning.map(Span::Seconds(time_s, 1.0))?;
        Some(rotation(&self.spin_per_s, time_s) * unimodular(map)?)
    }
}

/// Q = exp(St): the rotation about ω by |ω|t.
pub fn rotation(spin_per_s: &Matrix3<f64>, time_s: f64) -> Matrix3<f64> {
    let [x, y, z] = [spin_per_s.m32, spin_per_s.m13, spin_per_s.m21];
    Rotation3::new(Vector3::new(x, y, z) * time_s).into_inner()
}

/// The correct map after a time.
pub fn right_map(setting: &Setting, time_s: f64) -> Option<Matrix3<f64>> {
    Motion::of(setting)?.map(time_s)
}

/// The map scaled to determinant 1, within double precision: the size of a very strongly stretched map is arbitrary.
fn unimodular(map: Matrix3<f64>) -> Option<Matrix3<f64>> {
    let map = map / map.amax();
    let determinant = map.determinant();
    let scaled = if determinant > 0.0 { map / determinant.cbrt() } else { map };
    scaled.iter().all(|component| component.is_finite()).then_some(scaled)
}

/// exp(At) for a given A, scaled to determinant 1.
pub fn map_of(a: &Matrix3<f64>, time_s: f64) -> Option<Matrix3<f64>> {
    // r_e = √3 has Λ = ½: this flow has the strain rate 2 sym A, and so W + ΛD = A.
    let gradient_per_s = 0.5 * (a - a.transpose()) + (a + a.transpose());
    right_map(&Setting { gradient_per_s, spin_per_s: Matrix3::zeros(), aspect_ratio: 3f64.sqrt() }, time_s)
}

/// Λ.
pub fn shape(aspect_ratio: f64) -> f64 {
    let square = aspect_ratio * aspect_ratio;
    (square - 1.0) / (square + 1.0)
}

/// The direction of a rod that starts along `start`; `None` if it is not finite.
pub fn moved(map: &Matrix3<f64>, start: &[f64; 3]) -> Option<Vector3<f64>> {
    finite((map * Vector3::from(*start)).normalize())
}

/// End, map and start of a mistake in turn, of p.
pub fn in_turn(end: &Matrix3<f64>, map: &Matrix3<f64>, start: &Matrix3<f64>, p: &Vector3<f64>) -> Vector3<f64> {
    end * map * start * p
}

/// A direction of any length, if it is finite.
pub fn finite(p: Vector3<f64>) -> Option<Vector3<f64>> {
    p.iter().all(|component| component.is_finite()).then_some(p)
}

/// The angle between two directions or ||p| − 1|, whichever is larger; for a mistake with a length of its own, the
/// relative distance. Opposite directions are the same.
pub fn apart(found: &Vector3<f64>, expected: &Vector3<f64>, has_length: bool) -> f64 {
    if has_length {
        (found - expected).norm().min((found + expected).norm()) / expected.norm()
    } else {
        apart_rad(found, expected).max((found.norm() - 1.0).abs())
    }
}

/// φ and θ of a direction.
pub fn angles_of(p: &Vector3<f64>) -> [f64; 2] {
    [p.y.atan2(p.x), p.x.hypot(p.y).atan2(p.z)]
}

/// The direction with these φ and θ.
pub fn by_angles([phi, theta]: [f64; 2]) -> Vector3<f64> {
    from_angles(phi, theta).into_inner()
}

/// For each whole step |∂p(end)/∂p| at its middle, and how far it moves p; `maps` are those after each half step.
pub fn growths(maps: &[Matrix3<f64>], p0: &[f64; 3]) -> Vec<[f64; 2]> {
    let p = |half: usize| (maps[half] * Vector3::from(*p0)).normalize();
    let of = |now: usize| [growth(&maps[maps.len() - 1 - now], &p(now)), (p(now + 1) - p(now - 1)).norm()];
    (1..maps.len()).step_by(2).map(of).collect()
}

/// |∂(Fp/|Fp|)/∂p| = |(1 − qq)F|/|Fp|, q = Fp/|Fp|, for changes of p across p.
fn growth(map: &Matrix3<f64>, p: &Vector3<f64>) -> f64 {
    let carried = map * p;
    let q = carried.normalize();
    // Two directions perpendicular to p.
    let mut other = Vector3::zeros();
    other[p.iamin()] = 1.0;
    let first = p.cross(&other).normalize();
    let squares = [first, p.cross(&first)].map(|across| {
        let moved = map * across;
        (moved - q * moved.dot(&q)).norm_squared()
    });
    (squares[0] + squares[1]).sqrt() / carried.norm()
}
