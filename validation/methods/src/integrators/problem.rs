//! The problem that every integrator solves: one free rod in plane Couette flow u_2 = G x_1.

use nalgebra::{Matrix3, UnitVector3, Vector2, Vector3};
use shearbed_oracle::closed_form;
use std::f64::consts::TAU;

/// One free rod in plane Couette flow, in units of 1/G, over a number of its periods.
///
/// The right-hand sides are written apart from the core's, without cancellation at large r_e.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RodProblem {
    /// The aspect ratio r_e > 0.
    pub aspect_ratio: f64,
    /// t/T at the end.
    pub turns: f64,
    /// ½(1 + Λ) = r_e²/(r_e² + 1).
    long: f64,
    /// ½(1 − Λ) = 1/(r_e² + 1).
    short: f64,
}

impl RodProblem {
    /// A rod of `aspect_ratio` > 0 over `turns` periods.
    pub fn new(aspect_ratio: f64, turns: f64) -> Self {
        let square = aspect_ratio * aspect_ratio;
        Self { aspect_ratio, turns, long: 1.0 / (1.0 + 1.0 / square), short: 1.0 / (1.0 + square) }
    }

    /// From φ = 0.2, θ = 1 through a whole period, two flips, into the third to φ = 2π + 1: errors in phase or orbit
    /// are visible there, but not where long rods lie along the flow, whatever they did before.
    pub fn mid_flip(aspect_ratio: f64) -> (Self, UnitVector3<f64>) {
        Self::into_flip(aspect_ratio, 0.2, 1.0, 1.0)
    }

    /// From φ and θ (rad) through `turns` periods, and on to φ = 1 of either end of the rod: into the middle of the
    /// next flip.
    pub fn into_flip(aspect_ratio: f64, phi: f64, theta: f64, turns: f64) -> (Self, UnitVector3<f64>) {
        let phase = |phi: f64| (phi.sin() / aspect_ratio).atan2(phi.cos()) / TAU;
        let rest = phase(1.0) - phase(phi) - turns;
        let problem = Self::new(aspect_ratio, turns + rest.rem_euclid(0.5));
        (problem, direction(phi, theta))
    }

    /// The duration GT t/T in 1/G (eq. 15).
    pub fn strain(&self) -> f64 {
        TAU * (self.aspect_ratio + 1.0 / self.aspect_ratio) * self.turns
    }

    /// ṗ/G = Ap − p (p·Ap), A = W + ΛD: Jeffery's equation for |p| = 1.
    #[inline]
    pub fn rate(&self, p: &Vector3<f64>) -> Vector3<f64> {
        let along = (self.long - self.short) * p.x * p.y;
        self.pull(p) - p * along
    }

    /// ṗ/G = Ap − p (p·Ap)/|p|²: equal to `rate` at |p| = 1, and at right angles to p at any length.
    #[inline]
    pub fn tangent_rate(&self, p: &Vector3<f64>) -> Vector3<f64> {
        let along = (self.long - self.short) * p.x * p.y / p.norm_squared();
        self.pull(p) - p * along
    }

    /// ∂ṗ_i/∂p_j/G of [`RodProblem::rate`].
    pub fn rate_slope(&self, p: &Vector3<f64>) -> Matrix3<f64> {
        let shape = self.long - self.short;
        let along = Matrix3::identity() * (shape * p.x * p.y);
        self.matrix() - along - p * Vector3::new(shape * p.y, shape * p.x, 0.0).transpose()
    }

    /// ∂ṗ_i/∂p_j/G of [`RodProblem::tangent_rate`].
    pub fn tangent_rate_slope(&self, p: &Vector3<f64>) -> Matrix3<f64> {
        let shape = (self.long - self.short) / p.norm_squared();
        let along = shape * p.x * p.y;
        let gradient = Vector3::new(shape * p.y, shape * p.x, 0.0) - p * (2.0 * along / p.norm_squared());
        self.matrix() - Matrix3::identity() * along - p * gradient.transpose()
    }

    /// A = W + ΛD (A.1 in Cartesian components).
    fn matrix(&self) -> Matrix3<f64> {
        Matrix3::new(0.0, -self.short, 0.0, self.long, 0.0, 0.0, 0.0, 0.0, 0.0)
    }

    #[inline]
    fn pull(&self, p: &Vector3<f64>) -> Vector3<f64> {
        Vector3::new(-self.short * p.y, self.long * p.x, 0.0)
    }

