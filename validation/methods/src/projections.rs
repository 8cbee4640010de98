//! Means of |p_i| of initially isotropic rods, by a formula that the oracles do not use.

use nalgebra::{Matrix3, Vector3};

/// ⟨|p_i|⟩ of directions M p(0)/|M p(0)| for isotropic p(0): (1/π) ∫ (adj N)_ii^½ x^½/det N d(ln x), N = (M Mᵀ)⁻¹ + x
/// with det M = 1, by the trapezoid rule with an error of e^(−2π²/h).
pub fn projections(map: &Matrix3<f64>) -> Option<Vector3<f64>> {
    const STEP: f64 = 0.5;
    let map = map / map.determinant().abs().cbrt();
    let back = map.try_inverse()?;
    let (sigma, inverse) = (map * map.transpose(), back.transpose() * back);
    // The integrand rises as x^½ and falls as x^(−3/2).
    let steps = |range: f64| (range / STEP).ceil() as i32;
    let (left, right) = (steps(sigma.trace().ln() + 70.0), steps(inverse.trace().ln() + 25.0));
    let at = |k: i32| {
        let x = (STEP * f64::from(k)).exp();
        let determinant = ((x + inverse.trace()) * x + sigma.trace()) * x + 1.0;
        let adjugate = Vector3::from_fn(|i, _| (x + inverse.trace() - inverse[(i, i)]) * x + sigma[(i, i)]);
        adjugate.map(|entry| (entry * x).sqrt()) / determinant
    };
    let sum: Vector3<f64> = (-left..=right).map(at).sum();
    let means = sum * STEP / std::f64::consts::PI;
    means.iter().all(|mean| mean.is_finite()).then_some(means)
}

#[cfg(test)]
mod tests {
    use super::*;
    use shearbed_oracle::isotropic::mean_projections;

    #[test]
    fn they_are_carlsons_integrals() {
        for turns in [0.0, 0.1, 0.25, 0.5] {
            let (sin, cos) = (std::f64::consts::TAU * turns).sin_cos();
            let r = 11.6;
            let map = Matrix3::new(cos, -sin / r, 0.0, r * sin, cos, 0.0, 0.0, 0.0, 1.0);
            let off = projections(&map).unwrap() - Vector3::from(mean_projections(r, turns));
            assert!(off.amax() < 1e-12, "{turns}: {off}");
        }
        assert_eq!(projections(&Matrix3::zeros()), None);
    }
}
