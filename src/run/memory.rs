//! The memory that a run needs, so that a run that would not fit can be refused before it starts.

use crate::model::collision::reach;
use crate::model::neighbours;
use crate::motion::Propagator;
use crate::observable::Sum;
use crate::plan::free_motion::Way;
use crate::plan::{Plan, Stage};
use crate::run::ensemble::{batch, grouped, width};
use crate::suspension::rods;
use crate::suspension::snapshot::Snapshot;
use crate::suspension::{MOST_KEPT, bytes_of_lists};
use nalgebra::Matrix3;
use std::f64::consts::PI;

/// About the largest number of bytes that a run of `plan` holds, with `at_once` replicas at a time.
///
/// Bytes per rod of an interacting scene of many rods: direction (24) and the step it dates from (4), position (24),
/// aspect ratio (8) if they differ, and in the search its copy in spatial order (20) and its share of the cells (3).
/// Lists of collisions come on top. Up to 65 536 rods, R (8) and the unsorted copy (22) are kept too.
pub fn bytes(plan: &Plan, at_once: u64) -> u64 {
    let scene = plan.scene();
    let count = scene.particles.count;
    let replicas = scene.ensemble.replicas.min(at_once.max(1));
    let kept = |stage, bytes| if plan.runs(stage) { bytes } else { 0 };
    // A propagator per rod, and the data per output that all replicas share.
    let maps = match plan.free().map(|free| &free.way) {
        None if plan.runs(Stage::Diffusion) && plan.runs(Stage::AspectRatios) => [size_of::<Matrix3<f64>>(), 0],
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
        + kept(Stage::CollisionDraws, if count <= MOST_KEPT { 8 } else { 0 })
        + kept(Stage::Contacts, 4);
    let width = width(plan);
    let per_output = width * size_of::<Sum>();
    let waiting = scene.ensemble.replicas.min(batch(plan, width));
    // Candidates share collisions where each is the other's nearest neighbour. Measured, of 1000 rods: 103 collisions
    // of 121 candidates, 334 of 663.
    let candidates = candidates(plan);
    let lists = bytes_of_lists(candidates, candidates / (1.0 + 1.4 * candidates)) * count as f64;
    let phases = plan.outputs() * rods::bytes_per_output(plan);
    let search = kept(Stage::Neighbours, neighbours::bytes(count));
    let rods = replicas * (lists as u64 + (count * per_rod + search + phases) as u64) + maps[1] as u64;
    // Sums of replicas that wait to be added in order, three running moments of 8 bytes, and the sums over groups.
    let groups = 8 * grouped(plan.outputs() * width) as u64;
    let sums = plan.outputs() as u64 * (waiting * per_output as u64 + 3 * 8 * width as u64) + groups;
    // All rods that the scene asks for are held until the end.
    let of_rod = Snapshot::bytes_per_rod(plan) as u64;
    (rods + sums).saturating_add(plan.rods_out().saturating_mul(of_rod))
}

/// The expected share of rods that become candidates in a step: ∫ 1 − exp(−4π n s*(R)³/3) dR, the probability that the
/// nearest of randomly placed rods is closer than s*.
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
