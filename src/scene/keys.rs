//! The one table of a scene's keys: what each means, its unit, what it may hold and what it is where it is not given.

use crate::model::shape::{ALLOWED, Correlation};
use crate::observable::Observable;

/// A table of a scene file, or one of its keys.
///
/// ```
/// let alpha = shearbed::scene::KEYS.iter().find(|key| key.path == "interaction.alpha").unwrap();
/// assert_eq!(alpha.holds.to_string(), "a finite number ≥ 0");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Key {
    /// Its path, as `particles.count`.
    pub path: &'static str,
    /// What it means.
    pub meaning: &'static str,
    /// Its unit; empty where it has none.
    pub unit: &'static str,
    /// What it may hold.
    pub holds: Holds,
    /// What it is where it is not given.
    pub absent: Absent,
}

/// What a key is where it is not given.
///
/// ```
/// use shearbed::scene::{Absent, KEYS};
/// let m = KEYS.iter().find(|key| key.path == "interaction.m").unwrap();
/// assert_eq!(m.absent, Absent::Default("3"));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Absent {
    /// It must be given: in every scene, or in a table that is there.
    Refused,
    /// It has this value, as TOML.
    Default(&'static str),
    /// It is worked out, or another key takes its place.
    Other(&'static str),
}

/// What a key may hold.
///
/// ```
/// use shearbed::scene::{Holds, KEYS};
/// let length = KEYS.iter().find(|key| key.path == "particles.length_mm").unwrap();
/// assert_eq!(length.holds, Holds::Positive);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Holds {
    /// Keys of its own, some of them needed.
    Table(&'static str),
    /// A text.
    Text,
    /// A whole number.
    Whole {
        /// The least.
        least: u64,
        /// The most.
        most: u64,
    },
    /// A finite number > 0.
    Positive,
    /// A finite number ≥ 0.
    NotNegative,
    /// A number in a range.
    Between {
        /// The least.
        least: f64,
        /// The most.
        most: f64,
    },
    /// Three rows of three finite numbers.
    Gradient,
    /// Three finite numbers > 0.
    Sides,
    /// `"isotropic"` or two angles.
    Orientation,
    /// A file with a row for each rod.
    Rods,
    /// One of these words.
    OneOf(&'static [&'static str]),
    /// Observables, each once.
    Observables,
    /// Times of outputs.
    Times,
}

impl Holds {
    /// Whether a number is one of those allowed; what holds no number allows none.
    pub fn allows(&self, value: f64) -> bool {
        value.is_finite()
            && match *self {
                Self::Positive => value > 0.0,
                Self::NotNegative => value >= 0.0,
                Self::Between { least, most } => (least..=most).contains(&value),
                _ => false,
            }
    }
}

impl std::fmt::Display for Holds {
    /// What is allowed, in words.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Table(words) => f.write_str(words),
            Self::Text => f.write_str("a text in quotes"),
            Self::Whole { least, most } => write!(f, "a whole number from {least} to {most}"),
            Self::Positive => f.write_str("a finite number > 0"),
            Self::NotNegative => f.write_str("a finite number ≥ 0"),
            Self::Between { least, most } => write!(f, "a number from {least:e} to {most:e}"),
            Self::Gradient => f.write_str("three rows of three finite numbers"),
            Self::Sides => f.write_str("[H1, H2, H3], three finite numbers > 0"),
            Self::Orientation => f.write_str(
                "\"isotropic\" or { phi_deg = a finite number, theta_deg = a number from 0 to 180 }; rods of a file are \
                 given by rods = { file = a text }",
            ),
            Self::Rods => f.write_str("{ file = a text }, of which crc32 may be given too"),
            Self::OneOf(words) => {
                let words: Vec<_> = words.iter().map(|word| format!("\"{word}\"")).collect();
                match words.split_last() {
                    Some((last, [])) => f.write_str(last),
                    Some((last, others)) => write!(f, "{} or {last}", others.join(", ")),
                    None => Ok(()),
                }
            }
            Self::Observables => {
                let names = Observable::ALL.map(|observable| format!("\"{}\"", observable.name()));
                write!(f, "a list of one or more of {}, each once", names.join(", "))
            }
            Self::Times => f.write_str("a list of finite numbers ≥ 0 that grow, each the time of an output"),
        }
    }
}

