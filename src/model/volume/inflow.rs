//! Moves rods through the control volume in any flow of constant volume, and replaces rods that leave by inflowing
//! ones.

#[cfg(test)]
mod tests;

use super::ControlVolume;
use crate::model::random::ahead;
use nalgebra::{Matrix3, Vector3};
use rand::RngExt;
use rand_pcg::Pcg64Dxsm;

/// The longest step: ‖L‖Δt in Frobenius's norm. Taylor's series of exp(Lτ) loses a factor of up to e^‖L‖τ in precision.
pub const MAX_STEP: f64 = 8.0;

/// Random numbers reserved for one rod. A try takes five; on average fewer than ten are needed.
pub const NUMBERS: u128 = 1 << 20;

/// One step of rods in a control volume whose liquid has any gradient L of trace 0 (eqs 2 and 3, with x measured from
/// the volume's corner).
///
/// A rod that leaves returns uniformly distributed over the liquid that came in during the step: through a point of a
/// face, with a density ∝ the inflow there, at a time uniform in the step. Uniformly distributed rods therefore stay
/// so, except in liquid that came in twice during the step, a part ∝ Δt³ of the volume. Plane Couette flow u_2 = G x_1
/// uses eq. 14 instead ([`ControlVolume::advance`]).
#[derive(Clone, Debug)]
pub struct Inflow {
    sides: [f64; 3],
    gradient: Matrix3<f64>,
    step: f64,
    /// exp(LΔt) and exp(−LΔt).
    there: Matrix3<f64>,
    back: Matrix3<f64>,
    faces: Vec<Face>,
}

#[derive(Clone, Copy, Debug)]
struct Face {
    axis: usize,
    /// The face's coordinate along `axis`: 0 or the side.
    at: f64,
    /// The largest inflow velocity on the face.
    most: f64,
    /// Cumulative share of area × `most`, up to and including this face.
    share: f64,
}

impl Inflow {
    /// Steps of `step` > 0 in a liquid with the velocity gradient `gradient`; the unit of time is the gradient's.
    pub fn new(volume: &ControlVolume, gradient: Matrix3<f64>, step: f64) -> Self {
        let mut inflow = Self {
            sides: volume.sides(),
            gradient,
            step,
            there: exponential(&gradient, step),
            back: exponential(&gradient, -step),
            faces: Vec::new(),
        };
        let mut sum = 0.0;
        for axis in 0..3 {
            for at in [0.0, inflow.sides[axis]] {
                let mut face = Face { axis, at, most: 0.0, share: 0.0 };
                // A linear function is largest at a corner.
                for corner in [[0.0, 0.0], [0.0, 1.0], [1.0, 0.0], [1.0, 1.0]] {
                    face.most = face.most.max(inflow.speed_in(&face, &inflow.point(&face, corner)));
                }
                if face.most > 0.0 {
                    let [j, k] = across(axis);
                    sum += face.most * inflow.sides[j] * inflow.sides[k];
                    face.share = sum;
                    inflow.faces.push(face);
                }
            }
        }
        inflow.faces.iter_mut().for_each(|face| face.share /= sum);
        inflow
    }

    /// The velocity gradient L.
    pub fn gradient(&self) -> &Matrix3<f64> {
        &self.gradient
    }

    /// Moves every rod with the liquid over the step and replaces those that left. Returns the number of rods replaced.
    pub fn advance(&self, positions: &mut [Vec<f64>; 3], rng: &mut Pcg64Dxsm) -> u64 {
        let replace = |axes: [&mut [f64]; 3], rng: &mut Pcg64Dxsm| self.replace(axes, rng);
        super::advance(positions, NUMBERS, rng, |axes| self.carry(axes), replace)
    }

    /// Moves rods with the liquid and returns how many are then outside.
    fn carry(&self, axes: [&mut [f64]; 3]) -> u64 {
        let [x1, x2, x3] = axes;
        let mut left = 0;
        for ((x1, x2), x3) in x1.iter_mut().zip(x2).zip(x3) {
            let x = self.there * Vector3::new(*x1, *x2, *x3);
            left += u64::from(!self.holds(&x));
            [*x1, *x2, *x3] = x.into();
        }
        left
    }

    /// Replaces the rods that are outside, each with its own numbers of the stream.
    fn replace(&self, [x1, x2, x3]: [&mut [f64]; 3], rng: &mut Pcg64Dxsm) {
        for ((x1, x2), x3) in x1.iter_mut().zip(x2).zip(x3) {
            if !self.holds(&Vector3::new(*x1, *x2, *x3)) {
                [*x1, *x2, *x3] = self.come_in(rng.clone()).into();
                *rng = ahead(rng, NUMBERS);
            }
        }
    }

    /// A random position of a rod that came in during the step.
    fn come_in(&self, mut rng: Pcg64Dxsm) -> Vector3<f64> {
        loop {
            let [which, j, k, accepted, since]: [f64; 5] = std::array::from_fn(|_| rng.random());
            let Some(face) = self.faces.iter().find(|face| which < face.share) else {
                continue;
            };
            let entry = self.point(face, [j, k]);
            if accepted * face.most >= self.speed_in(face, &entry) {
                continue;
            }
            let x = carried(&self.gradient, entry, since * self.step);
            if self.holds(&x) && !self.holds(&(self.back * x)) {
                return x;
            }
        }
    }

    /// The point of `face` at these `shares` of its two sides.
    fn point(&self, face: &Face, shares: [f64; 2]) -> Vector3<f64> {
        let mut x = Vector3::from_element(face.at);
        for (axis, share) in across(face.axis).into_iter().zip(shares) {
            x[axis] = share * self.sides[axis];
        }
        x
    }

    /// The velocity into the volume at the point `x` of `face`.
    fn speed_in(&self, face: &Face, x: &Vector3<f64>) -> f64 {
        let velocity = self.gradient.row(face.axis).tr_dot(x);
        if face.at == 0.0 { velocity } else { -velocity }
    }

    fn holds(&self, x: &Vector3<f64>) -> bool {
        x.iter().zip(self.sides).all(|(x, side)| (0.0..side).contains(x))
    }
}

/// exp(Lτ), column by column.
fn exponential(gradient: &Matrix3<f64>, time: f64) -> Matrix3<f64> {
    let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
    Matrix3::from_columns(&axes.map(|axis| carried(gradient, axis, time)))
}

/// exp(Lτ) x by Taylor's series.
fn carried(gradient: &Matrix3<f64>, x: Vector3<f64>, time: f64) -> Vector3<f64> {
    let (mut sum, mut term) = (x, x);
    for k in 1..100 {
        term = gradient * term * (time / f64::from(k));
        let before = sum;
        sum += term;
        if sum == before {
            break;
        }
    }
    sum
}

/// The two axes along a face with this normal.
fn across(axis: usize) -> [usize; 2] {
    [[1, 2], [0, 2], [0, 1]][axis]
}
