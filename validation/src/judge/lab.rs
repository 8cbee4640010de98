//! Tools shared by cases and studies: the paper's problem as a scene, samples of replicas, and the scene in the form of
//! the naive reference.

use crate::judge::case::Effort;
use crate::judge::statistics::Sample;
use crate::oracle::naive::{self, Mistake, NaiveProblem, OtherFlow, Reading, Start};
use rayon::prelude::*;
use shearbed::Suspension;
use shearbed::observable::Channel;
use shearbed::plan::{Plan, Stage};
use shearbed::run::ensemble::Results;
use shearbed::run::run_replica;
use shearbed::scene::{Ensemble, Interaction, Orientation, Scene, Update};
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

/// A change of a scene: a variation of a case, or a mistake.
pub type Change = fn(&mut Scene);

/// The scene after `change`.
pub fn changed(mut scene: Scene, change: impl FnOnce(&mut Scene)) -> Scene {
    change(&mut scene);
    scene
}

/// Free rods of the paper's Fig. 6 (G = 0.5 1/s, r_e = 11.6, a = 0.72 mm): one period, projections.
pub fn free_scene(effort: &Effort) -> Scene {
    Scene { title: "a case".to_owned(), ensemble: Ensemble { replicas: 1, seed: effort.seed(0) }, ..Scene::default() }
}

/// The rods of `free_scene` interacting, at 50 per cm³ with α = 0.5 and m = 3 (Fig. 6, bottom).
pub fn interacting_scene(effort: &Effort) -> Scene {
    Scene { interaction: Some(Interaction::default()), ..free_scene(effort) }
}

/// So many of these rods at this concentration.
pub fn crowded_scene(effort: &Effort, count: usize, per_cm3: f64) -> Scene {
    changed(interacting_scene(effort), |scene| {
        scene.particles.count = count;
        interaction(scene).concentration_per_cm3 = Some(per_cm3);
    })
}

/// Those of `interacting_scene` with the paper's own update, A.14 taken literally, for cases that reproduce the paper.
pub fn paper_scene(effort: &Effort) -> Scene {
    changed(free_scene(effort), |scene| _ = paper_interaction(scene))
}

/// The interaction of a scene; if it has none, adds that of [`paper_scene`].
pub fn paper_interaction(scene: &mut Scene) -> &mut Interaction {
    scene.interaction.get_or_insert(Interaction { update: Update::Angles, ..Interaction::default() })
}

/// The interaction of a scene; if it has none, adds that of [`interacting_scene`].
pub fn interaction(scene: &mut Scene) -> &mut Interaction {
    scene.interaction.get_or_insert_default()
}

/// Sets the sides of the control volume in place of the concentration.
pub fn set_box_mm(scene: &mut Scene, sides: [f64; 3]) {
    let interaction = interaction(scene);
    (interaction.concentration_per_cm3, interaction.box_mm) = (None, Some(sides));
}

/// The plan of a case's scene.
pub fn plan(scene: &Scene) -> Plan {
    Plan::new(scene).expect("a case's scene is valid")
}

/// The suspension of a case's scene with interacting rods.
pub fn suspension(scene: &Scene, replica: u64) -> Suspension {
    Suspension::new(&plan(scene), replica).expect("a case's scene has rods that interact")
}

/// The suspension of a scene whose rods cannot collide, which is moved in time steps all the same.
pub fn stepped(scene: &Scene, replica: u64) -> Suspension {
    let plan = plan(scene).with_stage(Stage::Contacts).expect("a case's scene has an interaction");
    Suspension::new(&plan, replica).expect("the plan keeps its steps")
}

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

/// One value per replica, from the first on, computed side by side.
pub fn replicas<T: Send, C: FromParallelIterator<T>>(count: u64, value: impl Fn(u64) -> T + Sync + Send) -> C {
    (0..count).into_par_iter().map(value).collect()
}

/// X̄₁ of a suspension after `steps` more steps; `None` if one of them failed.
pub fn x1_after(suspension: &mut Suspension, steps: u64) -> Option<f64> {
    (0..steps).try_for_each(|_| suspension.step().map(|_| ())).ok()?;
    let directions = suspension.directions();
    Some(directions.iter().map(|p| p.x.abs()).sum::<f64>() / directions.len() as f64)
}

/// One value per replica of a scene, computed by `value` from the replica's means `mean(channel, output)`.
pub fn per_replica<T: Send>(
    scene: &Scene,
    count: u64,
    value: impl Fn(&dyn Fn(Channel, usize) -> f64) -> T + Sync,
) -> Vec<T> {
    let plan = plan(scene);
    replicas(count, |replica| {
        // A run that stopped fails every check: all its means are NaN.
        let means = run_replica(&plan, replica).ok();
        value(&|channel, output| means.as_ref().and_then(|means| means.mean(channel, output)).unwrap_or(f64::NAN))
    })
}

/// A mean over `samples` rods or replicas of a run at an output; NaN if the run stopped.
pub fn at_output<E>(results: &Result<Results, E>, channel: Channel, output: usize, samples: u64) -> Sample {
    let column = results.as_ref().ok().and_then(|results| results.column(&channel.name()));
    let (mean, se) = column.map_or((f64::NAN, f64::NAN), |column| (column.mean[output], column.se[output]));
    Sample { mean, se, samples }
}

/// Values that a check shares with its controls, by seed, effort and their keys: a control that is a wrong formula
/// needs no run of its own. Only those of one run are kept.
pub(crate) struct Shared<K, T>(Mutex<BTreeMap<(u64, bool, K), Arc<T>>>);

impl<K: Ord, T> Shared<K, T> {
    /// An empty store.
    pub(crate) const fn new() -> Self {
        Self(Mutex::new(BTreeMap::new()))
    }

    /// The value for `key`, computed by `work_out` if it is missing. It must depend only on key and effort.
    pub(crate) fn get(&self, effort: &Effort, key: K, work_out: impl FnOnce() -> T) -> Arc<T> {
        let key = (effort.seed, effort.full, key);
        let locked = || self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(value) = locked().get(&key) {
            return Arc::clone(value);
        }
        // Not under the lock: while it waits, a thread may be given another thread's work, which may need the lock too.
        let value = Arc::new(work_out());
        let mut stored = locked();
        stored.retain(|(seed, full, _), _| (*seed, *full) == (effort.seed, effort.full));
        stored.insert(key, Arc::clone(&value));
        value
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_key_and_effort_is_worked_out_once() {
        let shared = Shared::new();
        let mut runs = 0;
        for (seed, full, key) in
            [(1, false, 0), (1, false, 0), (1, false, 1), (2, false, 0), (2, true, 0), (2, true, 0)]
        {
            let effort = Effort { full, seed, data: None };
            let value = shared.get(&effort, key, || {
                runs += 1;
                (seed, key)
            });
            assert_eq!(*value, (seed, key));
        }
        assert_eq!(runs, 4);
    }
}
