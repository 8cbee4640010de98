//! How oscillations start and die, in the paper's words.
//!
//! The amplitude is that of Fig. 7's ordinate as far as the text tells: peak to trough of X̄₁, taken here as
//! X̄₁(t) − X̄₁(t + T/4) at t = 0, T/2, T, …, where free rods peak.

use super::lab::{self, Means, Sample, per_replica};
use crate::case::{About, Case, Effort, Evidence, Judges};
use shearbed::scene::Scene;

/// A change to the scene that the model runs; the expectation stays that of the unchanged scene.
type Mend = fn(&mut Scene);

/// Changes of a scene in the order in which the paper says that oscillations die out faster.
type Order = [Mend; 3];

pub fn cases() -> Vec<Case> {
    let about = |name, claim, source| About {
        name,
        judges: Judges::Statement,
        claim,
        source,
        equations: &["4"],
    };
    vec![
        Case::new(
            about(
                "free-amplitude",
                "\"The amplitude of oscillations is approximately half the particle length and is constant\" for free uniform rods.",
                "Results, before Fig. 6; Fig. 6 (top)",
            ),
            (|_| {}) as Mend,
            vec![
                ("unequal aspect ratios", |scene| {
                    scene.particles.aspect_ratio_sd_percent = 7.2
                }),
                ("rods in collision", |scene| {
                    lab::interaction(scene).concentration_per_cm3 = 100.0
                }),
            ],
            free_amplitude,
        ),
        Case::new(
            about(
                "faster-with-spread",
                "\"The oscillations decay faster … as the differences in the aspect ratios become larger\".",
                "Results, before Fig. 7; Fig. 9",
            ),
            [
                |scene: &mut Scene| scene.particles.aspect_ratio_sd_percent = 1.8,
                |scene: &mut Scene| scene.particles.aspect_ratio_sd_percent = 3.6,
                |scene: &mut Scene| scene.particles.aspect_ratio_sd_percent = 7.2,
            ] as Order,
            vec![(
                "σ without effect",
                [
                    |scene| scene.particles.aspect_ratio_sd_percent = 3.6,
                    |scene| scene.particles.aspect_ratio_sd_percent = 3.6,
                    |scene| scene.particles.aspect_ratio_sd_percent = 3.6,
                ],
            )],
            faster,
        ),
        Case::new(
            about(
                "faster-with-concentration",
                "\"The oscillations decay faster as the concentration (and consequently the number of collisions) increases\".",
                "Results, before Fig. 7; Fig. 7",
            ),
            [
                |scene: &mut Scene| lab::interaction(scene).concentration_per_cm3 = 20.0,
                |scene: &mut Scene| lab::interaction(scene).concentration_per_cm3 = 50.0,
                |scene: &mut Scene| lab::interaction(scene).concentration_per_cm3 = 100.0,
            ] as Order,
            vec![(
                "n without effect",
                [|scene| {
                    lab::interaction(scene);
                }; 3],
            )],
            faster,
        ),
        Case::new(
            about(
                "faster-with-length",
                "\"The oscillations decay faster … as the particles become longer\" at fixed r_e.",
                "Results, before Fig. 7; Fig. 8",
            ),
            [
                |scene: &mut Scene| {
                    lab::interaction(scene);
                    scene.particles.length_mm = 0.36;
                },
                |scene: &mut Scene| {
                    lab::interaction(scene);
                },
                |scene: &mut Scene| {
                    lab::interaction(scene);
                    scene.particles.length_mm = 1.44;
                },
            ] as Order,
            vec![(
                "a without effect",
                [|scene| {
                    lab::interaction(scene);
                }; 3],
            )],
            faster,
        ),
        Case::new(
            about(
                "faster-with-collisions",
                "\"The amplitude decays much faster when collisions occur than in the absence of particle-particle interactions\".",
                "Results, after Fig. 10; Figs 6 and 10",
            ),
            (|scene| {
                lab::interaction(scene);
            }) as Mend,
            vec![("collisions without effect", |scene| {
                lab::interaction(scene).alpha = 0.0
            })],
            collisions_damp,
        ),
        Case::new(
            About {
                equations: &["4", "16"],
                ..about(
                    "dies-out",
                    "\"The oscillations die out … after a few rotations, in contrast to the undamped oscillations\": to a fifth in four rotations with collisions and σ = 3.6 %; collisions alone take them to less than two thirds only.",
                    "Results, after Fig. 6",
                )
            },
            (|_| {}) as Mend,
            vec![("collisions without effect and uniform rods", |scene| {
                lab::interaction(scene).alpha = 0.0;
                scene.particles.aspect_ratio_sd_percent = 0.0;
            })],
            dies_out,
        ),
        Case::new(
            About {
                equations: &["4", "16"],
                ..about(
                    "other-axes-decay",
                    "\"The amplitudes of X̄_2 and X̄_3 decay in similar manner\" as that of X̄_1.",
                    "Results, after Fig. 10",
                )
            },
            (|means, k, axis| means.swing(k, axis)) as Swing,
            vec![
                ("X̄_2 and X̄_3 that keep their amplitude", |means, k, axis| {
                    means.swing(if axis == 0 { k } else { 0 }, axis)
                }),
                ("X̄_2 and X̄_3 gone at once", |means, k, axis| {
                    if axis == 0 || k == 0 {
                        means.swing(k, axis)
                    } else {
                        0.0
                    }
                }),
            ],
            on_all_axes,
        ),
    ]
}

