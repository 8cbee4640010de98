//! Sorting rods into cells.

use super::{Entry, Grid, RODS_PER_CELL};
use crate::model::chunks::{CHUNK, of_chunks};
use crate::model::neighbours::branchless::BLOCK;
use crate::model::widest::widest;
use rayon::prelude::*;
use std::ops::Range;
use std::slice::IterMut;

/// The rods of a bucket before they are sorted, and their cells, counted from the bucket's first.
pub(super) type Unsorted = (Vec<Entry>, Vec<u16>);

/// Cells per bucket. The rods of more than a chunk are first dealt out to buckets, then sorted within: a bucket's rods
/// fit the cache.
const BUCKET: usize = 1 << 12;

/// The most bytes that `count` rods take in a search: the entries, the starts of cells, and the entries of every bucket
/// that may be sorted at once.
pub(crate) fn bytes(count: usize) -> usize {
    let unsorted = size_of::<Entry>() + size_of::<u16>();
    let at_once = if count <= CHUNK { 1.0 } else { BUCKET as f64 / CHUNK as f64 };
    let starts = size_of::<u32>() as f64 / RODS_PER_CELL;
    count * size_of::<Entry>() + (count as f64 * (starts + at_once * unsorted as f64)) as usize
}

impl Grid {
    /// Sorts the rods by cell, in the order of rods within each.
    pub(super) fn sort<R: Iterator<Item = f64>>(
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

    /// Sorts the `entries` of the cells from `first` on, of which there are `before` others, and sets the `ends` of
    /// these cells.
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
}
