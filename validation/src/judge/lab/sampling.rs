//! Independent samples: one value per replica, and a test of uniformity.

use super::plan;
use crate::judge::accept::{Rule, Text, kolmogorov_samples};
use crate::judge::statistics::Sample;
use rayon::prelude::*;
use shearbed::observable::Channel;
use shearbed::run::ensemble::Results;
use shearbed::run::run_replica;
use shearbed::scene::Scene;
use statrs::distribution::Uniform;
use statrs::stats_tests::NaNPolicy;
use statrs::stats_tests::ks_test::{KSOneSampleAlternativeMethod, ks_onesample};

/// One value per replica of a scene, computed by `value` from the replica's means `mean(channel, output)`.
pub fn per_replica<T: Send>(
    scene: &Scene,
    replicas: u64,
    value: impl Fn(&dyn Fn(Channel, usize) -> f64) -> T + Sync,
) -> Vec<T> {
    let plan = plan(scene);
    let of_replica = |replica| {
        // A run that stopped fails every check: all its means are NaN.
        let means = run_replica(&plan, replica).ok();
        value(&|channel, output| means.as_ref().and_then(|means| means.mean(channel, output)).unwrap_or(f64::NAN))
    };
    (0..replicas).into_par_iter().map(of_replica).collect()
}

/// A mean over `samples` rods or replicas of a run at an output; NaN if the run stopped.
pub fn at_output<E>(results: &Result<Results, E>, channel: Channel, output: usize, samples: u64) -> Sample {
    let column = results.as_ref().ok().and_then(|results| results.column(&channel.name()));
    let (mean, se) = column.map_or((f64::NAN, f64::NAN), |column| (column.mean[output], column.se[output]));
    Sample { mean, se, samples }
}

/// The Kolmogorov–Smirnov test that `values` in [0, 1] are uniform; there must be enough values to show a `distance`
/// between the two distribution functions.
pub fn uniform(values: Vec<f64>, distance: f64, because: impl Into<Text>) -> Rule {
    let samples = values.len() as u64;
    let enough = kolmogorov_samples(distance);
    let method = KSOneSampleAlternativeMethod::TwoSidedAsymptotic;
    let (distance, p) = Uniform::new(0.0, 1.0)
        .ok()
        .and_then(|unit| ks_onesample(values, &unit, method, NaNPolicy::Propogate).ok())
        .unwrap_or((f64::NAN, f64::NAN));
    Rule::PValue { p, samples, enough, distance: Some(distance), because: because.into() }
}
