//! A scene: what a scene file says, checked. Units stand in the names of the keys.

use crate::model::volume::ControlVolume;
use crate::observable::Observable;
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize};

mod allowed;
mod file;
mod keys;
mod particles;
mod ranges;
mod rods;
mod steps;
pub use allowed::Invalid;
pub(crate) use allowed::refused;
pub use file::{Problem, SceneError, located, parse};
pub use keys::{Absent, Holds, KEYS, Key, MAX_COUNT, MAX_PER_UNIT, MAX_REPLICAS, MAX_SEED, TABLES};
pub(crate) use keys::{find, required};
pub use particles::{Isotropic, Orientation, OwnRods, Particles, RodsFile};
pub use rods::Misfit;
pub use steps::resolved_strain;
pub(crate) use steps::step_maps;

/// A whole scene. The tables and keys are those of the scene file ([`KEYS`]). In code, start from the default and say
/// what differs; [`crate::Plan::new`] checks it.
///
/// ```
/// use shearbed::scene::{Interaction, Particles, Scene};
/// let scene = Scene {
///     particles: Particles { count: 50, ..Particles::default() },
///     interaction: Some(Interaction { alpha: 0.3, ..Interaction::default() }),
///     ..Scene::default()
/// };
/// assert!(shearbed::Plan::new(&scene)?.steps() > 0);
/// # Ok::<(), shearbed::scene::Invalid>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// A line that says what the scene is.
    pub title: String,
    /// The imposed velocity gradient.
    pub flow: Flow,
    /// The rods.
    pub particles: Particles,
    /// How rods interact; without it they are free.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub interaction: Option<Interaction>,
    /// How long, and how finely.
    pub time: Time,
    /// Replicas and seed.
    #[serde(default)]
    pub ensemble: Ensemble,
    /// What is observed.
    #[serde(default)]
    pub output: Output,
}

/// `[flow]`: one of the two keys.
///
/// ```
/// use shearbed::scene::{Flow, Scene};
/// // Planar extension in place of shear: it has no period, so its time is given in strain.
/// let flow = Flow { shear_rate_per_s: None, gradient_per_s: Some([[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0; 3]]) };
/// let mut scene = Scene { flow, ..Scene::default() };
/// (scene.time.periods, scene.time.strain) = (None, Some(3.0));
/// assert!(shearbed::Plan::new(&scene).is_ok());
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Flow {
    /// G of plane Couette flow u_2 = G x_1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shear_rate_per_s: Option<f64>,
    /// Row i and column j hold ∂u_i/∂x_j.
    #[serde(default, skip_serializing_if = "Option::is_none", deserialize_with = "three_by_three")]
    pub gradient_per_s: Option<[[f64; 3]; 3]>,
}

/// Three of a list. Reading into an array would stop after three and let what follows pass.
fn three_of<T, E: Error>(list: Vec<T>, allowed: &str) -> Result<[T; 3], E> {
    list.try_into().map_err(|_| E::custom(allowed))
}

fn three_by_three<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<[[f64; 3]; 3]>, D::Error> {
    let allowed = "three rows of three numbers are allowed";
    let rows = Vec::<Vec<f64>>::deserialize(deserializer)?;
    let rows: Result<Vec<_>, _> = rows.into_iter().map(|row| three_of(row, allowed)).collect();
    three_of(rows?, allowed).map(Some)
}

fn three_numbers<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<[f64; 3]>, D::Error> {
    three_of(Vec::deserialize(deserializer)?, "three numbers are allowed").map(Some)
}

