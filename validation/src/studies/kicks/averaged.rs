//! The core against the averaged motion: the same rods at the same places, with and without draws; and the update
//! `angles` against `rotation`, with the same draws.

use super::*;

/// The distance of one replica of the model from the averaged motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Apart {
    pub x1: f64,
    /// The mean over rods of sin² of the angle between a rod and itself in the averaged motion: 0 on the same path,
    /// ⅔ for unrelated directions.
    pub square: f64,
    pub averaged_x1: f64,
}

/// Runs both for `steps` steps. Places and replacements do not depend on directions, so they are the same. `change` is
/// applied to the averaged motion alone.
pub fn apart(scene: &Scene, steps: u64, change: fn(&mut NaiveProblem), replica: u64) -> Apart {
    let mut core = lab::suspension(scene, replica);
    let mut problem = lab::problem(scene, replica, None);
    change(&mut problem);
    let mut averaged = Naive::new(problem);
    for _ in 0..steps {
        averaged.step_averaged();
        if core.step().is_err() {
            return Apart { x1: f64::NAN, square: f64::NAN, averaged_x1: f64::NAN };
        }
    }
    let rods: Vec<_> = core.directions().into_iter().zip(averaged.orientations).collect();
    let mean = |value: &dyn Fn(&[f64; 3], &[f64; 3]) -> f64| {
        rods.iter().map(|(p, q)| value(&(*p).into(), q)).sum::<f64>() / rods.len() as f64
    };
    Apart {
        x1: mean(&|p, q| p[0].abs() - q[0].abs()),
        square: mean(&|p, q| 1.0 - (p[0] * q[0] + p[1] * q[1] + p[2] * q[2]).powi(2)),
        averaged_x1: mean(&|_, q| q[0].abs()),
    }
}

/// What replicas find at one step and with one shortest arm, in rod lengths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AtStep<const N: usize> {
    pub steps_per_period: u64,
    pub min_contact_arm: f64,
    pub samples: [Sample; N],
}

/// X̄₁ of the averaged motion, that of the model less it, and sin² between the paths ([`Apart`]).
pub fn row(effort: &Effort, steps_per_period: u64, min_contact_arm: f64, replicas: u64) -> AtStep<3> {
    let scene = scene(effort, steps_per_period, min_contact_arm);
    let distances: Vec<_> = lab::replicas(replicas, |replica| apart(&scene, steps_per_period, |_| {}, replica));
    let values: [fn(&Apart) -> f64; 3] = [|apart| apart.averaged_x1, |apart| apart.x1, |apart| apart.square];
    AtStep { steps_per_period, min_contact_arm, samples: values.map(|value| Sample::of(distances.iter().map(value))) }
}

/// 50 rods at 400 per cm³, for one period: eight times as dense as in Fig. 7, so that a few replicas show the limit.
pub fn scene(effort: &Effort, steps_per_period: u64, min_contact_arm: f64) -> Scene {
    let mut scene = lab::crowded_scene(effort, 50, 400.0);
    lab::interaction(&mut scene).min_contact_arm = min_contact_arm;
    scene.time.steps_per_unit = Some(steps_per_period);
    scene.time.outputs_per_unit = Some(1);
    scene
}

/// X̄₁ at t/T = 1 of the scene of the averaged motion with `rotation`, and that with `angles` less it.
pub fn both_updates(effort: &Effort, steps_per_period: u64, min_contact_arm: f64, replicas: u64) -> AtStep<2> {
    let x1 = |update| {
        let mut scene = scene(effort, steps_per_period, min_contact_arm);
        lab::interaction(&mut scene).update = update;
        lab::per_replica(&scene, replicas, |mean| mean(Channel::X[0], 1))
    };
    let (rotation, angles) = (x1(Update::Rotation), x1(Update::Angles));
    let samples = [Sample::of(&rotation), Sample::of_differences(&angles, &rotation)];
    AtStep { steps_per_period, min_contact_arm, samples }
}
