//! Tests of the naive reference itself.

mod readings;

use super::motion::angles_rad;
use super::random::{GOLDEN, mix};
use super::*;
use rand::RngExt;
use std::f64::consts::PI;

fn fibres(count: usize, alpha: f64, change: impl FnOnce(&mut NaiveProblem)) -> NaiveProblem {
    let mut problem = NaiveProblem { count, alpha, ..NaiveProblem::paper(1, 0) };
    change(&mut problem);
    problem
}

fn far(a: &[[f64; 3]], b: &[[f64; 3]]) -> f64 {
    let each = a.iter().zip(b).map(|(a, b)| (vector(*a) - vector(*b)).amax());
    crate::worst(each)
}

#[test]
fn streams_match_reference_output() {
    // SplitMix64's published output for seed 1234567
    let published = [6457827717110365317, 3203168211198807973, 9817491932198370423];
    let state = |k| GOLDEN.wrapping_mul(k).wrapping_add(1234567);
    assert_eq!([1, 2, 3].map(|k| mix(state(k))), published);
    // computed independently, in unlimited integers, from the protocol and the definition of PCG-DXSM
    let fresh = || stream(0xFEDC_BA98_7654_3210, 0x0123_4567_89AB_CDEF, 0xF0E1_D2C3_B4A5_9687);
    let expected: [u64; 3] = [11167359422600035530, 6655880631465208119, 3148222621115903633];
    let mut draws = fresh();
    assert_eq!([0; 3].map(|_| draws.random::<u64>()), expected);
    assert_eq!(uniform(&mut fresh()), 0.6053837673454713);
}

#[test]
fn aspect_ratios_of_1_or_less_are_drawn_again() {
    let broad = |p: &mut NaiveProblem| (p.aspect_ratio, p.aspect_ratio_sd_percent) = (1.5, 50.0);
    let naive = Naive::new(fibres(50, 0.5, broad));
    let normal = Normal::new(1.5, 0.75).expect("0.75 is finite");
    let drawn = normal.sample_iter(stream(1, 0, 0));
    let drawn = drawn.take(50 + naive.redraws as usize);
    assert!(naive.redraws > 0);
    assert_eq!(drawn.filter(|&r| r > 1.0).collect::<Vec<f64>>(), naive.aspect_ratios);
}

#[test]
fn a_free_rod_follows_a4_and_a5() {
    let worst = |mistake| {
        let mut naive = Naive::new(fibres(1, 0.5, |p| p.mistake = mistake));
        naive.orientations[0] = axis([0.0, 0.3]);
        let (r, c) = (11.6, 0.3_f64.tan());
        let mut worst: f64 = 0.0;
        for k in 1..=200 {
            naive.step();
            let [phi, theta] = angles_rad(naive.orientations[0]);
            let turn = TAU * k as f64 / 200.0;
            // both as cross products, so that no tangent becomes infinite
            let a4 = phi.sin() * turn.cos() - r * phi.cos() * turn.sin();
            let a5 = theta.sin() * (r * phi.cos()).hypot(phi.sin()) - c * r * theta.cos();
            worst = worst.max(a4.abs()).max(a5.abs());
        }
        worst
    };
    assert!(worst(None) < 1e-11);
    assert!([Mistake::LambdaOne, Mistake::PeriodHalved].into_iter().all(|mistake| worst(Some(mistake)) > 1e-2));
}

#[test]
fn a_contact_worked_by_hand() {
    // u_2 = 2 x_1. A: x = 0, p = e1. B: x = (2,5,3), p = e3. Line: e1 x e3 = -e2.
    // (r_A, -c, 0) = (2, 5, 3 + r_B): r_A = 2, r_B = -3, c = -5.
    // V_A = 2 (0,.5,1) = (0,1,2). V_B = (0,4,0) - 3 (.25,-1,0) = (-.75,7,0). Mean: 4 e2.
    // V_A' = (0,4,2), less 0, over 2: (0,2,1).
    // V_B' = (-.75,4,0), less (0,4,0), over -3: (.25,0,0).
    let gradient = [[0.0; 3], [2.0, 0.0, 0.0], [0.0; 3]];
    let (e1, e3) = ([1.0, 0.0, 0.0], [0.0, 0.0, 1.0]);
    let (wa, wb) = ([0.0, 0.5, 1.0], [0.25, -1.0, 0.0]);
    let with = |xb, pb| collide([0.0; 3], e1, wa, xb, pb, wb, gradient);
    let expected = Contact {
        line: [0.0, -1.0, 0.0],
        arm_a_mm: 2.0,
        arm_b_mm: -3.0,
        gap_mm: -5.0,
        pdot_a_per_s: [0.0, 2.0, 1.0],
        pdot_b_per_s: [0.25, 0.0, 0.0],
    };
    assert_eq!(with([2.0, 5.0, 3.0], e3), Some(expected));
    assert_eq!(with([2.0, 5.0, 3.0], e1), None, "parallel");
    assert_eq!(with([0.0, 5.0, 3.0], e3), None, "no arm");
}

