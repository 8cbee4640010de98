//! What cases share: the paper's problem as a scene, independent samples of replicas, small statistics.

use crate::accept::{Rule, kolmogorov_samples};
use crate::case::Effort;
use crate::oracle::naive::{self, Mistake, Problem, Reading, Start};
use rayon::prelude::*;
use shearbed::plan::{Plan, Stage};
use shearbed::run::run_replica;
use shearbed::scene::{
    Ensemble, Flow, Interaction, Isotropic, Orientation, Output, Particles, Scene, Time, Update,
};
use shearbed::{Observable, Suspension};
use statrs::distribution::Uniform;
use statrs::statistics::Statistics;
use statrs::stats_tests::NaNPolicy;
use statrs::stats_tests::ks_test::{KSOneSampleAlternativeMethod, ks_onesample};
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// Free rods of the paper's Fig. 6 (G = 0.5 1/s, r_e = 11.6, a = 0.72 mm): one period, projections.
pub fn free_scene(effort: &Effort) -> Scene {
    Scene {
        title: "a case".to_owned(),
        flow: Flow {
            shear_rate_per_s: Some(0.5),
            gradient_per_s: None,
        },
        particles: Particles {
            count: 100,
            length_mm: 0.72,
            aspect_ratio: 11.6,
            aspect_ratio_sd_percent: 0.0,
            orientation: Orientation::Random(Isotropic::Isotropic),
        },
        interaction: None,
        time: Time {
            periods: Some(1.0),
            strain: None,
            steps_per_period: None,
            outputs_per_period: None,
            outputs_per_strain: None,
        },
        ensemble: Ensemble {
            replicas: 1,
            seed: effort.seed(0),
        },
        output: Output {
            observables: vec![Observable::Projections],
        },
    }
}

/// The same rods at 50 per cm³ with α = 0.5 and m = 3 (Fig. 6, bottom).
pub fn interacting_scene(effort: &Effort) -> Scene {
    Scene {
        interaction: Some(PAPER),
        ..free_scene(effort)
    }
}

const PAPER: Interaction = Interaction {
    concentration_per_cm3: 50.0,
    alpha: 0.5,
    m: 3.0,
    update: Update::Rotation,
    min_contact_arm: 0.0,
};

/// The interaction of a scene; the paper's where it had none.
pub fn interaction(scene: &mut Scene) -> &mut Interaction {
    scene.interaction.get_or_insert(PAPER)
}

/// Mean and standard error of independent values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// The mean.
    pub mean: f64,
    /// Its standard error.
    pub se: f64,
    /// How many values.
    pub samples: u64,
}

impl Sample {
    /// The sample of `values`.
    pub fn of(values: &[f64]) -> Self {
        Self {
            mean: values.mean(),
            se: values.std_dev() / (values.len() as f64).sqrt(),
            samples: values.len() as u64,
        }
    }

    /// The rule that this mean is `reference`, up to an `allowance`, by a sample that would show `effect` beyond it.
    pub fn is(self, reference: f64, allowance: f64, effect: f64, because: &'static str) -> Rule {
        Rule::Mean {
            mean: self.mean,
            se: self.se,
            samples: self.samples,
            reference,
            allowance,
            effect,
            because,
        }
    }

    /// The rule that this mean exceeds `bound`, by a sample that shows it where it does so by `effect`.
    pub fn exceeds(self, bound: f64, effect: f64, because: &'static str) -> Rule {
        Rule::Above {
            mean: self.mean,
            se: self.se,
            samples: self.samples,
            bound,
            effect,
            because,
        }
    }
}

/// One value per replica of a scene: `value` reads the means over rods, output by output, channel by channel.
pub fn per_replica<T: Send>(scene: &Scene, replicas: u64, value: impl Fn(&Means) -> T + Sync) -> Vec<T> {
    let plan = plan(scene);
    (0..replicas)
        .into_par_iter()
        .map(|replica| {
            let result = run_replica(&plan, replica);
            value(&Means {
                width: plan
                    .observables()
                    .iter()
                    .map(|observable| observable.width())
                    .sum(),
                count: scene.particles.count as f64,
                // A run that stopped fails whatever is asked of it: every mean is NaN.
                sums: result.map_or(Vec::new(), |result| {
                    result.sums.iter().map(|sum| sum.value).collect()
                }),
            })
        })
        .collect()
}

/// The means over rods of one replica.
pub struct Means {
    width: usize,
    count: f64,
    sums: Vec<f64>,
}

