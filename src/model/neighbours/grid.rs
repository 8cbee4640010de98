//! Nearest neighbours of many rods, by a grid of cells.

mod sort;

pub(crate) use sort::bytes;

use super::Nearest;
use super::branchless::{BLOCK, greater, lesser};
use crate::model::chunks::{CHUNK, of_chunks};
use crate::model::widest::widest;
use crate::model::work::Counters;
use sort::Unsorted;
use std::ops::Range;

/// A rod as stored in its cell, in single precision: it picks the pairs that are measured exactly.
#[derive(Clone, Copy, Debug, Default)]
struct Entry {
    /// The place over the longest side of the volume.
    place: [f32; 3],
    /// The reach over the longest side, rounded up.
    reach: f32,
    rod: u32,
}

/// Rods sorted into the cells of a volume [0, H₁) × [0, H₂) × [0, H₃), for one step, each with its reach.
///
/// Cells, and so the rods in memory, follow one another along axis 3, then 2, then 1, so that a search reads
/// neighbouring memory. The buffers are reused in every step.
#[derive(Clone, Debug, Default)]
pub(super) struct Grid {
    /// The longest side, the unit of length of all that follows.
    longest: f64,
    sides: [f32; 3],
    along: [usize; 3],
    width: [f32; 3],
    /// Number of cells per unit of length along each axis; 0 where there is one cell.
    per_length: [f32; 3],
    /// Index in `sorted` of each cell's first rod; one more entry ends the last cell.
    starts: Vec<u32>,
    sorted: Vec<Entry>,
    unsorted: Unsorted,
    /// Indices in `sorted` of the rods that need a search.
    crowded: Vec<u32>,
}

/// Rods per cell, about: with fewer the search looks at more cells, with more at more rods.
const RODS_PER_CELL: f64 = 1.4;

/// An upper bound of the error of a distance in single precision, in longest sides: two coordinates are rounded, and so
/// are their difference and its square.
const SLACK: f32 = 1e-6;

impl Grid {
    /// An empty grid for about `count` rods in a volume of the given sides: about [`RODS_PER_CELL`] in each.
    pub fn new(sides: [f64; 3], count: usize) -> Self {
        let along = cells_along(sides, count);
        let longest = sides.into_iter().fold(0.0, f64::max);
        let sides = sides.map(|side| (side / longest) as f32);
        let per_length = |axis: usize| match along[axis] {
            1 => 0.0,
            cells => cells as f32 / sides[axis],
        };
        Self {
            longest,
            sides,
            along,
            width: std::array::from_fn(|axis| sides[axis] / along[axis] as f32),
            per_length: std::array::from_fn(per_length),
            ..Self::default()
        }
    }

    /// Like [`super::Neighbours::each_nearest`], in the order of cells.
    pub fn each_nearest<R: Iterator<Item = f64>>(
        &mut self,
        positions: &[Vec<f64>; 3],
        reaches: impl Fn(usize) -> R + Sync,
        work: &mut Counters,
        mut found: impl FnMut(Nearest),
    ) {
        let count = positions[0].len();
        self.sort(positions, reaches);
        work.pairs_screened += (WINDOW * count) as u64;
        if count <= CHUNK {
            let mut crowded = std::mem::take(&mut self.crowded);
            self.search(positions, 0..count, &mut crowded, work, found);
            self.crowded = crowded;
            return;
        }
        let chunks = of_chunks(count, |places| {
            let (mut all, mut work) = (Vec::new(), Counters::default());
            self.search(positions, places, &mut Vec::new(), &mut work, |nearest| all.push(nearest));
            (all, work)
        });
        for (all, part) in chunks {
            work.add(&part);
            all.into_iter().for_each(&mut found);
        }
    }

    /// Calls `found` with every rod in `places` that has another rod within its reach.
    fn search(
        &self,
        positions: &[Vec<f64>; 3],
        places: Range<usize>,
        crowded: &mut Vec<u32>,
        work: &mut Counters,
        mut found: impl FnMut(Nearest),
    ) {
        for part in places.clone().step_by(LISTED) {
            let end = places.end.min(part + LISTED);
            crowded.clear();
            for first in (part..end).step_by(BLOCK) {
                self.find_crowded(first..end.min(first + BLOCK), crowded);
            }
            for &place in &*crowded {
                let entry = &self.sorted[place as usize];
                if let Some((other, square)) = self.nearest_within(positions, entry, work) {
                    found(Nearest { rod: entry.rod, other, square });
                }
            }
        }
    }

