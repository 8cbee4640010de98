//! Rods that interact in other flows than plane Couette flow by periods.

use crate::{parsed, planned, run};
use shearbed::run::ensemble;
use shearbed::scene::Update;
use shearbed::{Results, Scene};

const SHEAR: &str = "[[0, 0, 0], [0.5, 0, 0], [0, 0, 0]]";
pub(crate) const EXTENSION: &str = "[[0.5, 0, 0], [0, -0.5, 0], [0, 0, 0]]";
pub(crate) const GENERAL: &str = "[[0.3, -0.5, 0.1], [0.8, 0.1, -0.2], [0.4, 0.6, -0.4]]";
/// [`EXTENSION`] in numbers.
pub(crate) const STRETCHED: [[f64; 3]; 3] = [[0.5, 0.0, 0.0], [0.0, -0.5, 0.0], [0.0; 3]];
/// Rods turn in ellipses.
const ELLIPTIC: &str = "[[0, -0.3, 0], [1, 0, 0], [0, 0, 0]]";

fn text(gradient: &str, particles: &str, alpha: f64, time: &str) -> String {
    format!(
        "title = \"t\"\n[flow]\ngradient_per_s = {gradient}\n[particles]\nlength_mm = 0.72\norientation = \
            \"isotropic\"\n\
         {particles}\n[interaction]\nconcentration_per_cm3 = 1000\nalpha = {alpha}\n[time]\n{time}\n[output]\n\
         observables = [\"projections\", \"orientation_tensor\"]\n"
    )
}

fn scene(gradient: &str, particles: &str, alpha: f64, time: &str) -> Scene {
    parsed(&text(gradient, particles, alpha, time))
}

/// The largest difference of a channel at any output.
fn apart(one: &Results, other: &Results) -> f64 {
    let columns = |results: &Results| -> Vec<f64> {
        let columns = results.series.iter().flat_map(|series| &series.columns);
        columns.flat_map(|column| column.mean.clone()).collect()
    };
    let (one, other) = (columns(one), columns(other));
    assert_eq!(one.len(), other.len());
    shearbed_oracle::apart(&one, &other)
}

/// Rods that could meet, and do not, are moved step by step to where free rods are at once.
#[test]
fn rods_that_do_not_meet_are_free() {
    let rods = "count = 100\naspect_ratio = 5\naspect_ratio_sd_percent = 10";
    for (gradient, time) in
        [(SHEAR, "strain = 30"), (EXTENSION, "strain = 15"), (GENERAL, "strain = 15"), (ELLIPTIC, "periods = 2")]
    {
        let [free, stepped] = [0.0, 1e-15].map(|alpha| run(&scene(gradient, rods, alpha, time)));
        assert_eq!((free.counters.steps, stepped.counters.collisions), (0, 0));
        assert!(stepped.counters.steps > 50 && stepped.counters.replacements > 100);
        let apart = apart(&free, &stepped);
        assert!(apart < 1e-12, "{gradient}: {apart:e}");
    }
}

/// Each rod by its own map, in every chunk of a large run.
#[test]
fn many_unequal_rods_that_do_not_meet_are_free() {
    let rods = "count = 70000\naspect_ratio = 5\naspect_ratio_sd_percent = 10";
    let time = "strain = 0.4\nsteps_per_strain = 10\noutputs_per_strain = 5\n[output]\nrods_at = [0.4]";
    let text = |alpha: f64| text(EXTENSION, rods, alpha, time).replace("\n[output]\nobservables", "\nobservables");
    let [free, stepped] = [0.0, 1e-300].map(|alpha| run(&parsed(&text(alpha))));
    assert_eq!((free.counters.steps, stepped.counters.collisions), (0, 0));
    for (free, stepped) in free.snapshots[0].p.iter().zip(&stepped.snapshots[0].p) {
        let off = free.iter().zip(stepped).map(|(free, stepped)| (free - stepped).abs());
        assert!(shearbed_oracle::worst(off) < 1e-13);
    }
}

