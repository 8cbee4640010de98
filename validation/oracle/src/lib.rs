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

/// The README's example, as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
