//! Shares the rods of one large run among threads. The results do not depend on the number of threads.

use rayon::prelude::*;
use std::ops::Range;

/// Rods per chunk, the least work given to a thread. A run of one chunk stays on one thread; then replicas are shared
/// among threads.
pub(crate) const CHUNK: usize = 1 << 16;

/// Calls `each` with the number and the coordinates of every chunk of `axes`; returns the results in the order of
/// chunks.
pub(crate) fn over_chunks<T: Send>(
    axes: &mut [Vec<f64>; 3],
    each: impl Fn(usize, [&mut [f64]; 3]) -> T + Sync,
) -> Vec<T> {
    let [x1, x2, x3] = axes;
    if x1.len() <= CHUNK {
        return vec![each(0, [x1, x2, x3])];
    }
    (x1.par_chunks_mut(CHUNK).zip(x2.par_chunks_mut(CHUNK)).zip(x3.par_chunks_mut(CHUNK)))
        .enumerate()
        .map(|(k, ((x1, x2), x3))| each(k, [x1, x2, x3]))
        .collect()
}

/// Calls `each` with the range of rods of every chunk of `count` rods; returns the results in the order of chunks.
pub(crate) fn of_chunks<T: Send>(count: usize, each: impl Fn(Range<usize>) -> T + Sync) -> Vec<T> {
    (0..count.div_ceil(CHUNK)).into_par_iter().map(|k| each(k * CHUNK..count.min((k + 1) * CHUNK))).collect()
}
