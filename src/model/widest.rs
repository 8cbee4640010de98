//! Loops over rods in the widest instructions of the machine, chosen at run time.

use fearless_simd::{Level, dispatch};

/// Runs `work`, compiled for each instruction set; functions that it calls must be inlined. The bits are the same on
/// every machine: sums keep their order, and no product is fused into a sum.
#[inline(always)]
pub(crate) fn widest<T>(work: impl FnOnce() -> T) -> T {
    dispatch!(Level::new(), _simd => work())
}