    /// (φ̇, θ̇)/G at (φ, θ) in rad (A.2, A.3).
    #[inline]
    pub fn angle_rates(&self, angles: &Vector2<f64>) -> Vector2<f64> {
        let (sin_phi, cos_phi) = angles.x.sin_cos();
        let (sin_theta, cos_theta) = angles.y.sin_cos();
        Vector2::new(
            self.long * cos_phi * cos_phi + self.short * sin_phi * sin_phi,
            (self.long - self.short) * sin_theta * cos_theta * sin_phi * cos_phi,
        )
    }

    /// The direction at the end by the closed forms A.4 and A.5, which no integrator uses.
    ///
    /// Their error is 2·10⁻¹⁵ max(r_e, 1/r_e), and a few 10⁻¹⁶ near whole turns, where the phase is small.
    pub fn reference(&self, start: &UnitVector3<f64>) -> UnitVector3<f64> {
        let (phi, theta) = (start.y.atan2(start.x), start.x.hypot(start.y).atan2(start.z));
        // Whole turns change nothing, but φ would lose digits.
        let rest = self.turns - self.turns.round();
        let (phi, theta) = closed_form::angles_at(phi, theta, self.aspect_ratio, rest);
        direction(phi, theta)
    }
}

fn direction(phi: f64, theta: f64) -> UnitVector3<f64> {
    let in_plane = theta.sin();
    UnitVector3::new_normalize(Vector3::new(in_plane * phi.cos(), in_plane * phi.sin(), theta.cos()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use shearbed_oracle::jeffery;

    #[test]
    fn the_right_hand_sides_are_those_of_the_paper() {
        let mut gradient = Matrix3::zeros();
        gradient[(1, 0)] = 1.0;
        for r in [0.3, 2.0, 11.6, 100.0] {
            let problem = RodProblem::new(r, 1.0);
            for (phi, theta) in [(0.3f64, 1.0f64), (2.0, 0.4), (-1.0, 1.4)] {
                let p = direction(phi, theta);
                let expected = jeffery::direction_rate_per_s(&gradient, r, &p);
                assert!((problem.rate(&p) - expected).norm() < 1e-15);
                assert!((problem.tangent_rate(&p) - expected).norm() < 1e-15);
                let rates = problem.angle_rates(&Vector2::new(phi, theta));
                let expected = jeffery::angle_rates_per_s(1.0, r, phi, theta);
                assert!((rates.x - expected.0).abs() < 1e-15 && (rates.y - expected.1).abs() < 1e-15);
                let tangent = problem.tangent_rate(&(2.5 * p.into_inner()));
                assert!(tangent.dot(&p).abs() < 1e-15);
            }
        }
    }

    type Rate = fn(&RodProblem, &Vector3<f64>) -> Vector3<f64>;
    type Slope = fn(&RodProblem, &Vector3<f64>) -> Matrix3<f64>;

    #[test]
    fn slopes_are_those_of_the_rates() {
        let (problem, m) = (RodProblem::new(3.0, 1.0), Vector3::new(0.4, -0.7, 0.5));
        let pairs: [(Rate, Slope, f64); 2] = [
            (RodProblem::rate, RodProblem::rate_slope, 1e-5),
            (RodProblem::tangent_rate, RodProblem::tangent_rate_slope, 1e-6),
        ];
        for (rate, slope, h) in pairs {
            for axis in 0..3 {
                let e = Vector3::ith(axis, h);
                let difference = (rate(&problem, &(m + e)) - rate(&problem, &(m - e))) / (2.0 * h);
                // The error is at most h² times a third derivative of 3Λ/3!, and ε/h.
                assert!((slope(&problem, &m).column(axis) - difference).norm() < 1e-9, "{axis} {h}");
            }
        }
    }

    #[test]
    fn it_ends_in_the_flip() {
        for r in [0.1, 2.0, 11.6, 1e4] {
            let (problem, start) = RodProblem::mid_flip(r);
            let end = problem.reference(&start);
            // The fraction of a turn is rounded to 10⁻¹⁶, and φ moves by r_e times that.
            assert!((end.y.atan2(end.x) - 1.0).abs() < 2e-15 * (1.0 + r), "{r}");
            let (later, _) = RodProblem::into_flip(r, 2.5, 0.3, 1.75);
            let end = later.reference(&direction(2.5, 0.3));
            assert!(((end.y / end.x).atan() - 1.0).abs() < 4e-15 * (1.0 + r));
            assert!((1.75..2.25).contains(&later.turns));
            assert!((problem.strain() / (TAU * (r + 1.0 / r)) - problem.turns).abs() < 1e-15);
        }
    }
}
