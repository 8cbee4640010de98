//! Tests that each interpretation does what its description says, and changes a run.

use super::*;

#[test]
fn a_mutual_pair_may_have_one_draw() {
    let far_mm = |r: f64| 0.72 * 0.5 * (r.powf(-1.0 / 3.0) - 1.0);
    let mut second_draw_decides = 0;
    for seed in 1..20 {
        let change = |who| move |p: &mut NaiveProblem| (p.alpha, p.seed, p.reading.who) = (0.5, seed, who);
        let mut draws = stream(seed, 0, 3);
        let r = [0; 3].map(|_| uniform(&mut draws));
        // 0 and 1 are mutual neighbours: the limit follows from the smaller draw, or from that of the lower index
        for (who, r) in [(Who::EachDraws, r[0].min(r[1])), (Who::PairDraws, r[0])] {
            let count = |factor| taken(&[0.0, far_mm(r) * factor], [0, 0], change(who)).len();
            assert_eq!([1.0 - 1e-9, 1.0 + 1e-9].map(count), [1, 0], "{who:?}, seed {seed}");
        }
        second_draw_decides += usize::from(r[1] < r[0]);
        // 2's nearest is 1, whose nearest is 0, to which it is parallel: 2 draws by itself
        let one_sided = |factor| {
            let s_mm = far_mm(r[2]) * factor;
            taken(&[0.0, 0.5 * s_mm, 1.5 * s_mm], [0, 1], change(Who::PairDraws))
        };
        assert_eq!([1.0 - 1e-9, 1.0 + 1e-9].map(one_sided), [vec![(2, 1)], vec![]]);
    }
    assert!(second_draw_decides > 3);
}

#[test]
fn contact_lines_may_end_with_the_rods() {
    // arms of 2 and 3 mm
    let collisions = |lines, length_mm| hand_pair(|p| (p.reading.lines, p.length_mm) = (lines, length_mm)).collisions;
    let lengths = [3.9, 5.999999, 6.0, 6.000001];
    assert_eq!(lengths.map(|a| collisions(Lines::CutAtEnds, a)), [0, 0, 1, 1]);
    assert_eq!(lengths.map(|a| collisions(Lines::Infinite, a)), [1; 4]);
}

#[test]
fn the_nearest_rod_may_be_an_image() {
    // across each face a rod at 1 mm, inside one at 2 mm
    for k in 0..3 {
        let place = |x| {
            let mut place = [5.0; 3];
            place[k] = x;
            place
        };
        let positions_mm = [0.5, 9.5, 2.5].map(place);
        let found = |images| nearest(&positions_mm, 0, images, [10.0; 3]);
        let two = if k == 0 { 2 } else { 1 };
        assert_eq!(found(Images::None), Some(2));
        assert_eq!(found(Images::FlowAndVorticity), Some(two));
        assert_eq!(found(Images::All), Some(1));
        // and from the other side
        assert_eq!(nearest(&positions_mm, 1, Images::All, [10.0; 3]), Some(0));
    }
    assert_eq!(Images::All.nearest_mm([9.0, 1.0, 4.0], [1.0, 9.0, 6.0], [10.0; 3]), [-1.0, 11.0, 4.0]);
}

#[test]
fn an_image_collides_as_a_rod_at_its_place_would() {
    // the volume's side is 100 mm
    let after = |images, x1_mm| {
        let mut naive = Naive::new(fibres(2, 1e30, |p| {
            (p.concentration_per_cm3, p.reading.images) = (0.002, images);
        }));
        naive.positions_mm = vec![[1.0, 50.0, 50.0], [x1_mm, 51.0, 48.0]];
        naive.step();
        assert_eq!(naive.collisions, 1);
        naive.orientations
    };
    let image = after(Images::All, 99.0);
    assert!(far(&image, &after(Images::None, -1.0)) < 1e-12);
    assert!(far(&image, &after(Images::None, 99.0)) > 1e-3);
}

#[test]
fn a_kick_is_added_to_the_exact_step() {
    // as `one_step_by_hand`: the contact changes pdot_A by (1-L)/2 e2 and pdot_B by (1-L)/3 e2
    let naive = hand_pair(|p| p.update = Update::ExactStepAndKick);
    let lambda = shape_factor(11.6);
    let dt = PI * (11.6 + 1.0 / 11.6) / 200.0;
    let free = (11.6 * (TAU / 200.0).tan()).atan();
    let (a, b) = (free + (1.0 - lambda) / 2.0 * dt, (1.0 - lambda) / 3.0 * dt);
    let turned = [[a.cos(), a.sin(), 0.0], [0.0, b.sin(), b.cos()]];
    assert!(far(&naive.orientations, &turned) < 1e-14);
}

#[test]
fn a_scaled_overshoot_is_that_of_the_new_place() {
    let mut naive = Naive::new(fibres(50, 0.0, |p| p.reading.replacement = Replacement::ScaledOvershoot));
    let (mut draws, dt) = (stream(1, 0, 4), naive.problem.time_step_s());
    let mut leavers = 0;
    for _ in 0..200 {
        let before = naive.positions_mm.clone();
        naive.translate(dt);
        for (old, new) in before.iter().zip(&naive.positions_mm) {
            let x2 = old[1] + 0.5 * old[0] * dt;
            if x2 >= 10.0 {
                leavers += 1;
                let since = (x2 - 10.0) / (0.5 * old[0]);
                let x1 = 10.0 * uniform(&mut draws).sqrt();
                let expected = [x1, 0.5 * x1 * since, 10.0 * uniform(&mut draws)];
                assert!(far(&[expected], &[*new]) < 1e-12);
            }
        }
    }
    assert!(leavers > 100);
}

#[test]
fn a_scaled_overshoot_keeps_the_filling_even() {
    let unevenness = |replacement| {
        let mut naive = Naive::new(fibres(20_000, 0.0, |p| {
            (p.steps_per_period, p.reading.replacement) = (100, replacement);
        }));
        let ([edge, ..], dt) = (naive.problem.edges_mm(), naive.problem.time_step_s());
        (0..20).for_each(|_| naive.translate(dt));
        let distance = |k: usize| {
            let mut x: Vec<f64> = naive.positions_mm.iter().map(|x| x[k] / edge).collect();
            x.sort_by(f64::total_cmp);
            let off = |(i, x): (usize, &f64)| (x - (i as f64 + 0.5) / 20_000.0).abs();
            crate::worst(x.iter().enumerate().map(off))
        };
        distance(0).max(distance(1))
    };
    // Kolmogorov: with a uniform filling, positions deviate this much with a probability of 10^-3
    assert!(unevenness(Replacement::ScaledOvershoot) < 0.014);
    assert!(unevenness(Replacement::Overshoot) > 0.03);
}
