//! A scene: the content of a scene file; names of keys contain the units.
//!
//! One row of a `table!` makes a key: its field, unit, range, default and meaning. Reader, schema, `--keys`, the page
//! of keys and Python's keywords follow from it. To add a key, add its row to the table it belongs to, and use the
//! field. A [`document::Document`] keeps the line of every value, for errors. Scenes may use `observable` and the parts
//! before it.

use crate::model::volume::ControlVolume;
use crate::observable::{Observable, Observe};
use serde::{Deserialize, Deserializer, Serialize};

pub mod document;
mod error;
mod keys;
mod flow;
mod time;
mod particles;
mod read;
mod rods;
mod steps;
pub use error::{Error, Invalid, SceneProblem};
use flow::FlowKeys;
pub use flow::{Flow, FlowStep};
pub use keys::{
    Absent, Holds, Key, MAX_COUNT, MAX_FLOW_STEPS, MAX_PER_UNIT, MAX_REPLICAS, MAX_SEED, TABLES, Table, keys,
};
use keys::{Absent::Default as Otherwise, Absent::Other, Absent::Required, table, whole};
pub(crate) use keys::{find, refused};
pub(crate) use particles::equivalent;
pub use particles::{COUNTED, Isotropic, Orientation, OwnRods, Particles, RodsFile};
pub use read::{likeness, of_document, parse};
pub use rods::Misfit;
pub use steps::resolved_strain;
pub(crate) use steps::{nearest, step_maps};
use time::TimeKeys;
pub use time::{Time, TimeUnit};

/// Rods in the cube of a rod's length from which on neighbours may be more than one. The paper's densest has 0.037.
pub const DENSE: f64 = 0.1;

/// Keys that stand for the concentration.
const CONCENTRATIONS: [&str; 3] =
    ["interaction.concentration_per_cm3", "interaction.box_mm", "particles.volume_fraction"];

/// The key of given times of outputs.
const TIMES: &str = "output.times";

/// Sets a key of a scene's document. A concentration replaces that of the text, under whichever key that stands, a
/// duration one in another unit, with the steps and outputs per that unit, and times of outputs their number per unit.
///
/// # Errors
///
/// If a part of the key before the last is not a table.
pub fn set(document: &mut document::Document, key: &str, value: toml::Value) -> Result<(), Error> {
    document.set(key, value)?;
    // The key that was set is not the text's any more, and stays.
    alternatives(key).iter().for_each(|written| document.drop_written(written));
    Ok(())
}

/// The keys of a text that this one replaces when it is set.
fn alternatives(key: &str) -> Vec<&'static str> {
    if CONCENTRATIONS.contains(&key) {
        return CONCENTRATIONS.to_vec();
    }
    let outputs = TimeUnit::ALL.map(TimeUnit::outputs_key);
    match TimeUnit::ALL.into_iter().find(|unit| unit.duration_key() == key) {
        Some(own) => TimeUnit::ALL.into_iter().filter(|unit| *unit != own).flat_map(TimeUnit::keys).collect(),
        None if key == TIMES => outputs.to_vec(),
        None if outputs.contains(&key) => vec![TIMES],
        None => Vec::new(),
    }
}

/// A whole scene. Tables and keys are those of the scene file ([`keys()`]). In code, start from the default and change
/// what differs; [`crate::Plan::new`] checks the scene.
///
/// ```
/// use shearbed::scene::{Interaction, Particles, Scene};
/// let scene = Scene {
///     particles: Particles { count: 50, ..Particles::default() },
///     interaction: Some(Interaction { alpha: 0.3, ..Interaction::default() }),
///     ..Scene::default()
/// };
/// assert!(shearbed::Plan::new(&scene)?.steps() > 0);
/// # Ok::<(), shearbed::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Scene {
    /// One line that describes the scene.
    pub title: String,
    /// The imposed velocity gradient.
    pub flow: Flow,
    /// The liquid.
    #[serde(skip_serializing_if = "Liquid::is_default")]
    pub liquid: Liquid,
    /// The rods.
    pub particles: Particles,
    /// The interaction of rods; `None` for free rods.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub interaction: Option<Interaction>,
    /// The duration, with the numbers of steps and outputs.
    pub time: Time,
    /// Replicas and seed.
    pub ensemble: Ensemble,
    /// The observables, and the outputs at which every rod is saved.
    pub output: Output,
}

impl<'de> Deserialize<'de> for Scene {
    /// Reads the keys of a scene file, as [`parse`] does.
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let document = document::Document::of(toml::Table::deserialize(deserializer)?);
        of_document(&document).map_err(|error| serde::de::Error::custom(error.messages().join("; ")))
    }
}

table! {
    /// `[liquid]`.
    pub struct Liquid in "liquid" {
        viscosity_pa_s: Option<f64> = None, "Pa s", Holds::Positive, Other("no stress in Pa"),
            "μ of the liquid, for the stress in Pa";
    }
}

impl Liquid {
    fn is_default(&self) -> bool {
        *self == Self::default()
    }
}

