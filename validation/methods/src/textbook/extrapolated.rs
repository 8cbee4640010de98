//! The classical method of order 4, and extrapolated methods of any order.

use crate::integrators::rk4;
use nalgebra::{Matrix3, Vector3};

/// ṗ = Ap − p(p·Ap), Jeffery's equation with A = W + ΛD.
pub fn jeffery_rate(a: &Matrix3<f64>, p: Vector3<f64>) -> Vector3<f64> {
    a * p - p * p.dot(&(a * p))
}

/// p after `steps` steps of `h` s of the classical method of order 4.
pub fn rk4_in_p(a: &Matrix3<f64>, p: Vector3<f64>, h: f64, steps: u64) -> Vector3<f64> {
    (0..steps).fold(p, |p, _| rk4(|p| jeffery_rate(a, p), p, h))
}

/// p after `steps` steps of `h` s of an extrapolated method: Euler's with 1, 2, … substeps (Aitken & Neville; Hairer,
/// Nørsett & Wanner, Solving Ordinary Differential Equations I, II.9), of order `order`. If `normalised`, |p| is reset
/// to 1 after each step.
pub fn extrapolated(
    order: usize,
    normalised: bool,
    a: &Matrix3<f64>,
    p: Vector3<f64>,
    h: f64,
    steps: u64,
) -> Vector3<f64> {
    (0..steps).fold(p, |p, _| {
        let p = one_step(order, a, p, h);
        if normalised { p.normalize() } else { p }
    })
}

fn one_step(order: usize, a: &Matrix3<f64>, p: Vector3<f64>, h: f64) -> Vector3<f64> {
    let mut before: Vec<Vector3<f64>> = Vec::new();
    for parts in 1..=order {
        let mut row = vec![(0..parts).fold(p, |p, _| p + jeffery_rate(a, p) * (h / parts as f64))];
        for k in 1..parts {
            let ratio = parts as f64 / (parts - k) as f64;
            row.push(row[k - 1] + (row[k - 1] - before[k - 1]) / (ratio - 1.0));
        }
        before = row;
    }
    before[order - 1]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Twice the steps reduce the error by 2ᵖ. With 32 steps the errors of higher orders are no larger than that of
    /// the reference, about 10⁻¹².
    #[test]
    fn they_are_of_their_order() {
        let a = Matrix3::new(0.0, -0.1, 0.2, 0.9, 0.1, -0.3, 0.0, 0.4, -0.2);
        let start = Vector3::new(0.6, 0.0, 0.8);
        let end = extrapolated(8, true, &a, start, 1.0 / 64.0, 64);
        let order = |of: &dyn Fn(f64, u64) -> Vector3<f64>| {
            let error = |steps: u64| (of(1.0 / steps as f64, steps) - end).norm();
            (error(16) / error(32)).log2()
        };
        for p in 1..=5 {
            let found = order(&|h, steps| extrapolated(p, p % 2 == 0, &a, start, h, steps));
            assert!((found - p as f64).abs() < 0.4, "{p}: {found}");
        }
        let found = order(&|h, steps| rk4_in_p(&a, start, h, steps));
        assert!((found - 4.0).abs() < 0.2, "{found}");
    }
}
