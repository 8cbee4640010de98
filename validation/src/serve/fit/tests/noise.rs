//! Fits of points that hardly determine a parameter, with a noisy model: by chance its curves differ from one value to
//! another, which would make intervals too short.

use super::*;
use crate::judge::statistics::Sample;

const POINTS: usize = 40;
const NOISE: f64 = 0.01;
const PLANTED: f64 = 0.2;
/// One standard deviation of a replica.
const SCATTER: f64 = 0.03;

/// A slope at which the points determine the parameter to 0.2 of its range, −1 to 1.
const SLOPE: f64 = 0.008;

fn curve(slope: f64, value: f64) -> impl Iterator<Item = f64> {
    (0..POINTS).map(move |k| 0.5 + slope * value * (k as f64).cos().signum())
}

/// Replicas whose noise differs at each value of the parameters: no random numbers in common.
fn model(slope: f64, seed: u64) -> impl Fn(&[f64]) -> Result<Replica, String> + Sync {
    move |values| {
        let mean: Vec<f64> = curve(slope, values[0]).collect();
        let here = values
            .iter()
            .fold(seed, |hash, value| (hash ^ value.to_bits()).wrapping_mul(0x9E37_79B9_7F4A_7C15).rotate_left(29));
        Ok(Replica::whole(move |replica| {
            let mut rng = Pcg64Dxsm::seed_from_u64(here.wrapping_add(replica));
            let one = |mean: &f64| [mean + SCATTER * normal(&mut rng); 3];
            Ok(mean.iter().map(one).collect())
        }))
    }
}

fn points(seed: u64) -> Vec<Datum> {
    let curve = curve(SLOPE, PLANTED).enumerate().map(|(k, value)| (0, k as f64, value));
    noisy(curve, NOISE, &mut Pcg64Dxsm::seed_from_u64(seed))
}

fn fit(data: &[Datum], slope: f64, seed: u64) -> Fit {
    over_box(data, &Rods::none(1), &["a.a=-1:1"], &vec![(-1.0, 1.0)], &model(slope, seed), REPLICAS)
}

/// The control: the noise in the slopes counts as information of the points.
fn believed(fit: &Fit) -> Fit {
    with_best(fit, fit.best.with_noise())
}

/// Returns whether the intervals of 68 and 95 % contain the planted value, and the p-value.
fn asked(fit: &Fit) -> ([bool; 2], f64) {
    let law = ChiSquared::new((POINTS - 1) as f64).unwrap();
    (inside(fit, PLANTED), law.sf(fit.best.chi_square))
}

/// If 0.4 of the points' apparent information is noise, intervals are √0.6 as long and contain the truth in 56 and 87
/// %.
const EFFECT: f64 = 0.1;

/// Allows for the covariance of a replica, half of V, being itself estimated from [`REPLICAS`] replicas.
const ALLOWANCE: f64 = 0.02;
const REPLICAS: u64 = 100;
const RULE: [f64; 2] = [ALLOWANCE, EFFECT];

#[test]
fn the_noise_of_replicas_makes_no_interval_short() {
    let count = enough((0.68_f64 * 0.32).sqrt(), EFFECT) as u64;
    let one = |k: u64| {
        let fit = fit(&points(1000 + k), SLOPE, 5000 + k);
        (asked(&fit), asked(&believed(&fit)), fit.noise_share())
    };
    let all: Vec<_> = (0..count).into_par_iter().map(one).collect();
    let noise = all.iter().map(|(_, _, noise)| noise).sum::<f64>() / count as f64;
    assert!((0.33..0.5).contains(&noise), "{noise}");
    for (which, confidence) in [0.68, 0.95].into_iter().enumerate() {
        judged_share(Verdict::Pass, all.iter().map(|(own, ..)| own.0[which]), confidence, RULE);
    }
    judged_share(Verdict::Fail, all.iter().map(|(_, believed, _)| believed.0[0]), 0.68, RULE);
    // χ² is neither too large nor too small.
    for above in [0.05, 0.95] {
        judged_share(Verdict::Pass, all.iter().map(|(own, ..)| own.1 > above), 1.0 - above, RULE);
    }
}

/// If the model does not change with the parameter, the squares of its slopes are nothing but the noise's contribution.
#[test]
fn the_noise_of_a_flat_model_is_all_of_its_slopes() {
    let one = |seed: u64| {
        let surface = fit(&points(1), 0.0, seed).best.surface;
        let place = [0.3];
        (surface.noise(&place).trace(), surface.slopes(&place, &[0]).1.trace())
    };
    const SEEDS: u64 = 200;
    let all: Vec<(f64, f64)> = (0..SEEDS).into_par_iter().map(one).collect();
    let differences: Vec<f64> = all.iter().map(|(added, all)| all - added).collect();
    let seen = Sample::of(&differences);
    let mean = all.iter().map(|(_, all)| all).sum::<f64>() / SEEDS as f64;
    assert!(seen.mean.abs() < 4.0 * seen.se && seen.se < 0.05 * mean, "{seen:?} {mean}");
}
