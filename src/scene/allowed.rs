//! What each key of a scene may hold, in words and as a range, and the error that says so.

/// What is wrong with a scene: the key, its value, and what is allowed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Invalid {
    /// The table and key, as `particles.count`.
    pub key: &'static str,
    /// The value found; `None` where the key is missing.
    pub value: Option<String>,
    /// What is allowed.
    pub allowed: String,
}

impl std::error::Error for Invalid {}

impl std::fmt::Display for Invalid {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { key, value, allowed } = self;
        match value {
            Some(value) => write!(f, "{key} = {value} is not allowed: {allowed}"),
            None => write!(f, "{key} is missing: {allowed}"),
        }
    }
}

impl Invalid {
    pub(crate) fn new(key: &'static str, value: impl ToString, allowed: impl Into<String>) -> Self {
        Self {
            key,
            value: Some(value.to_string()),
            allowed: allowed.into(),
        }
    }

    pub(super) fn missing(key: &'static str, allowed: &str) -> Self {
        Self {
            key,
            value: None,
            allowed: allowed.to_owned(),
        }
    }
}

/// The tables of a scene.
pub(crate) const TABLES: [&str; 6] = ["flow", "particles", "interaction", "time", "ensemble", "output"];

/// The keys of a scene.
pub(crate) const KEYS: [&str; 21] = [
    "title",
    "flow.shear_rate_per_s",
    "flow.gradient_per_s",
    "particles.count",
    "particles.length_mm",
    "particles.aspect_ratio",
    "particles.aspect_ratio_sd_percent",
    "particles.orientation",
    "interaction.concentration_per_cm3",
    "interaction.alpha",
    "interaction.m",
    "interaction.update",
    "interaction.min_contact_arm",
    "time.periods",
    "time.strain",
    "time.steps_per_period",
    "time.outputs_per_period",
    "time.outputs_per_strain",
    "ensemble.replicas",
    "ensemble.seed",
    "output.observables",
];

/// What must be there: in the whole file, and in a table that is.
pub(crate) fn required() -> [(&'static str, &'static [&'static str]); 3] {
    [
        ("", &["title", "flow", "particles", "time"]),
        (
            "particles",
            &[
                "particles.count",
                "particles.length_mm",
                "particles.aspect_ratio",
                "particles.orientation",
            ],
        ),
        (
            "interaction",
            &["interaction.concentration_per_cm3", "interaction.alpha"],
        ),
    ]
}

/// The largest count of rods: indices of rods are 32 bits wide, and 10⁸ rods fill several GB.
pub const MAX_COUNT: usize = 100_000_000;
/// The largest number of replicas.
pub const MAX_REPLICAS: u64 = 10_000_000;
/// The most steps or outputs per period, and outputs per unit of strain.
pub const MAX_PER_UNIT: u64 = 10_000_000;
/// The largest seed: the largest integer of a TOML file.
pub const MAX_SEED: u64 = i64::MAX as u64;
/// The least and the most of the keys that hold whole numbers.
fn range(key: &str) -> Option<(u64, u64)> {
    Some(match key {
        "particles.count" => (1, MAX_COUNT as u64),
        "time.steps_per_period" | "time.outputs_per_period" | "time.outputs_per_strain" => (1, MAX_PER_UNIT),
        "ensemble.replicas" => (1, MAX_REPLICAS),
        "ensemble.seed" => (0, MAX_SEED),
        _ => return None,
    })
}

/// What a key or table may hold, in words; `None` for an unknown key.
pub(crate) fn allowed(key: &str) -> Option<String> {
    if let Some((least, most)) = range(key) {
        return Some(format!("a whole number from {least} to {most}"));
    }
    let words = match key {
        "title" => "a text in quotes",
        "flow" => "a table [flow] with shear_rate_per_s or gradient_per_s",
        "particles" => "a table [particles] with count, length_mm, aspect_ratio and orientation",
        "particles.orientation" => {
            "\"isotropic\" or { phi_deg = a finite number, theta_deg = a number from 0 to 180 }"
        }
        "interaction" => "a table [interaction] with concentration_per_cm3 and alpha, or none for free rods",
        "interaction.update" => "\"rotation\" or \"angles\"",
        "time" => "a table [time] with periods or strain",
        "ensemble" => "a table [ensemble]",
        "output" => "a table [output]",
        "output.observables" => {
            "a list of one or more of \"projections\", \"planar_projections\", \"mean_angle\", \
             \"orbit_constant\", \"orientation_tensor\", each once"
        }
        "flow.gradient_per_s" => "three rows of three finite numbers",
        "particles.aspect_ratio" => "a number from 1e-100 to 1e100",
        "flow.shear_rate_per_s"
        | "particles.length_mm"
        | "interaction.concentration_per_cm3"
        | "interaction.m" => "a finite number > 0",
        "particles.aspect_ratio_sd_percent"
        | "interaction.alpha"
        | "interaction.min_contact_arm"
        | "time.periods"
        | "time.strain" => "a finite number ≥ 0",
        _ => return None,
    };
    Some(words.to_owned())
}

/// A value outside what its key allows.
pub(super) fn refused(key: &'static str, value: impl ToString) -> Invalid {
    Invalid::new(key, value, allowed(key).unwrap_or_default())
}

pub(super) fn number(key: &'static str, value: f64, holds: bool) -> Result<(), Invalid> {
    if value.is_finite() && holds {
        Ok(())
    } else {
        Err(refused(key, value))
    }
}

pub(super) fn positive(key: &'static str, value: f64) -> Result<(), Invalid> {
    number(key, value, value > 0.0)
}

pub(super) fn not_negative(key: &'static str, value: f64) -> Result<(), Invalid> {
    number(key, value, value >= 0.0)
}

pub(super) fn whole(key: &'static str, value: u64) -> Result<(), Invalid> {
    match range(key) {
        Some((least, most)) if !(least..=most).contains(&value) => Err(refused(key, value)),
        _ => Ok(()),
    }
}
