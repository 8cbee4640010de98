//! A scene: what a scene file says, checked. Units stand in the names of the keys.

use crate::flow::VelocityGradient;
use crate::observable::Observable;
use crate::propagator::Propagator;
use nalgebra::Matrix3;
use serde::{Deserialize, Serialize};

/// A whole scene. The tables and keys are those of the scene file.
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
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Flow {
    /// G of plane Couette flow u_2 = G x_1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shear_rate_per_s: Option<f64>,
    /// Row i and column j hold ∂u_i/∂x_j.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gradient_per_s: Option<[[f64; 3]; 3]>,
}

/// `[particles]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Particles {
    /// N, the rods in the control volume.
    pub count: usize,
    /// a, the full length of a rod.
    pub length_mm: f64,
    /// r_e, or its mean.
    pub aspect_ratio: f64,
    /// σ of the Gaussian r_e in percent of its mean (eq. 11).
    #[serde(default)]
    pub aspect_ratio_sd_percent: f64,
    /// The directions at t = 0.
    pub orientation: Orientation,
}

/// The directions at t = 0.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(
    untagged,
    deny_unknown_fields,
    expecting = "\"isotropic\" or { phi_deg = number, theta_deg = number } is allowed"
)]
pub enum Orientation {
    /// Drawn by eq. 12.
    Random(Isotropic),
    /// The same for every rod.
    Given {
        /// φ from axis 1 towards axis 2.
        phi_deg: f64,
        /// θ from axis 3.
        theta_deg: f64,
    },
}

/// The word `"isotropic"`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Isotropic {
    /// Every direction is equally likely.
    Isotropic,
}

/// `[interaction]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Interaction {
    /// n, rods per volume.
    pub concentration_per_cm3: f64,
    /// α of eq. 7; 0 means that no rods collide.
    pub alpha: f64,
    /// m of eq. 7, any positive number.
    #[serde(default = "three")]
    pub m: f64,
    /// How a colliding rod takes its step.
    #[serde(default)]
    pub update: Update,
    /// A contact arm |r| below this many rod lengths is no contact.
    #[serde(default)]
    pub min_contact_arm: f64,
}

/// How a colliding rod takes its step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Update {
    /// Turn about p × ṗ′ by |ṗ′|Δt.
    #[default]
    Rotation,
    /// A.14 to the letter, in φ and θ.
    Angles,
}

/// `[time]`: `periods` of the mean aspect ratio, or `strain`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Time {
    /// Duration in periods T of the mean aspect ratio.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub periods: Option<f64>,
    /// Duration in shear strain ∫(2D:D)^½ dt.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub strain: Option<f64>,
    /// Steps per period of an interacting scene; 200 by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub steps_per_period: Option<u64>,
    /// Outputs per period; 50 by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub outputs_per_period: Option<u64>,
    /// Outputs per unit of strain; 10 by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub outputs_per_strain: Option<u64>,
}

/// `[ensemble]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Ensemble {
    /// Independent runs of the scene.
    pub replicas: u64,
    /// The seed of all random streams.
    pub seed: u64,
}

impl Default for Ensemble {
    fn default() -> Self {
        Self { replicas: 1, seed: 1 }
    }
}

/// `[output]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Output {
    /// What is observed.
    pub observables: Vec<Observable>,
}

impl Default for Output {
    fn default() -> Self {
        Self {
            observables: vec![Observable::Projections],
        }
    }
}

fn three() -> f64 {
    3.0
}

/// What is wrong with a scene: the key, its value, and what is allowed.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{key} = {value} is not allowed: {allowed}")]
pub struct Invalid {
    /// The table and key, as `particles.count`.
    pub key: &'static str,
    /// The value found, or `missing`.
    pub value: String,
    /// What is allowed.
    pub allowed: String,
}

impl Invalid {
    pub(crate) fn new(key: &'static str, value: impl ToString, allowed: impl Into<String>) -> Self {
        Self {
            key,
            value: value.to_string(),
            allowed: allowed.into(),
        }
    }
}

/// The largest count of rods: indices of rods are 32 bits wide, and 10⁸ rods fill several GB.
pub const MAX_COUNT: usize = 100_000_000;
/// The largest number of replicas.
pub const MAX_REPLICAS: u64 = 10_000_000;
/// The largest seed: the largest integer of a TOML file.
pub const MAX_SEED: u64 = i64::MAX as u64;
/// The most outputs and the most steps of one scene.
const MAX_TICKS: f64 = 1e9;
const MAX_OUTPUTS: f64 = 1e7;

