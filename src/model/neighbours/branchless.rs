//! Small loops without branches, for conditions that a processor cannot predict.

pub(super) const BLOCK: usize = 128;

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
