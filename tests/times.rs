//! A scene's time in seconds, and outputs at times of their own.

use shearbed::motion::Propagator;
use shearbed::nalgebra::{UnitVector3, Vector3};
use shearbed::run::{go_on, run_replica};
use shearbed::scene::{Flow, Interaction, Orientation, Scene, Time};
use shearbed::{Plan, run::ensemble};

fn changed(change: impl FnOnce(&mut Scene)) -> Scene {
    let mut scene = Scene::default();
    change(&mut scene);
    scene
}

fn interacting(scene: &mut Scene) {
    scene.interaction = Some(Interaction { concentration_per_cm3: Some(2000.0), ..Interaction::default() });
}

fn extension(scene: &mut Scene) {
    scene.flow = Flow::Gradient { gradient_per_s: [[0.5, 0.2, 0.0], [0.0, -0.25, 0.0], [0.0, 0.0, -0.25]] };
}

/// x1 at every output.
fn x1(scene: &Scene) -> Vec<f64> {
    let results = ensemble::run(&Plan::new(scene).unwrap()).unwrap();
    results.column("x1").unwrap().mean.clone()
}

/// Every kind of motion: in phase, each rod by itself, by steps, by maps, each by itself in any flow, and with all rods
/// alike.
fn every_motion() -> Vec<Scene> {
    let by_strain = || Time::strain(2.0);
    vec![
        Scene::default(),
        changed(|scene| scene.particles.aspect_ratio_sd_percent = 3.6),
        changed(interacting),
        changed(|scene| {
            interacting(scene);
            scene.time = by_strain();
        }),
        changed(|scene| {
            interacting(scene);
            extension(scene);
            scene.time = by_strain();
        }),
        changed(|scene| {
            extension(scene);
            scene.time = by_strain();
        }),
        changed(|scene| {
            scene.time = by_strain();
            scene.particles.aspect_ratio_sd_percent = 3.6;
        }),
        changed(|scene| {
            scene.time = by_strain();
            scene.particles.orientation = Orientation::Given { phi_deg: 30.0, theta_deg: 80.0 };
        }),
    ]
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
        let plan = Plan::new(&of_list).unwrap();
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

#[test]
fn a_replica_goes_on_between_given_times() {
    for mut scene in every_motion() {
        scene.time.steps_per_unit = scene.interaction.as_ref().map(|_| 50);
        scene.output.times = vec![0.2, 0.3, 0.7];
        let plan = Plan::new(&scene).unwrap();
        let whole = run_replica(&plan, 0).unwrap();
        let mut kept = Vec::new();
        go_on(&plan, 0, None, |state| kept.push(state())).unwrap();
        assert!(!kept.is_empty());
        for state in kept {
            assert_eq!(go_on(&plan, 0, Some(state), |_| ()).unwrap(), whole);
        }
    }
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
    let flow = *Plan::new(&scene(0.0)).unwrap().flow();
    let (sin, cos) = 60f64.to_radians().sin_cos();
    let (y, x) = 20f64.to_radians().sin_cos();
    let start = UnitVector3::new_normalize(Vector3::new(sin * x, sin * y, cos));
    let rods = Propagator::general(&flow, 11.6);
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
    let period_s = Propagator::new(Plan::new(&slow).unwrap().flow(), 11.6).period_s().unwrap();
    (slow.time, slow.output.times) = (Time::seconds(period_s), vec![0.25 * period_s, period_s]);
    let quarters = x1(&changed(|scene| scene.output.times = vec![0.25, 1.0]));
    let found = x1(&slow);
    assert!(found.iter().zip(&quarters).all(|(a, b)| (a - b).abs() < 1e-12), "{found:?} {quarters:?}");
    let elapsed = Plan::new(&slow).unwrap().elapsed(3.0);
    assert_eq!((elapsed.seconds, elapsed.strain), (3.0, 1.5));
}

const SCENE: &str = "title = \"t\"\n[flow]\nshear_rate_per_s = 1\n[particles]\ncount = 9\nlength_mm = 1\n\
    aspect_ratio = 5\norientation = \"isotropic\"\n[interaction]\nconcentration_per_cm3 = 9\nalpha = 0.5\n[time]\n";

#[test]
fn times_that_cannot_be_are_refused_with_what_can() {
    let refused = |rest: &str| Plan::parse("s.toml", &format!("{SCENE}{rest}")).unwrap_err().to_string();
    for (rest, said) in [
        ("periods = 1\nseconds = 2", "s.toml:13: time.periods = 1 is not allowed: either periods or seconds, not both"),
        ("strain = 1\nseconds = 2", "either strain or seconds, not both"),
        ("steps_per_second = 2", "periods, strain or seconds must be given"),
        (
            "seconds = 2\nsteps_per_strain = 2",
            "s.toml:14: time.steps_per_strain = 2 is not allowed: goes with strain; seconds take steps_per_second",
        ),
        ("periods = 2\noutputs_per_second = 2", "goes with seconds; periods take outputs_per_period"),
        (
            "periods = 1\noutputs_per_period = 10\n[output]\ntimes = [0.5]",
            "s.toml:14: time.outputs_per_period = 10 is not allowed: either it or output.times, not both",
        ),
        (
            "periods = 1\n[output]\ntimes = [0.5, 1.5]",
            "s.toml:15: output.times = [0.5, 1.5] is not allowed: up to 1e6 times within the run, which ends at \
                time.periods = 1",
        ),
        ("periods = 1\n[output]\ntimes = [0.5, 0.25]", "that grow"),
        (
            "periods = 1\nsteps_per_period = 100\n[output]\ntimes = [0.125, 0.5]",
            "interacting rods need different times on their steps, k/100; 0.125 is not one of them: set \
                steps_per_period",
        ),
        ("periods = 1\nsteps_per_period = 100\n[output]\ntimes = [0.5, 0.50000001]", "0.50000001 is not one of them"),
        (
            "periods = 1\n[output]\ntimes = [0.5]\nrods_at = [0.25]",
            "different output times, of output.times; 0.25 is not one",
        ),
    ] {
        let error = refused(rest);
        assert!(error.contains(said), "{rest}: {error}");
    }
    // A third in six digits is the step it stands for.
    let third = format!("{SCENE}seconds = 1\nsteps_per_second = 30\n[output]\ntimes = [0.333333, 0.66666667]");
    assert_eq!(Plan::parse("s.toml", &third).unwrap().steps(), 20);
}
