//! The model's values at the times of measured points, with their uncertainties.

use crate::methods::interpolate::interpolate;
use nalgebra::DMatrix;
use rayon::prelude::*;
use shearbed::observable::Channel;
use shearbed::plan::Plan;
use shearbed::run::run_replica;
use shearbed::scene::Output;
use shearbed::{Observable, Scene};

/// A place on a curve of the model.
#[derive(Clone, Copy, Debug)]
pub(super) struct MeasuredAt {
    /// Time t/T.
    pub(super) turns: f64,
    /// One standard deviation of t/T.
    pub(super) u_turns: f64,
    /// Index of the observable: 0, 1, 2 for x1, x2, x3.
    pub(super) channel: usize,
}

/// The model's values at some places.
#[derive(Clone, Debug)]
pub(super) struct Model {
    /// Means over rods and replicas.
    pub(super) value: Vec<f64>,
    /// The variance of each value due to its uncertain time.
    pub(super) time_variance: Vec<f64>,
    /// The difference between linear and the cubic interpolation that is used: more than the cubic's own error.
    pub(super) interpolation: Vec<f64>,
    /// A row for each replica, a column for each place: spreadᵀ·spread is the covariance of one replica's values, and
    /// divided by the number of replicas that of `value`.
    pub(super) spread: DMatrix<f64>,
}

/// Number of values computed at each place: the value, the linearly interpolated value, and the values at the two outer
/// nodes.
const EACH: usize = 4;

/// Runs replicas of a scene with an output per step, for as long as the places require. The time steps may be finer
/// than the outputs, by the factor `finer`.
pub(super) fn run(scene: &Scene, places: &[MeasuredAt], replicas: u64, finer: u64) -> Result<Model, String> {
    let mut scene = scene.clone();
    let per_period = scene.steps_per_unit();
    // Gauss–Hermite's outer nodes, ±√3 standard deviations.
    let nodes = |place: &MeasuredAt| [-1.0, 1.0].map(|side| place.turns + side * 3.0_f64.sqrt() * place.u_turns);
    let last = crate::oracle::worst(places.iter().map(|place| nodes(place)[1]));
    // One output more than the last place needs, for the cubic.
    scene.time.duration = ((last * per_period as f64).ceil() + 1.0) / per_period as f64;
    scene.time.outputs_per_unit = Some(per_period);
    scene.time.steps_per_unit = Some(per_period * finer);
    scene.output = Output { observables: vec![Observable::Projections], ..Output::default() };
    let plan = Plan::new(&scene).map_err(|invalid| invalid.to_string())?;
    let rows = (0..replicas)
        .into_par_iter()
        .map(|replica| {
            let found = run_replica(&plan, replica).map_err(|error| error.to_string())?;
            let evaluate = |place: &MeasuredAt| -> [f64; EACH] {
                let at = |output: usize| found.mean(Channel::X[place.channel], output).unwrap_or(f64::NAN);
                let cubic = |turns: f64| interpolate(plan.outputs(), turns * per_period as f64, 4, &at);
                let linear = interpolate(plan.outputs(), place.turns * per_period as f64, 2, &at);
                let [before, after] = nodes(place);
                [cubic(place.turns), linear, cubic(before), cubic(after)]
            };
            Ok(places.iter().flat_map(evaluate).collect())
        })
        .collect::<Result<Vec<Vec<f64>>, String>>()?;
    let n = rows.len() as f64;
    let means: Vec<f64> = (0..EACH * places.len()).map(|k| rows.iter().map(|row| row[k]).sum::<f64>() / n).collect();
    let spread =
        DMatrix::from_fn(rows.len(), places.len(), |r, k| (rows[r][EACH * k] - means[EACH * k]) / (n - 1.0).sqrt());
    let each = || means.chunks_exact(EACH);
    Ok(Model {
        value: each().map(|mean| mean[0]).collect(),
        // The mean of (S(t + ε) − S(t))² over a Gaussian ε by Gauss–Hermite's rule of three nodes: u_t²·(dS/dt)² if S
        // is straight, and also right at a peak, where the slope alone would give 0.
        time_variance: each().map(|mean| ((mean[2] - mean[0]).powi(2) + (mean[3] - mean[0]).powi(2)) / 6.0).collect(),
        interpolation: each().map(|mean| (mean[1] - mean[0]).abs()).collect(),
        spread,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn finer_steps_are_other_steps_at_the_same_times() {
        let scene = crate::judge::lab::interacting_scene(&crate::judge::case::Effort::gate());
        let place = |turns| MeasuredAt { turns, u_turns: 0.0, channel: 0 };
        let at = |finer| run(&scene, &[place(0.0), place(0.3)], 4, finer).unwrap().value;
        let (coarse, fine) = (at(1), at(2));
        assert_eq!(coarse[0], fine[0], "the same rods at the start");
        assert_ne!(coarse[1], fine[1], "other collisions after it");
        assert_relative_eq!(coarse[1], fine[1], epsilon = 0.05);
    }
}
