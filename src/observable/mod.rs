//! Observables: means over rods of a value per rod. A new observable needs a file beside this one, its `mod` line here
//! and its row in the registry; everything else, from the key in a scene to files and pictures, follows from these.

mod channel;
mod cos_2phi;
pub(crate) mod fault;
mod mean_angle;
mod orbit_constant;
mod orientation_tensor;
mod orientation_tensor_4;
mod particle_stress;
mod planar_projections;
mod projections;
mod registry;
mod stress;
mod sum;
#[cfg(test)]
mod tests;

pub use channel::Channel;
use registry::Mean;
pub use registry::Observable;
pub use sum::{Spread, Sum};

use crate::model::stress::Body;
use crate::model::widest::widest;

/// Rods per block: a block's directions stay in the first-level cache while all observables read them.
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
    /// The components p₁, p₂ and p₃ of the rods' directions.
    pub p: [[f64; BLOCK]; 3],
    /// Equivalent aspect ratios r_e.
    pub aspect_ratio: [f64; BLOCK],
    /// Weight of each rod in a stress: its cubed length over the mean cubed length of the suspension's rods.
    pub weight: [f64; BLOCK],
    /// The body of every rod, from which its stress follows.
    pub body: Body,
    /// Number of rods in the block.
    pub len: usize,
}

impl Default for Block {
    fn default() -> Self {
        Self { p: [[0.0; BLOCK]; 3], aspect_ratio: [1.0; BLOCK], weight: [1.0; BLOCK], body: Body::Spheroid, len: 0 }
    }
}

impl Block {
    /// Sets every rod's direction to `to(index in the block, its direction in from, its aspect ratio)`.
    #[inline(always)]
    pub(crate) fn turn(&mut self, from: [&[f64]; 3], to: impl Fn(usize, [f64; 3], f64) -> [f64; 3]) {
        let Self { p: [p1, p2, p3], aspect_ratio, .. } = self;
        widest(
            #[inline(always)]
            move || turned(from[0], from[1], from[2], aspect_ratio, p1, p2, p3, to),
        );
    }
}

/// Turns every rod. The arrays are separate arguments, so that the compiler knows that they do not overlap.
#[inline(always)]
#[allow(clippy::too_many_arguments)]
fn turned(
    q1: &[f64],
    q2: &[f64],
    q3: &[f64],
    aspect_ratio: &[f64; BLOCK],
    p1: &mut [f64; BLOCK],
    p2: &mut [f64; BLOCK],
    p3: &mut [f64; BLOCK],
    to: impl Fn(usize, [f64; 3], f64) -> [f64; 3],
) {
    let len = q1.len().min(BLOCK);
    let (q1, q2, q3) = (&q1[..len], &q2[..len], &q3[..len]);
    for k in 0..len {
        [p1[k], p2[k], p3[k]] = to(k, [q1[k], q2[k], q3[k]], aspect_ratio[k]);
    }
}

