//! Whole runs of free rods against closed forms with no simulation in them.

use super::lab;
use crate::accept::Rule;
use crate::case::{About, Case, Effort, Evidence, Judges};
use crate::oracle::isotropic;
use shearbed::ensemble;
use shearbed::scene::Scene;

/// A change to the scene that the model runs; the expectation stays that of the unchanged scene.
type Mend = fn(&mut Scene);

pub fn cases() -> Vec<Case> {
    vec![
        Case::new(
            About {
                name: "free-isotropic",
                judges: Judges::Core,
                claim: "Free rods of one aspect ratio, isotropic at first, have the mean projections of the closed form.",
                source: "eqs 4, 12, Fig. 6 (top)",
                equations: &["4", "12"],
            },
            (|_| {}) as Mend,
            vec![
                ("r_e 5 % longer", |scene| scene.particles.aspect_ratio *= 1.05),
                ("aspect ratios spread by 3.6 %", |scene| {
                    scene.particles.aspect_ratio_sd_percent = 3.6
                }),
                ("the flow turned round", |scene| {
                    // u_1 = G x_2: axes 1 and 2 exchanged.
                    scene.flow.shear_rate_per_s = None;
                    scene.flow.gradient_per_s = Some([[0.0, 0.5, 0.0], [0.0; 3], [0.0; 3]]);
                }),
            ],
            uniform_rods,
        ),
        Case::new(
            About {
                name: "free-polydisperse",
                judges: Judges::Core,
                claim: "Free rods of Gaussian aspect ratio, isotropic at first, have the mean projections of the quadrature.",
                source: "eqs 4, 11, 12, Fig. 6 (middle), Fig. 9",
                equations: &["4", "11"],
            },
            (|_| {}) as Mend,
            vec![
                ("no spread", |scene| scene.particles.aspect_ratio_sd_percent = 0.0),
                ("the spread 20 % too wide", |scene| {
                    scene.particles.aspect_ratio_sd_percent *= 1.2
                }),
                ("r_e 5 % longer", |scene| scene.particles.aspect_ratio *= 1.05),
            ],
            spread_rods,
        ),
        Case::new(
            About {
                name: "free-half-period",
                judges: Judges::Core,
                claim: "Mean projections of free rods of one aspect ratio repeat after T/2, because p ≡ −p.",
                source: "eqs 4, 15, A.4",
                equations: &["4", "15"],
            },
            (|_| {}) as Mend,
            vec![
                ("aspect ratios spread by 1 %", |scene| {
                    scene.particles.aspect_ratio_sd_percent = 1.0
                }),
                ("rods that interact", |scene| {
                    lab::interaction(scene);
                }),
            ],
            half_period,
        ),
    ]
}

fn uniform_rods(mend: &Mend, effort: &Effort) -> Vec<Evidence> {
    let mut evidence = Vec::new();
    for r in [1.5, 5.0, 11.6, 50.0] {
        let mut scene = lab::free_scene(effort);
        scene.particles.aspect_ratio = r;
        evidence.extend(compare(scene, *mend, effort, |turns| {
            isotropic::mean_projections(r, turns)
        }));
    }
    evidence
}

fn spread_rods(mend: &Mend, effort: &Effort) -> Vec<Evidence> {
    let mut evidence = Vec::new();
    for (r, sd) in [(11.6, 3.6), (14.2, 8.5), (5.0, 7.2)] {
        let mut scene = lab::free_scene(effort);
        scene.particles.aspect_ratio = r;
        scene.particles.aspect_ratio_sd_percent = sd;
        let expected = |turns| isotropic::mean_projections_polydisperse(r, sd, turns);
        evidence.extend(compare(scene, *mend, effort, expected));
    }
    evidence
}

/// X̄_i at three times of a run of many free rods, one by one in general position within the period.
fn compare(
    mut scene: Scene,
    mend: Mend,
    effort: &Effort,
    expected: impl Fn(f64) -> [f64; 3],
) -> Vec<Evidence> {
    scene.particles.count = effort.pick(40_000, 1_000_000);
    scene.time.periods = Some(3.0);
    scene.time.outputs_per_period = Some(50);
    let (r, sd) = (
        scene.particles.aspect_ratio,
        scene.particles.aspect_ratio_sd_percent,
    );
    mend(&mut scene);
    let results = ensemble::run(&lab::plan(&scene), || ());
    let mut evidence = Vec::new();
    for output in [12, 70, 149] {
        let turns = output as f64 / 50.0;
        for (axis, reference) in expected(turns).into_iter().enumerate() {
            let name = ["x1", "x2", "x3"][axis];
            let channel = results.as_ref().ok().and_then(|results| results.channel(name));
            let (mean, se) = channel.map_or((f64::NAN, f64::NAN), |c| (c.mean[output], c.se[output]));
            evidence.push(Evidence::new(
                format!("X̄_{} at t/T = {turns}, r_e = {r}, σ = {sd} %", axis + 1),
                Rule::Mean {
                    mean,
                    se,
                    samples: scene.particles.count as u64,
                    reference,
                    allowance: 0.0,
                    effect: 2e-3,
                    because: "the closed form is exact to 10⁻⁹; independent rods; 0.002 of a rod length tells the controls apart",
                },
            ));
        }
    }
    evidence
}

fn half_period(mend: &Mend, effort: &Effort) -> Vec<Evidence> {
    let mut scene = lab::free_scene(effort);
    scene.particles.count = 1000;
    scene.time.periods = Some(5.0);
    scene.time.outputs_per_period = Some(20);
    mend(&mut scene);
    let mut worst = 0.0f64;
    match ensemble::run(&lab::plan(&scene), || ()) {
        Ok(results) => {
            for channel in results.series.iter().flat_map(|series| &series.channels) {
                for (k, later) in channel.mean.iter().enumerate().skip(10) {
                    worst = worst.max((later - channel.mean[k - 10]).abs());
                }
            }
        }
        Err(_) => worst = f64::NAN,
    }
    let because = "the phases are equal bits; the sums of 1000 terms are rounded alike up to signs of zero";
    vec![Evidence::new(
        "largest |X̄_i(t + T/2) − X̄_i(t)|",
        Rule::within(worst, 1e-14, because),
    )]
}
