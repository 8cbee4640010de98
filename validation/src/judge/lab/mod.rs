//! Tools shared by cases and studies: the paper's problem as a scene, samples of replicas, and the scene in the form of
//! the naive reference.

mod reference;
mod sampling;
mod shared;

pub use reference::problem;
pub use sampling::{at_output, per_replica, uniform};
pub use shared::Shared;

use crate::judge::case::Effort;
use shearbed::Suspension;
use shearbed::plan::{Plan, Stage};
use shearbed::scene::{Ensemble, Interaction, Scene, Update};

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

/// The same with the paper's own update, A.14 taken literally, for cases that reproduce the paper.
pub fn paper_scene(effort: &Effort) -> Scene {
    changed(free_scene(effort), |scene| {
        paper_interaction(scene);
    })
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
