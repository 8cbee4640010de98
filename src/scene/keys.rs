//! The keys of a scene: meaning, unit, allowed values and default. Their rows are in `table!` blocks, one for each
//! table.

mod field;

pub(super) use field::Field;

use super::{Ensemble, FlowKeys, Interaction, Invalid, Liquid, Output, Particles, TimeKeys};
use crate::observable::Observable;

/// A table of a scene file, or one of its keys.
///
/// ```
/// let alpha = shearbed::scene::keys().find(|key| key.path == "interaction.alpha").unwrap();
/// assert_eq!(alpha.holds.to_string(), "a finite number ≥ 0");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Key {
    /// The dotted path of the key, such as `particles.count`.
    pub path: &'static str,
    /// What the key means.
    pub meaning: &'static str,
    /// The unit; empty if there is none.
    pub unit: &'static str,
    /// The allowed values.
    pub holds: Holds,
    /// What applies if the key is not given.
    pub absent: Absent,
}

impl Key {
    pub(crate) fn expected(&self) -> String {
        format!("expected {}", self.holds)
    }
}

/// What applies if a key is not given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Absent {
    /// The key is required: in every scene, or in a table that is given.
    Required,
    /// The default value, as TOML.
    Default(&'static str),
    /// The value is computed or given by another key, described in words.
    Other(&'static str),
}

/// The allowed values of a key.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Holds {
    /// A table of keys, described in words.
    Table(&'static str),
    /// A text.
    Text,
    /// An integer.
    Whole {
        /// The smallest allowed value.
        least: u64,
        /// The largest allowed value.
        most: u64,
    },
    /// A finite number > 0.
    Positive,
    /// A finite number ≥ 0.
    NotNegative,
    /// A number in a closed range.
    Between {
        /// The smallest allowed value.
        least: f64,
        /// The largest allowed value.
        most: f64,
    },
    /// Three rows of three finite numbers.
    Gradient,
    /// A sequence of flows.
    Steps,
    /// Three finite numbers > 0.
    Sides,
    /// `"isotropic"` or two angles.
    Orientation,
    /// A file with one row per rod.
    Rods,
    /// One of these words.
    OneOf(&'static [&'static str]),
    /// Observables, without repetition.
    Observables,
    /// Times.
    Times,
}

impl Holds {
    /// True if the number `value` is allowed; false for keys that do not hold a number.
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
    /// Writes what is allowed, in words.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Table(words) => f.write_str(words),
            Self::Text => f.write_str("a text in quotes"),
            Self::Whole { least, most } => write!(f, "a whole number from {least} to {most}"),
            Self::Positive => f.write_str("a finite number > 0"),
            Self::NotNegative => f.write_str("a finite number ≥ 0"),
            Self::Between { least, most } => write!(f, "a number from {least:e} to {most:e}"),
            Self::Gradient => f.write_str("three rows of three finite numbers"),
            Self::Steps => write!(
                f,
                "1 to {MAX_FLOW_STEPS} tables [[flow.steps]], each with strain (a finite number > 0) and \
                 shear_rate_per_s (a finite number other than 0) or gradient_per_s (three rows of three finite \
                 numbers, with a rate of strain)"
            ),
            Self::Sides => f.write_str("[H1, H2, H3], three finite numbers > 0"),
            Self::Orientation => f.write_str(
                "\"isotropic\" or { phi_deg = a finite number, theta_deg = a number from 0 to 180 }; rods of a file \
                 are given by rods = { file = a text }",
            ),
            Self::Rods => f.write_str("{ file = a text }, optionally with crc32"),
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
            Self::Times => f.write_str("a list of finite numbers ≥ 0 that grow"),
        }
    }
}

/// The largest number of rods: indices of rods have 32 bits, and 10⁸ rods fill several GB.
pub const MAX_COUNT: usize = 100_000_000;
/// The largest number of flows in a sequence.
pub const MAX_FLOW_STEPS: usize = 1000;
/// The largest number of replicas.
pub const MAX_REPLICAS: u64 = 10_000_000;
/// The largest number of steps or outputs per period, or of outputs per unit of strain.
pub const MAX_PER_UNIT: u64 = 10_000_000;
/// The largest seed: the largest integer of a TOML file.
pub const MAX_SEED: u64 = i64::MAX as u64;

pub(super) const fn whole(least: u64, most: u64) -> Holds {
    Holds::Whole { least, most }
}

/// Steps or outputs per unit of time.
pub(super) const PER_UNIT: Holds = whole(1, MAX_PER_UNIT);

