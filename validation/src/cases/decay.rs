//! How oscillations end, in the paper's words: they die out, and on all axes alike.

use super::lab::{self, Means, Sample, per_replica};
use crate::case::{About, Case, Effort, Evidence, Kind};
use shearbed::scene::Scene;

/// A change to the scene that the model runs; the expectation stays that of the unchanged scene.
type Mend = fn(&mut Scene);

pub fn cases() -> Vec<Case> {
    let about = |name, claim, source, statistical_checks| About {
        name,
        kind: Kind::Validation,
        claim,
        source,
        equations: &["4", "16"],
        statistical_checks,
    };
    vec![
        Case::new(
            about(
                "dies-out",
                "\"The oscillations die out … after a few rotations, in contrast to the undamped oscillations\": to a fifth in four rotations with collisions and σ = 3.6 %; collisions alone take them to less than two thirds only.",
                "Results, after Fig. 6",
                2,
            ),
            (|_| {}) as Mend,
            vec![("collisions without effect and uniform rods", |scene| {
                lab::interaction(scene).alpha = 0.0;
                scene.particles.aspect_ratio_sd_percent = 0.0;
            })],
            dies_out,
        ),
        Case::new(
            about(
                "other-axes-decay",
                "\"The amplitudes of X̄_2 and X̄_3 decay in similar manner\" as that of X̄_1.",
                "Results, after Fig. 10",
                2,
            ),
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

fn quarters(mut scene: Scene, half_periods: usize) -> Scene {
    scene.time.periods = Some((2 * half_periods + 1) as f64 / 4.0);
    scene.time.outputs_per_period = Some(4);
    scene
}

fn dies_out(mend: &Mend, effort: &Effort) -> Vec<Evidence> {
    [(3.6, 0.2, "σ = 3.6 %"), (0.0, 0.65, "σ = 0")]
        .into_iter()
        .map(|(sd, left, name)| {
            let mut scene = lab::interacting_scene();
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
    let mut scene = lab::interacting_scene();
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
