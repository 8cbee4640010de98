//! Nearest neighbours of many rods, by a grid of cells.

use super::Nearest;
use super::branchless::{BLOCK, greater, lesser};
use crate::model::chunks::{CHUNK, of_chunks};
use crate::model::widest::widest;
use crate::model::work::Counters;
use rayon::prelude::*;
use std::ops::Range;
use std::slice::IterMut;

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
/// Cells, and so the rods in memory, follow one another along axis 3, then 2, then 1, so that a search reads neighbouring memory.
/// The buffers are reused in every step.
#[derive(Clone, Debug, Default)]
pub(super) struct Grid {
    /// The longest side, the unit of length of all that follows.
    longest: f64,
    sides: [f32; 3],
    /// Number of cells along each side.
    along: [usize; 3],
    /// The sides of a cell.
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

/// The rods of a bucket before they are sorted, and their cells, counted from the bucket's first.
type Unsorted = (Vec<Entry>, Vec<u16>);

/// Rods per cell, about: with fewer the search looks at more cells, with more at more rods.
const RODS_PER_CELL: f64 = 1.4;

/// The most bytes that `count` rods take in a search: the entries, the starts of cells, and the entries of every bucket that may be sorted
/// at once.
pub(crate) fn bytes(count: usize) -> usize {
    let unsorted = size_of::<Entry>() + size_of::<u16>();
    let at_once = if count <= CHUNK { 1.0 } else { BUCKET as f64 / CHUNK as f64 };
    let starts = size_of::<u32>() as f64 / RODS_PER_CELL;
    count * size_of::<Entry>() + (count as f64 * (starts + at_once * unsorted as f64)) as usize
}

/// Cells per bucket. The rods of more than a chunk are first dealt out to buckets, then sorted within: a bucket's rods fit the cache.
const BUCKET: usize = 1 << 12;

/// An upper bound of the error of a distance in single precision, in longest sides: two coordinates are rounded, and so are their
/// difference and its square.
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

    /// Sorts the rods by cell, in the order of rods within each.
    fn sort<R: Iterator<Item = f64>>(
        &mut self,
        positions: &[Vec<f64>; 3],
        reaches: impl Fn(usize) -> R + Sync,
    ) {
        let count = positions[0].len();
        let cells = self.along.iter().product::<usize>();
        let mut starts = std::mem::take(&mut self.starts);
        let mut sorted = std::mem::take(&mut self.sorted);
        let mut unsorted = std::mem::take(&mut self.unsorted);
        starts.clear();
        starts.resize(cells + 1, 0);
        sorted.resize(count, Entry::default());
        if count <= CHUNK {
            self.deal(positions, 0..count, reaches(0), &mut [sorted.iter_mut()]);
            self.sort_bucket(0, 0, &mut sorted, &mut starts[1..], &mut unsorted);
        } else {
            let sizes = self.deal_chunks(positions, reaches, &mut sorted);
            let most = sizes.iter().copied().max().unwrap_or(0);
            let (mut before, mut rest) = (0, sorted.as_mut_slice());
            let buckets = sizes.iter().zip(starts[1..].chunks_mut(BUCKET)).map(|(size, ends)| {
                let (entries, others) = std::mem::take(&mut rest).split_at_mut(*size);
                rest = others;
                before += size;
                (before - size, entries, ends)
            });
            let buckets: Vec<_> = buckets.collect();
            (buckets.into_par_iter().enumerate()).with_min_len(CHUNK / BUCKET).for_each_init(
                || (Vec::with_capacity(most), Vec::with_capacity(most)),
                |unsorted, (bucket, (before, entries, ends))| {
                    self.sort_bucket((bucket * BUCKET) as u32, before as u32, entries, ends, unsorted);
                },
            );
        }
        (self.starts, self.sorted, self.unsorted) = (starts, sorted, unsorted);
    }

    /// Deals all rods out to buckets; returns the sizes of the buckets.
    fn deal_chunks<R: Iterator<Item = f64>>(
        &self,
        positions: &[Vec<f64>; 3],
        reaches: impl Fn(usize) -> R + Sync,
        mut sorted: &mut [Entry],
    ) -> Vec<usize> {
        let buckets = self.along.iter().product::<usize>().div_ceil(BUCKET);
        let counts = of_chunks(positions[0].len(), |rods| {
            let mut counts = vec![0; buckets];
            self.each_block(positions, rods, |_, _, cells| {
                cells.iter().for_each(|cell| counts[*cell as usize / BUCKET] += 1);
            });
            counts
        });
        // Each chunk of rods has room of its own in each bucket.
        let mut rooms: Vec<Vec<_>> = counts.iter().map(|_| Vec::with_capacity(buckets)).collect();
        for bucket in 0..buckets {
            for (rooms, counts) in rooms.iter_mut().zip(&counts) {
                let (room, others) = sorted.split_at_mut(counts[bucket]);
                rooms.push(room.iter_mut());
                sorted = others;
            }
        }
        rooms.into_par_iter().enumerate().for_each(|(chunk, mut rooms)| {
            let rods = chunk * CHUNK..positions[0].len().min((chunk + 1) * CHUNK);
            self.deal(positions, rods.clone(), reaches(rods.start), &mut rooms);
        });
        (0..buckets).map(|bucket| counts.iter().map(|counts| counts[bucket]).sum()).collect()
    }

