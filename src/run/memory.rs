//! The memory that a run needs, so that a run that would not fit can be refused before it starts.

use crate::model::collision::reach;
use crate::motion::Propagator;
use crate::observable::Sum;
use crate::plan::free_motion::Way;
use crate::plan::{Plan, Stage};
use crate::run::ensemble::{batch, width};
use crate::suspension::BYTES_OF_A_CANDIDATE;
use crate::suspension::rods;
use crate::suspension::snapshot::Snapshot;
use std::f64::consts::PI;

/// About the largest number of bytes that a run of `plan` holds, with `at_once` replicas at a time.
///
/// Bytes per rod of an interacting scene: direction (24) and the step it dates from (4), position (24), R (8), aspect ratio (8),
/// and in the search its copy in spatial order (32), cell (4), the cell's start (4) and an entry in the list of rods that need a
/// search (4). Lists of collisions come on top.
pub fn bytes(plan: &Plan, at_once: u64) -> u64 {
    let scene = plan.scene();
    let replicas = scene.ensemble.replicas.min(at_once.max(1));
    let kept = |stage, bytes| if plan.runs(stage) { bytes } else { 0 };
    // A propagator per rod, and the data per output that all replicas share.
    let maps = match plan.free().map(|free| &free.way) {
        None => [0, 0],
        Some(Way::Each { spans, .. }) => {
            let each = if plan.runs(Stage::AspectRatios) { size_of::<Propagator>() } else { 0 };
            [each, size_of_val(&spans[..])]
        }
        Some(Way::Maps(maps)) => [0, size_of_val(&maps[..])],
        Some(Way::Alike(ends)) => [0, size_of_val(&ends[..])],
    };
    let per_rod = 24
        + maps[0]
        + kept(Stage::AspectRatios, 8)
        + kept(Stage::Lengths, 8)
        + kept(Stage::Positions, 24)
        + kept(Stage::CollisionDraws, 8)
        + kept(Stage::Neighbours, 44)
        + kept(Stage::Contacts, 4);
    let width = width(plan);
    let per_output = width * size_of::<Sum>();
    let waiting = scene.ensemble.replicas.min(batch(plan, width));
    let lists = BYTES_OF_A_CANDIDATE as f64 * candidates(plan) * scene.particles.count as f64;
    let phases = plan.outputs() * rods::bytes_per_output(plan);
    let rods = replicas * (lists as u64 + (scene.particles.count * per_rod + phases) as u64) + maps[1] as u64;
    // Sums of replicas that wait to be added in order, and three running moments of 8 bytes.
    let sums = plan.outputs() as u64 * (waiting * per_output as u64 + 3 * 8 * width as u64);
    // All rods that the scene asks for are held until the end.
    let of_rod = Snapshot::bytes_per_rod(plan) as u64;
    (rods + sums).saturating_add(plan.rods_out().saturating_mul(of_rod))
}

/// The expected share of rods that become candidates in a step: ∫ 1 − exp(−4π n s*(R)³/3) dR, the probability that the nearest of
/// randomly placed rods is closer than s*.
fn candidates(plan: &Plan) -> f64 {
    const POINTS: usize = 64;
    let scene = plan.scene();
    let Some(interaction) = (scene.interaction.as_ref()).filter(|_| plan.runs(Stage::Contacts)) else {
        return 0.0;
    };
    let n = scene.concentration().unwrap_or(0.0) * scene.particles.mean_cube();
    let hit = |r: f64| {
        let reach = reach(r, interaction.alpha, interaction.m);
        -libm::expm1(-4.0 / 3.0 * PI * n * reach.powi(3))
    };
    let points = (0..POINTS).map(|k| hit((k as f64 + 0.5) / POINTS as f64));
    points.sum::<f64>() / POINTS as f64
}
