//! Sharing the rods of one large run over threads. What comes out does not depend on how many threads share the
//! chunks.

use rayon::prelude::*;
use std::ops::Range;

/// Rods of one chunk, the least that a thread takes. A run of one chunk stays on one thread: its replicas are shared over threads.
pub(crate) const CHUNK: usize = 1 << 16;

/// What `each` makes of every chunk of three arrays of coordinates and its number, in the order of chunks.
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

/// What `each` makes of every chunk of `count` rods, in the order of chunks.
pub(crate) fn of_chunks<T: Send>(count: usize, each: impl Fn(Range<usize>) -> T + Sync) -> Vec<T> {
    (0..count.div_ceil(CHUNK)).into_par_iter().map(|k| each(k * CHUNK..count.min((k + 1) * CHUNK))).collect()
}
