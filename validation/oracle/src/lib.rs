//! The oracles that judge the simulator `shearbed`: closed forms, quadratures, values in any precision and a naive
//! reference.
//!
//! Nothing here uses the simulator: the crate does not depend on it, so the compiler enforces this.

pub mod angle_grid;
pub mod closed_form;
pub mod diffusion;
pub mod exponential;
pub mod isotropic;
pub mod jeffery;
pub mod kicks;
pub mod moments;
pub mod naive;
pub mod pairing;
pub mod quadrature;
pub mod reference;
pub mod spheroid;

/// The larger of two errors; NaN if one of them is NaN, which `f64::max` would lose.
pub fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { a.max(b) }
}

/// The largest error, 0 if there are none; NaN if one of them is NaN.
pub fn worst(errors: impl IntoIterator<Item = f64>) -> f64 {
    errors.into_iter().fold(0.0, larger)
}

/// The largest difference of numbers from those in the same places of another list, up to the end of the shorter one.
pub fn apart(a: &[f64], b: &[f64]) -> f64 {
    worst(a.iter().zip(b).map(|(a, b)| (a - b).abs()))
}

#[test]
fn an_error_that_is_no_number_stays() {
    assert_eq!(worst([0.1, 0.3, 0.2]), 0.3);
    for errors in [[f64::NAN, 1.0, 2.0], [1.0, f64::NAN, 2.0], [1.0, 2.0, f64::NAN]] {
        assert!(worst(errors).is_nan() && apart(&errors, &[0.0; 3]).is_nan());
    }
}

/// The README's example, as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
