//! The update `angles` beside `rotation`, with the same draws.

use super::averaged;
use crate::judge::case::Effort;
use crate::judge::lab;
use crate::judge::statistics::Sample;
use shearbed::observable::Channel;
use shearbed::scene::Update;

/// Both updates at one step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BothUpdates {
    /// Steps per period.
    pub steps_per_period: u64,
    /// `min_contact_arm` in rod lengths.
    pub min_contact_arm: f64,
    /// X̄₁ at t/T = 1 by `rotation`.
    pub rotation_x1: Sample,
    /// By `angles`, less that.
    pub change: Sample,
}

/// Runs `replicas` of the scene of the averaged motion by both updates for a period.
pub fn row(effort: &Effort, steps_per_period: u64, min_contact_arm: f64, replicas: u64) -> BothUpdates {
    let x1 = |update| {
        let mut scene = averaged::scene(effort, steps_per_period, min_contact_arm);
        lab::interaction(&mut scene).update = update;
        lab::per_replica(&scene, replicas, |mean| mean(Channel::X[0], 1))
    };
    let (rotation, angles) = (x1(Update::Rotation), x1(Update::Angles));
    let change: Vec<_> = angles.iter().zip(&rotation).map(|(a, r)| a - r).collect();
    BothUpdates {
        steps_per_period,
        min_contact_arm,
        rotation_x1: Sample::of(&rotation),
        change: Sample::of(&change),
    }
}
