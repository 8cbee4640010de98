//! What scenes are planned as, refused for, and end with.

mod any_gradient;
mod bad_input;
mod determinism;
mod diffusion;
mod general_flows;
mod plan;
mod resume;
mod rod_errors;
mod rods_out;
mod sizes;
mod times;

use shearbed::run::ensemble;
use shearbed::scene::{OwnRods, RodsFile};
use shearbed::{Plan, Results, Scene};

/// The default scene, changed: 100 free isotropic rods of 0.72 mm and r_e = 11.6 in shear at 0.5 1/s for one period.
fn changed(change: impl FnOnce(&mut Scene)) -> Scene {
    let mut scene = Scene::default();
    change(&mut scene);
    scene
}

fn parsed(text: &str) -> Scene {
    shearbed::scene::parse("s.toml", text).unwrap()
}

fn planned(scene: &Scene) -> Plan {
    Plan::new(scene).unwrap()
}

fn run_plan(plan: &Plan) -> Results {
    ensemble::run(plan).unwrap()
}

fn run(scene: &Scene) -> Results {
    run_plan(&planned(scene))
}

/// Why a text is refused.
fn refusal(text: &str) -> String {
    match Plan::parse("dir/s.toml", text) {
        Ok(_) => format!("accepted:\n{text}"),
        Err(error) => error.to_string(),
    }
}

/// Runs `run` on this many threads.
fn on<T: Send>(threads: usize, run: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(run)
}

/// Means and standard errors of every channel, bit by bit.
fn bits(results: &Results) -> Vec<u64> {
    let columns = results.series.iter().flat_map(|series| &series.columns);
    columns.flat_map(|column| column.mean.iter().chain(&column.se)).map(|value| value.to_bits()).collect()
}

/// A file of rods with these directions.
fn file_of(p: [Vec<f64>; 3]) -> Option<RodsFile> {
    Some(RodsFile::with("rods.csv", OwnRods { p: Some(p), ..OwnRods::default() }))
}
