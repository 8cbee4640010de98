//! Converts a scene to the form of the naive reference.

use super::interaction;
use crate::oracle::naive::{self, Mistake, NaiveProblem, OtherFlow, Reading, Start};
use shearbed::scene::{Orientation, Scene, Update};

/// The scene in the form of the naive reference.
pub fn problem(scene: &Scene, replica: u64, mistake: Option<Mistake>) -> NaiveProblem {
    let mut scene = scene.clone();
    let interaction = interaction(&mut scene).clone();
    let particles = scene.particles.clone();
    NaiveProblem {
        count: particles.count,
        shear_rate_per_s: scene.flow.shear_rate_per_s().unwrap_or(f64::NAN),
        other_flow: scene
            .flow
            .gradient_per_s()
            .map(|gradient_per_s| OtherFlow { gradient_per_s, steps_per_strain: scene.steps_per_unit() as usize }),
        length_mm: particles.length_mm,
        length_sd_percent: particles.length_sd_percent,
        aspect_ratio: particles.aspect_ratio,
        aspect_ratio_sd_percent: particles.aspect_ratio_sd_percent,
        orientation: match particles.orientation {
            Orientation::Random(_) => Start::Isotropic,
            Orientation::Given { phi_deg, theta_deg } => {
                Start::Fixed { phi_rad: phi_deg.to_radians(), theta_rad: theta_deg.to_radians() }
            }
        },
        concentration_per_cm3: interaction.concentration_per_cm3.unwrap_or(f64::NAN),
        box_mm: interaction.box_mm,
        alpha: interaction.alpha,
        m: interaction.m,
        min_contact_arm: interaction.min_contact_arm,
        update: match interaction.update {
            Update::Rotation => naive::Update::Rotation,
            Update::Angles => naive::Update::Angles,
            Update::Kick => naive::Update::ExactStepAndKick,
            other => unimplemented!("the naive reference has no {other:?}"),
        },
        reading: Reading::default(),
        steps_per_period: scene.steps_per_unit() as usize,
        seed: scene.ensemble.seed,
        replica,
        mistake,
    }
}
