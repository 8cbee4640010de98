//! The control volume, its rods' positions, and the replacement of rods that leave it (Fig. 3, eq. 14).

mod inflow;

pub(crate) use inflow::NUMBERS as INFLOW_NUMBERS;
pub use inflow::{Inflow, MAX_STEP};

use crate::model::chunks::{CHUNK, over_chunks};
use crate::model::random::ahead;
use nalgebra::Matrix3;
use rand::RngExt;
use rand_pcg::Pcg64Dxsm;

/// The volume [0, H₁) × [0, H₂) × [0, H₃), with lengths in rod lengths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ControlVolume {
    /// H₁/a, H₂/a and H₃/a.
    sides: [f64; 3],
}

impl ControlVolume {
    /// The volume with these `sides` in rod lengths.
    pub fn of(sides: [f64; 3]) -> Self {
        Self { sides }
    }

    /// The cube that holds `count` rods at the concentration n a³ `per_cubed_length`:
    /// H/a = (N/(n a³))^{1/3}.
    pub fn holding(count: usize, per_cubed_length: f64) -> Self {
        Self::of([libm::cbrt(count as f64 / per_cubed_length); 3])
    }

    /// H₁/a, H₂/a and H₃/a.
    pub fn sides(&self) -> [f64; 3] {
        self.sides
    }

    /// The number of times per unit of time that the liquid crosses the volume, along the axis where it is largest.
    pub(crate) fn crossings(&self, gradient: &Matrix3<f64>) -> f64 {
        let along = |k: usize| (0..3).map(|j| gradient[(k, j)].abs() * (self.sides[j] / self.sides[k])).sum();
        (0..3).map(along).fold(0.0, f64::max)
    }

    /// True if the volume in cubed rod lengths and its inverse are normal numbers.
    pub(crate) fn is_known(&self) -> bool {
        let content: f64 = self.sides.iter().product();
        content.is_normal() && content.recip().is_normal()
    }

    /// `count` uniform positions as three arrays: x_i = H_i R_i, drawn rod by rod (eq. 12).
    pub fn draw_positions(&self, count: usize, rng: &Pcg64Dxsm) -> [Vec<f64>; 3] {
        let mut positions = [(); 3].map(|()| vec![0.0; count]);
        over_chunks(&mut positions, |chunk, [x1, x2, x3]| {
            let mut rng = ahead(rng, 3 * (chunk * CHUNK) as u64);
            for ((x1, x2), x3) in x1.iter_mut().zip(x2).zip(x3) {
                for (x, side) in [x1, x2, x3].into_iter().zip(self.sides) {
                    *x = side * rng.random::<f64>();
                }
            }
        });
        positions
    }

    /// Positions in rod lengths of rods at `places`, given in the unit of `length`. Positions rounded beyond a face are
    /// set to the face.
    pub fn within(&self, places: &[Vec<f64>; 3], length: f64) -> [Vec<f64>; 3] {
        let axis = |axis: usize| places[axis].iter().map(move |x| (x / length).min(self.sides[axis])).collect();
        std::array::from_fn(axis)
    }

    /// Moves every rod with the liquid of plane Couette flow u_2 = ±x_1 over `strain` ≥ 0 (`sign` of G) and replaces
    /// the rods that left through the faces normal to axis 2: x_1 = H₁√R, x_3 = H₃R, x_2 is the overshoot modulo H₂
    /// (eq. 14 with the text's second coordinate read as x_3). Returns the number of rods replaced.
    pub fn advance(&self, positions: &mut [Vec<f64>; 3], strain: f64, sign: f64, rng: &mut Pcg64Dxsm) -> u64 {
        let carry = |[x1, x2, _]: [&mut [f64]; 3]| self.carry(x1, x2, sign * strain);
        advance(positions, COUETTE_NUMBERS, rng, carry, |axes, rng| self.replace(axes, rng))
    }

    /// Moves rods along axis 2 and returns how many are then outside.
    fn carry(&self, x1: &[f64], x2: &mut [f64], strain: f64) -> u64 {
        let mut left = 0;
        let side = self.sides[1];
        for (x1, x2) in x1.iter().zip(x2) {
            *x2 += x1 * strain;
            left += u64::from(!(0.0..side).contains(x2));
        }
        left
    }

    /// Replaces the rods that are outside, each with the next two numbers of the stream.
    fn replace(&self, [x1, x2, x3]: [&mut [f64]; 3], rng: &mut Pcg64Dxsm) {
        let [h1, h2, h3] = self.sides;
        for ((x1, x2), x3) in x1.iter_mut().zip(x2).zip(x3) {
            if (0.0..h2).contains(x2) {
                continue;
            }
            // The inflow through a face is proportional to u_2, and so to x_1: hence the root.
            *x1 = h1 * rng.random::<f64>().sqrt();
            let overshoot = modulo(*x2, h2);
            // Just below 0, the remainder rounds up to the side itself.
            *x2 = if overshoot < h2 { overshoot } else { 0.0 };
            *x3 = h3 * rng.random::<f64>();
        }
    }
}

