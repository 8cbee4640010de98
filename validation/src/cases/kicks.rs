//! Kicks: how often, how large, and what the time step has to do with it (docs/time-step.md).

use super::lab::{self, Sample};
use crate::accept::Rule;
use crate::case::{About, Case, Effort, Evidence, Judges};
use crate::kicks::{Angles, Counts, is_above, kicks_rad, of_one_step, rates, step_strain, tail};
use crate::oracle::kicks::{chance_of_threads, kicks, largest_kick, tail_of_isotropic};
use crate::oracle::pairing::{Pair, nearest_pairs};
use rayon::prelude::*;
use shearbed::Suspension;
use shearbed::scene::Scene;
use std::f64::consts::PI;

pub fn cases() -> Vec<Case> {
    vec![
        Case::new(
            About {
                name: "kick-formula",
                judges: Judges::Core,
                claim: "Isotropic rods at random places are kicked by more than κ as often as P_c, the arm's density at 0 and the gap's velocity say, whatever Δt is.",
                source: "eqs 7–10, A.7–A.13; docs/time-step.md",
                equations: &["7", "8", "9", "10", "A.7", "A.10", "A.13"],
            },
            (|pair, chance| 2.0 * pair.chance * chance(1.0)) as Expected,
            vec![
                ("one arm left out", |pair, chance| pair.chance * chance(1.0)),
                ("not weighted with P_c", |_, chance| 2.0 * chance(1.0)),
                (
                    "the arm's density at 0 without the crossing angle",
                    |pair, chance| 2.0 * pair.chance * chance(0.25 * PI),
                ),
                ("a kick ∝ 2Δt", |pair, chance| 2.0 * pair.chance * chance(0.5)),
            ],
            formula,
        ),
        Case::new(
            About {
                name: "kick-memory",
                judges: Judges::Core,
                claim: "In runs, pairs whose gap closes are kicked as often as the formula says at any Δt; those whose gap opens ever less often as Δt → 0.",
                source: "A.7–A.14; docs/time-step.md",
                equations: &["A.13", "A.14"],
            },
            (kicks_rad as Angles, (|counts| counts) as Change),
            vec![
                ("closing and opening exchanged", (kicks_rad, exchanged)),
                (
                    "the whole turn |ṗ′|Δt for the kick",
                    (|c| c.angles_rad, |counts| counts),
                ),
            ],
            memory,
        ),
        Case::new(
            About {
                name: "kick-tail",
                judges: Judges::Core,
                claim: "Kicks have a tail ∝ 1/κ: Hill's exponent is 1, in fresh pairs and in runs.",
                source: "A.13; docs/time-step.md",
                equations: &["A.13"],
            },
            (kicks_rad as Angles, 0.0),
            vec![
                ("arms below 0.05 a are no contact", (kicks_rad, 0.05)),
                ("a kick ∝ r^−½", (|c| c.kicks_rad.map(f64::sqrt), 0.0)),
            ],
            heavy,
        ),
        Case::new(
            About {
                name: "kick-bound",
                judges: Judges::Core,
                claim: "A kick is |g|Δt/(2|r|); with a shortest arm r_min it is at most ¼GΔt[(2 − Λ′)s/r_min + 2 − Λ − Λ′].",
                source: "eq. 6, A.7–A.13; docs/time-step.md",
                equations: &["6", "A.7", "A.10", "A.13"],
            },
            (kicks_rad as Angles, 1.0),
            vec![
                ("arms down to a third of r_min", (kicks_rad, 1.0 / 3.0)),
                ("arms of every size", (kicks_rad, 0.0)),
                ("the whole turn |ṗ′|Δt for the kick", (|c| c.angles_rad, 1.0)),
            ],
            bounded,
        ),
    ]
}

/// The expected number of rods of a pair that are kicked, from the pair's chance to collide and the chance that
/// a collision kicks a rod by more than some factor times κ.
type Expected = fn(&Pair, &dyn Fn(f64) -> f64) -> f64;

