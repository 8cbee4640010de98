//! Every rod at the times that a scene asks for.

use crate::{changed, planned, run};
use shearbed::scene::{Ensemble, Flow, Interaction};
use shearbed::suspension::Collision;
use shearbed::{Scene, Suspension};

/// Rods of several aspect ratios, interacting or free.
fn scene(interacting: bool) -> Scene {
    let interaction = Interaction { concentration_per_cm3: Some(200.0), ..Interaction::default() };
    changed(|scene| {
        scene.particles.count = 150;
        scene.particles.aspect_ratio_sd_percent = 3.6;
        scene.time.outputs_per_unit = Some(4);
        scene.interaction = Some(interaction).filter(|_| interacting);
        scene.ensemble = Ensemble { replicas: 3, seed: 5 };
    })
}

#[test]
fn rods_that_are_asked_for_change_no_bit_of_the_rest() {
    for interacting in [false, true] {
        let mut asked = scene(interacting);
        let without = run(&asked);
        assert!(without.snapshots.is_empty());
        asked.output.rods_at = vec![0.0, 0.25, 1.0];
        let with = run(&asked);
        assert_eq!((&with.series, with.counters), (&without.series, without.counters));
        let places: Vec<_> = with.snapshots.iter().map(|s| (s.replica, s.output)).collect();
        let expected: Vec<_> = (0..3).flat_map(|replica| [0, 1, 4].map(|output| (replica, output))).collect();
        assert_eq!(places, expected);
    }
}

#[test]
fn their_means_are_the_observables() {
    let general = Flow::Gradient { gradient_per_s: [[0.0; 3], [0.5, 0.0, 0.1], [0.0; 3]] };
    for (interacting, flow) in [(false, Flow::default()), (true, Flow::default()), (false, general)] {
        let mut asked = Scene { flow, ..scene(interacting) };
        asked.ensemble.replicas = 1;
        asked.output.rods_at = vec![0.5, 0.75];
        let results = run(&asked);
        for snapshot in &results.snapshots {
            for (axis, name) in ["x1", "x2", "x3"].iter().enumerate() {
                let mean = snapshot.p[axis].iter().map(|p| p.abs()).sum::<f64>() / 150.0;
                let expected = results.column(name).unwrap().mean[snapshot.output];
                // 150 numbers up to 1 are added in another order.
                assert!((mean - expected).abs() < 150.0 * f64::EPSILON, "{name}: {mean} {expected}");
            }
            assert_eq!(snapshot.place_in_lengths.is_some(), interacting);
            assert_eq!(snapshot.collided.len(), 150);
        }
    }
}

#[test]
fn who_collided_is_who_did_in_the_last_step_and_places_are_those_of_the_step() {
    let mut asked = scene(true);
    asked.output.rods_at = vec![0.0, 0.5, 0.75];
    let plan = planned(&asked);
    let results = run(&asked);
    let mut suspension = Suspension::new(&plan, 2).unwrap();
    let each = plan.steps() / 4;
    let mut collided = 0;
    let own = results.snapshots.iter().filter(|snapshot| snapshot.replica == 2);
    for snapshot in own {
        let mut expected = vec![false; 150];
        while suspension.tick() < each * snapshot.output as u64 {
            expected.fill(false);
            for Collision { rods, .. } in suspension.step().unwrap() {
                rods.iter().for_each(|rod| expected[*rod] = true);
            }
        }
        assert_eq!(snapshot.collided, expected, "output {}", snapshot.output);
        assert_eq!(snapshot.place_in_lengths.as_ref(), Some(suspension.positions_in_lengths()));
        assert_eq!(snapshot.aspect_ratio, suspension.aspect_ratios());
        for (rod, p) in suspension.directions().iter().enumerate() {
            assert!((0..3).all(|axis| (snapshot.p[axis][rod] - p[axis]).abs() < 1e-15));
        }
        collided += expected.iter().filter(|collided| **collided).count();
    }
    assert!(collided > 0, "no rod collided: the test sees nothing");
}

/// A third in six digits is the output it stands for; its own time is what is written.
#[test]
fn times_are_those_of_the_nearest_outputs() {
    let mut asked = scene(false);
    asked.time.outputs_per_unit = Some(3);
    asked.output.rods_at = vec![0.333333, 0.66666667];
    assert_eq!(planned(&asked).rods_outputs(), [1, 2]);
}

/// At the widest spread that is allowed one draw in 750 crosses 1, or of discs 0, and is drawn again.
#[test]
fn rods_stay_rods_and_discs_discs() {
    for (mean, widest, side) in [(4.0, 25.0, 1.0..f64::MAX), (0.25, 100.0 / 3.0, 0.0..1.0), (0.8, 25.0 / 3.0, 0.0..1.0)]
    {
        let mut scene = scene(false);
        scene.particles.count = 100_000;
        scene.particles.aspect_ratio = mean;
        scene.particles.aspect_ratio_sd_percent = 0.999 * widest;
        scene.ensemble.replicas = 1;
        scene.time.outputs_per_unit = Some(1);
        scene.output.rods_at = vec![0.0];
        let results = run(&scene);
        let drawn = &results.snapshots[0].aspect_ratio;
        assert!(drawn.iter().all(|r| *r > side.start && *r < side.end), "{mean}");
        // 0.00134 of 10⁵, within five standard deviations.
        let again = results.counters.aspect_ratios_redrawn;
        assert!((76..192).contains(&again), "{mean}: {again}");
    }
}