/// A value per rod whose mean over rods and replicas is computed against time, with its standard error. A scene can
/// name those in [`Observable::ALL`]; [`crate::run::own::observe`] takes any other.
///
/// ```
/// use shearbed::observable::{Block, Observe, Sum};
///
/// /// Hermans' orientation factor along the flow, ⟨(3p₂² − 1)/2⟩.
/// struct Hermans;
/// impl Observe for Hermans {
///     fn name(&self) -> &'static str {
///         "hermans"
///     }
///     fn label(&self) -> &'static str {
///         "orientation factor along the flow"
///     }
///     fn columns(&self) -> &[&'static str] {
///         &["f_hermans"]
///     }
///     fn add(&self, block: &Block, sums: &mut [Sum]) {
///         sums[0].add_each(block.len, |i| 0.5 * (3.0 * block.p[1][i].powi(2) - 1.0));
///     }
/// }
/// let plan = shearbed::Plan::new(&shearbed::Scene::default())?;
/// let columns = shearbed::run::own::observe(&plan, &Hermans)?;
/// // Of isotropic rods it is 0.
/// assert!(columns[0].mean[0].abs() < 4.0 * columns[0].se[0]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub trait Observe: Sync {
    /// The observable's key in a scene file, and the stem of its result file.
    fn name(&self) -> &'static str;

    /// The axis label in a picture, with the unit.
    fn label(&self) -> &'static str;

    /// The names of the columns; at least one.
    fn columns(&self) -> &[&'static str];

    /// The symbol of a column by its place in [`Observe::columns`], with a unit in parentheses, as it stands on an
    /// axis: `φ̄ (rad)`. The column's name unless the observable says otherwise.
    fn symbol(&self, column: usize) -> String {
        self.columns()[column].to_owned()
    }

    /// Adds the rods of `block` to `sums`, one per column.
    fn add(&self, block: &Block, sums: &mut [Sum]);

    /// The least and the largest mean that a column can have, by its place in [`Observe::columns`]: measured values
    /// beyond are refused. Unbounded unless the observable says otherwise.
    fn range(&self, _column: usize) -> [f64; 2] {
        [f64::NEG_INFINITY, f64::INFINITY]
    }

    /// True if its formula holds in plane Couette flow u_2 = G x_1 alone.
    fn needs_couette(&self) -> bool {
        false
    }

    /// True if its sums are in units of μ G n⟨a³⟩ and its means in Pa: it needs the liquid's viscosity and the rods'
    /// concentration.
    fn needs_viscosity(&self) -> bool {
        false
    }

    /// True if rods count by their cubed length, as in [`Block::weight`].
    fn weighs_rods(&self) -> bool {
        false
    }

    /// True if the columns after the first are a density over [0, 1].
    fn is_density(&self) -> bool {
        false
    }

    /// For a tensor, its name and its trace summed over all rods, which must equal their number; else `None`.
    fn trace(&self, _sums: &[Sum]) -> Option<(&'static str, f64)> {
        None
    }
}

/// The range of a mean of products of direction components, by a column's name: `a1123` for p₁²p₂p₃. With exponents e
/// of sum d a product is at most Π (e/d)^(e/2).
fn range_of_product(column: &str) -> [f64; 2] {
    let axes = &column[1..];
    let exponents = ['1', '2', '3'].map(|axis| axes.matches(axis).count() as i32);
    let all = axes.len() as f64;
    let square: f64 = exponents.iter().map(|e| (f64::from(*e) / all).powi(*e)).product();
    let most = square.sqrt();
    [if exponents.iter().all(|e| e % 2 == 0) { 0.0 } else { -most }, most]
}

/// The index of the axis of factor `k` of such a mean.
fn axis(column: &str, k: usize) -> usize {
    usize::from(column.as_bytes()[1 + k] - b'1')
}

/// Sums per output.
pub(crate) fn width(observables: &[Observable]) -> usize {
    observables.iter().map(|observable| observable.width()).sum()
}

/// Number of independent partial sums, which the compiler may keep side by side in a register.
const LANES: usize = 8;

#[inline]
pub(crate) fn lane_sum(len: usize, f: impl Fn(usize) -> f64) -> f64 {
    widest(
        #[inline(always)]
        move || {
            whole_or(
                len,
                #[inline(always)]
                |len| lanes(len, &f),
            )
        },
    )
}

/// `of(len)`, compiled once more for whole blocks: where the compiler knows the length, loops have no ends to look
/// after.
#[inline(always)]
pub(crate) fn whole_or<T>(len: usize, of: impl Fn(usize) -> T) -> T {
    if len == BLOCK { of(BLOCK) } else { of(len) }
}

/// [`lane_sum`] for use inside [`widest`].
///
/// # Panics
///
/// If `len` is larger than [`BLOCK`].
#[inline(always)]
pub(crate) fn lanes(len: usize, f: impl Fn(usize) -> f64) -> f64 {
    let mut lanes = [0.0; LANES];
    assert!(len <= BLOCK, "a block has at most {BLOCK} rods, not {len}");
    let whole = len / LANES * LANES;
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