fn formula(expected: &Expected, effort: &Effort) -> Vec<Evidence> {
    let settings = [(0.1, 800, 1), (1.0, 100, 2), (10.0, 10, 3)];
    let evidence = settings.map(|(threshold_rad, steps, seed)| {
        let mut scene = fresh_scene(effort, 300, steps);
        scene.ensemble.seed = effort.seed(seed);
        let scaled = threshold_rad / step_strain(&scene);
        let constant = 6.0 * PI * tail_of_isotropic(scene.particles.aspect_ratio);
        let chance = |factor: f64| constant * chance_of_threads(factor * scaled);
        let ratios: Vec<_> = (0..effort.pick(240, 10_000))
            .into_par_iter()
            .map(|replica| {
                let mut suspension = lab::suspension(&scene, replica);
                let pairs = pairs(&mut scene.clone(), &suspension);
                let expected: f64 = pairs.iter().map(|pair| expected(pair, &chance)).sum();
                let kicks = of_one_step(&mut suspension, kicks_rad);
                let larger = kicks.iter().filter(|kick| is_above(**kick, threshold_rad)).count();
                larger as f64 / expected
            })
            .collect();
        Evidence::new(
            format!("rods kicked by more than {threshold_rad} rad over those expected, {steps} steps a period"),
            Sample::of(&ratios).is(
                1.0,
                0.003,
                0.04,
                "left out, 10⁻³ each: the next term in GΔt/κ, terms in (1 − Λ)/Y², the cube's corners, to which \
                 distant neighbours point; 4 % tells the controls apart",
            ),
        )
    });
    evidence.into()
}

/// Isotropic rods so near each other that a third collides in a step.
fn fresh_scene(effort: &Effort, count: usize, steps_per_period: u64) -> Scene {
    let mut scene = lab::interacting_scene(effort);
    scene.particles.count = count;
    let interaction = lab::interaction(&mut scene);
    (interaction.concentration_per_cm3, interaction.alpha) = (400.0, 2.0);
    scene.time.steps_per_period = Some(steps_per_period);
    scene.time.outputs_per_period = Some(1);
    scene
}

/// The nearest pairs of a suspension and their chances to collide.
fn pairs(scene: &mut Scene, suspension: &Suspension) -> Vec<Pair> {
    let interaction = lab::interaction(scene);
    let (alpha, m) = (interaction.alpha, interaction.m);
    let [x1, x2, x3] = suspension.positions_in_lengths();
    let places: Vec<_> = (0..x1.len()).map(|i| [x1[i], x2[i], x3[i]]).collect();
    nearest_pairs(&places, |s| (alpha / (s + alpha)).powf(m), |_, _| true)
}

/// The counts after a control has changed them.
type Change = fn(Counts) -> Counts;

fn exchanged(counts: Counts) -> Counts {
    Counts {
        closing: counts.opening,
        opening: counts.closing,
        ..counts
    }
}

fn memory((angles, change): &(Angles, Change), effort: &Effort) -> Vec<Evidence> {
    const OVER: usize = 1; // 0.1 rad
    let run = |alpha: f64, steps, replicas| {
        let mut scene = lab::interacting_scene(effort);
        scene.particles.count = 25;
        let interaction = lab::interaction(&mut scene);
        (interaction.concentration_per_cm3, interaction.alpha) = (400.0, alpha);
        rates(&scene, steps, 0..1, replicas, *angles)
    };
    // α = 2 for the opening ones: the more collisions a pair has, the sooner its memory shows.
    let replicas = effort.pick(40, 800);
    let [coarse, fine] =
        [200, 1600].map(|steps| run(2.0, steps, replicas).mean(|c| change(*c).opening[OVER]));
    let mut evidence = vec![Evidence::new(
        "kicks > 0.1 rad of opening pairs per rod and period at 200 steps, less those at 1600; α = 2",
        Sample {
            mean: coarse.mean - fine.mean,
            se: coarse.se.hypot(fine.se),
            samples: replicas,
        }
        .exceeds(0.0, 0.1, "they would be equal if the rate did not depend on Δt"),
    )];
    for (steps, replicas) in [(200, effort.pick(160, 4000)), (800, effort.pick(48, 2000))] {
        let row = run(0.5, steps, replicas);
        let fresh = row.mean(|c| c.fresh_closing[OVER]).mean;
        let off = row.mean(|c| (change(*c).closing[OVER] - c.fresh_closing[OVER]) / fresh);
        evidence.push(Evidence::new(
            format!("kicks > 0.1 rad of closing pairs over the formula's number, less 1; {steps} steps a period, α = ½"),
            off.is(
                0.0,
                0.05,
                0.05,
                "the formula takes the separation to be independent of the directions; a pair that collides is no \
                 longer so, by the share of P_c ≈ 0.05",
            ),
        ));
    }
    evidence
}