table! {
    /// `[interaction]`: with `concentration_per_cm3` or `box_mm`. By default 50 rods per cm³, with the paper's α = 0.5
    /// and m = 3.
    pub struct Interaction in "interaction" {
        concentration_per_cm3: Option<f64> = Some(50.0), "1/cm³", Holds::Positive,
            Other("box_mm or particles.volume_fraction"),
            "n, rods per volume";
        box_mm: Option<[f64; 3]> = None, "mm", Holds::Sides, Other("a cube"),
            "sides of the control volume along the axes (eqs 12, 14): count and box give n; if given, it must agree \
             within 0.1 %";
        alpha: f64 = 0.5, "", Holds::NotNegative, Required,
            "α of P_c = (α/(s/a + α))^m (eq. 7); 0: no rods collide";
        m: f64 = 3.0, "", Holds::Positive, Otherwise("3"),
            "m of eq. 7";
        update: Update = Update::Kick, "", Holds::OneOf(&["rotation", "angles", "kick"]), Otherwise("\"kick\""),
            "how a colliding rod takes its step; kick: as a free rod, then the change; rotation: a straight turn; \
             angles: exactly A.14";
        min_contact_arm: f64 = 0.0, "lengths of its own rod", Holds::NotNegative, Otherwise("0"),
            "a shorter contact arm is no contact";
    }
}

/// How a colliding rod turns in its step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum Update {
    /// Turn about p × ṗ′ by |ṗ′|Δt.
    Rotation,
    /// A.14 taken literally, in φ and θ.
    Angles,
    /// Jeffery's exact step, then a turn about p × (ṗ′ − ṗ) by |ṗ′ − ṗ|Δt: a collision without a change of rate adds no
    /// turn.
    #[default]
    Kick,
}

table! {
    /// `[ensemble]`.
    pub struct Ensemble in "ensemble" {
        replicas: u64 = 1, "", whole(1, MAX_REPLICAS), Otherwise("1"),
            "independent runs of the scene";
        seed: u64 = 1, "", whole(0, MAX_SEED), Otherwise("1"),
            "the seed of all random numbers";
    }
}

table! {
    /// `[output]`.
    pub struct Output in "output" {
        observables: Vec<Observable> = vec![Observable::Projections], "", Holds::Observables,
            Otherwise("[\"projections\"]"),
            "what is observed: each has a file of its own";
        times: Vec<f64> = Vec::new(), "T, strain or s", Holds::Times, Other("those of outputs_per_period"),
            "when means are taken, in place of outputs_per_period; of interacting rods, times of their steps",
            unwritten if |output: &Output| output.times.is_empty();
        rods_at: Vec<f64> = Vec::new(), "T, strain or s", Holds::Times, Otherwise("[]"),
            "when rods.csv has every rod: times of outputs",
            unwritten if |output: &Output| output.rods_at.is_empty();
        rods_every: Option<u64> = None, "outputs", whole(1, MAX_PER_UNIT), Other("the times of rods_at alone"),
            "rods.csv has every rod at each K-th output too, from the start on";
    }
}

impl Output {
    /// The key that asks for every rod at some output (`rods_at` if both do); `None` if no key does.
    pub fn rods_key(&self) -> Option<&'static str> {
        let every = self.rods_every.map(|_| "output.rods_every");
        if self.rods_at.is_empty() { every } else { Some("output.rods_at") }
    }

    /// Removes the request for every rod at some outputs.
    pub fn drop_rods(&mut self) {
        self.rods_at.clear();
        self.rods_every = None;
    }
}

/// Free rods of the paper's Fig. 6 for one period.
impl Default for Scene {
    fn default() -> Self {
        Self {
            title: "Rods of Fig. 6".to_owned(),
            flow: Flow::default(),
            liquid: Liquid::default(),
            particles: Particles::default(),
            interaction: None,
            time: Time::default(),
            ensemble: Ensemble::default(),
            output: Output::default(),
        }
    }
}

impl Scene {
    /// The same scene with all defaults in use written out.
    pub fn resolved(&self) -> Self {
        let mut scene = self.clone();
        scene.time.outputs_per_unit = self.output.times.is_empty().then(|| self.outputs_per_unit());
        if scene.steps() {
            scene.time.steps_per_unit = Some(self.steps_per_unit());
        }
        scene
    }

    /// The sides H₁, H₂ and H₃ in mm if they are given.
    pub fn box_mm(&self) -> Option<[f64; 3]> {
        self.interaction.as_ref()?.box_mm
    }

    /// n, rods per cm³ of the control volume: as given, from count and box, or from the volume fraction; `None` for
    /// free rods.
    pub fn concentration_per_cm3(&self) -> Option<f64> {
        match self.box_mm() {
            Some(sides) => {
                let cm3 = sides.map(|mm| mm / 10.0).iter().product::<f64>();
                Some(self.particles.count as f64 / cm3)
            }
            None => {
                let given = self.interaction.as_ref()?.concentration_per_cm3;
                given.or_else(|| Some(1e3 * self.particles.volume_fraction? / self.particles.spheroid_mm3()))
            }
        }
    }

