//! Kicks compared with rotary diffusion of the same C_I: how far rods deviate from Jeffery's motion after a fixed
//! strain, and their final orbits and phases.

use super::*;
use crate::methods::coefficients::jumps::{Shares, Watch, observed};
use crate::methods::coefficients::{Diffusing, Diffusion};

/// Shares of `replicas` replicas of interacting rods.
pub fn kicked(scene: &Scene, watch: Watch, replicas: u64) -> Vec<Shares> {
    lab::replicas(replicas, |replica| {
        let mut rods = lab::suspension(scene, replica);
        observed(scene.particles.aspect_ratio, watch, &mut || {
            let stopped = (0..watch.steps).any(|_| rods.step().is_err());
            (!stopped).then(|| rods.directions())
        })
    })
}

/// The same for as many rods in the same steps that turn by Jeffery's equation and rotary diffusion of C_I. Their seeds
/// are the effort's streams from `stream` on.
pub fn diffused(scene: &Scene, c_i: f64, watch: Watch, replicas: u64, (effort, stream): (&Effort, u64)) -> Vec<Shares> {
    let aspect_ratio = scene.particles.aspect_ratio;
    let diffusion = Diffusion::isotropic(shape_factor(aspect_ratio), c_i, watch.strain);
    lab::replicas(replicas, |replica| {
        let mut rods = Diffusing::isotropic(scene.particles.count, diffusion, effort.seed(stream + replica));
        observed(aspect_ratio, watch, &mut || {
            (0..watch.steps).for_each(|_| rods.step());
            Some(rods.rods.clone())
        })
    })
}

#[derive(Clone, Debug)]
pub struct Compared {
    pub setting: Setting,
    pub c_i: Estimate,
    pub strain: f64,
    pub kicks: Vec<Shares>,
    pub diffusion: Vec<Shares>,
}

/// Compares the suspensions whose C_I is known to be above 0: diffusion needs a positive C_I.
pub fn compared(rows: &[&Coefficients], effort: &Effort) -> Vec<Compared> {
    let diffusive = rows.iter().filter(|row| row.c_i.readable() && row.c_i.value > 0.0);
    let compare = |row: &&Coefficients| {
        let scene = scene(row.setting, effort);
        let watch = Watch::new(&scene, row.periods as f64, row.periods as f64);
        Compared {
            setting: row.setting,
            c_i: row.c_i,
            strain: watch.length(),
            kicks: kicked(&scene, watch, row.replicas),
            diffusion: diffused(&scene, row.c_i.value, watch, row.replicas, (effort, STREAM)),
        }
    };
    diffusive.map(compare).collect()
}

/// The first stream of seeds for the study's diffusion.
pub(super) const STREAM: u64 = 1 << 20;
