//! How the error of a suspension's mean falls with the rods: what `docs/work-precision.md` says. Nothing is timed.

use super::lab::{self, Sample};
use crate::accept::Rule;
use crate::case::{About, Case, Effort, Evidence, Judges};
use crate::suspensions::free::{Free, exponents};
use crate::suspensions::law;
use crate::suspensions::starts::{self, Start};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Dxsm;
use rayon::prelude::*;

/// Ways to lay rods, with the exponents that are claimed of them.
type Starts = Vec<Start>;

/// What is claimed of the bias of the rods: its exponent of N.
type Exponent = f64;

pub fn cases() -> Vec<Case> {
    let spoiled = |of: usize, lay| {
        vec![Start {
            lay,
            ..starts::ALL[of]
        }]
    };
    vec![
        Case::new(
            About {
                name: "free-suspension-rates",
                judges: Judges::Integrator,
                claim: "The error of a free suspension's X̄₁ falls as N^(−½) for random starts, N^(−1) for stratified \
                        ones and N^(−5/4) for a Fibonacci lattice.",
                source: "eqs 4, 12, A.4",
                equations: &["4", "12"],
            },
            starts::ALL.to_vec() as Starts,
            vec![
                (
                    "the generator starts anew every 1000 rods",
                    spoiled(0, |count, unequal, rng| {
                        let seed = rng.random();
                        (0..count.div_ceil(1000))
                            .flat_map(|_| {
                                (starts::ALL[0].lay)(1000, unequal, &mut Pcg64Dxsm::seed_from_u64(seed))
                            })
                            .take(count)
                            .collect()
                    }),
                ),
                (
                    "cells that are drawn from at random, not each once",
                    spoiled(1, starts::ALL[0].lay),
                ),
                (
                    "a lattice of every rod twice, and half as many",
                    spoiled(2, |count, unequal, rng| {
                        // Random halves of ten lattices each: the spacing is lost.
                        (0..10)
                            .flat_map(|_| (starts::ALL[2].lay)(count.div_ceil(10), unequal, rng))
                            .take(count)
                            .enumerate()
                            .filter_map(|(k, rod)| (k % 2 == 0).then_some(rod))
                            .flat_map(|rod| [rod, rod])
                            .collect()
                    }),
                ),
            ],
            rates,
        ),
        Case::new(
            About {
                name: "replicas-are-independent",
                judges: Judges::Integrator,
                claim: "The scatter of a mean over M replicas of interacting rods falls as M^(−½).",
                source: "section 'Method of solution': runs with other random numbers",
                equations: &["12"],
            },
            u64::MAX,
            vec![("only 64 different replicas", 64)],
            replicas,
        ),
        Case::new(
            About {
                name: "faces-cost-collisions",
                judges: Judges::Integrator,
                claim: "What the control volume's faces take from the collisions of a rod falls as N^(−1/3), the share of \
                        the volume near a face, and not as 1/N.",
                source: "eqs 8, 12; 'the number of particles'",
                equations: &["8"],
            },
            law::FACES as Exponent,
            vec![("1/N", -1.0)],
            faces,
        ),
    ]
}

/// 16 groups of trials; their spread is the error of an exponent.
const GROUPS: usize = 16;

fn rates(starts: &Starts, effort: &Effort) -> Vec<Evidence> {
    // Rods that are stretched little, so that a thousand of them resolve what there is.
    let free = Free {
        scene: "a case",
        aspect_ratio: 2.0,
        sd_percent: 0.0,
        turns: 0.2,
    };
    let counts = [1000, 5623, 31_623];
    let trials = effort.pick(6, 40) * GROUPS;
    let exponent = |start: &Start| {
        let tried: Vec<_> = counts.iter().map(|n| free.errors(start, *n, trials)).collect();
        Evidence::new(
            format!("exponent of N, {} starts", start.name),
            Sample::of(&exponents(&tried, GROUPS)).is(
                start.exponents[0],
                0.05,
                0.05,
                "0.05 for what is left of higher powers at 10³ rods; the exponents lie ½ and ¼ apart",
            ),
        )
    };
    starts.iter().map(exponent).collect()
}

fn replicas(different: &u64, effort: &Effort) -> Vec<Evidence> {
    let mut scene = lab::interacting_scene(effort);
    scene.particles.count = 25;
    scene.time.steps_per_period = Some(20);
    scene.time.outputs_per_period = Some(4);
    scene.time.periods = Some(0.25);
    let count = effort.pick(4096, 16_384);
    let x1 = lab::per_replica(&scene, count.min(*different), |means| means.at(1, 0));
    let x1: Vec<_> = x1.iter().copied().cycle().take(count as usize).collect();
    let (mean, se) = law::replicas_exponent(&x1).map_or((f64::NAN, f64::NAN), |e| (e.value, e.se));
    vec![Evidence::new(
        "exponent of M in the standard deviation of block means",
        Rule::Mean {
            mean,
            se,
            samples: 16,
            reference: -0.5,
            allowance: 0.0,
            effect: 0.02,
            because: "independent replicas; 16 groups of them",
        },
    )]
}

fn faces(exponent: &Exponent, effort: &Effort) -> Vec<Evidence> {
    // Candidates over five steps, with a reach so long that many are counted; each volume has twice the side of the last.
    let candidates = |count: usize, replicas: u64| {
        let mut scene = lab::interacting_scene(effort);
        scene.particles.count = count;
        lab::interaction(&mut scene).alpha = 2.0;
        let of_replica = |replica| {
            let mut suspension = lab::suspension(&scene, replica);
            let done = (0..5).all(|_| suspension.step().is_ok());
            let candidates = suspension.counters().candidates as f64 / (5 * count) as f64;
            if done { candidates } else { f64::NAN }
        };
        Sample::of(&(0..replicas).into_par_iter().map(of_replica).collect::<Vec<_>>())
    };
    let more = effort.pick(1, 8);
    let [small, middle, large] =
        [(64, 3000), (512, 600), (4096, 75)].map(|(count, replicas)| candidates(count, more * replicas));
    // a + b Nᵉ: the first difference is 8⁻ᵉ times the second.
    let ratio = 8f64.powf(-exponent);
    let terms = [(small, -1.0), (middle, 1.0 + ratio), (large, -ratio)].map(|(sample, factor)| {
        let factor = factor / large.mean;
        (factor * sample.mean, factor * sample.se)
    });
    vec![Evidence::new(
        "share of collisions gained from 64 to 512 rods, less the gain from 512 to 4096 that the exponent asks for",
        Rule::Mean {
            mean: terms.iter().map(|(mean, _)| mean).sum(),
            se: terms.iter().map(|(_, se)| se.powi(2)).sum::<f64>().sqrt(),
            samples: more * 75,
            reference: 0.0,
            allowance: 0.02,
            effect: 0.02,
            because: "edges, ∝ N^(−2/3), make up for a part of the faces; 1/N would be off by three times the first gain",
        },
    )]
}
