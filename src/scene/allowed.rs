//! The error of a value that its key does not allow.

use super::keys::{Holds, find};

/// What is wrong with a scene: the key, its value, and what is allowed.
///
/// ```
/// use shearbed::scene::{Particles, Scene};
/// let scene = Scene { particles: Particles { count: 0, ..Particles::default() }, ..Scene::default() };
/// let refused = shearbed::Plan::new(&scene).unwrap_err();
/// assert_eq!((refused.key, refused.value.as_deref()), ("particles.count", Some("0")));
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
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
        Self { key, value: Some(value.to_string()), allowed: allowed.into() }
    }

    pub(crate) fn missing(key: &'static str, allowed: &str) -> Self {
        Self { key, value: None, allowed: allowed.to_owned() }
    }
}

/// A value outside what its key allows.
pub(crate) fn refused(key: &'static str, value: impl ToString) -> Invalid {
    Invalid::new(key, value, find(key).map_or_else(String::new, |key| key.holds.to_string()))
}

/// Checks a number.
pub(crate) fn number(key: &'static str, value: f64) -> Result<(), Invalid> {
    match find(key) {
        Some(known) if known.holds.allows(value) => Ok(()),
        _ => Err(refused(key, value)),
    }
}

/// Checks a whole number.
pub(crate) fn whole(key: &'static str, value: u64) -> Result<(), Invalid> {
    match find(key).map(|key| key.holds) {
        Some(Holds::Whole { least, most }) if (least..=most).contains(&value) => Ok(()),
        _ => Err(refused(key, value)),
    }
}