fn heavy((angles, min_arm): &(Angles, f64), effort: &Effort) -> Vec<Evidence> {
    let mut fresh = fresh_scene(effort, 1000, 200);
    lab::interaction(&mut fresh).min_contact_arm = *min_arm;
    let mut run = lab::interacting_scene(effort);
    let interaction = lab::interaction(&mut run);
    (interaction.concentration_per_cm3, interaction.min_contact_arm) = (400.0, *min_arm);
    run.time.steps_per_period = Some(400);
    let replicas = [effort.pick(300, 6000), effort.pick(40, 1000)];
    let hills = [
        (
            "fresh pairs, kicks > 2GΔt",
            tail::hill(tail::fresh(&fresh, replicas[0], *angles), 2.0),
        ),
        (
            "runs, kicks > 0.5 rad",
            tail::hill(tail::in_runs(&run, replicas[1], *angles), 0.5),
        ),
    ];
    let rule = |hill: tail::Exponent| Rule::Mean {
        mean: hill.alpha,
        se: hill.se,
        samples: hill.count,
        reference: 1.0,
        allowance: 0.01,
        effect: 0.06,
        because: "the tail is (1 − 1/(140Y²))/Y above Y = 2: 0.0012 off; kicks of one pair in a run come in groups: \
                  a hundredth more; 0.06 tells 1 from the controls' 2",
    };
    hills
        .map(|(what, hill)| {
            Evidence::new(
                format!("Hill's exponent of {what}, of {}", hill.count),
                rule(hill),
            )
        })
        .into()
}

fn bounded((angles, share): &(Angles, f64), effort: &Effort) -> Vec<Evidence> {
    const MIN_ARM: f64 = 0.1;
    let mut worst = [0.0f64; 2];
    let mut collisions = 0;
    for (aspect_ratio, deviation_percent) in [(11.6, 3.6), (2.0, 10.0), (1.2, 0.0), (1000.0, 0.0)] {
        let mut scene = fresh_scene(effort, 200, 200);
        scene.particles.aspect_ratio = aspect_ratio;
        scene.particles.aspect_ratio_sd_percent = deviation_percent;
        lab::interaction(&mut scene).min_contact_arm = share * MIN_ARM;
        let strain = step_strain(&scene);
        for replica in 0..effort.pick(2, 50) {
            let mut suspension = lab::suspension(&scene, replica);
            let ratios = suspension.aspect_ratios();
            for _ in 0..20 {
                let places = suspension.positions_in_lengths().clone();
                let directions = suspension.directions();
                let Ok(found) = suspension.step() else {
                    worst = [f64::NAN; 2];
                    break;
                };
                collisions += found.len();
                for collision in found {
                    let [a, b] = collision.rods;
                    let separation = [0, 1, 2].map(|axis| places[axis][b] - places[axis][a]);
                    let distance = separation.iter().map(|x| x * x).sum::<f64>().sqrt();
                    let pair = [directions[a].into(), directions[b].into()];
                    let sine = directions[a].cross(&directions[b]).norm();
                    let expected = kicks(separation, pair, [ratios[a], ratios[b]]);
                    for (k, kick) in angles(collision)
                        .into_iter()
                        .map(|kick| kick / strain)
                        .enumerate()
                    {
                        let (own, other) = (ratios[collision.rods[k]], ratios[collision.rods[1 - k]]);
                        // The arm is known to ε s/sin², and the gap's velocity to as much.
                        let scale = (1.0 + distance) * (1.0 + expected[k]) / (sine * sine * MIN_ARM);
                        let off = (kick - expected[k]).abs() / scale;
                        let over = kick / largest_kick(distance, MIN_ARM, own, other) - 1.0;
                        for (worst, found) in worst.iter_mut().zip([off, over]) {
                            *worst = if found.is_nan() {
                                f64::NAN
                            } else {
                                worst.max(found)
                            };
                        }
                    }
                }
            }
        }
    }
    vec![
        Evidence::new(
            format!("kicks of {collisions} collisions less |g|Δt/(2|r|), over their conditioning"),
            Rule::within(worst[0], 1e-13, "some hundred roundings, ε each"),
        ),
        Evidence::new(
            "the largest kick over its bound, less 1 where it is above",
            Rule::within(worst[1], 1e-12, "round-off of kicks at the bound"),
        ),
    ]
}