/// The two rods of the contact worked by hand, before a step in which they are candidates.
fn hand_pair_at_rest(change: impl FnOnce(&mut NaiveProblem)) -> Naive {
    let mut naive = Naive::new(fibres(2, 1e30, |p| {
        (p.shear_rate_per_s, p.concentration_per_cm3) = (2.0, 0.002);
        change(p);
    }));
    naive.positions_mm = vec![[0.0; 3], [2.0, 5.0, 3.0]];
    naive.orientations = vec![[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]];
    naive
}

/// The same rods after the step.
fn hand_pair(change: impl FnOnce(&mut NaiveProblem)) -> Naive {
    let mut naive = hand_pair_at_rest(change);
    naive.step();
    naive
}

#[test]
fn one_step_by_hand() {
    // With Jeffery's rates: pdot_A = (1+L) e2, pdot_B = 0. V_A = 2 (1+L) e2, V_B = 4 e2,
    // mean 3 + L: pdot_A' = (3+L)/2 e2, pdot_B' = (L-1)/(-3) e2 = (1-L)/3 e2.
    for update in [Update::Rotation, Update::Angles] {
        let naive = hand_pair(|p| p.update = update);
        let lambda = (11.6 * 11.6 - 1.0) / (11.6 * 11.6 + 1.0);
        let dt = PI * (11.6 + 1.0 / 11.6) / 200.0;
        let (a, b) = ((3.0 + lambda) / 2.0 * dt, (1.0 - lambda) / 3.0 * dt);
        let turned = [[a.cos(), a.sin(), 0.0], [0.0, b.sin(), b.cos()]];
        assert!(far(&naive.orientations, &turned) < 1e-14);
        assert!(far(&naive.positions_mm, &[[0.0; 3], [2.0, 5.0 + 4.0 * dt, 3.0]]) < 1e-14);
        assert_eq!((naive.collisions, naive.last_collisions), (1, vec![(0, 1)]));
        let [turn_a, turn_b] = naive.last_turns_rad[0];
        assert!((turn_a - a).abs() < 1e-14 && (turn_b - b).abs() < 1e-14);
    }
}

#[test]
fn arms_are_in_units_of_their_own_rods() {
    // the arms are 2 mm (first rod) and 3 mm (second)
    let collisions = |lengths_mm: [f64; 2]| {
        let mut naive = hand_pair_at_rest(|p| p.min_contact_arm = 4.0);
        naive.lengths_mm = lengths_mm.into();
        naive.step();
        naive.collisions
    };
    let found = [[0.5, 0.75], [0.500001, 0.75], [0.5, 0.750001], [0.1, 0.1]].map(collisions);
    assert_eq!(found, [1, 0, 0, 1]);
}

#[test]
fn a_rod_draws_by_its_own_length() {
    let mut draws = stream(1, 0, 3);
    let r = [0; 2].map(|_| uniform(&mut draws));
    // each reaches its partner where s = a alpha (R^(-1/m) - 1), with its own length a
    let needed = r.map(|r: f64| 1.0 / (0.5 * (r.powf(-1.0 / 3.0) - 1.0)));
    let reached = |length, lengths_mm: [f64; 2]| {
        let mut naive = Naive::new(fibres(2, 0.5, |p| p.reading.length = length));
        naive.positions_mm = vec![[0.0; 3], [1.0, 0.0, 0.0]];
        naive.lengths_mm = lengths_mm.into();
        naive.step();
        naive.last_collisions
    };
    let (least, most) = (1.0 - 1e-9, 1.0 + 1e-9);
    for (factors, taken) in [([most, least], vec![(0, 1)]), ([least, most], vec![(1, 0)]), ([least, least], vec![])] {
        let [a, b] = [0, 1].map(|rod| factors[rod] * needed[rod]);
        assert_eq!(reached(Length::Own, [a, b]), taken);
        assert_eq!(reached(Length::Partners, [b, a]), taken);
    }
    // the rod that needs less draws, however unequal the two are
    let enough = f64::min(needed[0], needed[1]);
    let both = |factor: f64| reached(Length::MeanOfBoth, [1.5 * factor * enough, 0.5 * factor * enough]);
    assert_eq!([both(least).len(), both(most).len()], [0, 1]);
}

