//! What cases and studies share, below both: the paper's problem as a scene, samples of replicas, and the scene as the
//! naive reference takes it.

mod reference;
mod sampling;
mod shared;

pub use reference::problem;
pub use sampling::{per_replica, uniform};
pub use shared::Shared;

use crate::judge::case::Effort;
use shearbed::Suspension;
use shearbed::plan::{Plan, Stage};
use shearbed::scene::{Ensemble, Interaction, Scene, Update};

/// A change of a scene: what a case varies, or a mistake.
pub type Change = fn(&mut Scene);

/// The scene with a change.
pub fn changed(mut scene: Scene, change: impl FnOnce(&mut Scene)) -> Scene {
    change(&mut scene);
    scene
}

/// Free rods of the paper's Fig. 6 (G = 0.5 1/s, r_e = 11.6, a = 0.72 mm): one period, projections.
pub fn free_scene(effort: &Effort) -> Scene {
    Scene {
        title: "a case".to_owned(),
        ensemble: Ensemble { replicas: 1, seed: effort.seed(0) },
        ..Scene::default()
    }
}

/// The same rods at 50 per cm³ with α = 0.5 and m = 3 (Fig. 6, bottom).
pub fn interacting_scene(effort: &Effort) -> Scene {
    Scene { interaction: Some(Interaction::default()), ..free_scene(effort) }
}

/// The same with the paper's own update, A.14 to the letter: for what reproduces the paper.
pub fn paper_scene(effort: &Effort) -> Scene {
    changed(free_scene(effort), |scene| {
        paper_interaction(scene);
    })
}

/// The interaction of a scene; that of [`paper_scene`] where it had none.
pub fn paper_interaction(scene: &mut Scene) -> &mut Interaction {
    scene.interaction.get_or_insert(Interaction { update: Update::Angles, ..Interaction::default() })
}

/// The interaction of a scene; that of [`interacting_scene`] where it had none.
pub fn interaction(scene: &mut Scene) -> &mut Interaction {
    scene.interaction.get_or_insert_default()
}

/// The plan of a scene that a case has written.
pub fn plan(scene: &Scene) -> Plan {
    Plan::new(scene).expect("a case's scene is valid")
}

/// The suspension of a scene that a case has written, with every rod free to meet.
pub fn suspension(scene: &Scene, replica: u64) -> Suspension {
    Suspension::new(&plan(scene), replica).expect("a case's scene has rods that interact")
}

/// The suspension of a scene whose rods cannot meet, carried and stepped all the same.
pub fn stepped(scene: &Scene, replica: u64) -> Suspension {
    let plan = plan(scene).keeping(Stage::Contacts).expect("a case's scene has an interaction");
    Suspension::new(&plan, replica).expect("the plan keeps its steps")
}
