//! What is measured of the limit Δt → 0 for the report and the documents.

use super::tail::{self, Exponent};
use super::{KICKS, StepCounts, averaged, kicks_rad, rates, updates};
use crate::input::scenes;
use crate::judge::case::Effort;
use crate::judge::lab;
use shearbed::scene::Scene;

/// Everything that was measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Limit {
    /// Kicks in the first two periods of Fig. 4's suspension against the step.
    pub steps: Vec<StepCounts>,
    /// Kicks in the first period of a suspension where rods collide often, against the step.
    pub dense: Vec<StepCounts>,
    /// Kicks in each period at one step.
    pub periods: Vec<StepCounts>,
    /// Exponents of the tail, and of what.
    pub tails: Vec<(String, Exponent)>,
    /// The model against the averaged motion.
    pub averaged: Vec<averaged::AveragedStep>,
    /// `angles` against `rotation`.
    pub updates: Vec<updates::BothUpdates>,
    /// Replicas behind the counts and behind the averaged motion.
    pub replicas: [u64; 2],
}

/// The scene whose kicks are counted.
pub const SCENE: &str = "fig4-n50";

/// The steps per period of the study of single periods.
pub const PERIODS_AT: u64 = 400;

/// Measures everything: a few replicas for the report of a quick run, enough for the documents in a full one.
pub fn measure(effort: &Effort) -> Result<Limit, String> {
    let built_in = scenes::find(SCENE).ok_or("no such scene")?;
    let scene = built_in.scene().map_err(|error| error.to_string())?;
    let replicas = effort.pick([30, 20], [200, 100]);
    let finest = effort.pick(3200, 12_800);
    let steps = [50, 100, 200, 400, 800, 1600, 3200, 6400, 12_800];
    let steps = steps.into_iter().filter(|steps| *steps <= finest);
    let averaged_finest = effort.pick(800, 6400);
    let averaged_steps = [100, 200, 400, 800, 1600, 3200, 6400];
    let averaged_steps = averaged_steps.into_iter().filter(|steps| *steps <= averaged_finest);
    let mut dense = lab::interacting_scene(effort);
    let interaction = lab::interaction(&mut dense);
    (interaction.concentration_per_cm3, interaction.alpha) = (Some(400.0), 2.0);
    let dense_steps = [100, 400, 1600, 6400, 25_600];
    let dense_steps = (dense_steps.into_iter()).filter(|steps| *steps <= 2 * finest);
    // The second is the rods' radius.
    let arms = [0.25, 0.5 / 11.6, 0.0];
    Ok(Limit {
        steps: steps.map(|steps| rates(&scene, steps, 0..2, replicas[0], KICKS)).collect(),
        dense: dense_steps.map(|steps| rates(&dense, steps, 0..1, replicas[1], KICKS)).collect(),
        periods: (0..6)
            .map(|period| rates(&scene, PERIODS_AT, period..period + 1, replicas[0], KICKS))
            .collect(),
        tails: tails(&scene, replicas[0]),
        averaged: arms
            .into_iter()
            .flat_map(|arm| averaged_steps.clone().map(move |steps| (steps, arm)))
            .map(|(steps, arm)| averaged::row(effort, steps, arm, replicas[1]))
            .collect(),
        updates: [0.25, 0.0]
            .into_iter()
            .flat_map(|arm| averaged_steps.clone().map(move |steps| (steps, arm)))
            .map(|(steps, arm)| updates::row(effort, steps, arm, 2 * replicas[1]))
            .collect(),
        replicas,
    })
}

fn tails(scene: &Scene, replicas: u64) -> Vec<(String, Exponent)> {
    let with = |steps, arm| {
        let mut scene = scene.clone();
        scene.time.steps_per_unit = Some(steps);
        scene.time.outputs_per_unit = Some(1);
        scene.time.duration = 2.0;
        lab::interaction(&mut scene).min_contact_arm = arm;
        scene
    };
    let run = |steps, arm| tail::hill(tail::in_runs(&with(steps, arm), replicas, kicks_rad), 0.3);
    // One step in place of two periods of 200: as many collisions from as many starts.
    let fresh = tail::hill(tail::fresh(&with(200, 0.0), 400 * replicas, kicks_rad), 2.0);
    let mut tails = vec![("fresh arms, kicks over GΔt".to_owned(), fresh)];
    for steps in [100, 400, 1600] {
        tails.push((format!("two periods, {steps} steps a period, rad"), run(steps, 0.0)));
    }
    tails.push(("400 steps, min_contact_arm = 0.05, rad".to_owned(), run(400, 0.05)));
    tails
}
