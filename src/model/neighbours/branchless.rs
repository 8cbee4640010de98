//! Small loops whose outcome cannot be foretold, without branches.

use std::ops::Range;

/// Rods that are looked at together.
pub(super) const BLOCK: usize = 128;

/// Calls `found` with every rod whose cell is in `range`, in the order of rods.
pub(super) fn each_rod_in(cells: &[u32], range: Range<usize>, mut found: impl FnMut(usize)) {
    let (first, len) = (range.start as u32, range.len() as u32);
    for (block, cells) in cells.chunks(BLOCK).enumerate() {
        // Listed without a branch: which rod is in the range cannot be foretold.
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

/// As one instruction: `f32::min` minds NaN too.
pub(super) fn lesser(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

pub(super) fn greater(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}
