//! Every rod at the times that a scene asks for.

use shearbed::run::ensemble;
use shearbed::scene;
use shearbed::suspension::Collision;
use shearbed::{Plan, Results, Scene, Suspension};

const SCENE: &str = r#"
title = "rods out"
[flow]
shear_rate_per_s = 0.5
[particles]
count = 150
length_mm = 0.72
aspect_ratio = 11.6
aspect_ratio_sd_percent = 3.6
orientation = "isotropic"
[time]
periods = 1
outputs_per_period = 4
[ensemble]
replicas = 3
seed = 5
"#;

const INTERACTING: &str = "[interaction]\nconcentration_per_cm3 = 200\nalpha = 0.5\n";

fn scene(text: &str) -> Scene {
    scene::parse("s.toml", text).unwrap()
}

fn run(scene: &Scene) -> Results {
    ensemble::run(&Plan::new(scene).unwrap()).unwrap()
}

#[test]
fn rods_that_are_asked_for_change_no_bit_of_the_rest() {
    for interaction in ["", INTERACTING] {
        let mut asked = scene(&format!("{SCENE}{interaction}"));
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
    for (interaction, flow) in [
        ("", "shear_rate_per_s = 0.5"),
        (INTERACTING, "shear_rate_per_s = 0.5"),
        ("", "gradient_per_s = [[0, 0, 0], [0.5, 0, 0.1], [0, 0, 0]]"),
    ] {
        let text = SCENE.replace("shear_rate_per_s = 0.5", flow);
        let mut asked = scene(&format!("{text}{interaction}"));
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
            assert_eq!(snapshot.place_in_lengths.is_some(), !interaction.is_empty());
            assert_eq!(snapshot.collided.len(), 150);
        }
    }
}

#[test]
fn who_collided_is_who_did_in_the_last_step_and_places_are_those_of_the_step() {
    let mut asked = scene(&format!("{SCENE}{INTERACTING}"));
    asked.output.rods_at = vec![0.0, 0.5, 0.75];
    let plan = Plan::new(&asked).unwrap();
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

#[test]
fn times_that_are_no_outputs_are_refused_with_what_is() {
    let refused = |rods_at: &str| {
        let text = format!("{SCENE}[output]\nrods_at = {rods_at}\n");
        Plan::parse("s.toml", &text).unwrap_err().to_string()
    };
    let key = "s.toml:18: output.rods_at = ";
    for (given, allowed) in [
        ("[0.1]", "k/4 up to 1; 0.1 is not one of them"),
        ("[0, 1.25]", "k/4 up to 1; 1.25 is not one of them"),
        ("[0.25, 0.2500001]", "0.2500001 is not one of them"),
        ("[0.5, 0.25]", "that grow"),
        ("[-0.25]", "≥ 0"),
        ("[nan]", "≥ 0"),
        ("[inf]", "≥ 0"),
        ("0.5", "a list of"),
        ("[\"now\"]", "a list of"),
    ] {
        let error = refused(given);
        assert!(error.starts_with(&format!("{key}{given} is not allowed: ")), "{error}");
        assert!(error.contains(allowed), "{error}");
    }
    // A third in six digits is the output it stands for; its own time is what is written.
    let text = SCENE.replace("outputs_per_period = 4", "outputs_per_period = 3");
    let asked = scene(&format!("{text}[output]\nrods_at = [0.333333, 0.66666667]\n"));
    assert_eq!(Plan::new(&asked).unwrap().rods_outputs(), [1, 2]);
}

/// At the widest spread that is allowed one draw in 750 crosses 1, or of discs 0, and is drawn again.
#[test]
fn rods_stay_rods_and_discs_discs() {
    for (mean, widest, side) in [(4.0, 25.0, 1.0..f64::MAX), (0.25, 100.0 / 3.0, 0.0..1.0), (0.8, 25.0 / 3.0, 0.0..1.0)]
    {
        let mut scene = scene(SCENE);
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
