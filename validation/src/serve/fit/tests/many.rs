//! Fits of three parameters: replicas at 128 nodes show how the model changes, others its mean at the best place.

use super::super::search::MOST_SHARE;
use super::*;
use crate::methods::least_squares::likelihood::REPLICAS as MEAN;

const POINTS: usize = 20;
const NOISE: f64 = 0.02;
/// At an edge of their ranges, so that the best place is not the centre of a box.
const PLANTED: [f64; 3] = [0.011, -0.021, 0.001];
/// Standard deviations of what a replica has at all values of the parameters, and of what it has at each alone.
const EVERYWHERE: f64 = 0.1;
const HERE: f64 = 0.02;

fn curve(values: &[f64]) -> Vec<f64> {
    let angle = |k: usize| std::f64::consts::TAU * k as f64 / POINTS as f64;
    let terms = |k: usize| [angle(k).cos(), angle(k).sin(), (2.0 * angle(k)).cos()];
    (0..POINTS).map(|k| terms(k).iter().zip(values).map(|(term, value)| term * value).sum()).collect()
}

fn model(seed: u64) -> impl Fn(&[f64]) -> Result<Replica, String> + Sync {
    move |values| {
        let mean = curve(values);
        let here = values.iter().fold(seed, |all, value| (all ^ value.to_bits()).wrapping_mul(0x9E37_79B9_7F4A_7C15));
        Ok(Replica::whole(move |replica| {
            let rng = |seed: u64| Pcg64Dxsm::seed_from_u64(seed.wrapping_mul(1_000_003).wrapping_add(replica));
            let (mut everywhere, mut here) = (rng(seed), rng(here));
            let mut scatter = || EVERYWHERE * normal(&mut everywhere) + HERE * normal(&mut here);
            Ok(mean.iter().map(|mean| [mean + scatter(); 3]).collect())
        }))
    }
}

#[test]
fn the_mean_comes_from_replicas_at_the_best_place() {
    let point = |(k, value)| Datum { value, u: NOISE, ..Datum::place(0, "x1", k as f64) };
    let data: Vec<_> = curve(&PLANTED).into_iter().enumerate().map(point).collect();
    let fit = searched(&data, &["a.a=0.01:0.4", "a.b=-0.4:-0.02", "a.c=0:0.4"], &model(1), 1000);
    // The share of the mean is reached by those replicas: a node has a few, not the hundreds that it would need.
    let (at_nodes, alone) = (fit.emulator.replicas(), fit.emulator.behind_covariance());
    assert!(at_nodes <= 100 && alone > 2 * at_nodes && fit.best.share(MEAN) <= MOST_SHARE, "{at_nodes} {alone}");
    let found = fit.values(&fit.best.place);
    for (axis, planted) in PLANTED.into_iter().enumerate() {
        let pull = (found[axis] - planted) / fit.covariance()[(axis, axis)].sqrt();
        // The points are exact: replicas have a tenth of the variance, four standard deviations of which are 1.3.
        assert!(pull.abs() < 1.3, "{axis}: {pull}");
    }
}
