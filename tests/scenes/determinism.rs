//! The same scene and seed give the same bits: on any number of threads, and for a replica run alone.

use crate::{any_gradient, bits, changed, on, planned, run};
use shearbed::observable::Channel;
use shearbed::run::{ensemble, run_replica};
use shearbed::scene::{Ensemble, Flow, Interaction, Time};
use shearbed::{Observable, Plan, Scene};

/// Interacting rods of several aspect ratios.
fn scene(replicas: u64, seed: u64) -> Scene {
    changed(|scene| {
        scene.interaction = Some(Interaction::default());
        scene.particles.aspect_ratio_sd_percent = 3.6;
        scene.time.outputs_per_unit = Some(10);
        scene.ensemble = Ensemble { replicas, seed };
    })
}

fn plan(replicas: u64, seed: u64) -> Plan {
    planned(&scene(replicas, seed))
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    // More rods than one thread takes on alone, and enough candidates that their contacts are shared too.
    let large = |periods: f64, interacting: bool, sd: f64| {
        let mut scene = scene(1, 1);
        scene.particles.count = 150_000;
        scene.particles.aspect_ratio_sd_percent = sd;
        (scene.time.duration, scene.time.outputs_per_unit) = (periods, Some(100));
        scene.interaction = scene.interaction.filter(|_| interacting);
        scene
    };
    let mut extension = large(0.0, true, 0.0);
    extension.flow = Flow::Gradient { gradient_per_s: any_gradient::STRETCHED };
    extension.time = Time::strain(0.3);
    let mut diffusing = crate::diffusion::scene(0.1);
    diffusing.particles.count = 140_000;
    for scene in [
        scene(9, 1),
        Scene { interaction: None, ..scene(9, 1) },
        large(0.03, true, 3.6),
        large(0.8, false, 0.0),
        large(0.03, false, 3.6),
        extension,
        diffusing,
    ] {
        let one = on(1, || run(&scene));
        for threads in [2, 3, 7] {
            let more = on(threads, || run(&scene));
            assert_eq!(bits(&one), bits(&more), "{threads} threads: {scene:?}");
            assert_eq!((one.counters, &one.snapshots), (more.counters, &more.snapshots));
        }
        let collide = scene.interaction.is_some();
        assert!(
            if scene.particles.count > 100 { (one.counters.collisions > 1024) == collide } else { true },
            "{scene:?}"
        );
    }
}

#[test]
fn a_large_run_sums_over_all_rods() {
    let mut scene = scene(1, 1);
    scene.interaction = None;
    scene.particles.count = 150_000;
    scene.output.observables = vec![Observable::OrientationTensor];
    let results = run(&scene);
    let column = |name| results.column(name).unwrap();
    for output in 0..results.times.len() {
        let squares: f64 = ["a11", "a22", "a33"].map(|name| column(name).mean[output]).iter().sum();
        assert!((squares - 1.0).abs() < 1e-12, "⟨|p|²⟩ = {squares}");
        // ⟨p₃²⟩ of one replica has its standard error from the squares: of numbers in [0, 1].
        let (mean, se) = (column("a33").mean[output], column("a33").se[output]);
        assert!(se > 0.0 && se * se * 149_999.0 < mean * (1.0 - mean));
    }
}

#[test]
fn a_replica_run_alone_is_its_part_of_the_ensemble() {
    let plan = plan(4, 1);
    let whole = ensemble::run(&plan).unwrap();
    // Backwards, so that nothing can lean on an earlier replica.
    let mut alone: Vec<_> = (0..4).rev().map(|k| run_replica(&plan, k).unwrap()).collect();
    alone.reverse();
    let columns = whole.series.iter().flat_map(|series| &series.columns);
    for column in columns {
        let channel = Channel::named(&column.name).unwrap();
        for (output, expected) in column.mean.iter().enumerate() {
            let mut mean = 0.0;
            for (replica, found) in alone.iter().enumerate() {
                mean += (found.mean(channel, output).unwrap() - mean) / (replica + 1) as f64;
            }
            assert_eq!(mean.to_bits(), expected.to_bits(), "{} at output {output}", column.name);
        }
    }
    assert_eq!(alone[0].mean(Channel::X[0], whole.times.len()), None);
    assert_eq!(alone[0].mean(Channel::named("c_b").unwrap(), 0), None);
}

#[test]
fn a_replica_does_not_depend_on_how_many_there_are() {
    let of = |replicas| run_replica(&plan(replicas, 1), 2).unwrap();
    assert_eq!(of(3), of(1000));
}

#[test]
fn replicas_and_seeds_differ() {
    let run = |seed, replica| run_replica(&plan(2, seed), replica).unwrap();
    let runs = [run(1, 0), run(1, 1), run(2, 0), run(0, 0), run(u64::MAX >> 1, 0)];
    for (k, one) in runs.iter().enumerate() {
        for other in &runs[..k] {
            // Already the first output differs.
            assert_ne!(one.mean(Channel::X[0], 0), other.mean(Channel::X[0], 0));
        }
    }
}

/// An algorithm that does more work than before, or draws differently, shows here.
#[test]
fn the_work_of_a_fixed_scene_is_known() {
    insta::assert_debug_snapshot!(run(&scene(4, 1)).counters);
}

/// The same of rods sorted into cells, from dilute to dense.
#[test]
fn the_work_of_many_rods_is_known() {
    for concentration_per_cm3 in [0.5, 50.0, 5000.0] {
        let mut scene = scene(1, 1);
        scene.particles.count = 2000;
        scene.time.duration = 0.1;
        let interaction = scene.interaction.as_mut().unwrap();
        interaction.concentration_per_cm3 = Some(concentration_per_cm3);
        let counters = run(&scene).counters;
        insta::assert_debug_snapshot!(format!("work_at_{concentration_per_cm3}_per_cm3"), counters);
    }
}