    /// Adds to `crowded` those of at most [`BLOCK`] places whose rods may have another rod within their reach.
    ///
    /// Most rods have none and are skipped without a branch: no rod is near among the next [`WINDOW`]
    /// rods before and behind, and the reach can touch no others.
    fn find_crowded(&self, places: Range<usize>, crowded: &mut Vec<u32>) {
        let within = places.clone();
        let flags = widest(
            #[inline(always)]
            move || self.may_be_crowded(within),
        );
        let flagged = places.zip(flags).filter(|(_, flag)| *flag);
        crowded.extend(flagged.map(|(place, _)| place as u32));
    }

    /// For each place, whether its rod may have another rod within its reach.
    #[inline(always)]
    fn may_be_crowded(&self, places: Range<usize>) -> [bool; BLOCK] {
        let mut x = [[FAR; PADDED]; 3];
        let mut cell = [[0.0f32; PADDED]; 3];
        let mut reach = [0.0f32; PADDED];
        let before = places.start.saturating_sub(MARGIN);
        let end = self.sorted.len().min(places.end + MARGIN);
        let shift = before + MARGIN - places.start;
        let [slabs, rows] = [self.along[0] as f32, self.along[1] as f32];
        // Places beyond the first and the last rod get rows that do not exist.
        cell[0][..shift].fill(-1.0);
        cell[0][shift + end - before..].fill(slabs);
        let entries = &self.sorted[before..end];
        for axis in 0..3 {
            let own = x[axis][shift..].iter_mut().zip(&mut cell[axis][shift..]);
            for ((x, cell), entry) in own.zip(entries) {
                (*x, *cell) = (entry.place[axis], self.cell_at(axis, entry.place[axis]));
            }
        }
        for (reach, entry) in reach[shift..].iter_mut().zip(entries) {
            *reach = entry.reach + SLACK;
        }
        let mut squares = [[0.0f32; PADDED]; WINDOW];
        for (offset, squares) in (1..).zip(&mut squares) {
            for k in 0..PADDED - offset {
                let d = |axis: usize| x[axis][k + offset] - x[axis][k];
                squares[k] = d(0) * d(0) + d(1) * d(1) + d(2) * d(2);
            }
        }
        let width = self.width;
        let inner = self.sides.map(|side| side - SLACK);
        let row = |k: usize| cell[0][k] * rows + cell[1][k];
        let mut flags = [false; BLOCK];
        for k in MARGIN..MARGIN + BLOCK {
            let mut least = FAR;
            for (offset, squares) in (1..).zip(&squares) {
                least = lesser(least, lesser(squares[k], squares[k - offset]));
            }
            let near = least <= reach[k] * reach[k];
            // There are no rods beyond the walls of the volume.
            let within = |axis: usize| {
                let low = greater(x[axis][k] - reach[k], 0.0);
                let high = lesser(x[axis][k] + reach[k], inner[axis]);
                (low >= cell[axis][k] * width[axis]) & (high < (cell[axis][k] + 1.0) * width[axis])
            };
            let (low, high) = (k - MARGIN, k + MARGIN);
            let all_before = (row(low) != row(k)) | ((cell[2][low] + 1.0) * width[2] <= x[2][k] - reach[k]);
            let all_behind = (row(high) != row(k)) | (cell[2][high] * width[2] > x[2][k] + reach[k]);
            flags[k - MARGIN] = near | !(within(0) & within(1) & all_before & all_behind);
        }
        flags
    }

    /// The nearest other rod closer than the reach of `entry`, with the square of its distance.
    fn nearest_within(&self, positions: &[Vec<f64>; 3], entry: &Entry, work: &mut Counters) -> Option<(u32, f64)> {
        let reach = entry.reach.min(2.0);
        let widest = self.width.into_iter().fold(0.0, greater);
        let mut radius = reach.min(widest);
        loop {
            let found = self.nearest_in_ball(positions, entry, radius, work);
            if found.is_some() || radius >= reach {
                return found;
            }
            radius = reach.min(2.0 * radius);
        }
    }