/// The swing of X̄_i in the quarter period from t = kT/2 on, as read from a replica.
type Swing = fn(&Means, usize, usize) -> f64;

impl Means {
    /// |X̄_i(kT/2) − X̄_i(kT/2 + T/4)|, signed so that free rods give a positive one; four outputs a period.
    fn swing(&self, half_periods: usize, axis: usize) -> f64 {
        let fall = self.at(2 * half_periods, axis) - self.at(2 * half_periods + 1, axis);
        if axis == 1 { -fall } else { fall }
    }
}

/// The amplitude of X̄₁ at t = kT/2, replica by replica.
fn amplitudes(scene: &Scene, replicas: u64, half_periods: &[usize]) -> Vec<Vec<f64>> {
    let last = half_periods.iter().max().copied().unwrap_or(0);
    let found = per_replica(&quarters(scene.clone(), last), replicas, |means| {
        half_periods
            .iter()
            .map(|&k| means.swing(k, 0))
            .collect::<Vec<_>>()
    });
    (0..half_periods.len())
        .map(|k| found.iter().map(|amplitudes| amplitudes[k]).collect())
        .collect()
}

/// The scene up to the quarter period after t = kT/2, with outputs at quarter periods.
fn quarters(mut scene: Scene, half_periods: usize) -> Scene {
    scene.time.periods = Some((2 * half_periods + 1) as f64 / 4.0);
    scene.time.outputs_per_period = Some(4);
    scene
}

fn free_amplitude(mend: &Mend, effort: &Effort) -> Vec<Evidence> {
    let mut scene = lab::free_scene(effort);
    scene.particles.count = 1000;
    mend(&mut scene);
    let found = amplitudes(&scene, effort.pick(40, 400), &[0, 8]);
    let change: Vec<f64> = found[0]
        .iter()
        .zip(&found[1])
        .map(|(first, last)| last - first)
        .collect();
    vec![
        Evidence::new(
            "amplitude at t = 0, in rod lengths",
            Sample::of(&found[0]).is(
                0.5,
                0.05,
                0.01,
                "\"approximately\": a tenth; \"the exact value depends on the aspect ratio\"",
            ),
        ),
        Evidence::new(
            "its change by t/T = 4",
            Sample::of(&change).is(
                0.0,
                1e-12,
                0.01,
                "constant: the same phases come back to round-off",
            ),
        ),
    ]
}