/// By hand: it turns by (2 W:W)^½ = 2 where it strains by (2 D:D)^½ = 0.1, so 20 for each unit of strain, 0.37 in a
/// step at most: 55 steps, or a number with one digit before zeros.
#[test]
fn a_flow_that_mostly_turns_takes_more_steps() {
    let turning = "[[0.05, -1, 0], [1, 0, 0], [0, 0, -0.05]]";
    let steps =
        |gradient: &str, time: &str| scene(gradient, "count = 10\naspect_ratio = 5", 0.5, time).steps_per_unit();
    assert_eq!(steps(turning, "strain = 1\noutputs_per_strain = 1"), 55);
    assert_eq!(steps(turning, "strain = 1"), 80);
    assert_eq!(steps(EXTENSION, "strain = 1\noutputs_per_strain = 1"), 3);
    assert_eq!(steps(turning, "strain = 1\noutputs_per_strain = 10"), 60);
    assert_eq!(steps(SHEAR, "strain = 1"), 4);
}

/// Rods and liquid that turn as one body have no velocity along a contact line: collisions change nothing, if they are
/// kicks.
#[test]
fn in_a_rotation_kicks_do_nothing() {
    let rotation = "[[0, -0.5, 0], [0.5, 0, 0], [0, 0, 0]]";
    let rods = "count = 100\naspect_ratio = 11.6";
    let of = |alpha: f64, update| {
        let mut scene = scene(rotation, rods, alpha, "periods = 10");
        scene.interaction.as_mut().unwrap().update = update;
        let plan = planned(&scene);
        (plan.warnings().len(), ensemble::run(&plan).unwrap())
    };
    let ((_, free), (quiet, kicked)) = (of(0.0, Update::Kick), of(0.5, Update::Kick));
    assert!(kicked.counters.collisions > 1000);
    assert!(apart(&free, &kicked) < 1e-11);
    let (warned, straight) = of(0.5, Update::Rotation);
    assert!(apart(&free, &straight) > 0.01 && warned == quiet + 1);
}

/// Shear counted in strain and in periods is the same suspension, collision by collision: a period of 40 units of
/// strain.
#[test]
fn shear_by_strain_is_shear_by_periods() {
    let r = (40.0 + (40.0f64.powi(2) - 4.0 * std::f64::consts::TAU.powi(2)).sqrt()) / (2.0 * std::f64::consts::TAU);
    for rods in ["", "length_sd_percent = 20"] {
        let rods = format!("count = 60\naspect_ratio = {r}\n{rods}");
        let by_strain = "strain = 8\nsteps_per_strain = 10\noutputs_per_strain = 1";
        let by_periods = "periods = 0.2\nsteps_per_period = 400\noutputs_per_period = 40";
        let [strain, periods] = [by_strain, by_periods].map(|time| run(&scene(SHEAR, &rods, 0.5, time)));
        assert!(strain.counters.collisions > 100, "{:?}", strain.counters);
        assert_eq!(
            (strain.counters.collisions, strain.counters.replacements),
            (periods.counters.collisions, periods.counters.replacements)
        );
        let apart = apart(&strain, &periods);
        assert!(apart < 1e-9, "{apart:e}");
    }
}

/// A flow that is turned by 90° does the same to rods that are turned with it, in law.
#[test]
fn a_turned_flow_turns_the_result() {
    let rods = "count = 100\naspect_ratio = 5\n";
    let run = |gradient: &str| {
        let mut scene = scene(gradient, rods, 0.5, "strain = 10\noutputs_per_strain = 1");
        scene.ensemble.replicas = 200;
        run(&scene)
    };
    // u_1 = x_2 and u_2 = x_3: gradient, flow, vorticity along the axes 2, 1, 3 and 3, 2, 1.
    let one = run("[[0, 1, 0], [0, 0, 0], [0, 0, 0]]");
    let other = run("[[0, 0, 0], [0, 0, 1], [0, 0, 0]]");
    assert!(one.counters.collisions > 10_000);
    let farthest = |names: [[&str; 2]; 3]| {
        let columns = names.map(|[of_one, of_other]| (one.column(of_one).unwrap(), other.column(of_other).unwrap()));
        let differences = columns
            .into_iter()
            .flat_map(|(a, b)| (0..a.mean.len()).map(|k| (a.mean[k] - b.mean[k]).abs() / f64::hypot(a.se[k], b.se[k])));
        shearbed_oracle::worst(differences)
    };
    assert!(farthest([["x2", "x3"], ["x1", "x2"], ["x3", "x1"]]) < 5.0);
    assert!(farthest([["x2", "x2"], ["x1", "x1"], ["x3", "x3"]]) > 20.0);
}
