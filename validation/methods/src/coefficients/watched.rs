//! J and the moments from every step of the rods of one replica.

use super::Means;
use crate::tensors::fourth::PAIRS;
use nalgebra::{Matrix3, Vector3, Vector6};

/// Moments change little in a step: every tenth step's are taken.
const EVERY: usize = 10;

/// The means over `steps` steps of the rods of one replica, each of the given strain, over which Jeffery's motion is
/// `free` ([`super::free`]): from the directions at the `start` through those that `next` returns after each step.
/// `None` if `next` stops.
// Not generic, so that it is compiled in this crate, which is optimised, and not in the suite, which is not.
pub fn watched(
    free: &Matrix3<f64>,
    strain: f64,
    start: Vec<Vector3<f64>>,
    steps: usize,
    next: &mut dyn FnMut() -> Option<Vec<Vector3<f64>>>,
) -> Option<Means> {
    let mut sums = Means::default();
    let mut before = start;
    for step in 0..steps {
        let after = next()?;
        let share = 1.0 / after.len() as f64;
        for (p, moved) in before.iter().zip(&after) {
            let alone = (free * p).normalize();
            sums.gain += (moved * moved.transpose() - alone * alone.transpose()) * share;
        }
        if step.is_multiple_of(EVERY) {
            for p in &after {
                let pairs = Vector6::from_fn(|n, _| p[PAIRS[n].0] * p[PAIRS[n].1]);
                let square = p * p.transpose() * share;
                sums.second += square;
                sums.fourth.0 += pairs * pairs.transpose() * share;
                sums.sixth += square * (p.x * p.y).powi(2);
            }
        }
        before = after;
    }
    let share = 1.0 / steps.div_ceil(EVERY) as f64;
    sums.second *= share;
    sums.fourth.0 *= share;
    sums.sixth *= share;
    sums.gain /= steps as f64 * strain;
    Some(sums)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::coefficients::{Diffusing, Diffusion, free};

    const LAMBDA: f64 = 0.8;
    const STRAIN: f64 = 0.01;

    /// The means of rods with this diffusivity over `steps` steps, after as many others.
    fn found(rods: usize, steps: usize, diffusivity: Matrix3<f64>) -> Means {
        let diffusion = Diffusion { shape_factor: LAMBDA, diffusivity, strain: STRAIN };
        let mut all = Diffusing::isotropic(rods, diffusion, 5);
        (0..steps).for_each(|_| all.step());
        all.means(&free(LAMBDA, STRAIN), steps)
    }

    /// p = (0.6, 0.8, 0) after (0, 1, 0), without a motion of its own.
    #[test]
    fn the_step_of_one_rod_by_hand() {
        let mut turned = || Some(vec![Vector3::new(0.6, 0.8, 0.0)]);
        let found = watched(&Matrix3::identity(), 0.5, vec![Vector3::y()], 1, &mut turned).unwrap();
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
        // A step of pδ + δp with δ of variance 2C·0.01 scatters by 0.018: 0.74 % of |J| in the mean of 8·10⁶, five of
        // which are allowed.
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
