//! A scene's time in seconds, and outputs at times of their own.

use crate::{changed, planned, run};
use shearbed::model::orientation::from_degrees;
use shearbed::motion::Propagator;
use shearbed::scene::{Flow, Interaction, Orientation, Scene, Time};

fn interacting(scene: &mut Scene) {
    scene.interaction = Some(Interaction { concentration_per_cm3: Some(2000.0), ..Interaction::default() });
}

fn extension(scene: &mut Scene) {
    scene.flow = Flow::Gradient { gradient_per_s: [[0.5, 0.2, 0.0], [0.0, -0.25, 0.0], [0.0, 0.0, -0.25]] };
}

/// x1 at every output.
fn x1(scene: &Scene) -> Vec<f64> {
    run(scene).column("x1").unwrap().mean.clone()
}

type Change<'a> = &'a dyn Fn(&mut Scene);

/// Every kind of motion: in phase, each rod by itself, by steps, by maps, each by itself in any flow, and with all rods
/// alike.
pub(crate) fn every_motion() -> Vec<Scene> {
    let by_strain = |scene: &mut Scene| scene.time = Time::strain(2.0);
    let unequal = |scene: &mut Scene| scene.particles.aspect_ratio_sd_percent = 3.6;
    let alike = |scene: &mut Scene| scene.particles.orientation = Orientation::Given { phi_deg: 30.0, theta_deg: 80.0 };
    let changes: [&[Change]; 8] = [
        &[],
        &[&unequal],
        &[&interacting],
        &[&interacting, &by_strain],
        &[&interacting, &extension, &by_strain],
        &[&extension, &by_strain],
        &[&by_strain, &unequal],
        &[&by_strain, &alike],
    ];
    changes.map(|all| changed(|scene| all.iter().for_each(|change| change(scene)))).to_vec()
}

#[test]
fn means_at_given_times_are_those_of_outputs_there() {
    for scene in every_motion() {
        let of_grid = changed(|grid| {
            *grid = scene.clone();
            grid.time.outputs_per_unit = Some(10);
            grid.time.steps_per_unit = scene.interaction.as_ref().map(|_| 50);
        });
        let of_list = changed(|list| {
            *list = of_grid.clone();
            list.time.outputs_per_unit = None;
            list.output.times = vec![0.2, 0.3, 0.7];
            list.output.rods_at = vec![0.7];
        });
        let plan = planned(&of_list);
        assert_eq!((plan.times(), plan.rods_outputs()), (vec![0.2, 0.3, 0.7], vec![2]));
        let (all, some) = (x1(&of_grid), x1(&of_list));
        for (k, at) in [2, 3, 7].into_iter().enumerate() {
            assert!((some[k] - all[at]).abs() < 1e-14, "{:?}: {some:?}", of_list.time);
        }
        assert!(some[0] != some[1] && some[1] != some[2], "{some:?}");
    }
}

/// A motion with a period is kept for one period only if its outputs repeat.
#[test]
fn given_times_of_a_periodic_motion_do_not_repeat() {
    let mut scene = changed(|scene| {
        scene.flow = Flow::Gradient { gradient_per_s: [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 2.0, 0.0]] };
        (scene.time, scene.time.outputs_per_unit) = (Time::periods(4.0), Some(16));
    });
    let all = x1(&scene);
    scene.time.outputs_per_unit = None;
    scene.output.times = (1..=64).map(|k| f64::from(k) / 16.0).collect();
    let found = x1(&scene);
    assert!(found.len() == 64 && found.iter().zip(&all[1..]).all(|(a, b)| (a - b).abs() < 1e-13));
}

/// Free rods reach any time: a rod by itself is where the closed form has it.
#[test]
fn free_rods_reach_any_time() {
    let times = vec![0.1234, 0.5 - 1e-9, 2.712_3];
    let scene = |sd: f64| {
        changed(|scene| {
            scene.time = Time::periods(3.0);
            scene.particles.orientation = Orientation::Given { phi_deg: 20.0, theta_deg: 60.0 };
            scene.particles.aspect_ratio_sd_percent = sd;
            scene.output.times = times.clone();
        })
    };
    let (start, rods) = (from_degrees(20.0, 60.0), Propagator::general(planned(&scene(0.0)).flow(), 11.6));
    for (mean, time) in x1(&scene(0.0)).into_iter().zip(&times) {
        let p = rods.after_turns(&start, *time).unwrap();
        assert!((mean - p.x.abs()).abs() < 1e-13, "{mean} {}", p.x);
    }
    // A narrow spread: another motion, and nearly the same mean.
    let narrow = x1(&scene(1e-7));
    assert!(narrow.iter().zip(x1(&scene(0.0))).all(|(a, b)| (a - b).abs() < 1e-6), "{narrow:?}");
}

#[test]
fn seconds_are_periods_and_strains_in_another_unit() {
    // At a unit rate a second is a unit of strain: the same bits.
    let alike = |change: fn(&mut Scene)| {
        [Time::seconds(2.0), Time::strain(2.0)].map(|time| {
            let mut scene = changed(change);
            scene.flow = Flow::Shear { shear_rate_per_s: 1.0 };
            (scene.time, scene.time.steps_per_unit) = (time, scene.interaction.as_ref().map(|_| 50));
            x1(&scene)
        })
    };
    let [by_seconds, by_strain] = alike(interacting);
    assert_eq!(by_seconds, by_strain);
    let [by_seconds, by_strain] = alike(|_| ());
    assert!(by_seconds.len() == 21 && by_seconds.iter().zip(&by_strain).all(|(a, b)| (a - b).abs() < 1e-14));
    // At half the rate half as much happens.
    let mut slow = changed(|scene| scene.time = Time::seconds(4.0));
    slow.flow = Flow::Shear { shear_rate_per_s: 0.5 };
    assert!(x1(&slow).iter().zip(&by_strain).all(|(a, b)| (a - b).abs() < 1e-14));
    // In a period of seconds, rods turn around once.
    let period_s = Propagator::new(planned(&slow).flow(), 11.6).period_s().unwrap();
    (slow.time, slow.output.times) = (Time::seconds(period_s), vec![0.25 * period_s, period_s]);
    let quarters = x1(&changed(|scene| scene.output.times = vec![0.25, 1.0]));
    let found = x1(&slow);
    assert!(found.iter().zip(&quarters).all(|(a, b)| (a - b).abs() < 1e-12), "{found:?} {quarters:?}");
    let elapsed = planned(&slow).elapsed(3.0);
    assert_eq!((elapsed.seconds, elapsed.strain), (3.0, 1.5));
}

/// A third in six digits is the step it stands for.
#[test]
fn times_are_those_of_the_nearest_steps() {
    let mut scene = changed(interacting);
    scene.time = Time { steps_per_unit: Some(30), ..Time::seconds(1.0) };
    scene.output.times = vec![0.333333, 0.66666667];
    assert_eq!(planned(&scene).steps(), 20);
}
