//! Nearest neighbours of many rods, by a grid of cells.

use super::Nearest;
use super::branchless::{BLOCK, each_rod_in, greater, lesser, nearest_u32};
use crate::model::chunks::{CHUNK, of_chunks};
use crate::model::phase::nearest_whole;
use crate::model::widest::widest;
use crate::model::work::Counters;
use rayon::prelude::*;
use std::ops::Range;

/// A rod as stored in its cell.
#[derive(Clone, Copy, Debug, Default)]
#[repr(align(32))]
struct Entry {
    position: [f64; 3],
    /// The rod's reach, rounded up.
    reach: f32,
    rod: u32,
}

/// Rods sorted into the cells of a volume [0, H₁) × [0, H₂) × [0, H₃), for one step, each with its reach.
///
/// Cells, and so the rods in memory, follow one another along axis 3, then 2, then 1, so that a search reads neighbouring memory.
/// The buffers are reused in every step.
#[derive(Clone, Debug, Default)]
pub(super) struct Grid {
    sides: [f64; 3],
    /// The longest of `sides`.
    longest: f64,
    /// Number of cells along each side.
    along: [usize; 3],
    /// Number of cells per unit of length along each axis.
    per_length: [f64; 3],
    /// The cell of each rod.
    cells: Vec<u32>,
    /// Index in `sorted` of each cell's first rod; one more entry ends the last cell.
    starts: Vec<u32>,
    sorted: Vec<Entry>,
    /// Indices in `sorted` of the rods that need a search.
    crowded: Vec<u32>,
}

impl Grid {
    /// An empty grid for about `count` rods in a volume of the given sides: about one rod a cell.
    pub fn new(sides: [f64; 3], count: usize) -> Self {
        let along = cells_along(sides, count);
        Self {
            sides,
            longest: sides.into_iter().fold(0.0, f64::max),
            along,
            per_length: std::array::from_fn(|axis| along[axis] as f64 / sides[axis]),
            ..Self::default()
        }
    }

    /// Like [`super::Neighbours::each_nearest`], in the order of cells.
    pub fn each_nearest(
        &mut self,
        positions: &[Vec<f64>; 3],
        reach: impl Fn(usize) -> f64 + Sync,
        work: &mut Counters,
        mut found: impl FnMut(Nearest),
    ) {
        self.find_cells(positions);
        self.sort(positions, reach);
        let count = self.sorted.len();
        work.pairs_screened += (WINDOW * count) as u64;
        if count <= CHUNK {
            let mut crowded = std::mem::take(&mut self.crowded);
            self.search(0..count, &mut crowded, work, found);
            self.crowded = crowded;
            return;
        }
        let chunks = of_chunks(count, |places| {
            let (mut all, mut work) = (Vec::new(), Counters::default());
            self.search(places, &mut Vec::new(), &mut work, |nearest| all.push(nearest));
            (all, work)
        });
        for (all, part) in chunks {
            work.add(&part);
            all.into_iter().for_each(&mut found);
        }
    }

    fn find_cells(&mut self, positions: &[Vec<f64>; 3]) {
        let count = positions[0].len();
        let mut cells = std::mem::take(&mut self.cells);
        cells.resize(count, 0);
        let fill = |(chunk, cells): (usize, &mut [u32])| {
            let part = chunk * CHUNK..chunk * CHUNK + cells.len();
            let [x1, x2, x3] = positions.each_ref().map(|x| &x[part.clone()]);
            let (grid, [_, rows, columns]) = (&*self, self.along.map(|cells| cells as f64));
            widest(
                #[inline(always)]
                move || {
                    for (cell, ((x1, x2), x3)) in cells.iter_mut().zip(x1.iter().zip(x2).zip(x3)) {
                        let (i, j, k) = (grid.cell_at(0, *x1), grid.cell_at(1, *x2), grid.cell_at(2, *x3));
                        *cell = nearest_u32((i * rows + j) * columns + k);
                    }
                },
            );
        };
        if count <= CHUNK {
            fill((0, &mut cells));
        } else {
            cells.par_chunks_mut(CHUNK).enumerate().for_each(fill);
        }
        self.cells = cells;
    }