    /// n⟨a³⟩ with the full length a, the number of rods in the cube of a rod's length; `None` for free rods.
    pub fn rods_per_cubed_length(&self) -> Option<f64> {
        let cube_cm3 = (0.1 * self.particles.length_mm).powi(3) * self.particles.mean_cube();
        Some(self.concentration_per_cm3()? * cube_cm3)
    }

    /// `dilute`, `semi-dilute` or `concentrated` by Doi & Edwards: rods turn freely below one rod in the cube of a
    /// rod's length; above, they hinder each other, and from a volume fraction of about 1/r_e, which is n a³ = r_e,
    /// they do so everywhere. The model is for n a³ far below 1: from [`DENSE`] to 1 it says `not far below 1`. `None`
    /// for free rods.
    pub fn regime(&self) -> Option<&'static str> {
        Some(match self.rods_per_cubed_length()? {
            n_a3 if n_a3 < DENSE => "dilute",
            n_a3 if n_a3 < 1.0 => "not far below 1",
            n_a3 if n_a3 < self.particles.aspect_ratio => "semi-dilute",
            _ => "concentrated",
        })
    }

    /// The key that gives the concentration of rods that may interact.
    pub fn concentration_key(&self) -> &'static str {
        match (self.box_mm(), self.particles.volume_fraction) {
            (Some(_), _) => "interaction.box_mm",
            (None, Some(_)) => "particles.volume_fraction",
            (None, None) => "interaction.concentration_per_cm3",
        }
    }

    /// Sets the number of rods at the same concentration: a box changes in proportion.
    pub fn set_count(&mut self, count: usize) {
        let grown = libm::cbrt(count as f64 / self.particles.count as f64);
        if let Some(Interaction { box_mm: Some(sides), .. }) = &mut self.interaction {
            *sides = sides.map(|side| side * grown);
        }
        self.particles.count = count;
    }

    /// The unit of the rods' stresses, μ G n⟨a³⟩ in Pa, in plane Couette flow; `None` without a viscosity or a
    /// concentration.
    pub(crate) fn stress_pa(&self) -> Option<f64> {
        let cubes = self.concentration()? * self.particles.mean_cube();
        Some(self.liquid.viscosity_pa_s? * self.flow.gradient()?.shear_rate_per_s()? * cubes)
    }

    /// The unit of an observable's sums.
    pub(crate) fn unit(&self, of: &dyn Observe) -> f64 {
        if of.needs_viscosity() { self.stress_pa().unwrap_or(1.0) } else { 1.0 }
    }

    /// n a³, the number of rods per cubed mean rod length; `None` for free rods.
    pub(crate) fn concentration(&self) -> Option<f64> {
        Some(self.concentration_per_cm3()? * (self.particles.length_mm / 10.0).powi(3))
    }

    /// The sides H₁, H₂ and H₃ in mm of the control volume; `None` for free rods.
    pub fn sides_mm(&self) -> Option<[f64; 3]> {
        let cube = || Some(self.volume()?.sides().map(|side| side * self.particles.length_mm));
        self.box_mm().or_else(cube)
    }

    /// The control volume, in mean rod lengths; `None` for free rods.
    pub(crate) fn volume(&self) -> Option<ControlVolume> {
        match self.box_mm() {
            Some(sides) => Some(ControlVolume::of(sides.map(|mm| mm / self.particles.length_mm))),
            None => Some(ControlVolume::holding(self.particles.count, self.concentration()?)),
        }
    }

    /// Outputs per unit of time, given or by default: a strain of 0.2 apart, of rods that take steps 0.4, at least 50 a
    /// period; or 10 a unit of strain (a second: rounded up). If rods take steps, it divides them: the least even
    /// divisor that is enough, or the largest.
    pub fn outputs_per_unit(&self) -> u64 {
        self.time.outputs_per_unit.unwrap_or_else(|| {
            let most = self.default_outputs();
            let steps = self.steps().then(|| self.steps_per_unit().max(1));
            let divides = |k: &u64| steps.is_none_or(|steps| steps.is_multiple_of(*k));
            let least = self.least_outputs();
            let last = steps.unwrap_or(0).min(least.saturating_mul(10));
            let even = (least..=last).find(|k| k.is_multiple_of(2) && divides(k));
            even.or_else(|| (1..=most).rev().find(divides)).unwrap_or(1)
        })
    }

    /// All values that their keys do not allow.
    pub(crate) fn out_of_range(&self) -> Vec<Invalid> {
        let mut wrong = Vec::new();
        FlowKeys::from(self.flow.clone()).check(&mut wrong);
        self.liquid.check(&mut wrong);
        self.particles.check(&mut wrong);
        if self.particles.physical_aspect_ratio.is_some() {
            // The value from a correlation is checked with the correlation.
            wrong.retain(|invalid| invalid.key != "particles.aspect_ratio");
        }
        self.interaction.iter().for_each(|interaction| interaction.check(&mut wrong));
        TimeKeys::from(self.time.clone()).check(&mut wrong);
        self.ensemble.check(&mut wrong);
        self.output.check(&mut wrong);
        wrong
    }
}
