//! The study on made-up traces.

use super::*;
use crate::studies::suspensions::job::Look;
use crate::studies::suspensions::law_tables;
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Dxsm;

fn scene(periods: f64, steps: u64, replicas: u64) -> Scene {
    let mut scene =
        Scene { time: Time::periods(periods), ..crate::input::scenes::find("fig7-n50").unwrap().scene().unwrap() };
    (scene.time.steps_per_unit, scene.ensemble.replicas) = (Some(steps), replicas);
    scene
}

/// Made up: X̄₁ = 0.3 + t·b/S + 0.5/N with noise, of so many replicas.
fn synthetic(scene: &Scene, [b, noise]: [f64; 2], replicas: u64) -> Law {
    let jobs = jobs(scene, Replicas::Each(replicas));
    let mut rng = Pcg64Dxsm::seed_from_u64(7);
    let mut trace = |job: &Job| {
        let (steps, rods) = (job.scene.steps_per_unit() as f64, job.scene.particles.count as f64);
        let mut look = |mark: &u64| {
            let normal: f64 = StandardNormal.sample(&mut rng);
            let x1 = 0.3 + *mark as f64 / steps * b / steps + 0.5 / rods + noise * normal;
            Look { x1, p1_below: [0.5; PLACES], orbit_below: [0.5; PLACES] }
        };
        Trace { looks: job.marks.iter().map(&mut look).collect(), directions: Vec::new() }
    };
    let traces: Vec<Vec<_>> = jobs.iter().map(|job| (0..job.replicas).map(|_| trace(job)).collect()).collect();
    read(scene, &jobs, &traces)
}

#[test]
fn the_times_are_quarters_of_the_first_and_the_last_period() {
    let of = |periods| (end(&scene(periods, 200, 2)), times(end(&scene(periods, 200, 2))));
    assert_eq!(of(0.3), (0.25, vec![0.25]));
    assert_eq!(of(2.007), (2.0, [1, 2, 3, 4, 5, 6, 7, 8].map(|k| f64::from(k) / 4.0).to_vec()));
    assert_eq!(of(6.0), (6.0, vec![0.25, 0.5, 0.75, 1.0, 5.25, 5.5, 5.75, 6.0]));
    assert_eq!((of(0.0).0, of(1e4).0), (0.25, LONGEST));
    // 250 steps a period have no step at a quarter: an end there takes 252.
    let steps = |periods, steps| own(&scene(periods, steps, 2)).steps_per_period;
    assert_eq!([steps(1.0, 250), steps(1.25, 250), steps(1.25, 249), steps(1.25, 1)], [250, 252, 248, 4]);
}

#[test]
fn settings_are_judged_at_each_time() {
    let (b, noise) = (-0.8, 0.004);
    let scene = scene(3.0, 250, 16);
    let law = synthetic(&scene, [b, noise], 200);
    let times: Vec<_> = law.times.iter().map(|at| at.time).collect();
    assert_eq!(times, [0.5, 1.0, 2.5, 3.0]);
    for at in &law.times {
        let (bias, rods) = (at.steps_bias.unwrap(), at.rods_bias.unwrap());
        // Less 3200, 6400 and 12800 steps.
        let off = b * at.time * (1.0 / 250.0 - 7.0 / 12_800.0 / 3.0);
        assert!((bias.value - off).abs() < 4.0 * bias.se && bias.se < 5e-4, "{at:?}");
        let fewer = 0.5 / scene.particles.count as f64 - 0.5 / 1000.0;
        assert!((rods.value - fewer).abs() < 4.0 * rods.se && rods.se < 6e-4, "{at:?}");
        // 200 replicas tell their scatter to 5 %.
        assert!((at.scatter / (noise / 4.0) - 1.0).abs() < 0.2, "{at:?}");
    }
    assert!(synthetic(&scene, [b, noise], 7).times.is_empty());
    // Two replicas correlate by ±1, whatever they are.
    let correlated = |replicas| {
        let law = synthetic(&scene, [b, noise], replicas);
        law.changes.iter().filter(|change| change.correlation.is_some()).count()
    };
    let all = law.changes.len();
    assert_eq!([2, 7, 8].map(correlated), [0, 0, all]);
    assert_eq!(synthetic(&self::scene(1.0, 6400, 16), [b, noise], 8).times[0].steps_bias, None);
}

#[test]
fn what_limits_a_scene_is_named() {
    let said = |of: [f64; 2], replicas: u64| {
        let mut scene = scene(1.0, 200, replicas);
        scene.set_count(1000);
        law_tables::law(&synthetic(&scene, of, 200), 50.0)[0].caption.clone()
    };
    // A bias of 0.005 and standard errors of 0.02, 0.005 and 0.0005.
    for (noise, replicas, words) in
        [(0.02, 1, "More replicas first: "), (0.02, 16, "Half of both"), (0.005, 100, "Finer steps first")]
    {
        let said = said([1.0, noise], replicas);
        assert!(said.contains(words), "{said} {words}");
    }
    let quiet = said([0.0, 0.02], 2000);
    assert!(quiet.contains("no bias of the steps is seen") && !quiet.contains("first: "), "{quiet}");
    // With 100 rods X̄₁ is 0.0045 higher than with 1000.
    let few = law_tables::law(&synthetic(&scene(1.0, 200, 400), [0.2, 0.01], 200), 50.0)[0].caption.clone();
    assert!(few.contains("More rods first"), "{few}");
}