    /// Puts `rods` into the rooms of their buckets, or into the only room.
    fn deal(
        &self,
        positions: &[Vec<f64>; 3],
        rods: Range<usize>,
        mut reaches: impl Iterator<Item = f64>,
        rooms: &mut [IterMut<Entry>],
    ) {
        let last = rooms.len() - 1;
        self.each_block(positions, rods, |first, places, cells| {
            for (k, (cell, reach)) in cells.iter().zip(&mut reaches).enumerate() {
                if let Some(entry) = rooms[(*cell as usize / BUCKET).min(last)].next() {
                    let reach = ((reach / self.longest) as f32).next_up();
                    let place = [places[0][k], places[1][k], places[2][k]];
                    *entry = Entry { place, reach, rod: (first + k) as u32 };
                }
            }
        });
    }

    /// Calls `each` with the first of every block of `rods`, their places in the volume and their cells.
    fn each_block(
        &self,
        positions: &[Vec<f64>; 3],
        rods: Range<usize>,
        mut each: impl FnMut(usize, &[[f32; BLOCK]; 3], &[u32]),
    ) {
        let (mut places, mut cells) = ([[0.0; BLOCK]; 3], [0; BLOCK]);
        for first in rods.clone().step_by(BLOCK) {
            let block = first..rods.end.min(first + BLOCK);
            let own = positions.each_ref().map(|x| &x[block.clone()]);
            let (places, cells) = (&mut places, &mut cells[..block.len()]);
            widest(
                #[inline(always)]
                || {
                    let per_longest = 1.0 / self.longest;
                    for (places, x) in places.iter_mut().zip(own) {
                        places.iter_mut().zip(x).for_each(|(place, x)| *place = (x * per_longest) as f32);
                    }
                    let [x1, x2, x3] = &*places;
                    for (cell, ((x1, x2), x3)) in cells.iter_mut().zip(x1.iter().zip(x2).zip(x3)) {
                        *cell = self.cell([*x1, *x2, *x3]);
                    }
                },
            );
            each(first, places, cells);
        }
    }

    /// Sorts the `entries` of the cells from `first` on, of which there are `before` others, and sets the `ends` of these cells.
    fn sort_bucket(
        &self,
        first: u32,
        before: u32,
        entries: &mut [Entry],
        ends: &mut [u32],
        (unsorted, cells): &mut Unsorted,
    ) {
        unsorted.clear();
        unsorted.extend_from_slice(entries);
        cells.resize(entries.len(), 0);
        widest(
            #[inline(always)]
            || {
                for (cell, entry) in cells.iter_mut().zip(&*entries) {
                    *cell = self.cell(entry.place).wrapping_sub(first) as u16;
                }
            },
        );
        cells.iter().for_each(|cell| ends[usize::from(*cell)] += 1);
        let mut sum = before;
        for end in &mut *ends {
            sum += std::mem::replace(end, sum);
        }
        // Each is now the start of its cell, and moves to its end as the cell fills.
        for (entry, cell) in unsorted.iter().zip(cells) {
            let place = &mut ends[usize::from(*cell)];
            entries[(*place - before) as usize] = *entry;
            *place += 1;
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
    fn nearest_within(
        &self,
        positions: &[Vec<f64>; 3],
        entry: &Entry,
        work: &mut Counters,
    ) -> Option<(u32, f64)> {
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
                    let [own, place] =
                        [entry.rod, other.rod].map(|rod| positions.each_ref().map(|x| x[rod as usize]));
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

    /// The cell of a place in the volume.
    #[inline(always)]
    fn cell(&self, place: [f32; 3]) -> u32 {
        let at = |axis: usize| self.cell_at(axis, place[axis]);
        let [_, rows, columns] = self.along.map(|cells| cells as f32);
        ((at(0) * rows + at(1)) * columns + at(2)) as u32
    }

    /// [`Self::index`] of a coordinate in the volume, as a number with a fraction of 0: this vectorises. Of a single coordinate a cast is
    /// faster.
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

/// The largest number of cells along a side.
const MOST_ALONG: usize = 256;

/// Numbers of cells along each side for about `count` rods, as cubic as possible. A side thinner than a cube gets one cell; the others
/// share the rest.
fn cells_along(sides: [f64; 3], count: usize) -> [usize; 3] {
    let count = count as f64 / RODS_PER_CELL;
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

/// How many rods are looked at for one list of those that need a search.
const LISTED: usize = 32 * BLOCK;

/// How many rods before and behind, in the order of cells, are tested first.
const WINDOW: usize = 4;
const MARGIN: usize = WINDOW + 1;
const PADDED: usize = BLOCK + 2 * MARGIN;
/// A coordinate farther away than any rod.
const FAR: f32 = f32::MAX;
