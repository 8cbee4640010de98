//! Tests of placing rods, and of collisions as the paper words them.

use super::*;
use crate::scene::{Interaction, Scene, Time};

#[test]
fn a_state_of_other_counts_or_outside_the_volume_is_refused_and_changes_nothing() {
    let mut scene = Scene { interaction: Some(Interaction::default()), ..Scene::default() };
    scene.particles.count = 3;
    let plan = Plan::new(&scene).unwrap();
    let mut suspension = Suspension::new(&plan, 0).unwrap();
    let before = suspension.positions_in_lengths().clone();
    let places = |count| [(); 3].map(|()| vec![0.1; count]);
    let directions = |count| vec![Vector3::z_axis(); count];
    let mut uneven = places(3);
    uneven[2].pop();
    let sides = suspension.sides_in_lengths();
    let at = |axis: usize, x: f64| {
        let mut all = places(3);
        all[axis][1] = x;
        all
    };
    for (places, directions) in [
        (places(3), directions(2)),
        (places(2), directions(3)),
        (places(4), directions(4)),
        (uneven, directions(3)),
        (at(0, -1e-300), directions(3)),
        (at(1, sides[1].next_up()), directions(3)),
        (at(2, f64::NAN), directions(3)),
    ] {
        assert_eq!(suspension.place(places, &directions), None);
        assert_eq!(suspension.positions_in_lengths(), &before);
    }
    assert_eq!(suspension.place(at(1, sides[1]), &directions(3)), Some(()));
    assert_eq!(suspension.place(places(3), &directions(3)), Some(()));
    assert_eq!(suspension.positions_in_lengths(), &places(3));
}

/// More rods than have their R kept: each candidate's is drawn again, at its place in the stream.
#[test]
fn candidates_of_many_rods_are_those_of_the_stream_in_every_step() {
    let mut scene = Scene { interaction: Some(Interaction::default()), ..Scene::default() };
    scene.particles.count = MOST_KEPT + 3000;
    scene.particles.length_sd_percent = 20.0;
    let plan = Plan::new(&scene).unwrap();
    let mut suspension = Suspension::new(&plan, 0).unwrap();
    let mut draws = stream(scene.ensemble.seed, 0, Purpose::Collisions);
    let mut seen = 0;
    for _ in 0..2 {
        let drawn: Vec<f64> = (0..scene.particles.count).map(|_| draws.random()).collect();
        let places = suspension.positions_in_lengths().clone();
        let square = |a: usize, b: usize| places.iter().map(|x| (x[b] - x[a]).powi(2)).sum::<f64>();
        suspension.step().unwrap();
        for rod in (MOST_KEPT - 1000..MOST_KEPT + 3000).step_by(7) {
            let others = (0..scene.particles.count).filter(|other| *other != rod);
            let nearest = others.min_by(|a, b| square(rod, *a).total_cmp(&square(rod, *b))).unwrap();
            let reach = suspension.reach.of(drawn[rod]) * suspension.rods.length(rod);
            let expected = (square(rod, nearest) < reach * reach).then_some(nearest as u32);
            let found = suspension.candidates.iter().find(|candidate| candidate.1 == rod as u32);
            assert_eq!(found.map(|candidate| candidate.2), expected, "rod {rod}");
            seen += usize::from(expected.is_some());
        }
    }
    assert!(seen > 10, "{seen} candidates");
}

/// Two rods that are certain to collide, in shear of either sign and in other flows.
#[test]
fn a_collision_gives_both_contact_points_the_mean_velocity_along_the_line() {
    const STEPS: u64 = 100_000;
    let general = [[0.3, -0.5, 0.1], [0.8, 0.1, -0.2], [0.4, 0.6, -0.4]];
    for gradient in [
        [[0.0; 3], [0.5, 0.0, 0.0], [0.0; 3]],
        [[0.0; 3], [-0.5, 0.0, 0.0], [0.0; 3]],
        [[0.5, 0.0, 0.0], [0.0, -0.5, 0.0], [0.0; 3]],
        general,
    ] {
        let mut scene = Scene {
            interaction: Some(Interaction { concentration_per_cm3: Some(1.0), alpha: 1e12, ..Interaction::default() }),
            ..Scene::default()
        };
        scene.flow = crate::scene::Flow::Gradient { gradient_per_s: gradient };
        scene.particles.count = 2;
        scene.time = Time { steps_per_unit: Some(STEPS), outputs_per_unit: Some(1), ..Time::strain(1.0) };
        let plan = Plan::new(&scene).unwrap();
        let mut suspension = Suspension::new(&plan, 0).unwrap();
        let [side, ..] = suspension.sides_in_lengths();
        let centres = [[0.4, 0.5, 0.5], [0.55, 0.45, 0.6]].map(|x| x.map(|x| x * side));
        let places = [0, 1, 2].map(|axis| vec![centres[0][axis], centres[1][axis]]);
        let start = [(0.3, 1.0), (2.0, 0.7)].map(|(phi, theta)| crate::model::orientation::from_angles(phi, theta));
        suspension.place(places, &start).unwrap();
        assert_eq!(suspension.step().unwrap().len(), 1);

        // As the paper words it, in units of strain: u at each rod's centre plus r ṗ, along the contact line.
        let per_strain = plan.flow().per_s() / plan.flow().magnitude_per_s();
        let (strain, spin) = (0.5 * (per_strain + per_strain.transpose()), 0.5 * (per_strain - per_strain.transpose()));
        let [a, b] = centres.map(Vector3::from);
        let met = contact(&(b - a), &start[0], &start[1], [0.0; 2]).unwrap();
        let free = start.map(|p| {
            let p = p.into_inner();
            spin * p + shape_factor(11.6) * (strain * p - p * p.dot(&(strain * p)))
        });
        let after = suspension.directions();
        let rates = [0, 1].map(|k| (after[k] - start[k].into_inner()) * STEPS as f64);
        let along = |rates: &[Vector3<f64>; 2]| {
            [(a, 0), (b, 1)].map(|(x, k)| met.line.dot(&(per_strain * x + rates[k] * met.arms[k])))
        };
        let [before_a, before_b] = along(&free);
        assert!((before_a - before_b).abs() > 0.05, "they would part");
        let mean = 0.5 * (before_a + before_b);
        for velocity in along(&rates) {
            // A step of 1e-5 bends the path by about the same amount.
            assert!((velocity - mean).abs() < 1e-3, "{gradient:?}: {velocity} {mean}");
        }
    }
}