/// Declares a table of a scene, with a row for each key: field, type, value in `Default`, then unit, allowed values,
/// value if a scene file lacks the key, and meaning. Makes the struct, its `KEYS`, its reader (`read`), its check
/// (`check`) and its `Serialize`. Keys of type `Option` are written if they are `Some`; `unwritten if` says when
/// another key is left out.
macro_rules! table {
    (
        $(#[$meta:meta])*
        $visibility:vis struct $name:ident in $table:literal {
            $($field:ident: $type:ty = $value:expr, $unit:literal, $holds:expr, $absent:expr,
                $meaning:literal $(, unwritten if $unwritten:expr)?;)*
        }
    ) => {
        $(#[$meta])*
        #[derive(Clone, Debug, PartialEq)]
        $visibility struct $name {
            $(#[doc = $meaning] pub $field: $type,)*
        }

        impl Default for $name {
            fn default() -> Self {
                Self { $($field: $value,)* }
            }
        }

        impl $name {
            pub(in crate::scene) const KEYS: &[$crate::scene::Key] = &[$($crate::scene::Key {
                path: concat!($table, ".", stringify!($field)),
                meaning: $meaning,
                unit: $unit,
                holds: $holds,
                absent: $absent,
            }),*];

            pub(in crate::scene) fn read_keys(reader: &mut $crate::scene::read::Reader<'_>) -> Option<Self> {
                $(let $field = reader.key(concat!($table, ".", stringify!($field)), $value);)*
                Some(Self { $($field: $field?,)* })
            }

            pub(in crate::scene) fn check(&self, wrong: &mut Vec<$crate::scene::Invalid>) {
                $($crate::scene::keys::check(concat!($table, ".", stringify!($field)), &self.$field, wrong);)*
            }
        }

        impl serde::Serialize for $name {
            fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                use serde::ser::SerializeMap;
                let mut map = serializer.serialize_map(None)?;
                $(if $crate::scene::keys::Field::is_given(&self.$field) $(&& !$unwritten(self))? {
                    map.serialize_entry(stringify!($field), &self.$field)?;
                })*
                map.end()
            }
        }
    };
}
pub(super) use table;

/// A table of a scene and its keys.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Table {
    /// The key of the table itself.
    pub key: Key,
    /// The keys in the table.
    pub keys: &'static [Key],
}

const fn of(
    path: &'static str,
    meaning: &'static str,
    words: &'static str,
    absent: Absent,
    keys: &'static [Key],
) -> Table {
    Table { key: Key { path, meaning, unit: "", holds: Holds::Table(words), absent }, keys }
}

use Absent::{Other, Required};

/// The only key outside the tables.
pub(super) const TITLE: Key = Key {
    path: "title",
    meaning: "a line that says what the scene is",
    unit: "",
    holds: Holds::Text,
    absent: Required,
};

/// The tables of a scene.
#[rustfmt::skip]
pub const TABLES: [Table; 7] = [
    of("flow", "the imposed velocity gradient", "a table [flow] with shear_rate_per_s, gradient_per_s or \
        steps", Required, FlowKeys::KEYS),
    of("liquid", "the liquid", "a table [liquid]", Other("its keys' defaults"), Liquid::KEYS),
    of("particles", "the rods", "a table [particles] with count, length_mm, aspect_ratio and \
        orientation", Required, Particles::KEYS),
    of("interaction", "how rods meet", "a table [interaction] with concentration_per_cm3 or box_mm, and alpha, or none \
        for free rods", Other("free rods"), Interaction::KEYS),
    of("time", "how long, and how finely", "a table [time] with periods, strain or seconds", Required, TimeKeys::KEYS),
    of("ensemble", "replicas and seed", "a table [ensemble]", Other("its keys' defaults"), Ensemble::KEYS),
    of("output", "what is observed", "a table [output]", Other("its keys' defaults"), Output::KEYS),
];

/// All keys of a scene, in the order of the tables.
pub fn keys() -> impl Iterator<Item = &'static Key> + Clone {
    const TITLES: &[Key] = &[TITLE];
    const ALL: &[Table] = &TABLES;
    TITLES.iter().chain(ALL.iter().flat_map(|table| table.keys))
}

pub(crate) fn find(path: &str) -> Option<&'static Key> {
    const ALL: &[Table] = &TABLES;
    keys().chain(ALL.iter().map(|table| &table.key)).find(|key| key.path == path)
}

/// Checks a value by itself, and adds an entry to `wrong` if its key does not allow it.
pub(super) fn check(path: &'static str, value: &impl Field, wrong: &mut Vec<Invalid>) {
    if let Some(key) = find(path).filter(|key| !value.allowed(&key.holds)) {
        wrong.push(Invalid::new(path, value.shown(), key.expected()));
    }
}

/// The error of a `value` that its key does not allow.
pub(crate) fn refused(key: &'static str, value: impl ToString) -> Invalid {
    Invalid::new(key, value, find(key).map_or_else(String::new, Key::expected))
}

#[cfg(test)]
mod tests;
