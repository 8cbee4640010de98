//! The imposed velocity field: u_i = Σ_j (∂u_i/∂x_j) x_j (eqs 2 and 3).

use nalgebra::Matrix3;

/// A constant velocity gradient L with L_ij = ∂u_i/∂x_j in 1/s (eq. 2, with the printed ∂x_i read as ∂x_j).
///
/// Axes: 1 is the gradient axis, 2 the flow axis, 3 the vorticity axis of plane Couette flow.
/// All nine components are finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VelocityGradient(Matrix3<f64>);

impl VelocityGradient {
    /// A gradient from its nine components in 1/s, row i and column j holding ∂u_i/∂x_j.
    /// `None` when a component is not finite.
    pub fn new(per_s: Matrix3<f64>) -> Option<Self> {
        per_s.iter().all(|c| c.is_finite()).then_some(Self(per_s))
    }

    /// Plane Couette flow u_2 = G x_1 with the shear rate G in 1/s; `None` if G is not finite.
    pub fn plane_couette(shear_rate_per_s: f64) -> Option<Self> {
        let mut per_s = Matrix3::zeros();
        per_s[(1, 0)] = shear_rate_per_s;
        Self::new(per_s)
    }

    /// The matrix L in 1/s.
    pub fn per_s(&self) -> &Matrix3<f64> {
        &self.0
    }

    /// G in 1/s where the flow is plane Couette flow u_2 = G x_1 with G ≠ 0, else `None`.
    pub fn shear_rate_per_s(&self) -> Option<f64> {
        let g = self.0[(1, 0)];
        let only = self.0.iter().filter(|c| **c != 0.0).count() == 1;
        (only && g != 0.0).then_some(g)
    }

    /// The strain rate D = (L + Lᵀ)/2 in 1/s.
    pub fn strain_rate(&self) -> Matrix3<f64> {
        0.5 * (self.0 + self.0.transpose())
    }

    /// The vorticity tensor W = (L − Lᵀ)/2 in 1/s, so that L = W + D.
    pub fn vorticity(&self) -> Matrix3<f64> {
        0.5 * (self.0 - self.0.transpose())
    }

    /// The magnitude (2 D:D)^½ of the strain rate in 1/s: |G| in plane Couette flow, 0 in a pure rotation.
    pub fn magnitude_per_s(&self) -> f64 {
        self.scaled(Self::strain_rate)
    }

    /// The magnitude (2 W:W)^½ of the vorticity in 1/s, twice the rate at which the liquid turns: |G| in plane Couette
    /// flow.
    pub fn turn_per_s(&self) -> f64 {
        self.scaled(Self::vorticity)
    }

    /// √2 times the norm of `part` of the gradient, in 1/s.
    fn scaled(&self, part: impl Fn(&Self) -> Matrix3<f64>) -> f64 {
        let largest = self.0.amax();
        if largest == 0.0 {
            return 0.0;
        }
        // Scaled first, so that components of 10⁻³⁰⁰ or 10³⁰⁸ neither underflow nor overflow in the squares and sums.
        largest * part(&Self(self.0 / largest)).norm() * std::f64::consts::SQRT_2
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;

    #[test]
    fn plane_couette_flow_is_recognised_and_only_it() {
        let flow = VelocityGradient::plane_couette(-0.5).unwrap();
        assert_eq!(flow.shear_rate_per_s(), Some(-0.5));
        assert_eq!(flow.per_s() * Vector3::new(2.0, 7.0, 7.0), Vector3::new(0.0, -1.0, 0.0));
        let mut other = *flow.per_s();
        other[(0, 1)] = 1e-300;
        assert_eq!(VelocityGradient::new(other).unwrap().shear_rate_per_s(), None);
        assert!(VelocityGradient::plane_couette(f64::NAN).is_none());
    }

    #[test]
    fn the_magnitude_of_plane_couette_flow_is_its_shear_rate() {
        for g in [1e-300, 0.5, 1e300] {
            let flow = VelocityGradient::plane_couette(g).unwrap();
            assert!((flow.magnitude_per_s() / g - 1.0).abs() < 4.0 * f64::EPSILON);
            assert!((flow.turn_per_s() / g - 1.0).abs() < 4.0 * f64::EPSILON);
        }
        let extension = |e: f64| VelocityGradient::new(Matrix3::from_diagonal(&Vector3::new(e, -e, 0.0)));
        assert!((extension(8e307).unwrap().magnitude_per_s() / 1.6e308 - 1.0).abs() < 4.0 * f64::EPSILON);
        assert_eq!(extension(1e308).unwrap().magnitude_per_s(), f64::INFINITY);
    }
}
