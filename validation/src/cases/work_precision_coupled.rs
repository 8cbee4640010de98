//! Runs that share random numbers, and the cheapest split of a run: what `docs/work-precision.md` says.

use super::lab::{self, Sample};
use crate::accept::Rule;
use crate::case::{About, Case, Effort, Evidence, Judges};
use crate::suspensions::coupled::{at, free, free_mean, interacting};
use crate::suspensions::job::Job;
use crate::suspensions::law;
use crate::suspensions::split::{Constants, Scope, Split, reference};
use crate::suspensions::{Estimate, correlation};
use shearbed::Scene;

/// A change to the scene.
type Mend = fn(&mut Scene);

/// Which scene runs beside, and which closed form is taken for its mean.
#[derive(Clone, Copy)]
struct Beside {
    free: Mend,
    other: Mend,
    mean: Mend,
}

/// A change to what is run for an error.
type Respell = fn(&mut Split);

pub fn cases() -> Vec<Case> {
    let same = Beside {
        free: |_| {},
        other: |_| {},
        mean: |_| {},
    };
    vec![
        Case::new(
            About {
                name: "paths-do-not-converge",
                judges: Judges::Program,
                claim: "Halving the time step again and again does not bring a rod's paths together, because kicks have \
                        no bound.",
                source: "A.13, A.14; eq. 8 without Δt",
                equations: &["A.13", "A.14"],
            },
            (|_| {}) as Mend,
            vec![
                (
                    "arms below a rod length are no contact, so that kicks are bounded",
                    |scene| lab::interaction(scene).min_contact_arm = 1.0,
                ),
                ("rods that hardly ever meet", |scene| {
                    lab::interaction(scene).alpha = 1e-6
                }),
            ],
            paths,
        ),
        Case::new(
            About {
                name: "shared-random-numbers",
                judges: Judges::Program,
                claim: "The same rods without collisions say more of X̄₁ than a run at half the step, and their mean is \
                        known; for a difference between two α, shared random numbers save a factor of four at T/4.",
                source: "eqs 4, 7, 12",
                equations: &["4", "7"],
            },
            same,
            vec![
                (
                    "free rods of another seed",
                    Beside {
                        free: |scene| scene.ensemble.seed += 1,
                        ..same
                    },
                ),
                (
                    "the other α at another seed",
                    Beside {
                        other: |scene| scene.ensemble.seed += 1,
                        ..same
                    },
                ),
                (
                    "the closed form of rods a tenth longer",
                    Beside {
                        mean: |scene| scene.particles.aspect_ratio *= 1.1,
                        ..same
                    },
                ),
            ],
            shared,
        ),
        Case::new(
            About {
                name: "cheapest-split",
                judges: Judges::Program,
                claim: "Steps and replicas by the rule for an error of 0.02 give the bias and the scatter that it says.",
                source: "eqs 4, 8, 12",
                equations: &["4"],
            },
            (|_| {}) as Respell,
            vec![
                ("a tenth of the replicas", |split| {
                    split.replicas = split.replicas.div_ceil(10)
                }),
                ("four times the replicas", |split| split.replicas *= 4),
                ("five steps a period", |split| split.steps_per_period = 5),
            ],
            realised,
        ),
    ]
}

/// Mean squares of angles between the same rod at two steps, replica by replica, at T/4.
fn mean_squares(scene: &Scene, steps: u64, replicas: u64) -> Vec<f64> {
    let run = |steps: u64| {
        let mut job = Job::new(scene, steps, scene.particles.count, replicas, 1);
        job.marks = vec![steps / 4];
        job.followed = replicas;
        job.run(&|| ()).unwrap_or_default()
    };
    let (coarse, fine) = (run(steps), run(2 * steps));
    let pairs = coarse.chunks(1).zip(fine.chunks(1));
    pairs
        .map(|(one, other)| law::apart(one, other, 0).powi(2))
        .collect()
}

fn paths(mend: &Mend, effort: &Effort) -> Vec<Evidence> {
    let mut scene = lab::interacting_scene(effort);
    mend(&mut scene);
    let replicas = effort.pick(48, 480);
    let (coarse, fine) = (
        mean_squares(&scene, 100, replicas),
        mean_squares(&scene, 800, replicas),
    );
    let kept: Vec<_> = (fine.iter().zip(&coarse))
        .map(|(fine, coarse)| fine - 0.5 * coarse)
        .collect();
    vec![Evidence::new(
        "mean square angle (rad²) between 800 and 1600 steps a period, less half of that between 100 and 200",
        Sample::of(&kept).exceeds(
            0.0,
            0.005,
            "paths that converge with order ½ or more would bring an eighth or less; the mean square is some 0.035",
        ),
    )]
}

