//! The same scene and seed give the same bits: on any number of threads, and for a replica run alone.

use shearbed::run::run_replica;
use shearbed::{Observable, Plan, Results, Scene, ensemble, scene_file};

fn scene(replicas: u64, seed: u64) -> Scene {
    let text = format!(
        r#"
title = "interacting rods"
[flow]
shear_rate_per_s = 0.5
[particles]
count = 100
length_mm = 0.72
aspect_ratio = 11.6
aspect_ratio_sd_percent = 3.6
orientation = "isotropic"
[interaction]
concentration_per_cm3 = 50
alpha = 0.5
[time]
periods = 1
outputs_per_period = 10
[ensemble]
replicas = {replicas}
seed = {seed}
"#
    );
    scene_file::parse("scene.toml", &text).unwrap()
}

fn plan(replicas: u64, seed: u64) -> Plan {
    Plan::new(&scene(replicas, seed)).unwrap()
}

/// Means and standard errors of every channel, bit by bit.
fn bits(results: &Results) -> Vec<u64> {
    let channels = results.series.iter().flat_map(|series| &series.channels);
    channels
        .flat_map(|channel| channel.mean.iter().chain(&channel.se))
        .map(|value| value.to_bits())
        .collect()
}

fn run_on(threads: usize, plan: &Plan) -> Results {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .unwrap();
    pool.install(|| ensemble::run(plan, || ()).unwrap())
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let free = Scene {
        interaction: None,
        ..scene(9, 1)
    };
    for plan in [plan(9, 1), Plan::new(&free).unwrap()] {
        let one = run_on(1, &plan);
        for threads in [2, 3, 7] {
            let more = run_on(threads, &plan);
            assert_eq!(bits(&one), bits(&more), "{threads} threads");
            assert_eq!(one.counters, more.counters);
        }
    }
}

#[test]
fn a_large_run_gives_the_same_bits_on_any_number_of_threads() {
    // More rods than one thread takes on alone, and enough candidates that their contacts are shared too.
    let large = |periods, interacting: bool, sd| {
        let mut scene = scene(1, 1);
        scene.particles.count = 150_000;
        scene.particles.aspect_ratio_sd_percent = sd;
        scene.time.periods = Some(periods);
        scene.time.outputs_per_period = Some(100);
        if !interacting {
            scene.interaction = None;
        }
        Plan::new(&scene).unwrap()
    };
    for plan in [
        large(0.03, true, 3.6),
        large(0.8, false, 0.0),
        large(0.03, false, 3.6),
    ] {
        let one = run_on(1, &plan);
        for threads in [2, 3] {
            let more = run_on(threads, &plan);
            assert_eq!(bits(&one), bits(&more), "{threads} threads");
            assert_eq!(one.counters, more.counters);
        }
        assert_eq!(one.counters.collisions > 1024, plan.scene().interaction.is_some());
    }
}

#[test]
fn a_large_run_sums_over_all_rods() {
    let mut scene = scene(1, 1);
    scene.interaction = None;
    scene.particles.count = 150_000;
    scene.output.observables = vec![Observable::OrientationTensor];
    let replica = run_replica(&Plan::new(&scene).unwrap(), 0).unwrap();
    for sums in replica.sums.chunks_exact(6) {
        let squares: f64 = sums[..3].iter().map(|sum| sum.value).sum();
        assert!((squares / 150_000.0 - 1.0).abs() < 1e-12, "Σ|p|² = {squares}");
        // ⟨p₁²⟩ has its standard error from the squares: of one replica.
        let square = sums[2].square.unwrap();
        assert!(square < sums[2].value && square > 0.5 * sums[2].value.powi(2) / 150_000.0);
    }
}

#[test]
fn a_replica_run_alone_is_its_part_of_the_ensemble() {
    let plan = plan(4, 1);
    let whole = ensemble::run(&plan, || ()).unwrap();
    // Backwards, so that nothing can lean on an earlier replica.
    let mut alone: Vec<_> = (0..4)
        .rev()
        .map(|k| run_replica(&plan, k).unwrap().sums)
        .collect();
    alone.reverse();
    let channels = &whole.series[0].channels;
    for (output, _) in whole.times.iter().enumerate() {
        for (k, channel) in channels.iter().enumerate() {
            let mut mean = 0.0;
            for (replica, sums) in alone.iter().enumerate() {
                let value = sums[output * channels.len() + k].value / 100.0;
                mean += (value - mean) / (replica + 1) as f64;
            }
            assert_eq!(
                mean.to_bits(),
                channel.mean[output].to_bits(),
                "{} at output {output}",
                channel.name
            );
        }
    }
}

#[test]
fn a_replica_does_not_depend_on_how_many_there_are() {
    let of = |replicas| run_replica(&plan(replicas, 1), 2).unwrap();
    assert_eq!(of(3), of(1000));
}

#[test]
fn replicas_and_seeds_differ() {
    let sums = |seed, replica| run_replica(&plan(2, seed), replica).unwrap().sums;
    let runs = [
        sums(1, 0),
        sums(1, 1),
        sums(2, 0),
        sums(0, 0),
        sums(u64::MAX >> 1, 0),
    ];
    for (k, one) in runs.iter().enumerate() {
        for other in &runs[..k] {
            // Already the first output differs.
            assert_ne!(one[0], other[0]);
        }
    }
}

/// An algorithm that does more work than before, or draws differently, shows here.
#[test]
fn the_work_of_a_fixed_scene_is_known() {
    insta::assert_debug_snapshot!(run_on(2, &plan(4, 1)).counters);
}

/// The same of rods sorted into cells, from dilute to dense.
#[test]
fn the_work_of_many_rods_is_known() {
    for concentration_per_cm3 in [0.5, 50.0, 5000.0] {
        let mut scene = scene(1, 1);
        scene.particles.count = 2000;
        scene.time.periods = Some(0.1);
        let interaction = scene.interaction.as_mut().unwrap();
        interaction.concentration_per_cm3 = concentration_per_cm3;
        let counters = run_on(2, &Plan::new(&scene).unwrap()).counters;
        insta::assert_debug_snapshot!(format!("work_at_{concentration_per_cm3}_per_cm3"), counters);
    }
}