/// `[interaction]`: with `concentration_per_cm3` or `box_mm`.
///
/// ```
/// use shearbed::scene::Interaction;
/// let crowded = Interaction { concentration_per_cm3: Some(2000.0), ..Interaction::default() };
/// assert_eq!((crowded.alpha, crowded.m), (0.5, 3.0));
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Interaction {
    /// n, rods per volume; without it the box gives it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub concentration_per_cm3: Option<f64>,
    /// H₁, H₂ and H₃, the sides of the control volume (eqs 12 and 14); without them it is a cube.
    #[serde(default, skip_serializing_if = "Option::is_none", deserialize_with = "three_numbers")]
    pub box_mm: Option<[f64; 3]>,
    /// α of eq. 7; 0 means that no rods collide.
    pub alpha: f64,
    /// m of eq. 7, any positive number.
    #[serde(default = "three")]
    pub m: f64,
    /// How a colliding rod takes its step.
    #[serde(default)]
    pub update: Update,
    /// A contact arm |r| below this many lengths of its own rod is no contact.
    #[serde(default)]
    pub min_contact_arm: f64,
}

/// How a colliding rod takes its step.
///
/// ```
/// use shearbed::scene::{Interaction, Update};
/// let to_the_letter = Interaction { update: Update::Angles, ..Interaction::default() };
/// assert_ne!(to_the_letter, Interaction::default());
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Update {
    /// Turn about p × ṗ′ by |ṗ′|Δt.
    #[default]
    Rotation,
    /// A.14 to the letter, in φ and θ.
    Angles,
    /// Jeffery's exact step, then a turn about p × (ṗ′ − ṗ) by |ṗ′ − ṗ|Δt: a collision that changes nothing moves nothing.
    Kick,
}

/// `[time]`: `periods` of the mean aspect ratio, or `strain`.
///
/// ```
/// use shearbed::scene::Time;
/// let two_periods = Time { periods: Some(2.0), outputs_per_period: Some(100), ..Time::default() };
/// assert_eq!(two_periods.strain, None);
/// ```
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Time {
    /// Duration in periods T of the mean aspect ratio.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub periods: Option<f64>,
    /// Duration in shear strain ∫(2D:D)^½ dt.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub strain: Option<f64>,
    /// Steps per period of an interacting scene; by default as many as resolve the motion.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub steps_per_period: Option<u64>,
    /// Steps per unit of strain of an interacting scene; by default as many as resolve the motion.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub steps_per_strain: Option<u64>,
    /// Outputs per period; 50 by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub outputs_per_period: Option<u64>,
    /// Outputs per unit of strain; 10 by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub outputs_per_strain: Option<u64>,
}

/// `[ensemble]`.
///
/// ```
/// use shearbed::scene::{Ensemble, Scene};
/// let scene = Scene { ensemble: Ensemble { replicas: 4, seed: 2 }, ..Scene::default() };
/// assert!(shearbed::Plan::new(&scene).is_ok());
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Ensemble {
    /// Independent runs of the scene.
    pub replicas: u64,
    /// The seed of all random streams.
    pub seed: u64,
}

/// Free rods of the paper's Fig. 6 for one period.
impl Default for Scene {
    fn default() -> Self {
        Self {
            title: "Rods of Fig. 6".to_owned(),
            flow: Flow::default(),
            particles: Particles::default(),
            interaction: None,
            time: Time { periods: Some(1.0), ..Time::default() },
            ensemble: Ensemble::default(),
            output: Output::default(),
        }
    }
}

/// G = 0.5 1/s.
impl Default for Flow {
    fn default() -> Self {
        Self { shear_rate_per_s: Some(0.5), gradient_per_s: None }
    }
}

/// 50 rods per cm³, with the paper's α = 0.5 and m = 3.
impl Default for Interaction {
    fn default() -> Self {
        Self {
            concentration_per_cm3: Some(50.0),
            box_mm: None,
            alpha: 0.5,
            m: three(),
            update: Update::default(),
            min_contact_arm: 0.0,
        }
    }
}

impl Default for Ensemble {
    fn default() -> Self {
        Self { replicas: 1, seed: 1 }
    }
}

