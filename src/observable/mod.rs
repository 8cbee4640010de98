//! What is observed of the rods: means over rods of a value per rod.

mod channel;
pub(crate) mod fault;
mod sum;
#[cfg(test)]
mod tests;

pub use channel::Channel;
pub use sum::{Spread, Sum};

use crate::model::orientation::{bounded_orbit_constant, folded_phi};
use serde::{Deserialize, Serialize};

/// Rods handled at a time: their directions stay in the first cache while every observable reads them.
pub const BLOCK: usize = 128;

/// Directions, aspect ratios and weights of up to [`BLOCK`] rods, as structure of arrays.
///
/// ```
/// use shearbed::observable::Block;
/// let mut block = Block { len: 1, ..Block::default() };
/// block.p[2][0] = 1.0; // along the vorticity axis
/// assert_eq!(block.aspect_ratio[0], 1.0);
/// ```
#[derive(Clone, Debug)]
pub struct Block {
    /// p₁, p₂ and p₃.
    pub p: [[f64; BLOCK]; 3],
    /// r_e.
    pub aspect_ratio: [f64; BLOCK],
    /// Of each rod in a stress: its cubed length over the mean cubed length of the suspension's rods.
    pub weight: [f64; BLOCK],
    /// How many rods are in the block.
    pub len: usize,
}

impl Default for Block {
    fn default() -> Self {
        Self { p: [[0.0; BLOCK]; 3], aspect_ratio: [1.0; BLOCK], weight: [1.0; BLOCK], len: 0 }
    }
}

impl Block {
    /// Puts every rod along `to(place in the block, direction in from, aspect ratio)`.
    #[inline(always)]
    pub(crate) fn turn(&mut self, from: [&[f64]; 3], to: impl Fn(usize, [f64; 3], f64) -> [f64; 3]) {
        let [p1, p2, p3] = &mut self.p;
        let ends = p1.iter_mut().zip(p2).zip(p3);
        let starts = from[0].iter().zip(from[1]).zip(from[2]);
        for (k, ((((p1, p2), p3), ((q1, q2), q3)), r)) in ends.zip(starts).zip(&self.aspect_ratio).enumerate()
        {
            [*p1, *p2, *p3] = to(k, [*q1, *q2, *q3], *r);
        }
    }
}

/// What can be observed. Each has a file of its own, named as its key.
///
/// ```
/// use shearbed::Observable;
/// let names: Vec<_> = Observable::Projections.channels().map(|channel| channel.name()).collect();
/// assert_eq!(names, ["x1", "x2", "x3"]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Observable {
    /// Means of |p_i| (eq. 4; with the signs, random rods would give 0).
    Projections,
    /// Mean projections on the planes x₁x₂, x₂x₃, x₁x₃ (eq. 21, with φ in the second factor).
    PlanarProjections,
    /// The mean of φ folded into [0, π/2] (eq. 18), in radians.
    MeanAngle,
    /// Mean and density of C_b = C/(1 + C) (eq. 13).
    OrbitConstant,
    /// ⟨pp⟩.
    OrientationTensor,
    /// ⟨pppp⟩: its 15 components that differ.
    #[serde(rename = "orientation_tensor_4")]
    OrientationTensor4,
    /// What dilute slender rods add to the stress in plane Couette flow, over μ_fiber G: shear stress σ₁₂ and normal stress
    /// differences N₁ = σ₂₂ − σ₁₁ (flow less gradient) and N₂ = σ₁₁ − σ₃₃ of σ_ij = μ_fiber ⟨p_i p_j p_k p_l⟩ D_kl, which is
    /// μ_fiber G ⟨p_i p_j p₁p₂⟩ (Batchelor 1970; docs/coefficients.md). μ_fiber ∝ n⟨a³⟩, and rods count by their cubed length.
    ParticleStress,
}

/// The components of ⟨pppp⟩ that differ, each as two of the pairs 11, 22, 33, 12, 13, 23 by their places.
const QUADS: [[usize; 2]; 15] = [
    [0, 0],
    [0, 3],
    [0, 4],
    [0, 1],
    [0, 5],
    [0, 2],
    [3, 1],
    [3, 5],
    [3, 2],
    [4, 2],
    [1, 1],
    [1, 5],
    [1, 2],
    [5, 2],
    [2, 2],
];

/// Those of [`QUADS`] whose sum over both pairs is the trace of the trace of ⟨pppp⟩, which is 1, and how often each counts.
pub(crate) const TRACES: [(usize, f64); 6] = [(0, 1.0), (10, 1.0), (14, 1.0), (3, 2.0), (5, 2.0), (12, 2.0)];

/// The bins of the density of C_b over [0, 1].
const BINS: usize = 20;

