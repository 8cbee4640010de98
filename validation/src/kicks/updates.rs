//! The update `angles` beside `rotation`, with the same draws.

use crate::cases::lab::{self, Sample};
use shearbed::scene::{Scene, Update};

/// Both updates at one step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// Steps per period.
    pub steps_per_period: u64,
    /// `min_contact_arm` in rod lengths.
    pub min_contact_arm: f64,
    /// X̄₁ at t/T = 1 by `rotation`.
    pub rotation_x1: Sample,
    /// By `angles`, less that.
    pub change: Sample,
}

/// Runs `replicas` of a scene by both updates for a period.
pub fn row(scene: &Scene, steps_per_period: u64, min_contact_arm: f64, replicas: u64) -> Row {
    let x1 = |update| {
        let mut scene = scene.clone();
        scene.time.steps_per_period = Some(steps_per_period);
        scene.time.outputs_per_period = Some(1);
        scene.time.periods = Some(1.0);
        let interaction = lab::interaction(&mut scene);
        (interaction.min_contact_arm, interaction.update) = (min_contact_arm, update);
        lab::per_replica(&scene, replicas, |means| means.at(1, 0))
    };
    let (rotation, angles) = (x1(Update::Rotation), x1(Update::Angles));
    let change: Vec<_> = angles.iter().zip(&rotation).map(|(a, r)| a - r).collect();
    Row {
        steps_per_period,
        min_contact_arm,
        rotation_x1: Sample::of(&rotation),
        change: Sample::of(&change),
    }
}
