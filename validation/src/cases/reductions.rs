//! A richer model must reduce to the simpler one, and whole runs keep the symmetries of the equations.

use super::lab::{self, Sample, per_replica};
use crate::accept::Rule;
use crate::case::{About, Case, Effort, Evidence, Judges};
use nalgebra::UnitVector3;
use shearbed::ensemble::{self, Results};
use shearbed::scene::{Orientation, Scene};

/// How far a limit is taken: 1 is the limit, 0 stops short of it.
type Limit = f64;

pub fn cases() -> Vec<Case> {
    vec![
        Case::new(
            About {
                name: "reductions",
                judges: Judges::Core,
                claim: "α → 0, n → 0, m → ∞ and one rod give free rods to the bit; σ → 0 gives uniform rods and r_e → 1 gives spheres to round-off.",
                source: "eqs 7, 11; A.1",
                equations: &["7", "11"],
            },
            1.0 as Limit,
            vec![("the limits not taken", 0.0)],
            reductions,
        ),
        Case::new(
            About {
                name: "symmetries",
                judges: Judges::Core,
                claim: "Whole runs keep the symmetries: rods in another order and units of length and time to the bit, p → −p to round-off, the mirrored flow exactly for free rods.",
                source: "eqs 3, 4, 7, 15",
                equations: &["4"],
            },
            0.0 as Break,
            vec![(
                "2 % more shear in the new units, and 2° off the mirrored angles",
                0.02,
            )],
            symmetries,
        ),
        Case::new(
            About {
                name: "mirrored-flow",
                judges: Judges::Core,
                claim: "Interacting rods in the mirrored flow have the same mean projections in law.",
                source: "eqs 3, 14",
                equations: &["3", "14"],
            },
            -0.5 as ShearRate,
            vec![(
                "a third flow: axes 1 and 2 not mirrored, half the concentration",
                0.5,
            )],
            mirrored,
        ),
        Case::new(
            About {
                name: "standard-errors",
                judges: Judges::Core,
                claim: "Standard errors are those of independent replicas, or of rods where there is one replica.",
                source: "the results' own columns",
                equations: &[],
            },
            (|results| results) as Spoil,
            vec![
                ("without the root of their number", |mut results| {
                    scale_errors(&mut results, 4.0);
                    results
                }),
                ("N for N − 1", |mut results| {
                    scale_errors(&mut results, (15.0f64 / 16.0).sqrt());
                    results
                }),
            ],
            standard_errors,
        ),
    ]
}

fn run(scene: &Scene) -> Option<Results> {
    ensemble::run(&lab::plan(scene), || ()).ok()
}

/// The largest difference of any channel at any output.
fn difference(a: &Scene, b: &Scene) -> f64 {
    let (Some(a), Some(b)) = (run(a), run(b)) else {
        return f64::NAN;
    };
    let channels = |results: &Results| -> Vec<f64> {
        results
            .series
            .iter()
            .flat_map(|series| &series.channels)
            .flat_map(|c| c.mean.clone())
            .collect()
    };
    let pairs = channels(&a).into_iter().zip(channels(&b));
    pairs.map(|(a, b)| (a - b).abs()).fold(
        0.0,
        |worst, d| if d.is_nan() { f64::NAN } else { f64::max(worst, d) },
    )
}

fn reductions(limit: &Limit, effort: &Effort) -> Vec<Evidence> {
    let taken = *limit == 1.0;
    let mut free = lab::free_scene(effort);
    free.particles.aspect_ratio_sd_percent = 3.6;
    let mut interacting = free.clone();
    lab::interaction(&mut interacting);
    let with = |change: &dyn Fn(&mut Scene)| {
        let mut scene = interacting.clone();
        change(&mut scene);
        scene
    };
    let value = |limit: f64, short: f64| if taken { limit } else { short };
    let alpha = with(&|scene| lab::interaction(scene).alpha = value(1e-300, 0.5));
    let thin = with(&|scene| lab::interaction(scene).concentration_per_cm3 = value(1e-30, 50.0));
    let steep = with(&|scene| lab::interaction(scene).m = value(1e9, 3.0));
    let one = with(&|scene| scene.particles.count = 1);
    let mut one_free = free.clone();
    one_free.particles.count = if taken { 1 } else { 2 };

    let mut uniform = lab::free_scene(effort);
    uniform.time.periods = Some(3.0);
    let mut narrow = uniform.clone();
    narrow.particles.aspect_ratio_sd_percent = value(1e-12, 1.0);

    let mut round = lab::free_scene(effort);
    round.particles.aspect_ratio = value(1.0 + 1e-12, 1.1);
    let mut sphere = lab::free_scene(effort);
    sphere.particles.aspect_ratio = 1.0;

    vec![
        Evidence::new(
            "α = 10⁻³⁰⁰ against free rods",
            Rule::exact(difference(&alpha, &free)),
        ),
        Evidence::new(
            "n = 10⁻³⁰ per cm³ against free rods",
            Rule::exact(difference(&thin, &free)),
        ),
        Evidence::new(
            "m = 10⁹ against free rods",
            Rule::exact(difference(&steep, &free)),
        ),
        Evidence::new(
            "one interacting rod against one free rod",
            Rule::exact(difference(&one, &one_free)),
        ),
        Evidence::new(
            "σ = 10⁻¹² % against σ = 0",
            Rule::within(
                difference(&narrow, &uniform),
                1e-11,
                "a phase of 6π shifted by σ, grown by r_e at the flip",
            ),
        ),
        Evidence::new(
            "r_e = 1 + 10⁻¹² against a sphere",
            Rule::within(difference(&round, &sphere), 1e-11, "the map differs by r_e − 1"),
        ),
    ]
}

