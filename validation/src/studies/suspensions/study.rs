//! An interacting scene's whole study: law, constants, cheapest splits and what they gave, coupled estimates.

use super::Estimate;
use super::coupled::{self, Coupled};
use super::job::Job;
use super::law::{self, JobMean, Law, Replicas};
use super::split::{self, Constants, Realised, Scope, Split, TARGETS};
use crate::input::scenes;
use crate::studies::work_precision::{Budget, measure};
use serde::Serialize;
use shearbed::model::jeffery::strain_per_period;

/// The built-in scene that is studied: the paper's Fig. 7, rods of one size.
pub const SCENE: &str = "fig7-n50";

/// How far to go.
#[derive(Clone, Copy, Debug)]
pub struct Extent {
    /// Of the study of steps, rods and replicas.
    pub replicas: Replicas,
    /// Steps per period and replicas of the reference with the scene's own rods.
    pub reference: (u64, u64),
    /// Steps per period, rods and replicas of the one without faces.
    pub unbounded: Option<(u64, usize, u64)>,
    /// How often the split for each of [`TARGETS`] is run.
    pub repeats: [u64; 3],
    /// Replicas of the coupled runs.
    pub coupled: u64,
}

impl Extent {
    /// For the report of every day: seconds.
    pub const QUICK: Self = Self {
        replicas: Replicas::Within { rod_steps: 10_000_000, most: 2000 },
        reference: (800, 400),
        unbounded: None,
        repeats: [16, 0, 0],
        coupled: 200,
    };
    /// For `shearbed bench` and full reports: a minute or two.
    pub const FULL: Self = Self {
        replicas: Replicas::Within { rod_steps: 100_000_000, most: 20_000 },
        reference: (3200, 5000),
        unbounded: Some((800, 100_000, 8)),
        repeats: [64, 16, 8],
        coupled: 2000,
    };
}

/// A split, its time, and what it gave where it was run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Answer {
    /// What to run.
    pub split: Split,
    /// Its time on one core, from the time of a rod's step.
    pub seconds: f64,
    /// What it gave.
    pub realised: Option<Realised>,
}

/// Everything.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Interacting {
    /// The scene's name.
    pub scene: String,
    /// G T: the strain of a period.
    pub strain_per_period: f64,
    /// Steps, rods and replicas.
    pub law: Law,
    /// What the error is made of.
    pub constants: Constants,
    /// Of a rod's step on one core, in s, with the scene's own rods.
    pub rod_step_s: f64,
    /// For each of [`TARGETS`]: with the scene's own rods, and without faces.
    pub answers: Vec<Answer>,
    /// What the realised errors are counted from: the scene's own rods, and without faces.
    pub references: Vec<JobMean>,
    /// What shared random numbers save.
    pub coupled: Coupled,
}

/// Studies [`SCENE`] on the threads of the current pool; the time of a rod's step is of one core.
pub fn run(extent: Extent, budget: Budget) -> Result<Interacting, String> {
    let built_in = scenes::find(SCENE).ok_or("no such scene")?;
    let scene = built_in.scene().map_err(|error| error.to_string())?;
    let own = Scope::OwnRods(scene.particles.count);
    let jobs = law::jobs(&scene, extent.replicas);
    let law = law::read(&scene, &jobs, &law::run(&jobs, &|| ())?);
    let constants = Constants::of(&law).ok_or("no straight line fits X̄₁ against the steps or the rods")?;

    let single = Job::new(&scene, scene.steps_per_unit(), scene.particles.count, 1, 1);
    let rod_step_s = measure(budget, || single.run(&|| ())).least / single.rod_steps() as f64;
    let (steps, replicas) = extent.reference;
    let mut references = vec![split::reference(&scene, steps, scene.particles.count, replicas)?];
    if let Some((steps, rods, replicas)) = extent.unbounded {
        references.push(split::reference(&scene, steps, rods, replicas)?);
    }
    let mut answers = Vec::new();
    for (scope, reference) in [(own, references.first()), (Scope::Unbounded, references.get(1))] {
        for (target, repeats) in TARGETS.into_iter().zip(extent.repeats) {
            let split = constants.cheapest(scope, target);
            // A reference is no judge of errors as small as its own.
            let judge = reference
                .filter(|reference| repeats > 0 && off_at_most(&constants, scope, reference) < target);
            let realised = judge.map(|reference| {
                let reference = Estimate { value: reference.x1, se: reference.se };
                split.realise(&scene, repeats, reference)
            });
            answers.push(Answer {
                split,
                seconds: split.rod_steps() as f64 * rod_step_s,
                realised: realised.transpose()?,
            });
        }
    }
    Ok(Interacting {
        scene: SCENE.to_owned(),
        strain_per_period: strain_per_period(scene.particles.aspect_ratio),
        coupled: coupled::measure(&scene, extent.coupled)?,
        law,
        constants,
        rod_step_s,
        answers,
        references,
    })
}

/// What a reference may itself be off: its bias at most, and two standard errors.
fn off_at_most(constants: &Constants, scope: Scope, reference: &JobMean) -> f64 {
    let bias = constants.bias(scope, reference.steps_per_period as f64, reference.rods as f64);
    bias.hypot(2.0 * reference.se)
}