impl Scene {
    /// Checks every value and every combination of values.
    pub fn check(&self) -> Result<(), Invalid> {
        let flow = self.check_flow()?;
        self.check_particles()?;
        if let Some(interaction) = &self.interaction {
            self.check_interaction(interaction, &flow)?;
        }
        self.check_time(&flow)?;
        whole("ensemble.replicas", self.ensemble.replicas, 1, MAX_REPLICAS)?;
        whole("ensemble.seed", self.ensemble.seed, 0, MAX_SEED)?;
        let observables = &self.output.observables;
        let repeated = observables
            .iter()
            .enumerate()
            .any(|(k, o)| observables[..k].contains(o));
        if observables.is_empty() || repeated {
            let names: Vec<_> = observables.iter().map(|o| o.name()).collect();
            return Err(Invalid::new(
                "output.observables",
                format!("{names:?}"),
                "at least one observable, each once",
            ));
        }
        Ok(())
    }

    fn check_flow(&self) -> Result<VelocityGradient, Invalid> {
        match (self.flow.shear_rate_per_s, self.flow.gradient_per_s) {
            (Some(g), None) => {
                number("flow.shear_rate_per_s", g, "a number > 0", g > 0.0)?;
                VelocityGradient::plane_couette(g)
                    .ok_or_else(|| Invalid::new("flow.shear_rate_per_s", g, "a number > 0"))
            }
            (None, Some(rows)) => {
                VelocityGradient::new(Matrix3::from_fn(|i, j| rows[i][j])).ok_or_else(|| {
                    Invalid::new(
                        "flow.gradient_per_s",
                        format!("{rows:?}"),
                        "three rows of three finite numbers",
                    )
                })
            }
            (Some(g), Some(_)) => Err(Invalid::new(
                "flow.shear_rate_per_s",
                g,
                "either shear_rate_per_s or gradient_per_s, not both",
            )),
            (None, None) => Err(Invalid::new(
                "flow.shear_rate_per_s",
                "missing",
                "shear_rate_per_s or gradient_per_s must be given",
            )),
        }
    }

    fn check_particles(&self) -> Result<(), Invalid> {
        let particles = &self.particles;
        whole("particles.count", particles.count as u64, 1, MAX_COUNT as u64)?;
        positive("particles.length_mm", particles.length_mm)?;
        let (r, sd) = (particles.aspect_ratio, particles.aspect_ratio_sd_percent);
        number(
            "particles.aspect_ratio",
            r,
            "a number from 1e-100 to 1e100",
            (1e-100..=1e100).contains(&r),
        )?;
        let key = "particles.aspect_ratio_sd_percent";
        number(key, sd, "a number ≥ 0", sd >= 0.0)?;
        // Three standard deviations: P(r_e ≤ 1) = 0.0013 per rod.
        let deviation = 3.0 * r * sd / 100.0;
        let too_wide = sd > 0.0 && ((r - 1.0).abs() <= deviation || r <= deviation);
        if too_wide {
            let widest = 100.0 * ((r - 1.0).abs().min(r) / (3.0 * r));
            return Err(Invalid::new(
                key,
                sd,
                format!(
                    "so wide that r_e ≤ 1 (for discs: r_e ≥ 1 or ≤ 0) is likely; with mean {r} below {widest:.4}, \
                     three standard deviations"
                ),
            ));
        }
        if let Orientation::Given { phi_deg, theta_deg } = particles.orientation {
            number("particles.orientation", phi_deg, "a finite phi_deg", true)?;
            let ok = (0.0..=180.0).contains(&theta_deg);
            number("particles.orientation", theta_deg, "theta_deg from 0 to 180", ok)?;
        }
        Ok(())
    }

    fn check_interaction(&self, interaction: &Interaction, flow: &VelocityGradient) -> Result<(), Invalid> {
        positive(
            "interaction.concentration_per_cm3",
            interaction.concentration_per_cm3,
        )?;
        let alpha = interaction.alpha;
        number("interaction.alpha", alpha, "a number ≥ 0", alpha >= 0.0)?;
        positive("interaction.m", interaction.m)?;
        let arm = interaction.min_contact_arm;
        number("interaction.min_contact_arm", arm, "a number ≥ 0", arm >= 0.0)?;
        let side = self.volume_side_in_lengths(interaction);
        if !(side.is_finite() && side > 0.0) {
            return Err(Invalid::new(
                "interaction.concentration_per_cm3",
                interaction.concentration_per_cm3,
                "such that the control volume's side (N/(n a³))^⅓ is a finite number > 0",
            ));
        }
        if flow.shear_rate_per_s().is_none() {
            return Err(Invalid::new(
                "flow.gradient_per_s",
                format!("{:?}", self.flow.gradient_per_s.unwrap_or_default()),
                "interacting rods need plane Couette flow: only ∂u_2/∂x_1 other than 0",
            ));
        }
        let r = self.particles.aspect_ratio;
        number(
            "particles.aspect_ratio",
            r,
            "interacting rods need a number > 1",
            r > 1.0,
        )
    }

    /// H/a = (N/(n a³))^{1/3}.
    pub(crate) fn volume_side_in_lengths(&self, interaction: &Interaction) -> f64 {
        crate::volume::ControlVolume::holding(self.particles.count, self.concentration(interaction)).side()
    }

