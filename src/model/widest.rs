//! Loops over rods in the widest instructions that the machine has, chosen at run time.

use fearless_simd::{Level, dispatch};

/// Runs `work`, compiled for each set of instructions; what it calls must be inlined into it. The bits are the same on every
/// machine: sums keep their order, and no product is fused into a sum.
#[inline(always)]
pub(crate) fn widest<T>(work: impl FnOnce() -> T) -> T {
    dispatch!(Level::new(), _simd => work())
}