fn faster(order: &Order, effort: &Effort) -> Vec<Evidence> {
    let amplitude = |mend: &Mend| {
        let mut scene = lab::free_scene(effort);
        mend(&mut scene);
        amplitudes(&scene, effort.pick(120, 1000), &[3]).remove(0)
    };
    let found: Vec<_> = order.iter().map(amplitude).collect();
    let because = "the same seeds in both; noise of 0.01 tells the controls apart";
    [(0, 1, "first less second"), (1, 2, "second less third")]
        .into_iter()
        .map(|(a, b, which)| {
            let fall: Vec<f64> = found[a].iter().zip(&found[b]).map(|(a, b)| a - b).collect();
            Evidence::new(
                format!("fall of the amplitude at t/T = 1½, {which}"),
                Sample::of(&fall).exceeds(0.0, 0.01, because),
            )
        })
        .collect()
}

fn collisions_damp(mend: &Mend, effort: &Effort) -> Vec<Evidence> {
    let mut evidence = Vec::new();
    for sd in [0.0, 3.6] {
        let mut free = lab::free_scene(effort);
        free.particles.aspect_ratio_sd_percent = sd;
        let mut interacting = free.clone();
        mend(&mut interacting);
        let replicas = effort.pick(120, 1000);
        let without = amplitudes(&free, replicas, &[2, 4]);
        let with = amplitudes(&interacting, replicas, &[2, 4]);
        for (k, when) in [(0, "1"), (1, "2")] {
            let fall: Vec<f64> = without[k].iter().zip(&with[k]).map(|(a, b)| a - b).collect();
            let because = "\"much\" has no number in the paper: 0.02 of a rod length, what a figure shows";
            evidence.push(Evidence::new(
                format!("amplitude without less with collisions at t/T = {when}, σ = {sd} %"),
                Sample::of(&fall).exceeds(0.02, 0.01, because),
            ));
        }
    }
    evidence
}

fn dies_out(mend: &Mend, effort: &Effort) -> Vec<Evidence> {
    [(3.6, 0.2, "σ = 3.6 %"), (0.0, 0.65, "σ = 0")]
        .into_iter()
        .map(|(sd, left, name)| {
            let mut scene = lab::interacting_scene(effort);
            scene.particles.aspect_ratio_sd_percent = sd;
            mend(&mut scene);
            let margin = per_replica(&quarters(scene, 8), effort.pick(60, 600), |means| {
                left * means.swing(0, 0) - means.swing(8, 0)
            });
            Evidence::new(
                format!("{left} of the first amplitude less that at t/T = 4, n = 50 per cm³, {name}"),
                Sample::of(&margin).exceeds(
                    0.0,
                    0.01,
                    "\"a few\" is read as four; noise of 0.01 tells the control apart",
                ),
            )
        })
        .collect()
}

/// What is left of the amplitude after two periods, X̄_2 and X̄_3 against X̄_1.
fn on_all_axes(swing: &Swing, effort: &Effort) -> Vec<Evidence> {
    let mut scene = lab::interacting_scene(effort);
    scene.particles.aspect_ratio_sd_percent = 3.6;
    let found = per_replica(&quarters(scene, 4), effort.pick(100, 1000), |means| {
        [0, 1, 2].map(|axis| [swing(means, 0, axis), swing(means, 4, axis)])
    });
    // Of the means, not of the replicas: a replica's ratio is noisy and so biased.
    let first = [0, 1, 2].map(|axis| Sample::of(&found.iter().map(|f| f[axis][0]).collect::<Vec<_>>()).mean);
    [1, 2]
        .into_iter()
        .map(|axis| {
            let difference: Vec<f64> = found
                .iter()
                .map(|f| f[axis][1] / first[axis] - f[0][1] / first[0])
                .collect();
            Evidence::new(
                format!("share of the amplitude left at t/T = 2, X̄_{} less X̄_1", axis + 1),
                Sample::of(&difference).is(
                    0.0,
                    0.15,
                    0.02,
                    "\"similar\" has no number in the paper: 0.15 of the first amplitude",
                ),
            )
        })
        .collect()
}
