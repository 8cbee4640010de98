//! Small loops without branches, for conditions that a processor cannot predict.

use std::ops::Range;

/// Number of rods in a block.
pub(super) const BLOCK: usize = 128;

/// Calls `found` with every rod whose cell is in `range`, in the order of rods.
pub(super) fn each_rod_in(cells: &[u32], range: Range<usize>, mut found: impl FnMut(usize)) {
    let (first, len) = (range.start as u32, range.len() as u32);
    for (block, cells) in cells.chunks(BLOCK).enumerate() {
        // The list is made without a branch: the processor cannot predict which rods are in the range.
        let mut list = [0u8; BLOCK];
        let mut listed = 0;
        for (k, cell) in cells.iter().enumerate() {
            list[listed] = k as u8;
            listed += usize::from(cell.wrapping_sub(first) < len);
        }
        for k in &list[..listed] {
            found(block * BLOCK + usize::from(*k));
        }
    }
}

/// The nearest whole number, for 0 ≤ x < 2³²: adding 2⁵² leaves no digits for a fraction. It vectorises, unlike `as`.
#[inline(always)]
pub(super) fn nearest_u32(x: f64) -> u32 {
    (x + 4_503_599_627_370_496.0).to_bits() as u32
}

/// The smaller of two numbers in one instruction; `f32::min` would also treat NaN.
#[inline(always)]
pub(super) fn lesser(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

#[inline(always)]
pub(super) fn greater(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}
