//! Means over steps that are watched one by one.

use super::Means;
use crate::tensors::closures::PAIRS;
use nalgebra::{Matrix3, Vector3, Vector6};

/// Moments change little in a step: every tenth step's are taken.
const EVERY: usize = 10;

/// The steps of the rods of one replica, from which [`Means`] come.
#[derive(Clone, Debug)]
pub struct Watched {
    free: Matrix3<f64>,
    strain: f64,
    steps: usize,
    samples: usize,
    sums: Means,
}

impl Watched {
    /// No steps yet; each will have this strain, over which Jeffery's motion is `free` ([`super::free`]).
    pub fn new(free: Matrix3<f64>, strain: f64) -> Self {
        Self { free, strain, steps: 0, samples: 0, sums: Means::default() }
    }

    /// Adds a step of all rods from their directions `before` it to those `after`.
    pub fn step(&mut self, before: &[Vector3<f64>], after: &[Vector3<f64>]) {
        let share = 1.0 / after.len() as f64;
        for (p, moved) in before.iter().zip(after) {
            let alone = (self.free * p).normalize();
            self.sums.gain += (moved * moved.transpose() - alone * alone.transpose()) * share;
        }
        if self.steps.is_multiple_of(EVERY) {
            self.samples += 1;
            for p in after {
                let pairs = Vector6::from_fn(|n, _| p[PAIRS[n].0] * p[PAIRS[n].1]);
                let square = p * p.transpose() * share;
                self.sums.second += square;
                self.sums.fourth.0 += pairs * pairs.transpose() * share;
                self.sums.sixth += square * (p.x * p.y).powi(2);
            }
        }
        self.steps += 1;
    }

    /// The means over the steps.
    pub fn means(&self) -> Means {
        let share = 1.0 / self.samples as f64;
        let mut means = self.sums;
        means.second *= share;
        means.fourth.0 *= share;
        means.sixth *= share;
        means.gain /= self.steps as f64 * self.strain;
        means
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::coefficients::{Diffusing, Diffusion};

    const LAMBDA: f64 = 0.8;
    const STRAIN: f64 = 0.01;

    /// The means of rods with this diffusivity over `steps` steps, after as many others.
    fn found(rods: usize, steps: usize, diffusivity: Matrix3<f64>) -> Means {
        let diffusion = Diffusion { shape_factor: LAMBDA, diffusivity, strain: STRAIN };
        let mut all = Diffusing::isotropic(rods, diffusion, 5);
        (0..steps).for_each(|_| all.step());
        all.means(steps)
    }

    /// p = (0.6, 0.8, 0) after (0, 1, 0), without a motion of its own.
    #[test]
    fn the_step_of_one_rod_by_hand() {
        let mut watched = Watched::new(Matrix3::identity(), 0.5);
        watched.step(&[Vector3::y()], &[Vector3::new(0.6, 0.8, 0.0)]);
        let found = watched.means();
        let close = |found: f64, due: f64| assert!((found - due).abs() < 1e-14, "{found} {due}");
        close(found.second[(0, 1)], 0.48);
        close(found.fourth.at(0, 0, 1, 1), 0.48 * 0.48);
        close(found.sheared()[(1, 1)], 0.64 * 0.48);
        close(found.sixth[(0, 0)], 0.36 * 0.48 * 0.48);
        // 0.36 more, and 0.36 less, in a strain of a half.
        close(found.gain[(0, 0)], 0.72);
        close(found.gain[(1, 1)], -0.72);
    }

    #[test]
    fn free_rods_gain_nothing() {
        let gain = found(500, 100, Matrix3::zeros()).gain;
        assert!(gain.amax() < 1e-13, "{gain}");
    }

    /// Of an anisotropic diffusivity that is known, J is what the operator makes of it, in every component.
    #[test]
    fn anisotropic_diffusion_gains_what_its_operator_says() {
        let diffusivity = Matrix3::new(0.1, 0.02, 0.0, 0.02, 0.04, 0.0, 0.0, 0.0, 0.01);
        let means = found(2000, 4000, diffusivity);
        let due = means.diffused(&diffusivity);
        let off = |due: Matrix3<f64>| (means.gain - due).amax() / due.norm();
        // A step of pδ + δp with δ of variance 2C·0.01 scatters by 0.018: 0.74 % of |J| in the mean of 8·10⁶, five of which are allowed.
        assert!(off(due) < 0.037, "{} {} {due}", off(due), means.gain);
        // One C_I says something else, and so does the operator without the drift.
        assert!(means.misfit() > 0.1, "{}", means.misfit());
        let (c, a) = (diffusivity, means.second);
        let other = due + c * a + a * c - means.fourth.contract(&c) * 2.0;
        assert!(off(other) > 0.1, "{}", off(other));
    }

    #[test]
    fn koch_s_coefficients_are_found_in_what_they_do() {
        let mut means = found(500, 500, Matrix3::identity() * 0.01);
        let [one, other] = means.diffusivities_of_koch();
        means.gain = means.diffused(&(one * 0.2 + other * 3.0));
        let (found, misfit) = means.koch();
        assert!((found[0] - 0.2).abs() < 1e-9 && (found[1] - 3.0).abs() < 1e-9, "{found:?}");
        assert!(misfit < 1e-12 && means.misfit() > 0.05, "{misfit} {}", means.misfit());
        // One C_I is a multiple of the first.
        means.gain = means.diffusion() * 0.01;
        let (found, misfit) = means.koch();
        assert!((found[0] * means.sixth.trace() - 0.01).abs() < 1e-9 && found[1].abs() < 1e-9, "{found:?}");
        assert!(misfit < 1e-9 && means.misfit() < 1e-12);
    }
}