/// `[output]`.
///
/// ```
/// use shearbed::{Observable, scene::Output};
/// let output = Output { observables: vec![Observable::OrientationTensor], ..Output::default() };
/// assert!(output.rods_at.is_empty());
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Output {
    /// What is observed.
    pub observables: Vec<Observable>,
    /// When every rod is written: times of outputs, in the unit of [`crate::Plan::times`].
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub rods_at: Vec<f64>,
}

impl Default for Output {
    fn default() -> Self {
        Self { observables: vec![Observable::Projections], rods_at: Vec::new() }
    }
}

/// Outputs per unit of strain by default.
const OUTPUTS_PER_STRAIN: u64 = 10;

fn three() -> f64 {
    3.0
}

impl Scene {
    /// The same scene with every default that is used written out.
    pub fn resolved(&self) -> Self {
        let mut scene = self.clone();
        match scene.time.strain {
            Some(_) => scene.time.outputs_per_strain = Some(self.outputs_per_strain()),
            None => scene.time.outputs_per_period = Some(self.outputs_per_period()),
        }
        if scene.interaction.is_some() {
            scene.set_steps_per_unit(self.steps_per_unit());
        }
        scene
    }

    /// H₁, H₂ and H₃ where they are given.
    pub fn box_mm(&self) -> Option<[f64; 3]> {
        self.interaction.as_ref()?.box_mm
    }

    /// n, rods per cm³ of the control volume: as given, or what count and box make it.
    pub fn concentration_per_cm3(&self) -> Option<f64> {
        match self.box_mm() {
            Some(sides) => {
                let cm3 = sides.map(|mm| mm / 10.0).iter().product::<f64>();
                Some(self.particles.count as f64 / cm3)
            }
            None => self.interaction.as_ref()?.concentration_per_cm3,
        }
    }

    /// Gives the control volume so many rods at the same concentration: a box grows or shrinks in proportion.
    pub fn set_count(&mut self, count: usize) {
        let grown = libm::cbrt(count as f64 / self.particles.count as f64);
        if let Some(Interaction { box_mm: Some(sides), .. }) = &mut self.interaction {
            *sides = sides.map(|side| side * grown);
        }
        self.particles.count = count;
    }

    /// n a³, rods per cubed mean rod length.
    pub(crate) fn concentration(&self) -> Option<f64> {
        Some(self.concentration_per_cm3()? * (self.particles.length_mm / 10.0).powi(3))
    }

    /// H₁, H₂ and H₃ of interacting rods' control volume.
    pub fn sides_mm(&self) -> Option<[f64; 3]> {
        let cube = || Some(self.volume()?.sides().map(|side| side * self.particles.length_mm));
        self.box_mm().or_else(cube)
    }

    /// The control volume of interacting rods, in mean rod lengths.
    pub(crate) fn volume(&self) -> Option<ControlVolume> {
        match self.box_mm() {
            Some(sides) => Some(ControlVolume::of(sides.map(|mm| mm / self.particles.length_mm))),
            None => Some(ControlVolume::holding(self.particles.count, self.concentration()?)),
        }
    }

    /// Outputs per period, given or by default: 50, or where rods interact the largest divisor of the
    /// steps per period up to 50.
    pub fn outputs_per_period(&self) -> u64 {
        let steps = self.steps_per_unit().max(1);
        self.time.outputs_per_period.unwrap_or_else(|| {
            let divides = |k: &u64| self.interaction.is_none() || steps.is_multiple_of(*k);
            (1..=50).rev().find(divides).unwrap_or(1)
        })
    }

    /// Outputs per unit of strain, given or by default: 10, or where rods interact the largest divisor of the steps per unit of
    /// strain up to 10.
    pub fn outputs_per_strain(&self) -> u64 {
        self.time.outputs_per_strain.unwrap_or_else(|| {
            let steps = self.time.steps_per_strain.filter(|_| self.interaction.is_some());
            let divides = |k: &u64| steps.is_none_or(|steps| steps.is_multiple_of(*k));
            (1..=OUTPUTS_PER_STRAIN).rev().find(divides).unwrap_or(1)
        })
    }
}
