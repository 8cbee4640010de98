//! Flows that oscillate.

use super::*;
use crate::angle_grid;
use crate::diffusion::oscillating;
use std::f64::consts::TAU;

/// Stretched and turned in a plane, and out of it.
const MIXED: [[f64; 3]; 3] = [[0.3, -0.5, 0.0], [0.8, -0.1, 0.0], [0.0, 0.0, -0.2]];

/// By steps of steady flows with harmonics, and by Taylor's series on a grid.
#[test]
fn both_methods_agree_in_a_flow_that_oscillates() {
    for (flow, rings) in [(COUETTE, 20), (MIXED, 20)] {
        let grid = angle_grid::oscillating(flow, 0.8, 0.3, rings, [3.0, 2.0, 5e-4]);
        let error = |motion: &Motion, period_s: f64| {
            let found = oscillating(motion, [period_s, 0.0], Start::Isotropic, &[0.7, 2.0]).unwrap()[1];
            assert!(found.error < 2e-11);
            apart(&grid.second, &found.second).max(apart(&grid.fourth, &found.fourth))
        };
        judge(flow, Motion::diffusing(flow, 3.0, 0.3), |motion| error(motion, 3.0), 5e-12, 1e-5);
        assert!(error(&Motion::diffusing(flow, 3.0, 0.3), 3.03) > 1e-5);
    }
}

/// da_12/dt = −6D_r a_12 + ΛG/5 cos ωt while directions are nearly alike, and a very long period is a steady flow.
#[test]
fn weak_and_slow_oscillations_have_their_limits() {
    let (d_r, rate) = (0.25, 1e-5);
    let motion = Motion::diffusing(COUETTE.map(|row| row.map(|x| rate * x)), 3.0, d_r);
    let error = |omega: f64, [phase, due_phase]: [f64; 2]| {
        let times = [0.3, 1.0, 4.0];
        let found = oscillating(&motion, [TAU / 1.5, phase], Start::Isotropic, &times).unwrap();
        let due = |t: f64| {
            let (sine, cosine) = (omega * t + due_phase).sin_cos();
            let late = (-6.0 * d_r * t).exp() * (6.0 * d_r * due_phase.cos() + omega * due_phase.sin());
            0.8 * rate / 5.0 * (6.0 * d_r * cosine + omega * sine - late) / (36.0 * d_r * d_r + omega * omega)
        };
        crate::worst(found.iter().zip(times).map(|(means, t)| (means.second[3] - due(t)).abs()))
    };
    for phase in [0.0, 1.0, -TAU / 4.0] {
        assert!(error(1.5, [phase; 2]) < 2e-12, "{phase}: {:e}", error(1.5, [phase; 2]));
    }
    assert!(error(1.6, [0.0; 2]) > 1e-9 && error(1.5, [0.0, 0.1]) > 1e-9);
    let motion = Motion::diffusing(COUETTE, 3.0, d_r);
    let [slow, steady] =
        [oscillating(&motion, [1e9, 0.0], Start::Isotropic, &[2.0]), at(&motion, Start::Isotropic, &[2.0])];
    assert!(slow.unwrap()[0].apart(&steady.unwrap()[0]) < 1e-11);
}

/// In turned axes the tensor is turned, whatever the flow.
#[test]
fn a_turned_oscillation_is_turned() {
    let turn = nalgebra::Rotation3::from_euler_angles(0.4, -0.7, 1.1);
    let l = Matrix3::from_fn(|i, j| ASKEW[i][j]);
    let there = turn * l * turn.inverse();
    let of = |l: [[f64; 3]; 3]| {
        let found = oscillating(&Motion::diffusing(l, 3.0, 0.3), [2.0, 0.0], Start::Isotropic, &[0.6, 1.7]).unwrap();
        matrix(found[1].second)
    };
    let (here, there) = (of(ASKEW), of(std::array::from_fn(|i| std::array::from_fn(|j| there[(i, j)]))));
    assert!((turn * here * turn.inverse() - there).amax() < 1e-11);
    assert!((here - there).amax() > 1e-2);
}