    /// Sorts the rods by cell; each thread sorts those of a range of cells, in the order of rods.
    fn sort(&mut self, positions: &[Vec<f64>; 3], reach: impl Fn(usize) -> f64 + Sync) {
        let cells = self.along.iter().product::<usize>();
        let rods = &self.cells;
        let threads = if rods.len() <= CHUNK { 1 } else { rayon::current_num_threads() };
        let own = cells.div_ceil(threads);
        // Counts are stored two entries up, so that filling leaves `starts[cell]` at the start of its cell.
        self.starts.clear();
        self.starts.resize(cells + 2, 0);
        let count = |(part, counts): (usize, &mut [u32])| {
            let first = part * own;
            each_rod_in(rods, first..first + own, |rod| counts[rods[rod] as usize - first] += 1);
        };
        let counts = &mut self.starts[2..];
        if threads == 1 {
            count((0, counts));
        } else {
            counts.par_chunks_mut(own).enumerate().for_each(count);
        }
        let mut sum = 0;
        for start in &mut self.starts[2..] {
            sum += *start;
            *start = sum;
        }
        self.sorted.resize(rods.len(), Entry::default());
        let [x1, x2, x3] = positions;
        let place = |first: usize, places: &mut [u32], sorted: &mut [Entry]| {
            let taken = places[0];
            each_rod_in(rods, first..first + own, |rod| {
                let place = &mut places[rods[rod] as usize - first];
                sorted[(*place - taken) as usize] = Entry {
                    position: [x1[rod], x2[rod], x3[rod]],
                    reach: (reach(rod) as f32).next_up(),
                    rod: rod as u32,
                };
                *place += 1;
            });
        };
        if threads == 1 {
            place(0, &mut self.starts[1..], &mut self.sorted);
            return;
        }
        let mut rest = self.sorted.as_mut_slice();
        let mut parts = Vec::with_capacity(threads);
        let ends: Vec<_> =
            (own..cells + own).step_by(own).map(|end| self.starts[end.min(cells) + 1]).collect();
        for ((part, places), end) in self.starts[1..=cells].chunks_mut(own).enumerate().zip(ends) {
            let (sorted, others) = rest.split_at_mut((end - places[0]) as usize);
            rest = others;
            parts.push((part * own, places, sorted));
        }
        (parts.into_par_iter()).for_each(|(first, places, sorted)| place(first, places, sorted));
    }