const GROUPS: usize = 20;

fn shared(beside: &Beside, effort: &Effort) -> Vec<Evidence> {
    let mut scene = lab::interacting_scene(effort);
    scene.particles.count = 25;
    let replicas = effort.pick(2000, 20_000);
    let changed = |mend: Mend| {
        let mut scene = scene.clone();
        mend(&mut scene);
        scene
    };
    let first = |values: Result<Vec<Vec<f64>>, String>| at(&values.unwrap_or_default(), 0);
    let own = first(interacting(&scene, 100, 1.0, 1, replicas));
    let finer = first(interacting(&scene, 200, 1.0, 1, replicas));
    let other = first(interacting(&changed(beside.other), 100, 0.8, 1, replicas));
    let free = first(free(&changed(beside.free), 1, replicas));
    // One value for each group of replicas.
    let size = own.len() / GROUPS;
    let grouped = |value: &dyn Fn(std::ops::Range<usize>) -> f64| {
        let groups = (0..GROUPS).map(|group| value(group * size..(group + 1) * size));
        Sample::of(&groups.collect::<Vec<_>>())
    };
    let tied =
        |beside: &[f64], group: std::ops::Range<usize>| correlation(&own[group.clone()], &beside[group]);
    let more = grouped(&|group| tied(&free, group.clone()).powi(2) - tied(&finer, group).powi(2));
    let common = grouped(&|group| tied(&other, group));
    vec![
        Evidence::new(
            "share of the variance that free rods explain, less the share that half the step does",
            more.exceeds(
                0.0,
                0.05,
                "the better control variate; the two differ by a fifth of the variance",
            ),
        ),
        Evidence::new(
            "correlation of X̄₁ between α and 0.8 α at T/4",
            common.exceeds(
                0.75,
                0.04,
                "1/(1 − ρ) independent runs for each that shares: four at ρ = ¾",
            ),
        ),
        Evidence::new(
            "X̄₁ of the free rods at T/4",
            Sample::of(&free).is(
                free_mean(&changed(beside.mean), 0.25),
                0.0,
                5e-4,
                "the control variate's mean is a closed form; a rod a tenth longer has 10 % less",
            ),
        ),
    ]
}

/// The constants of Fig. 7's rods at 50 per cm³ as `shearbed bench --case fig7-n50` finds them, rounded up.
const CONSTANTS: Constants = Constants {
    steps_bias: 0.7,
    fewest_steps: 100,
    rods_bias: 0.045,
    variance_per_rod: 0.105,
};

/// X̄₁ at t/T = 1 of 25 rods at four times the steps.
fn reference_x1(effort: &Effort) -> Estimate {
    let found = reference(&twenty_five(effort), 400, 25, 1000);
    found.map_or(
        Estimate {
            value: f64::NAN,
            se: f64::NAN,
        },
        |found| Estimate {
            value: found.x1,
            se: found.se,
        },
    )
}

fn twenty_five(effort: &Effort) -> Scene {
    let mut scene = lab::interacting_scene(effort);
    scene.particles.count = 25;
    scene
}

fn realised(respell: &Respell, effort: &Effort) -> Vec<Evidence> {
    let said = CONSTANTS.cheapest(Scope::OwnRods(25), 0.02);
    let mut run = said;
    respell(&mut run);
    let repeats = effort.pick(100, 400);
    let Ok(found) = run.realise(&twenty_five(effort), repeats, reference_x1(effort)) else {
        return Vec::new();
    };
    let ratio = (found.scatter.value / said.scatter).powi(2);
    vec![
        Evidence::new(
            format!(
                "bias of {} steps and {} replicas of 25 rods, against 400 steps",
                said.steps_per_period, said.replicas
            ),
            Rule::Mean {
                mean: found.bias.value,
                se: found.bias.se,
                samples: repeats,
                reference: 0.0,
                allowance: said.bias + CONSTANTS.bias(Scope::OwnRods(25), 400.0, 25.0),
                effect: 0.01,
                because: "the bias that the rule allows for, and that of the reference",
            },
        ),
        Evidence::new(
            "variance of repeats over the one that the rule says",
            Rule::Mean {
                mean: ratio,
                se: ratio * (2.0 / (repeats as f64 - 1.0)).sqrt(),
                samples: repeats,
                reference: 1.0,
                allowance: 0.1,
                effect: 0.25,
                because: "0.1: the variance of a rod more, v, depends on N by some percent",
            },
        ),
    ]
}
