//! A richer model must reduce to the simpler one; standard errors are those of independent values.

use super::*;
use shearbed::run::ensemble::{self, Results};

/// The changes that take a scene to a limit: of α, n, m, the number of rods, σ, and r_e.
type Limits = [Change; 6];

const TAKEN: Limits = [
    |scene| lab::interaction(scene).alpha = 1e-300,
    |scene| lab::interaction(scene).concentration_per_cm3 = Some(1e-30),
    |scene| lab::interaction(scene).m = 1e9,
    |scene| scene.particles.count = 1,
    |scene| scene.particles.aspect_ratio_sd_percent = 1e-12,
    |scene| scene.particles.aspect_ratio = 1.0 + 1e-12,
];

/// A function that returns the standard error of the mean of independent values.
type StandardError = fn(&[f64]) -> f64;

pub fn cases() -> Vec<Case> {
    let taken = |which: usize, change: Change| {
        let mut limits = TAKEN;
        limits[which] = change;
        limits
    };
    vec![
        Case::of(Judges::Core, "reductions")
            .claim(
                "α → 0, n → 0, m → ∞ and one rod give free rods to the bit; σ → 0 gives uniform rods and r_e → 1 gives \
                 spheres to round-off.",
            )
            .source("eqs 7, 11")
            .under_test(TAKEN)
            .mistake("α = ½", taken(0, |scene| lab::interaction(scene).alpha = 0.5))
            .mistake("n = 50 per cm³", taken(1, |scene| lab::interaction(scene).concentration_per_cm3 = Some(50.0)))
            .mistake("m = 3", taken(2, |scene| lab::interaction(scene).m = 3.0))
            .mistake("100 rods for one", taken(3, |scene| scene.particles.count = 100))
            .mistake("σ = 10⁻⁶ %", taken(4, |scene| scene.particles.aspect_ratio_sd_percent = 1e-6))
            .mistake("r_e = 1 + 10⁻⁶", taken(5, |scene| scene.particles.aspect_ratio = 1.0 + 1e-6))
            .check(reductions),
        Case::of(Judges::Program, "standard-errors")
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

/// The largest difference of any channel at any output between the scenes `a` and `b`; NaN if one of them stops,
/// or if they have different outputs.
pub(super) fn difference(a: &Scene, b: &Scene) -> f64 {
    let (Some(a), Some(b)) = (run(a), run(b)) else {
        return f64::NAN;
    };
    let channels = |results: &Results| -> Vec<f64> {
        results.series.iter().flat_map(|series| &series.columns).flat_map(|c| c.mean.clone()).collect()
    };
    let (a, b) = (channels(&a), channels(&b));
    // Series of different lengths differ.
    if a.len() == b.len() { worst(a.into_iter().zip(b).map(|(a, b)| (a - b).abs())) } else { f64::NAN }
}

fn reductions(limits: &Limits, effort: &Effort) -> [Evidence; 6] {
    let uniform = lab::changed(lab::free_scene(effort), |scene| scene.time.outputs_per_unit = Some(50));
    let free = lab::changed(uniform.clone(), |scene| scene.particles.aspect_ratio_sd_percent = 3.6);
    let interacting = Scene { interaction: lab::interacting_scene(effort).interaction, ..free.clone() };
    let long = lab::changed(uniform.clone(), |scene| scene.time.duration = 3.0);
    let one = lab::changed(free.clone(), limits[3]);
    let sphere = lab::changed(uniform.clone(), |scene| scene.particles.aspect_ratio = 1.0);
    let apart =
        |which: usize, scene: &Scene, limit: &Scene| difference(&lab::changed(scene.clone(), limits[which]), limit);
    [
        Evidence::on("α = 10⁻³⁰⁰ against free rods", "rod lengths").exact(apart(0, &interacting, &free)),
        Evidence::on("n = 10⁻³⁰ per cm³ against free rods", "rod lengths").exact(apart(1, &interacting, &free)),
        Evidence::on("m = 10⁹ against free rods", "rod lengths").exact(apart(2, &interacting, &free)),
        Evidence::on("one interacting rod against one free rod", "rod lengths").exact(apart(3, &interacting, &one)),
        Evidence::on("σ = 10⁻¹² % against σ = 0", "rod lengths")
            .within(apart(4, &long, &long), 1e-11)
            .because("a phase of 6π shifted by σ, grown by r_e at the flip"),
        Evidence::on("r_e = 1 + 10⁻¹² against a sphere", "rod lengths")
            .within(apart(5, &uniform, &sphere), 1e-11)
            .because("the map differs by r_e − 1"),
    ]
}

fn standard_errors(standard_error: &StandardError, effort: &Effort) -> Vec<Evidence> {
    let mut scene = lab::interacting_scene(effort);
    scene.time = Time { outputs_per_unit: Some(10), ..Time::periods(0.5) };
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
        Evidence::on("relative error of the errors over replicas", "–").within(over_replicas, 1e-12).because(because),
        Evidence::on("relative error of the errors over rods", "–").within(over_rods, 1e-12).because(because),
    ]
}

/// The largest relative error of X̄₁'s standard errors at outputs with an expected one.
fn worst_ratio(results: &Results, expected: impl Fn(usize) -> Option<f64>) -> f64 {
    let Some(channel) = results.column("x1") else {
        return f64::NAN;
    };
    let errors = channel.se.iter().enumerate();
    worst(errors.filter_map(|(output, se)| expected(output).map(|expected| (se / expected - 1.0).abs())))
}
