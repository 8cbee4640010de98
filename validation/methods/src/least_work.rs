//! The least work that a machine can do with an array, beside which the speed of the core is shown.

use fearless_simd::{Level, Simd, dispatch, f64x8, prelude::*};

/// A plain sum, in lanes that the compiler may keep side by side.
pub fn plain_sum(values: &[f64]) -> f64 {
    let mut lanes = [0.0; 8];
    for chunk in values.chunks_exact(8) {
        for (lane, value) in lanes.iter_mut().zip(chunk) {
            *lane += value;
        }
    }
    lanes.iter().sum::<f64>() + values.chunks_exact(8).remainder().iter().sum::<f64>()
}

/// Σ 1/√x over whole eights, in the widest instructions of the machine: one root and one quotient a number, the least
/// with which a direction is brought to length 1.
pub fn sum_of_inverse_roots(values: &[f64]) -> f64 {
    #[inline(always)]
    fn sum<S: Simd>(simd: S, values: &[f64]) -> f64 {
        let mut sums = f64x8::splat(simd, 0.0);
        for eight in values.chunks_exact(8) {
            sums += f64x8::splat(simd, 1.0) / f64x8::from_slice(simd, eight).sqrt();
        }
        sums.as_slice().iter().sum()
    }
    dispatch!(Level::new(), simd => sum(simd, values))
}

#[cfg(test)]
mod tests {
    #[test]
    fn sums_are_what_they_say() {
        let values: Vec<f64> = (1..=1003).map(f64::from).collect();
        assert_eq!(super::plain_sum(&values), 1003.0 * 1004.0 / 2.0);
        let values: Vec<f64> = (1..=8).flat_map(|_| [1.0, 4.0, 16.0]).collect();
        assert_eq!(super::sum_of_inverse_roots(&values), 8.0 * 1.75);
    }
}
