//! Rods in any flow of constant volume: rods that leave come back with the liquid that came in.

use super::mistake::{Mistake, either};
use super::motion::{matrix, vector};
use super::random::uniform;
use nalgebra::Matrix3;
use rand_pcg::Pcg64Dxsm;

/// A flow in place of plane Couette flow, with steps per unit of strain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OtherFlow {
    /// L_ij = du_i/dx_j, 1/s, of trace 0.
    pub gradient_per_s: [[f64; 3]; 3],
    /// dt = 1 / (steps_per_strain (2 D:D)^1/2).
    pub steps_per_strain: usize,
}

impl OtherFlow {
    pub(super) fn time_step_s(&self) -> f64 {
        let gradient = matrix(self.gradient_per_s);
        let strain_rate = (gradient + gradient.transpose()) / 2.0;
        1.0 / (self.steps_per_strain as f64 * (2.0 * strain_rate.norm_squared()).sqrt())
    }
}

/// Random numbers reserved for each rod in the stream.
const NUMBERS: u128 = 1 << 20;

/// The position after `dt_s` of the liquid at `x_mm`.
fn carried(gradient: Matrix3<f64>, x_mm: [f64; 3], dt_s: f64) -> [f64; 3] {
    ((gradient * dt_s).exp() * vector(x_mm)).into()
}

fn inside(x_mm: [f64; 3], edges_mm: [f64; 3]) -> bool {
    (0..3).all(|k| 0.0 <= x_mm[k] && x_mm[k] < edges_mm[k])
}

/// A face of the volume: its normal axis, and true for the face away from the origin.
type Face = (usize, bool);

const FACES: [Face; 6] = [(0, false), (0, true), (1, false), (1, true), (2, false), (2, true)];

/// The point of a face at these shares of its edges, in mm.
fn place((axis, far): Face, [j, k]: [f64; 2], edges_mm: [f64; 3]) -> [f64; 3] {
    let far = f64::from(u8::from(far));
    let shares = [[far, j, k], [j, far, k], [j, k, far]][axis];
    [0, 1, 2].map(|i| shares[i] * edges_mm[i])
}

/// The velocity into the volume at a point of a face, mm/s.
fn inflow((axis, far): Face, gradient: Matrix3<f64>, x_mm: [f64; 3]) -> f64 {
    let along = (gradient * vector(x_mm))[axis];
    if far { -along } else { along }
}

/// Moves every position (mm) with the liquid over a step. Rods that leave come back; `replaced` counts them.
pub fn carry(
    places_mm: &mut [[f64; 3]],
    gradient_per_s: [[f64; 3]; 3],
    edges_mm: [f64; 3],
    dt_s: f64,
    stream: &Pcg64Dxsm,
    replaced: &mut u64,
    made: Option<Mistake>,
) {
    let gradient = matrix(gradient_per_s);
    let step = (gradient * dt_s).exp();
    for x in places_mm {
        *x = (step * vector(*x)).into();
        if !inside(*x, edges_mm) {
            *x = come_in(gradient, edges_mm, dt_s, stream, *replaced, made);
            *replaced += 1;
        }
    }
}

/// The position at which rod number `rod` of all that have left comes back, uniform in the liquid that came in during
/// the step: it enters through a face drawn by largest inflow and area, at a point accepted by the inflow there, at a
/// drawn time. It is drawn again if the rod would have left, or was inside when the step began.
fn come_in(
    gradient: Matrix3<f64>,
    edges_mm: [f64; 3],
    dt_s: f64,
    stream: &Pcg64Dxsm,
    rod: u64,
    made: Option<Mistake>,
) -> [f64; 3] {
    let mut draws = stream.clone();
    draws.advance(NUMBERS * u128::from(rod));
    let corners = [[0.0, 0.0], [0.0, 1.0], [1.0, 0.0], [1.0, 1.0]];
    let most = |face| {
        let of_corner = |corner| inflow(face, gradient, place(face, corner, edges_mm));
        crate::worst(corners.into_iter().map(of_corner))
    };
    let weight = |face: Face| {
        let area: f64 = (0..3).filter(|k| *k != face.0).map(|k| edges_mm[k]).product();
        let most = most(face);
        either(made, Mistake::FacesByArea, if most > 0.0 { area } else { 0.0 }, area * most)
    };
    let all: f64 = FACES.into_iter().map(weight).sum();
    loop {
        let [which, j, k, kept, since] = [0; 5].map(|_| uniform(&mut draws));
        let mut below = 0.0;
        let face = FACES.into_iter().find(|face| {
            below += weight(*face);
            which * all < below
        });
        let Some(face) = face else { continue };
        let entry_mm = place(face, [j, k], edges_mm);
        let let_in = kept * most(face) < inflow(face, gradient, entry_mm);
        if !either(made, Mistake::InflowUniform, inflow(face, gradient, entry_mm) > 0.0, let_in) {
            continue;
        }
        // not the whole step: a rod on a face was inside
        let since = either(made, Mistake::InflowAtOnce, 0.999, since);
        let x_mm = carried(gradient, entry_mm, since * dt_s);
        if inside(x_mm, edges_mm) && !inside(carried(gradient, x_mm, -dt_s), edges_mm) {
            return x_mm;
        }
    }
}