/// The largest count of rods: indices of rods are 32 bits wide, and 10⁸ rods fill several GB.
pub const MAX_COUNT: usize = 100_000_000;
/// The largest number of replicas.
pub const MAX_REPLICAS: u64 = 10_000_000;
/// The most steps or outputs per period, and outputs per unit of strain.
pub const MAX_PER_UNIT: u64 = 10_000_000;
/// The largest seed: the largest integer of a TOML file.
pub const MAX_SEED: u64 = i64::MAX as u64;

const PER_UNIT: Holds = whole(1, MAX_PER_UNIT);

const fn whole(least: u64, most: u64) -> Holds {
    Holds::Whole { least, most }
}

const fn key(
    path: &'static str,
    meaning: &'static str,
    unit: &'static str,
    holds: Holds,
    absent: Absent,
) -> Key {
    Key { path, meaning, unit, holds, absent }
}

use Absent::{Default, Other, Refused};
use Holds::{NotNegative, OneOf, Positive, Table, Text};

/// The tables of a scene.
#[rustfmt::skip]
pub const TABLES: [Key; 6] = [
    key("flow", "the imposed velocity gradient", "", Table("a table [flow] with shear_rate_per_s or gradient_per_s"), Refused),
    key("particles", "the rods", "", Table("a table [particles] with count, length_mm, aspect_ratio and orientation"), Refused),
    key("interaction", "how rods meet", "", Table("a table [interaction] with concentration_per_cm3 or box_mm, and alpha, or none for free rods"), Other("free rods")),
    key("time", "how long, and how finely", "", Table("a table [time] with periods or strain"), Refused),
    key("ensemble", "replicas and seed", "", Table("a table [ensemble]"), Other("its keys' defaults")),
    key("output", "what is observed", "", Table("a table [output]"), Other("its keys' defaults")),
];

/// The keys of a scene, in the order of the tables.
#[rustfmt::skip]
pub const KEYS: [Key; 28] = [
    key("title", "a line that says what the scene is", "", Text, Refused),
    key("flow.shear_rate_per_s", "G of plane Couette flow u_2 = G x_1", "1/s", Positive, Other("gradient_per_s")),
    key("flow.gradient_per_s", "row i and column j hold ∂u_i/∂x_j", "1/s", Holds::Gradient, Other("shear_rate_per_s")),
    key("particles.count", "N, rods in the control volume", "", whole(1, MAX_COUNT as u64), Refused),
    key("particles.length_mm", "a, the full length of a rod, or its mean", "mm", Positive, Refused),
    key("particles.length_sd_percent", "standard deviation of a Gaussian length, in percent of its mean; below 33.3333", "%", NotNegative, Default("0")),
    key("particles.aspect_ratio", "r_e, or its mean; below 1 a disc; interacting rods need more than 1", "", Holds::Between { least: 1e-100, most: 1e100 }, Other("physical_aspect_ratio")),
    key("particles.physical_aspect_ratio", "length over diameter of a cylinder, of which shape_correlation makes r_e", "", Holds::Between { least: ALLOWED.0, most: ALLOWED.1 }, Other("aspect_ratio")),
    key("particles.shape_correlation", "the formula for r_e of a cylinder, as `shearbed shape` lists them", "", OneOf(&Correlation::NAMES), Other("goes with physical_aspect_ratio")),
    key("particles.aspect_ratio_sd_percent", "σ of a Gaussian r_e, in percent of its mean (eq. 11)", "%", NotNegative, Default("0")),
    key("particles.orientation", "the directions at t = 0; φ from axis 1 to axis 2, θ from axis 3; used where a file of rods has none", "degrees", Holds::Orientation, Other("\"isotropic\" with rods, else it must be given")),
    key("particles.rods", "a CSV file beside the scene with a row for each rod, with columns of rods.csv; missing ones are drawn", "", Holds::Rods, Other("all is drawn")),
    key("interaction.concentration_per_cm3", "n, rods per volume", "1/cm³", Positive, Other("box_mm")),
    key("interaction.box_mm", "sides of the control volume along the axes (eqs 12, 14): count and box give n; where it is given too, it agrees to 1e-3", "mm", Holds::Sides, Other("a cube")),
    key("interaction.alpha", "α of P_c = (α/(s/a + α))^m (eq. 7); 0: no rods collide", "", NotNegative, Refused),
    key("interaction.m", "m of eq. 7", "", Positive, Default("3")),
    key("interaction.update", "how a colliding rod takes its step; angles: A.14 to the letter; kick: as a free rod, then the change", "", OneOf(&["rotation", "angles", "kick"]), Default("\"rotation\"")),
    key("interaction.min_contact_arm", "a shorter contact arm is no contact", "lengths of its own rod", NotNegative, Default("0")),
    key("time.periods", "how long, in periods T of the mean aspect ratio", "T", NotNegative, Other("strain")),
    key("time.strain", "how long, in shear strain ∫(2D:D)^½ dt: for flows without a period", "", NotNegative, Other("periods")),
    key("time.steps_per_period", "steps of interacting rods", "", PER_UNIT, Other("as many as resolve the motion")),
    key("time.steps_per_strain", "steps of interacting rods per unit of strain", "", PER_UNIT, Other("as many as resolve the motion")),
    key("time.outputs_per_period", "outputs; of interacting rods a divisor of the steps", "", PER_UNIT, Other("50, or the largest divisor below")),
    key("time.outputs_per_strain", "outputs per unit of strain; of interacting rods a divisor of the steps", "", PER_UNIT, Other("10, or the largest divisor below")),
    key("ensemble.replicas", "independent runs of the scene", "", whole(1, MAX_REPLICAS), Default("1")),
    key("ensemble.seed", "the seed of all random numbers", "", whole(0, MAX_SEED), Default("1")),
    key("output.observables", "what is observed: each has a file of its own", "", Holds::Observables, Default("[\"projections\"]")),
    key("output.rods_at", "when rods.csv has every rod: t/T, or strain where the time is one", "T or strain", Holds::Times, Default("[]")),
];