/// Collisions in one step of rods on axis 1, all of which are candidates unless `change` alters that.
fn taken(x1_mm: &[f64], parallel: [usize; 2], change: impl FnOnce(&mut NaiveProblem)) -> Vec<(usize, usize)> {
    let mut naive = Naive::new(fibres(x1_mm.len(), 1e30, change));
    naive.positions_mm = x1_mm.iter().map(|&x| [x, 0.0, 0.0]).collect();
    naive.orientations[parallel[0]] = naive.orientations[parallel[1]];
    naive.step();
    naive.last_collisions
}

#[test]
fn who_collides_by_chance() {
    // s/a = 1/2, alpha = 1/2: P_c = (1/2)^m
    assert_eq!(collision_probability(0.36, 0.72, 0.5, 3.0), 0.125);
    assert_eq!([0.0, 0.36].map(|s| collision_probability(s, 0.72, 0.0, 3.0)), [0.0; 2]);
    // P_c = R at s = a alpha (R^(-1/m) - 1); the smaller draw of a pair decides
    let mut draws = stream(1, 0, 3);
    let r = uniform(&mut draws).min(uniform(&mut draws));
    let s_mm = 0.72 * 0.5 * (r.powf(-1.0 / 3.0) - 1.0);
    let count = |factor| taken(&[0.0, s_mm * factor], [0, 0], |p| p.alpha = 0.5).len();
    assert_eq!([1.0 - 1e-9, 1.0 + 1e-9].map(count), [1, 0]);
}

#[test]
fn chances_are_those_of_nearest_neighbours() {
    // Rods at 0, 1 and 3 along the flow: nearest at 1, 1 and 2 rod lengths.
    let places = [vec![0.0; 3], vec![0.0, 1.0, 3.0], vec![0.0; 3]];
    let found = expected_candidates(&places, 0.5, 3.0);
    assert!((found - (2.0 / 27.0 + 1.0 / 125.0)).abs() < 1e-15, "{found}");
}

#[test]
fn who_collides_by_order() {
    let line = [[0.0; 3], [1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]];
    assert_eq!(nearest(&line, 0, Images::None, [10.0; 3]), Some(1));
    assert_eq!(taken(&[0.0, 1.0, 3.0, 4.0], [0, 0], |_| ()), [(0, 1), (2, 3)]);
    let x1_mm = [0.0, 10.0, 11.0, 30.0];
    assert_eq!(taken(&x1_mm, [0, 0], |_| ()), [(1, 2)]);
    // a parallel pair is dropped without a collision: its rods are free for later candidates
    assert_eq!(taken(&x1_mm, [1, 2], |_| ()), [(0, 1), (3, 2)]);
    let by_mistake = taken(&x1_mm, [0, 0], |p| p.mistake = Some(Mistake::IndexOrder));
    let by_reading = taken(&x1_mm, [0, 0], |p| p.reading.who = Who::IndexOrder);
    assert_eq!([by_mistake, by_reading], [[(0, 1), (3, 2)]; 2]);
}

#[test]
fn projections_are_means_of_moduli() {
    assert_eq!(mean_projections(&[[0.6, -0.8, 0.0], [-1.0, 0.0, 0.0]]), [0.8, 0.4, 0.0]);
}

/// A.13 gives the rates of the angles of an axis that moves by pdot: a small step by A.14 is p + pdot dt.
#[test]
fn a_step_of_the_angles_is_that_of_the_axis() {
    for p in [axis([0.3, 0.9]), axis([2.0, 2.4])] {
        let pdot = jeffery(p, 5.0, [[0.0; 3], [2.0, 0.0, 0.0], [0.0; 3]]);
        let off = |made| {
            let moved = vector(moved_by_angles(p, pdot, 1e-5, made));
            (moved - vector(p) - vector(pdot) * 1e-5).norm()
        };
        assert!(off(None) < 1e-9 && off(Some(Mistake::PrintedA13)) > 1e-7);
    }
}