/// Sums per output.
pub(crate) fn width(observables: &[Observable]) -> usize {
    observables.iter().map(|observable| observable.width()).sum()
}

impl Observable {
    /// Every observable.
    pub const ALL: [Self; 7] = [
        Self::Projections,
        Self::PlanarProjections,
        Self::MeanAngle,
        Self::OrbitConstant,
        Self::OrientationTensor,
        Self::OrientationTensor4,
        Self::ParticleStress,
    ];

    /// The key in a scene file, and the stem of the file's name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Projections => "projections",
            Self::PlanarProjections => "planar_projections",
            Self::MeanAngle => "mean_angle",
            Self::OrbitConstant => "orbit_constant",
            Self::OrientationTensor => "orientation_tensor",
            Self::OrientationTensor4 => "orientation_tensor_4",
            Self::ParticleStress => "particle_stress",
        }
    }

    /// Its channels, in the order of its columns.
    pub fn channels(self) -> impl Iterator<Item = Channel> {
        (0..self.width()).map(move |index| Channel::new(self, index))
    }

    /// How many channels there are.
    pub fn width(self) -> usize {
        match self {
            Self::Projections | Self::PlanarProjections | Self::ParticleStress => 3,
            Self::MeanAngle => 1,
            Self::OrbitConstant => 1 + BINS,
            Self::OrientationTensor => 6,
            Self::OrientationTensor4 => QUADS.len(),
        }
    }

    /// Adds the block's rods to the sums of this observable's channels.
    pub fn add(self, block: &Block, sums: &mut [Sum]) {
        let [p1, p2, p3] = &block.p;
        match self {
            Self::Projections => {
                for (sum, p) in sums.iter_mut().zip([p1, p2, p3]) {
                    sum.add_each(block.len, |i| p[i].abs());
                }
            }
            Self::PlanarProjections => {
                for (sum, (a, b)) in sums.iter_mut().zip([(p1, p2), (p2, p3), (p1, p3)]) {
                    sum.add_each(block.len, |i| (a[i] * a[i] + b[i] * b[i]).sqrt());
                }
            }
            Self::MeanAngle => sums[0].add_each(block.len, |i| folded_phi(p1[i], p2[i])),
            Self::OrbitConstant => {
                let mut bounded = [0.0; BLOCK];
                for (i, c) in bounded[..block.len].iter_mut().enumerate() {
                    *c = bounded_orbit_constant([p1[i], p2[i], p3[i]], block.aspect_ratio[i]);
                }
                sums[0].add_each(block.len, |i| bounded[i]);
                for (bin, sum) in sums[1..].iter_mut().enumerate() {
                    // A density: the share of rods in the bin over the bin's width.
                    let inside = |c: f64| ((c * BINS as f64) as usize).min(BINS - 1) == bin;
                    sum.add_each(block.len, |i| if inside(bounded[i]) { BINS as f64 } else { 0.0 });
                }
            }
            Self::OrientationTensor => {
                let pairs = [(p1, p1), (p2, p2), (p3, p3), (p1, p2), (p1, p3), (p2, p3)];
                for (sum, (a, b)) in sums.iter_mut().zip(pairs) {
                    sum.add_each(block.len, |i| a[i] * b[i]);
                }
            }
            Self::OrientationTensor4 => {
                let pairs = [(p1, p1), (p2, p2), (p3, p3), (p1, p2), (p1, p3), (p2, p3)];
                for (sum, [one, other]) in sums.iter_mut().zip(QUADS) {
                    let ((a, b), (c, d)) = (pairs[one], pairs[other]);
                    sum.add_each(block.len, |i| a[i] * b[i] * (c[i] * d[i]));
                }
            }
            Self::ParticleStress => {
                let weight = &block.weight;
                sums[0].add_each(block.len, |i| weight[i] * (p1[i] * p2[i]).powi(2));
                sums[1]
                    .add_each(block.len, |i| weight[i] * (p1[i] * p2[i] * (p2[i] * p2[i] - p1[i] * p1[i])));
                sums[2]
                    .add_each(block.len, |i| weight[i] * (p1[i] * p2[i] * (p1[i] * p1[i] - p3[i] * p3[i])));
            }
        }
    }
}

/// Independent partial sums, so that the compiler may keep them side by side in a register.
const LANES: usize = 8;

#[inline]
pub(crate) fn lane_sum(len: usize, f: impl Fn(usize) -> f64) -> f64 {
    let mut lanes = [0.0; LANES];
    let whole = len.min(BLOCK) / LANES * LANES;
    for first in (0..whole).step_by(LANES) {
        for (lane, sum) in lanes.iter_mut().enumerate() {
            *sum += f(first + lane);
        }
    }
    for i in whole..len {
        lanes[i - whole] += f(i);
    }
    lanes.iter().sum()
}
