//! A rough estimate of the run time of suspensions before they start.

use shearbed::Plan;
use shearbed::plan::Stage;
use shearbed_validation::studies::speed::{SECONDS_PER_DRAW, SECONDS_PER_OUTPUT, SECONDS_PER_ROD_AND_STEP};
use shearbed_validation::studies::suspensions::job::Job;
use shearbed_validation::studies::suspensions::law::{self, Replicas};

/// The text for a number of rods times steps: `4.0e9 rods × steps, some 3 min of one core`.
fn text(rod_steps: f64) -> String {
    format!("{rod_steps:.1e} rods × steps, {} of one core", about(rod_steps * SECONDS_PER_ROD_AND_STEP))
}

fn about(seconds: f64) -> String {
    match seconds {
        s if s < 1.0 => "below 1 s".to_owned(),
        s if s < 120.0 => format!("some {s:.0} s"),
        s if s < 7200.0 => format!("some {:.0} min", s / 60.0),
        s => format!("some {:.0} h", s / 3600.0),
    }
}

/// The cost of a study's jobs, as text.
pub(super) fn of_jobs(jobs: &[Job]) -> String {
    text(jobs.iter().map(|job| job.rod_steps() as f64).sum())
}

/// The cost of a run and of a study of an interacting scene, as text; of a run of free rods where it takes a second or
/// more.
pub(super) fn of_scene(plan: &Plan) -> String {
    let scene = plan.scene();
    if !plan.runs(Stage::Contacts) {
        let rods = scene.particles.count as f64 * scene.ensemble.replicas as f64;
        let outputs = plan.outputs() as f64;
        let seconds = rods * (SECONDS_PER_DRAW + outputs * SECONDS_PER_OUTPUT);
        return if seconds < 1.0 {
            String::new()
        } else {
            format!("run: {:.1e} rods × outputs, {} of one core\n", rods * outputs, about(seconds))
        };
    }
    let own = scene.particles.count as f64 * scene.ensemble.replicas as f64 * plan.steps() as f64;
    let study = if law::judges(plan) {
        of_jobs(&law::jobs(scene, Replicas::CONVERGE))
    } else {
        "only plane Couette flow by periods, and no particles.rods".to_owned()
    };
    format!("run: {}\nconverge: {study}\n", text(own))
}
