//! Tests of flows other than plane Couette flow: rods come back where the liquid came in.

use super::*;
use crate::naive::inflow::{carried, come_in, inside};

const EDGES_MM: [f64; 3] = [1.0, 2.0, 4.0];
const DT_S: f64 = 0.1;

fn entries(rows: [[f64; 3]; 3], made: Option<Mistake>) -> Vec<[f64; 3]> {
    let draws = stream(9, 0, 4);
    let one = |rod| come_in(matrix(rows), EDGES_MM, DT_S, &draws, rod, made);
    (0..20_000).map(one).collect()
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let values: Vec<_> = values.collect();
    values.iter().sum::<f64>() / values.len() as f64
}

/// By hand: u_2 = x_1 brings liquid in only at x_2 = 0, with a density proportional to x_1 (mean 2/3 of the edge), and
/// it has moved by a uniform share of x_1 dt.
#[test]
fn shear_brings_rods_in_as_it_does_liquid() {
    let shear = [[0.0; 3], [1.0, 0.0, 0.0], [0.0; 3]];
    let means = |made| {
        let all = entries(shear, made);
        assert!(all.iter().all(|x| inside(*x, EDGES_MM) && x[1] <= x[0] * DT_S * (1.0 + 1e-12)));
        let way = |x: &[f64; 3]| x[1] / (x[0] * DT_S);
        [mean(all.iter().map(|x| x[0])), mean(all.iter().map(way)), mean(all.iter().map(|x| x[2] / 4.0))]
    };
    // standard errors of 0.0017 and 0.002
    let near = |found: [f64; 3], expected: [f64; 3]| (0..3).all(|k| (found[k] - expected[k]).abs() < 0.01);
    assert!(near(means(None), [2.0 / 3.0, 0.5, 0.5]));
    assert!(near(means(Some(Mistake::InflowUniform)), [0.5, 0.5, 0.5]));
    assert!(near(means(Some(Mistake::InflowAtOnce)), [2.0 / 3.0, 0.999, 0.5]));
    // transposed, liquid comes in along the other axis
    let draws = stream(9, 0, 4);
    let problem = NaiveProblem {
        other_flow: Some(OtherFlow { gradient_per_s: shear, steps_per_strain: 10 }),
        mistake: Some(Mistake::GradientTransposed),
        ..NaiveProblem::paper(1, 0)
    };
    assert!((problem.time_step_s() - DT_S).abs() < 1e-15);
    let x = come_in(matrix(problem.gradient_per_s()), EDGES_MM, DT_S, &draws, 0, None);
    assert!(x[0] <= x[1] * DT_S * (1.0 + 1e-12));
}

/// By hand: u = (x_1, −x_2/2, −x_3/2) comes in at both far faces, 1·4 mm² at 1 mm/s and 1·2 mm² at 2 mm/s: equal
/// shares.
#[test]
fn extension_brings_rods_in_through_both_faces() {
    let extension = [[1.0, 0.0, 0.0], [0.0, -0.5, 0.0], [0.0, 0.0, -0.5]];
    let through_axis_2 = |made| {
        let all = entries(extension, made);
        let at = |x: &[f64; 3], k: usize| x[k] >= EDGES_MM[k] * (-0.5 * DT_S).exp() * (1.0 - 1e-12);
        assert!(all.iter().all(|x| at(x, 1) || at(x, 2)));
        mean(all.iter().map(|x| f64::from(u8::from(at(x, 1) && !at(x, 2)))))
    };
    // the corner filled through both faces is 2.4 % of each
    assert!((through_axis_2(None) - 0.5 * 0.9756).abs() < 0.02);
    assert!(through_axis_2(Some(Mistake::FacesByArea)) > 0.6);
}

#[test]
fn places_go_with_the_liquid() {
    let there = carried(matrix([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0; 3]]), [1.0, 0.0, 3.0], FRAC_PI_2);
    assert!(far(&[there], &[[0.0, 1.0, 3.0]]) < 1e-14);
}