/// By how much the second run is off.
type Break = f64;

fn symmetries(off: &Break, effort: &Effort) -> Vec<Evidence> {
    let base = {
        let mut scene = lab::interacting_scene(effort);
        scene.particles.aspect_ratio_sd_percent = 3.6;
        scene
    };
    let mut lengths = base.clone();
    lengths.particles.length_mm *= 8.0;
    lab::interaction(&mut lengths).concentration_per_cm3 *= (1.0 + off) / 512.0;
    let mut times = base.clone();
    times.flow.shear_rate_per_s = Some(0.5e-30);
    times.particles.aspect_ratio *= 1.0 + off;

    let given = |scene: &Scene, phi_deg, theta_deg| {
        let mut scene = scene.clone();
        scene.particles.orientation = Orientation::Given { phi_deg, theta_deg };
        scene
    };
    // A fifth of a period: kicks grow the 10⁻¹⁶ of the turned start.
    let mut short = base.clone();
    short.time.periods = Some(0.2);
    let head = given(&short, 25.0, 70.0);
    let tail = given(&short, 205.0 + 100.0 * off, 110.0);

    let mut mirror = lab::free_scene(effort);
    mirror.flow.shear_rate_per_s = None;
    mirror.flow.gradient_per_s = Some([[0.0; 3], [-0.5, 0.0, 0.0], [0.0; 3]]);
    let mirror = given(&mirror, -25.0 + 100.0 * off, 70.0);
    let straight = given(&lab::free_scene(effort), 25.0, 70.0);

    vec![
        Evidence::new(
            "the same rods in another order, every one of them a candidate",
            Rule::exact(relabelled(*off, effort)),
        ),
        Evidence::new(
            "lengths 8 times larger, concentration 512 times less",
            Rule::exact(difference(&lengths, &base)),
        ),
        Evidence::new(
            "a shear rate of 5·10⁻³¹ 1/s",
            Rule::exact(difference(&times, &base)),
        ),
        Evidence::new(
            "every rod turned head to tail, interacting",
            Rule::within(
                difference(&tail, &head),
                1e-10,
                "the turned angles are rounded to 10⁻¹⁶, which kicks ∝ 1/r grow",
            ),
        ),
        Evidence::new(
            "free rods in the mirrored flow from mirrored angles",
            Rule::within(
                difference(&mirror, &straight),
                0.0,
                "every product has the same factors up to sign",
            ),
        ),
    ]
}

/// The largest difference of a rod's direction after ten steps, with the rods in reverse order. α is huge, so
/// that every draw makes a candidate, and the steps so short that no rod leaves: only then are the random
/// numbers, which belong to places in the list, without effect.
fn relabelled(off: f64, effort: &Effort) -> f64 {
    let mut scene = lab::interacting_scene(effort);
    lab::interaction(&mut scene).alpha = 1e30;
    scene.time.steps_per_period = Some(10_000_000);
    scene.time.outputs_per_period = Some(1);
    let mut first = lab::suspension(&scene, 0);
    // Away from the faces normal to axis 2.
    let mut places = first.positions_in_lengths().clone();
    places[1].iter_mut().for_each(|x| *x = 0.1 + 0.9 * *x);
    let directions: Vec<_> = first
        .directions()
        .into_iter()
        .map(UnitVector3::new_normalize)
        .collect();
    let mut second = first.clone();
    let mut reversed = places.clone();
    reversed.iter_mut().for_each(|axis| axis.reverse());
    reversed[0][0] += off;
    let backwards: Vec<_> = directions.iter().rev().copied().collect();
    let placed = first
        .place(places, &directions)
        .and(second.place(reversed, &backwards));
    for _ in 0..10 {
        if placed.is_none() || first.step().is_err() || second.step().is_err() {
            return f64::NAN;
        }
    }
    let (forth, back) = (first.directions(), second.directions());
    let distances = forth.iter().zip(back.iter().rev()).map(|(a, b)| (a - b).norm());
    distances.fold(0.0, f64::max)
        + if first.counters().collisions > 0 {
            0.0
        } else {
            f64::NAN
        }
}