    fn nearest_in_ball(
        &self,
        positions: &[Vec<f64>; 3],
        entry: &Entry,
        radius: f32,
        work: &mut Counters,
    ) -> Option<(u32, f64)> {
        let ends = |by: f32| std::array::from_fn(|axis| self.index(axis, entry.place[axis] + by));
        let [low, high]: [[usize; 3]; 2] = [ends(-radius - SLACK), ends(radius + SLACK)];
        let mut best = None;
        let mut best_square = (self.longest * f64::from(radius)).powi(2);
        // Who is farther than this in single precision is not nearer than the best.
        let mut most = (radius + SLACK).powi(2);
        for i in low[0]..=high[0] {
            for j in low[1]..=high[1] {
                let row = (i * self.along[1] + j) * self.along[2];
                let range = self.starts[row + low[2]] as usize..self.starts[row + high[2] + 1] as usize;
                work.cells += (high[2] + 1 - low[2]) as u64;
                work.pairs_screened += range.len() as u64;
                for other in &self.sorted[range] {
                    let d = |axis: usize| other.place[axis] - entry.place[axis];
                    if d(0) * d(0) + d(1) * d(1) + d(2) * d(2) > most || other.rod == entry.rod {
                        continue;
                    }
                    work.distances += 1;
                    let [own, place] = [entry.rod, other.rod].map(|rod| positions.each_ref().map(|x| x[rod as usize]));
                    let square = (0..3).map(|k| (place[k] - own[k]).powi(2)).sum::<f64>();
                    let closer = square < best_square;
                    let tie = square == best_square && best.is_some_and(|b| other.rod < b);
                    if closer || tie {
                        best = Some(other.rod);
                        best_square = square;
                        most = ((square.sqrt() / self.longest) as f32 + SLACK).powi(2);
                    }
                }
            }
        }
        best.map(|index| (index, best_square))
    }

    /// The cell index of coordinate `x` along `axis`; coordinates outside belong to the first or last cell.
    fn index(&self, axis: usize, x: f32) -> usize {
        ((x * self.per_length[axis]) as i32).clamp(0, self.along[axis] as i32 - 1) as usize
    }

    #[inline(always)]
    fn cell(&self, place: [f32; 3]) -> u32 {
        let at = |axis: usize| self.cell_at(axis, place[axis]);
        let [_, rows, columns] = self.along.map(|cells| cells as f32);
        ((at(0) * rows + at(1)) * columns + at(2)) as u32
    }

    /// [`Self::index`] of a coordinate in the volume, as a number with a fraction of 0: this vectorises. Of a single
    /// coordinate a cast is faster.
    #[inline(always)]
    fn cell_at(&self, axis: usize, x: f32) -> f32 {
        let (cells, last) = (x * self.per_length[axis], self.along[axis] as f32 - 1.0);
        let nearest = (cells + ROUNDS) - ROUNDS;
        let whole = if nearest > cells { nearest - 1.0 } else { nearest };
        if whole > last { last } else { whole }
    }
}

/// Adding 1.5 · 2²³ leaves no digits for a fraction of numbers up to 2²².
const ROUNDS: f32 = 12_582_912.0;

const MOST_ALONG: usize = 256;

/// Numbers of cells along each side for about `count` rods, as cubic as possible. A side thinner than a cube gets one
/// cell; the others share the rest.
fn cells_along(sides: [f64; 3], count: usize) -> [usize; 3] {
    let count = count as f64 / RODS_PER_CELL;
    let ratio = |axis: usize, other: usize| sides[axis] / sides[other];
    let cubic: [f64; 3] =
        std::array::from_fn(|axis| libm::cbrt(count * ratio(axis, (axis + 1) % 3) * ratio(axis, (axis + 2) % 3)));
    let thin: Vec<usize> = (0..3).filter(|axis| cubic[*axis] < 1.0).collect();
    let along: [f64; 3] = match thin[..] {
        [] => cubic,
        [thin] => {
            let [a, b] = [(thin + 1) % 3, (thin + 2) % 3];
            std::array::from_fn(|axis| match axis {
                axis if axis == thin => 1.0,
                axis => (count * ratio(axis, a + b - axis)).sqrt().min(count),
            })
        }
        // At most two sides are thin: the product of `cubic` is `count`.
        _ => std::array::from_fn(|axis| if thin.contains(&axis) { 1.0 } else { count }),
    };
    along.map(|cells| (cells.floor() as usize).clamp(1, MOST_ALONG))
}

/// How many rods are looked at for one list of those that need a search.
const LISTED: usize = 32 * BLOCK;

/// How many rods before and behind, in the order of cells, are tested first.
const WINDOW: usize = 4;
const MARGIN: usize = WINDOW + 1;
const PADDED: usize = BLOCK + 2 * MARGIN;
/// A coordinate farther away than any rod.
const FAR: f32 = f32::MAX;