/// The table or key with this path.
pub(crate) fn find(path: &str) -> Option<&'static Key> {
    KEYS.iter().chain(&TABLES).find(|key| key.path == path)
}

/// What must be there: tables and keys of the whole file, or keys of a table that is there.
pub(crate) fn required(table: &str) -> impl Iterator<Item = &'static Key> {
    let within = move |key: &&Key| key.path.rsplit_once('.').map_or("", |(table, _)| table) == table;
    let needed = |key: &&Key| key.absent == Refused;
    KEYS.iter().chain(&TABLES).filter(within).filter(needed)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene;

    /// The least text with every required key, and `line` in its table.
    fn text(path: &str, value: &str) -> String {
        let (table, name) = path.rsplit_once('.').unwrap_or(("", path));
        let mut text = "title = \"t\"\n".to_owned();
        for of in &TABLES {
            let mut keys: Vec<(&str, &str)> = match of.path {
                "flow" => vec![("shear_rate_per_s", "1")],
                "particles" => {
                    vec![
                        ("count", "10"),
                        ("length_mm", "1"),
                        ("aspect_ratio", "5"),
                        ("orientation", "\"isotropic\""),
                    ]
                }
                "interaction" => vec![("concentration_per_cm3", "1"), ("alpha", "1")],
                "time" => vec![("periods", "1")],
                _ => Vec::new(),
            };
            if of.path == table {
                keys.retain(|(known, _)| *known != name);
                keys.push((name, value));
            }
            text += &format!("[{}]\n", of.path);
            keys.iter().for_each(|(key, value)| text += &format!("{key} = {value}\n"));
        }
        text
    }

    #[test]
    fn a_default_is_what_a_scene_without_the_key_has() {
        let without = scene::parse("t", &text("", "")).unwrap();
        for key in &KEYS {
            if let Default(value) = key.absent
                && key.path != "time.outputs_per_strain"
            {
                assert_eq!(scene::parse("t", &text(key.path, value)).unwrap(), without, "{}", key.path);
            }
        }
        assert_eq!(without.outputs_per_strain(), 10);
    }

    #[test]
    fn what_a_key_does_not_hold_is_refused_with_what_it_holds() {
        for key in KEYS.iter().filter(|key| key.path != "title") {
            let (most, wrong) = match key.holds {
                Holds::Whole { least, most } => (Some((least, most)), "-1"),
                Holds::Between { .. } => (None, "1e101"),
                _ => (None, "-1"),
            };
            let refused = |value: &str| {
                let error = scene::parse("t", &text(key.path, value)).unwrap_err().to_string();
                assert!(error.contains(&key.holds.to_string()), "{error}");
            };
            refused(wrong);
            refused("1979-05-27");
            if let Some((least, most)) = most {
                if least > 0 {
                    refused("0");
                }
                if most < MAX_SEED {
                    refused(&(most + 1).to_string());
                }
            }
        }
    }
}