/// G of the second flow in 1/s.
type ShearRate = f64;

fn mirrored(shear_rate_per_s: &ShearRate, effort: &Effort) -> Vec<Evidence> {
    let mut straight = lab::interacting_scene(effort);
    straight.time.outputs_per_period = Some(4);
    let mut mirror = straight.clone();
    mirror.flow.shear_rate_per_s = None;
    mirror.flow.gradient_per_s = Some([[0.0; 3], [*shear_rate_per_s, 0.0, 0.0], [0.0; 3]]);
    mirror.ensemble.seed = effort.seed(2);
    if *shear_rate_per_s > 0.0 {
        lab::interaction(&mut mirror).concentration_per_cm3 *= 0.5;
    }
    let replicas = effort.pick(300, 4000);
    (0..3)
        .map(|axis| {
            let of = |scene: &Scene| Sample::of(&per_replica(scene, replicas, |means| means.at(4, axis)));
            let (a, b) = (of(&straight), of(&mirror));
            let apart = Sample {
                mean: a.mean - b.mean,
                se: a.se.hypot(b.se),
                samples: replicas,
            };
            Evidence::new(
                format!("X̄_{} at t/T = 1, flow less mirrored flow", axis + 1),
                apart.is(0.0, 0.0, 0.003, "a symmetry of the model; independent seeds"),
            )
        })
        .collect()
}

/// What a control does to the results before they are judged.
type Spoil = fn(Results) -> Results;

fn scale_errors(results: &mut Results, factor: f64) {
    let channels = results.series.iter_mut().flat_map(|series| &mut series.channels);
    channels
        .flat_map(|channel| &mut channel.se)
        .for_each(|se| *se *= factor);
}

fn standard_errors(spoil: &Spoil, effort: &Effort) -> Vec<Evidence> {
    let mut scene = lab::interacting_scene(effort);
    scene.time.periods = Some(0.5);
    scene.time.outputs_per_period = Some(10);
    scene.ensemble.replicas = 16;
    let over_replicas = run(&scene).map(spoil).map_or(f64::NAN, |results| {
        let expected = |output| Sample::of(&per_replica(&scene, 16, |means| means.at(output, 0))).se;
        worst_ratio(&results, |output| Some(expected(output)))
    });
    // One replica of rods whose projections at t = 0 are known one by one.
    let mut one = lab::free_scene(effort);
    one.particles.count = 16;
    one.time.periods = Some(0.0);
    let mut watched = lab::interacting_scene(effort);
    watched.particles.count = 16;
    let directions = lab::suspension(&watched, 0).directions();
    let projections: Vec<f64> = directions.iter().map(|p| p.x.abs()).collect();
    let over_rods = run(&one).map(spoil).map_or(f64::NAN, |results| {
        worst_ratio(&results, |output| {
            (output == 0).then(|| Sample::of(&projections).se)
        })
    });
    let because = "two ways of summing sixteen squares";
    vec![
        Evidence::new(
            "relative error of the errors over replicas",
            Rule::within(over_replicas, 1e-12, because),
        ),
        Evidence::new(
            "relative error of the errors over rods",
            Rule::within(over_rods, 1e-12, because),
        ),
    ]
}

/// The largest relative error of X̄₁'s standard errors where one is expected.
fn worst_ratio(results: &Results, expected: impl Fn(usize) -> Option<f64>) -> f64 {
    let Some(channel) = results.channel("x1") else {
        return f64::NAN;
    };
    let errors = channel.se.iter().enumerate();
    errors
        .filter_map(|(output, se)| expected(output).map(|expected| (se / expected - 1.0).abs()))
        .fold(0.0, |worst, error| {
            if error.is_nan() {
                f64::NAN
            } else {
                f64::max(worst, error)
            }
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_difference_is_seen_and_none_is_none() {
        let scene = lab::free_scene(&Effort::gate());
        assert_eq!(difference(&scene, &scene), 0.0);
        let mut other = scene.clone();
        other.particles.aspect_ratio *= 1.0 + 1e-6;
        assert!(difference(&scene, &other) > 1e-9);
    }
}