/// `x.rem_euclid(side)`, without a division for a rod that is less than a side away, as nearly all are: x − side is
/// exact there.
#[inline]
fn modulo(x: f64, side: f64) -> f64 {
    if x >= side && x < 2.0 * side {
        x - side
    } else if x < 0.0 && x > -side {
        x + side
    } else {
        x.rem_euclid(side)
    }
}

/// Random numbers used per replaced rod in plane Couette flow.
pub(crate) const COUETTE_NUMBERS: u128 = 2;

/// Moves all rods by `carry`, which returns how many left, then replaces those in the order of rods, each with the next
/// `numbers` of the stream. Returns the number of rods replaced.
fn advance(
    positions: &mut [Vec<f64>; 3],
    numbers: u128,
    rng: &mut Pcg64Dxsm,
    carry: impl Fn([&mut [f64]; 3]) -> u64 + Sync,
    replace: impl Fn([&mut [f64]; 3], &mut Pcg64Dxsm) + Sync,
) -> u64 {
    if positions[0].len() <= CHUNK {
        let left = carry(positions.each_mut().map(Vec::as_mut_slice));
        replace(positions.each_mut().map(Vec::as_mut_slice), rng);
        return left;
    }
    let left = over_chunks(positions, |_, axes| carry(axes));
    let after = |left: &[u64]| ahead(rng, numbers * u128::from(left.iter().sum::<u64>()));
    over_chunks(positions, |chunk, axes| replace(axes, &mut after(&left[..chunk])));
    *rng = after(&left);
    left.iter().sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::random::{Purpose, stream};

    #[test]
    fn a_place_modulo_the_side_has_the_bits_of_the_library() {
        let mut rng = stream(5, 0, Purpose::Positions);
        for side in [1.0, 3.7, 1e-3, 271.441_761_659_490_6] {
            let near = [-2.0, -1.0, -0.0, 0.0, 1.0, 2.0, 3.0_f64].map(|k| k * side);
            let ends = near.into_iter().flat_map(|x| [x.next_down(), x, x.next_up()]);
            let inside = (0..20_000).map(|_| side * (5.0 * rng.random::<f64>() - 2.0));
            for x in ends.chain(inside) {
                assert_eq!(modulo(x, side).to_bits(), x.rem_euclid(side).to_bits(), "{x} {side}");
            }
        }
    }

    /// Many rods are moved and replaced, chunk by chunk, as fewer rods are one after the other.
    pub(super) fn in_parts(volume: ControlVolume, advance: impl Fn(&mut [Vec<f64>; 3], &mut Pcg64Dxsm) -> u64) {
        let count = 2 * CHUNK + 1000;
        let mut all = volume.draw_positions(count, &stream(3, 0, Purpose::Positions));
        let mut parts: Vec<[Vec<f64>; 3]> = [0..CHUNK, CHUNK..2 * CHUNK, 2 * CHUNK..count]
            .map(|part| all.each_ref().map(|axis| axis[part.clone()].to_vec()))
            .into();
        let start = stream(3, 0, Purpose::Replacements);
        let (mut one, mut many) = (start.clone(), start);
        for _ in 0..2 {
            let replaced = advance(&mut all, &mut many);
            let each = parts.iter_mut().map(|part| advance(part, &mut one));
            assert_eq!(replaced, each.sum::<u64>());
            assert_eq!(many, one);
        }
        for (axis, all) in all.iter().enumerate() {
            assert!(all.iter().eq(parts.iter().flat_map(|part| &part[axis])));
        }
    }

    #[test]
    fn many_rods_are_replaced_as_one_after_the_other() {
        let volume = ControlVolume::holding(2 * CHUNK + 1000, 1.0);
        in_parts(volume, |positions, rng| volume.advance(positions, 0.3, 1.0, rng));
    }

    #[test]
    fn rods_that_leave_come_back_inside_and_the_others_only_move() {
        let volumes = [ControlVolume::holding(1000, 1.0), ControlVolume::of([20.0, 10.0, 5.0])];
        for (volume, sign) in volumes.into_iter().flat_map(|volume| [(volume, 1.0), (volume, -1.0)]) {
            let sides = volume.sides();
            let mut positions = volume.draw_positions(1000, &stream(3, 0, Purpose::Positions));
            let before = positions.clone();
            let replaced = volume.advance(&mut positions, 0.3, sign, &mut stream(3, 0, Purpose::Replacements));
            let mut changed = 0;
            for rod in 0..1000 {
                let moved = before[1][rod] + sign * 0.3 * before[0][rod];
                if (0.0..sides[1]).contains(&moved) {
                    assert_eq!((positions[0][rod], positions[1][rod]), (before[0][rod], moved));
                } else {
                    changed += 1;
                    assert!((positions[1][rod] - moved).abs() > 0.99 * sides[1]);
                }
                assert!((0..3).all(|k| (0.0..sides[k]).contains(&positions[k][rod])));
            }
            assert_eq!(replaced, changed);
            assert!(changed > 50);
        }
    }
}