impl Means {
    /// The mean of a channel at an output.
    pub fn at(&self, output: usize, channel: usize) -> f64 {
        let sum = self.sums.get(output * self.width + channel);
        sum.map_or(f64::NAN, |sum| sum / self.count)
    }

    /// The mean of a channel over a range of outputs.
    pub fn over(&self, outputs: std::ops::Range<usize>, channel: usize) -> f64 {
        let len = outputs.len() as f64;
        outputs.map(|output| self.at(output, channel)).sum::<f64>() / len
    }
}

/// What a check and its controls have in common: worked out once for a run's seed and effort.
pub struct Shared<T>(Mutex<Kept<T>>);

struct Kept<T> {
    run: (u64, bool),
    values: BTreeMap<u64, Arc<OnceLock<Arc<T>>>>,
}

impl<T> Default for Shared<T> {
    fn default() -> Self {
        Self::new()
    }
}

impl<T> Shared<T> {
    /// Nothing yet.
    pub const fn new() -> Self {
        Self(Mutex::new(Kept {
            run: (0, false),
            values: BTreeMap::new(),
        }))
    }

    /// The value with this `key`, worked out by the first that asks for it; another run forgets it.
    pub fn get(&self, effort: &Effort, key: u64, work_out: impl FnOnce() -> T) -> Arc<T> {
        let place = {
            let mut kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
            let run = (effort.seed, effort.full);
            if kept.run != run {
                kept.run = run;
                kept.values.clear();
            }
            Arc::clone(kept.values.entry(key).or_default())
        };
        Arc::clone(place.get_or_init(|| Arc::new(work_out())))
    }
}

/// The plan of a scene that a case has written.
pub fn plan(scene: &Scene) -> Plan {
    Plan::new(scene).expect("a case's scene is valid")
}

/// The suspension of a scene that a case has written, with every rod free to meet.
pub fn suspension(scene: &Scene, replica: u64) -> Suspension {
    Suspension::new(&plan(scene), replica).expect("a case's scene has rods that interact")
}

/// The suspension of a scene whose rods cannot meet, carried and stepped all the same.
pub fn stepped(scene: &Scene, replica: u64) -> Suspension {
    let plan = plan(scene)
        .keeping(Stage::Contacts)
        .expect("a case's scene has an interaction");
    Suspension::new(&plan, replica).expect("the plan keeps its steps")
}

/// The Kolmogorov–Smirnov test that `values` in [0, 1] are uniform there, by as many as would show a `distance` between
/// the two distribution functions.
pub fn uniform(values: Vec<f64>, distance: f64, because: &'static str) -> Rule {
    let samples = values.len() as u64;
    let enough = kolmogorov_samples(distance);
    let method = KSOneSampleAlternativeMethod::TwoSidedAsymptotic;
    let (distance, p) = Uniform::new(0.0, 1.0)
        .ok()
        .and_then(|unit| ks_onesample(values, &unit, method, NaNPolicy::Propogate).ok())
        .unwrap_or((f64::NAN, f64::NAN));
    Rule::PValue {
        p,
        samples,
        enough,
        distance: Some(distance),
        because,
    }
}

/// The scene as the naive reference takes it.
pub fn problem(scene: &Scene, replica: u64, mistake: Option<Mistake>) -> Problem {
    let mut scene = scene.clone();
    let interaction = interaction(&mut scene).clone();
    let particles = scene.particles.clone();
    Problem {
        count: particles.count,
        shear_rate_per_s: scene.flow.shear_rate_per_s.unwrap_or(f64::NAN),
        length_mm: particles.length_mm,
        aspect_ratio: particles.aspect_ratio,
        aspect_ratio_sd_percent: particles.aspect_ratio_sd_percent,
        orientation: match particles.orientation {
            Orientation::Random(_) => Start::Isotropic,
            Orientation::Given { phi_deg, theta_deg } => Start::Fixed {
                phi_rad: phi_deg.to_radians(),
                theta_rad: theta_deg.to_radians(),
            },
        },
        concentration_per_cm3: interaction.concentration_per_cm3,
        alpha: interaction.alpha,
        m: interaction.m,
        min_contact_arm: interaction.min_contact_arm,
        update: match interaction.update {
            Update::Rotation => naive::Update::Rotation,
            Update::Angles => naive::Update::Angles,
        },
        reading: Reading::default(),
        steps_per_period: scene.steps_per_period() as usize,
        seed: scene.ensemble.seed,
        replica,
        mistake,
    }
}
