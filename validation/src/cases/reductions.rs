//! A richer model must reduce to the simpler one; standard errors are those of independent values.

use super::*;
use shearbed::run::ensemble::{self, Results};

#[derive(Clone, Copy)]
struct Limits {
    alpha: f64,
    concentration_per_cm3: f64,
    m: f64,
    count: usize,
    sd_percent: f64,
    aspect_ratio: f64,
}

const TAKEN: Limits = Limits {
    alpha: 1e-300,
    concentration_per_cm3: 1e-30,
    m: 1e9,
    count: 1,
    sd_percent: 1e-12,
    aspect_ratio: 1.0 + 1e-12,
};

/// A function that returns the standard error of the mean of independent values.
type StandardError = fn(&[f64]) -> f64;

pub fn cases() -> Vec<Case> {
    vec![
        Case::core("reductions")
            .claim(
                "α → 0, n → 0, m → ∞ and one rod give free rods to the bit; σ → 0 gives uniform rods and r_e → 1 gives \
                 spheres to round-off.",
            )
            .source("eqs 7, 11")
            .under_test(TAKEN)
            .mistake("α = ½", Limits { alpha: 0.5, ..TAKEN })
            .mistake("n = 50 per cm³", Limits { concentration_per_cm3: 50.0, ..TAKEN })
            .mistake("m = 3", Limits { m: 3.0, ..TAKEN })
            .mistake("100 rods for one", Limits { count: 100, ..TAKEN })
            .mistake("σ = 10⁻⁶ %", Limits { sd_percent: 1e-6, ..TAKEN })
            .mistake("r_e = 1 + 10⁻⁶", Limits { aspect_ratio: 1.0 + 1e-6, ..TAKEN })
            .check(reductions),
        Case::program("standard-errors")
            .claim("Standard errors are those of independent replicas, or of rods where there is one replica.")
            .source("the results' own columns")
            .under_test((|values| Sample::of(values).se) as StandardError)
            .mistake("without the root of their number", |values| Sample::of(values).se * (values.len() as f64).sqrt())
            .mistake("N for N − 1", |values| {
                let n = values.len() as f64;
                Sample::of(values).se * ((n - 1.0) / n).sqrt()
            })
            .check(standard_errors),
    ]
}

fn run(scene: &Scene) -> Option<Results> {
    ensemble::run(&lab::plan(scene)).ok()
}

/// The largest difference of any channel at any output between the scenes `a` and `b`; NaN if one of them stops.
pub(super) fn difference(a: &Scene, b: &Scene) -> f64 {
    let (Some(a), Some(b)) = (run(a), run(b)) else {
        return f64::NAN;
    };
    let channels = |results: &Results| -> Vec<f64> {
        results.series.iter().flat_map(|series| &series.columns).flat_map(|c| c.mean.clone()).collect()
    };
    let pairs = channels(&a).into_iter().zip(channels(&b));
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, larger)
}

fn reductions(limits: &Limits, effort: &Effort) -> Vec<Evidence> {
    let mut free = lab::free_scene(effort);
    free.particles.aspect_ratio_sd_percent = 3.6;
    let mut interacting = free.clone();
    lab::interaction(&mut interacting);
    let with = |change: &dyn Fn(&mut Scene)| lab::changed(interacting.clone(), change);
    let alpha = with(&|scene| lab::interaction(scene).alpha = limits.alpha);
    let thin = with(&|scene| lab::interaction(scene).concentration_per_cm3 = Some(limits.concentration_per_cm3));
    let steep = with(&|scene| lab::interaction(scene).m = limits.m);
    let one = with(&|scene| scene.particles.count = limits.count);
    let mut one_free = free.clone();
    one_free.particles.count = limits.count;

    let mut uniform = lab::free_scene(effort);
    uniform.time.duration = 3.0;
    let mut narrow = uniform.clone();
    narrow.particles.aspect_ratio_sd_percent = limits.sd_percent;

    let mut round = lab::free_scene(effort);
    round.particles.aspect_ratio = limits.aspect_ratio;
    let mut sphere = lab::free_scene(effort);
    sphere.particles.aspect_ratio = 1.0;

    vec![
        Evidence::exact("α = 10⁻³⁰⁰ against free rods", difference(&alpha, &free)),
        Evidence::exact("n = 10⁻³⁰ per cm³ against free rods", difference(&thin, &free)),
        Evidence::exact("m = 10⁹ against free rods", difference(&steep, &free)),
        Evidence::exact("one interacting rod against one free rod", difference(&one, &one_free)),
        Evidence::within(
            "σ = 10⁻¹² % against σ = 0",
            difference(&narrow, &uniform),
            1e-11,
            "a phase of 6π shifted by σ, grown by r_e at the flip",
        ),
        Evidence::within(
            "r_e = 1 + 10⁻¹² against a sphere",
            difference(&round, &sphere),
            1e-11,
            "the map differs by r_e − 1",
        ),
    ]
}

fn standard_errors(standard_error: &StandardError, effort: &Effort) -> Vec<Evidence> {
    let mut scene = lab::interacting_scene(effort);
    scene.time.duration = 0.5;
    scene.time.outputs_per_unit = Some(10);
    scene.ensemble.replicas = 16;
    let over_replicas = run(&scene).map_or(f64::NAN, |results| {
        let expected = |output| standard_error(&per_replica(&scene, 16, |mean| mean(Channel::X[0], output)));
        worst_ratio(&results, |output| Some(expected(output)))
    });
    // One replica of rods whose projections at t = 0 are known individually.
    let mut one = lab::free_scene(effort);
    one.particles.count = 16;
    one.time.duration = 0.0;
    let mut watched = lab::interacting_scene(effort);
    watched.particles.count = 16;
    let directions = lab::suspension(&watched, 0).directions();
    let projections: Vec<f64> = directions.iter().map(|p| p.x.abs()).collect();
    let over_rods = run(&one).map_or(f64::NAN, |results| {
        worst_ratio(&results, |output| (output == 0).then(|| standard_error(&projections)))
    });
    let because = "two ways of summing sixteen squares";
    vec![
        Evidence::within("relative error of the errors over replicas", over_replicas, 1e-12, because),
        Evidence::within("relative error of the errors over rods", over_rods, 1e-12, because),
    ]
}

/// The largest relative error of X̄₁'s standard errors at outputs with an expected one.
fn worst_ratio(results: &Results, expected: impl Fn(usize) -> Option<f64>) -> f64 {
    let Some(channel) = results.column("x1") else {
        return f64::NAN;
    };
    let errors = channel.se.iter().enumerate();
    errors.filter_map(|(output, se)| expected(output).map(|expected| (se / expected - 1.0).abs())).fold(0.0, larger)
}