    /// Calls `found` with every rod in `places` that has another rod within its reach.
    fn search(
        &self,
        places: Range<usize>,
        crowded: &mut Vec<u32>,
        work: &mut Counters,
        mut found: impl FnMut(Nearest),
    ) {
        crowded.clear();
        for first in places.clone().step_by(BLOCK) {
            self.find_crowded(first..places.end.min(first + BLOCK), crowded);
        }
        for &place in &*crowded {
            let entry = &self.sorted[place as usize];
            if let Some((other, square)) = self.nearest_within(entry, work) {
                found(Nearest { rod: entry.rod, other, square });
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
        // The reach is enlarged by the single-precision rounding of a coordinate and of a cell's border.
        let slack = 1e-6 * self.longest as f32;
        for (k, entry) in self.sorted[before..end].iter().enumerate() {
            for axis in 0..3 {
                x[axis][shift + k] = entry.position[axis] as f32;
                cell[axis][shift + k] = self.cell_at(axis, entry.position[axis]) as f32;
            }
            reach[shift + k] = entry.reach + slack;
        }
        let mut squares = [[0.0f32; PADDED]; WINDOW];
        for (offset, squares) in (1..).zip(&mut squares) {
            for k in 0..PADDED - offset {
                let d = |axis: usize| x[axis][k + offset] - x[axis][k];
                squares[k] = d(0) * d(0) + d(1) * d(1) + d(2) * d(2);
            }
        }
        let width = self.per_length.map(|per_length| 1.0 / per_length as f32);
        let inner = self.sides.map(|side| side as f32 - slack);
        let row = |k: usize| cell[0][k] * rows + cell[1][k];
        let mut flags = [false; BLOCK];
        for (k, flag) in (MARGIN..).zip(&mut flags) {
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
            *flag = near | !(within(0) & within(1) & all_before & all_behind);
        }
        flags
    }

    /// The nearest other rod closer than the reach of `entry`, with the square of its distance.
    fn nearest_within(&self, entry: &Entry, work: &mut Counters) -> Option<(u32, f64)> {
        let reach = f64::from(entry.reach).min(2.0 * self.longest);
        let widest = 1.0 / self.per_length.into_iter().fold(f64::INFINITY, f64::min);
        let mut radius = reach.min(widest);
        loop {
            let found = self.nearest_in_ball(entry, radius, work);
            if found.is_some() || radius >= reach {
                return found;
            }
            radius = reach.min(2.0 * radius);
        }
    }

    fn nearest_in_ball(&self, entry: &Entry, radius: f64, work: &mut Counters) -> Option<(u32, f64)> {
        let ends = |by: f64| std::array::from_fn(|axis| self.index(axis, entry.position[axis] + by));
        let [low, high]: [[usize; 3]; 2] = [ends(-radius), ends(radius)];
        let mut best = None;
        let mut best_square = radius * radius;
        for i in low[0]..=high[0] {
            for j in low[1]..=high[1] {
                let row = (i * self.along[1] + j) * self.along[2];
                let range = self.starts[row + low[2]] as usize..self.starts[row + high[2] + 1] as usize;
                work.cells += (high[2] + 1 - low[2]) as u64;
                work.distances += range.len() as u64;
                for other in &self.sorted[range] {
                    if other.rod == entry.rod {
                        continue;
                    }
                    let difference = |k: usize| other.position[k] - entry.position[k];
                    let square = (0..3).map(|k| difference(k).powi(2)).sum::<f64>();
                    let closer = square < best_square;
                    let tie = square == best_square && best.is_some_and(|b| other.rod < b);
                    if closer || tie {
                        best = Some(other.rod);
                        best_square = square;
                    }
                }
            }
        }
        best.map(|index| (index, best_square))
    }

    /// The cell index of coordinate `x` along `axis`; coordinates outside belong to the first or last cell.
    fn index(&self, axis: usize, x: f64) -> usize {
        ((x * self.per_length[axis]) as i32).clamp(0, self.along[axis] as i32 - 1) as usize
    }

    /// [`Self::index`] of a coordinate in the volume, as a number with a fraction of 0: this vectorises. Of a single coordinate a cast is
    /// faster.
    #[inline(always)]
    fn cell_at(&self, axis: usize, x: f64) -> f64 {
        let (cells, last) = (x * self.per_length[axis], (self.along[axis] - 1) as f64);
        let nearest = nearest_whole(cells);
        let whole = if nearest > cells { nearest - 1.0 } else { nearest };
        if whole > last { last } else { whole }
    }
}

/// The largest number of cells along a side.
const MOST_ALONG: usize = 256;

/// Numbers of cells along each side for about `count` cells, as cubic as possible. A side thinner than a cube gets one cell; the others
/// share the rest.
fn cells_along(sides: [f64; 3], count: usize) -> [usize; 3] {
    let count = count as f64;
    let ratio = |axis: usize, other: usize| sides[axis] / sides[other];
    let cubic: [f64; 3] = std::array::from_fn(|axis| {
        libm::cbrt(count * ratio(axis, (axis + 1) % 3) * ratio(axis, (axis + 2) % 3))
    });
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

/// How many rods before and behind, in the order of cells, are tested first.
const WINDOW: usize = 4;
const MARGIN: usize = WINDOW + 1;
const PADDED: usize = BLOCK + 2 * MARGIN;
/// A coordinate farther away than any rod.
const FAR: f32 = f32::MAX;