    /// n a³, rods per cubed rod length.
    pub(crate) fn concentration(&self, interaction: &Interaction) -> f64 {
        interaction.concentration_per_cm3 * (self.particles.length_mm / 10.0).powi(3)
    }

    fn check_time(&self, flow: &VelocityGradient) -> Result<(), Invalid> {
        let time = &self.time;
        for (key, value) in [
            ("time.steps_per_period", time.steps_per_period),
            ("time.outputs_per_period", time.outputs_per_period),
            ("time.outputs_per_strain", time.outputs_per_strain),
        ] {
            whole(key, value.unwrap_or(1), 1, 10_000_000)?;
        }
        match (time.periods, time.strain) {
            (Some(periods), None) => self.check_periods(periods, flow),
            (None, Some(strain)) => self.check_strain(strain, flow),
            (Some(periods), Some(_)) => Err(Invalid::new(
                "time.periods",
                periods,
                "either periods or strain, not both",
            )),
            (None, None) => Err(Invalid::new(
                "time.periods",
                "missing",
                "periods or strain must be given",
            )),
        }
    }

    fn check_periods(&self, periods: f64, flow: &VelocityGradient) -> Result<(), Invalid> {
        let key = "time.periods";
        number(key, periods, "a number ≥ 0", periods >= 0.0)?;
        if Propagator::new(flow, self.particles.aspect_ratio)
            .period_s()
            .is_none()
        {
            return Err(Invalid::new(
                key,
                periods,
                "rods of this aspect ratio have no period in this flow: give strain",
            ));
        }
        if let Some(outputs) = self.time.outputs_per_strain {
            return Err(Invalid::new(
                "time.outputs_per_strain",
                outputs,
                "goes with strain; periods take outputs_per_period",
            ));
        }
        let outputs = self.outputs_per_period();
        bounded(key, periods, outputs, "outputs", MAX_OUTPUTS)?;
        if self.interaction.is_some() {
            let steps = self.steps_per_period();
            bounded(key, periods, steps, "steps", MAX_TICKS)?;
            if !steps.is_multiple_of(outputs) {
                return Err(Invalid::new(
                    "time.outputs_per_period",
                    outputs,
                    format!("interacting rods need a divisor of steps_per_period = {steps}"),
                ));
            }
        }
        Ok(())
    }

    fn check_strain(&self, strain: f64, flow: &VelocityGradient) -> Result<(), Invalid> {
        let key = "time.strain";
        number(key, strain, "a number ≥ 0", strain >= 0.0)?;
        if flow.magnitude_per_s() == 0.0 {
            return Err(Invalid::new(
                key,
                strain,
                "this flow has no strain rate: give periods",
            ));
        }
        if self.interaction.is_some() {
            return Err(Invalid::new(
                key,
                strain,
                "interacting rods take steps per period: give periods",
            ));
        }
        for (key, value) in [
            ("time.steps_per_period", self.time.steps_per_period),
            ("time.outputs_per_period", self.time.outputs_per_period),
        ] {
            if let Some(value) = value {
                return Err(Invalid::new(
                    key,
                    value,
                    "goes with periods; strain takes outputs_per_strain",
                ));
            }
        }
        bounded(key, strain, self.outputs_per_strain(), "outputs", MAX_OUTPUTS)
    }

    /// Steps per period, given or by default.
    pub fn steps_per_period(&self) -> u64 {
        self.time.steps_per_period.unwrap_or(200)
    }

    /// Outputs per period, given or by default: 50, or where rods interact the largest divisor of the
    /// steps per period up to 50.
    pub fn outputs_per_period(&self) -> u64 {
        let steps = self.steps_per_period().max(1);
        self.time.outputs_per_period.unwrap_or_else(|| {
            let divides = |k: &u64| self.interaction.is_none() || steps.is_multiple_of(*k);
            (1..=50).rev().find(divides).unwrap_or(1)
        })
    }

    /// Outputs per unit of strain, given or by default.
    pub fn outputs_per_strain(&self) -> u64 {
        self.time.outputs_per_strain.unwrap_or(10)
    }
}

fn number(key: &'static str, value: f64, allowed: &str, holds: bool) -> Result<(), Invalid> {
    if value.is_finite() && holds {
        Ok(())
    } else {
        Err(Invalid::new(key, value, allowed))
    }
}

fn positive(key: &'static str, value: f64) -> Result<(), Invalid> {
    number(key, value, "a number > 0", value > 0.0)
}

fn whole(key: &'static str, value: u64, least: u64, most: u64) -> Result<(), Invalid> {
    if (least..=most).contains(&value) {
        Ok(())
    } else {
        Err(Invalid::new(
            key,
            value,
            format!("a whole number from {least} to {most}"),
        ))
    }
}

fn bounded(key: &'static str, duration: f64, per_unit: u64, what: &str, most: f64) -> Result<(), Invalid> {
    let all = duration * per_unit as f64;
    number(
        key,
        duration,
        &format!("at most {most:e} {what} in all, not {all:e}"),
        all <= most,
    )
}
