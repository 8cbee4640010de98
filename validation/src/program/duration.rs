//! A rough estimate of the run time of suspensions before they start.

use crate::studies::suspensions::job::Job;
use crate::studies::suspensions::law::{self, Replicas};
use shearbed::Plan;
use shearbed::plan::Stage;

/// A step of one rod takes 26 to 58 ns of one core, for 10² to 10⁶ rods (docs/src/developer/performance.md).
const SECONDS_PER_ROD_AND_STEP: f64 = 40e-9;

/// The text for a number of rods times steps: `4.0e9 rods × steps, some 3 min of one core`.
fn text(rod_steps: f64) -> String {
    let seconds = rod_steps * SECONDS_PER_ROD_AND_STEP;
    let time = match seconds {
        s if s < 1.0 => "below 1 s".to_owned(),
        s if s < 120.0 => format!("some {s:.0} s"),
        s if s < 7200.0 => format!("some {:.0} min", s / 60.0),
        s => format!("some {:.0} h", s / 3600.0),
    };
    format!("{rod_steps:.1e} rods × steps, {time} of one core")
}

/// The cost of a study's jobs, as text.
pub(super) fn of_jobs(jobs: &[Job]) -> String {
    text(jobs.iter().map(|job| job.rod_steps() as f64).sum())
}

/// The cost of a run and of a study of an interacting scene, as text; empty for free rods, whose time is negligible.
pub(super) fn of_scene(plan: &Plan) -> String {
    if !plan.runs(Stage::Contacts) {
        return String::new();
    }
    let scene = plan.scene();
    let own = scene.particles.count as f64 * scene.ensemble.replicas as f64 * plan.steps() as f64;
    let study = match law::judges(plan) {
        true => of_jobs(&law::jobs(scene, Replicas::CONVERGE)),
        false => "plane Couette flow by periods only".to_owned(),
    };
    format!("run: {}\nconverge: {study}\n", text(own))
}
