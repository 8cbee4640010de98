//! Flows one after another.

use super::*;
use crate::angle_grid;
use crate::diffusion::{FlowStep, densities, through};

const REST: [[f64; 3]; 3] = [[0.0; 3]; 3];
const PLANAR: [[f64; 3]; 3] = [[-0.5, 0.0, 0.0], [0.0, 0.5, 0.0], [0.0; 3]];
const SHAPE: f64 = 0.8;

/// Flows with D_r in 1/s and a duration in s, of rods of Λ = 0.8.
fn steps(flows: &[([[f64; 3]; 3], f64, f64)]) -> Vec<FlowStep> {
    let step = |(l, d_r, duration_s): &([[f64; 3]; 3], f64, f64)| FlowStep {
        motion: Motion::diffusing(*l, 3.0, *d_r),
        duration_s: *duration_s,
    };
    flows.iter().map(step).collect()
}

/// By harmonics whose axes change with the flow, and on a grid that knows no axes.
#[test]
fn both_methods_agree_through_flows() {
    let backwards = COUETTE.map(|row| row.map(|x| -x));
    let turned = [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [1.0, 0.0, 0.0]];
    let askew_backwards = ASKEW.map(|row| row.map(|x| -0.8 * x));
    for (flows, mirrored) in [
        (vec![(COUETTE, 0.2, 1.5), (REST, 0.2, 0.3), (backwards, 0.2, 0.7)], true),
        (vec![(PLANAR, 0.2, 1.0), (turned, 0.3, 1.0)], true),
        (vec![(ASKEW, 0.3, 1.0), (COUETTE, 0.2, 0.5), (PLANAR, 0.3, 0.5)], false),
        (vec![(ASKEW, 0.2, 0.5), (askew_backwards, 0.2, 1.0)], false),
    ] {
        let grid = angle_grid::through(&flows, SHAPE, if mirrored { 28 } else { 20 });
        let end: f64 = flows.iter().map(|(.., duration_s)| duration_s).sum();
        let error = |flows: &[_]| {
            let found = through(&steps(flows), Start::Isotropic, &[end]).unwrap()[0];
            apart(&grid.second, &found.second).max(apart(&grid.fourth, &found.fourth))
        };
        assert!(error(&flows) < 5e-12, "{flows:?}: {:e}", error(&flows));
        for at in 0..flows.len() {
            let mut wrong = flows.clone();
            wrong[at].1 *= 1.01;
            assert!(error(&wrong) > 1e-5, "{flows:?} {at}: {:e}", error(&wrong));
        }
        let mut swapped = flows.clone();
        swapped.swap(0, 1);
        assert!(error(&swapped) > 1e-4);
    }
}

/// A flow in pieces is the flow; a sharp start is followed through flows.
#[test]
fn a_flow_in_pieces_is_the_flow() {
    for (flow, start) in
        [(COUETTE, Start::Isotropic), (ASKEW, Start::Isotropic), (COUETTE, Start::Plane([0.0, 0.0, 1.0]))]
    {
        let pieces = [(flow, 0.3, 0.5), (flow, 0.3, 0.25), (flow, 0.3, 9.0)];
        let times = [0.25, 0.5, 0.6, 0.75, 2.0];
        let (whole, parts) = (steps(&pieces[..1]), steps(&pieces));
        let [whole, parts] = [whole, parts].map(|flows| through(&flows, start, &times).unwrap());
        for (a, b) in whole.iter().zip(&parts) {
            assert!(a.apart(b) < 1e-11, "{:e}", a.apart(b));
        }
        assert!(whole[1].apart(&whole[2]) > 1e-3);
    }
}

/// The density's moments over the sphere are the means, and it is that of both directions of a rod.
#[test]
fn the_density_has_the_means() {
    let flows = steps(&[(COUETTE, 0.2, 1.0), (ASKEW, 0.2, 1.0)]);
    let rule = crate::diffusion::harmonics::sphere_rule(40);
    let mut directions: Vec<_> = rule.iter().map(|(p, _)| *p).collect();
    directions.extend(rule.iter().map(|(p, _)| p.map(|x| -x)));
    let (values, error) = densities(&flows, Start::Isotropic, &[0.5, 1.5], &directions).unwrap();
    let means = through(&flows, Start::Isotropic, &[0.5, 1.5]).unwrap();
    assert!(error < 4e-12);
    for (values, means) in values.iter().zip(means) {
        let (here, opposite) = values.split_at(rule.len());
        assert!(here.iter().zip(opposite).all(|(a, b)| (a - b).abs() < 1e-12));
        let moment = |i: usize, j: usize| rule.iter().zip(here).map(|((p, w), x)| w * x * p[i] * p[j]).sum::<f64>();
        let second = PAIRS.map(|(i, j)| moment(i, j));
        assert!(apart(&second, &means.second) < 1e-11, "{second:?} {:?}", means.second);
        assert!(apart(&[1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0, 0.0, 0.0, 0.0], &means.second) > 0.01);
    }
    assert!(densities(&flows, Start::Plane([0.0, 0.0, 1.0]), &[0.0], &directions).is_err());
}
