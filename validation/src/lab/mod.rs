//! What cases and studies share, below both: the paper's problem as a scene, samples of replicas, and the scene as the
//! naive reference takes it.

mod reference;
mod sampling;
mod shared;

pub use reference::problem;
pub use sampling::{per_replica, uniform};
pub use shared::Shared;

use crate::case::Effort;
use shearbed::plan::{Plan, Stage};
use shearbed::scene::{
    Ensemble, Flow, Interaction, Isotropic, Orientation, Output, Particles, Scene, Time, Update,
};
use shearbed::{Observable, Suspension};

/// Free rods of the paper's Fig. 6 (G = 0.5 1/s, r_e = 11.6, a = 0.72 mm): one period, projections.
pub fn free_scene(effort: &Effort) -> Scene {
    Scene {
        title: "a case".to_owned(),
        flow: Flow {
            shear_rate_per_s: Some(0.5),
            gradient_per_s: None,
        },
        particles: Particles {
            count: 100,
            length_mm: 0.72,
            aspect_ratio: 11.6,
            aspect_ratio_sd_percent: 0.0,
            orientation: Orientation::Random(Isotropic::Isotropic),
        },
        interaction: None,
        time: Time {
            periods: Some(1.0),
            strain: None,
            steps_per_period: None,
            outputs_per_period: None,
            outputs_per_strain: None,
        },
        ensemble: Ensemble {
            replicas: 1,
            seed: effort.seed(0),
        },
        output: Output {
            observables: vec![Observable::Projections],
        },
    }
}

/// The same rods at 50 per cm³ with α = 0.5 and m = 3 (Fig. 6, bottom).
pub fn interacting_scene(effort: &Effort) -> Scene {
    Scene {
        interaction: Some(PAPER),
        ..free_scene(effort)
    }
}

const PAPER: Interaction = Interaction {
    concentration_per_cm3: 50.0,
    alpha: 0.5,
    m: 3.0,
    update: Update::Rotation,
    min_contact_arm: 0.0,
};

/// The interaction of a scene; the paper's where it had none.
pub fn interaction(scene: &mut Scene) -> &mut Interaction {
    scene.interaction.get_or_insert(PAPER)
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
    let plan = plan(scene)
        .keeping(Stage::Contacts)
        .expect("a case's scene has an interaction");
    Suspension::new(&plan, replica).expect("the plan keeps its steps")
}
