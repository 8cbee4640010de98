//! The types that the value of a key can have.

use super::{Holds, MAX_FLOW_STEPS};
use crate::observable::Observable;
use crate::scene::document::{as_toml, decimal};
use crate::scene::{FlowStep, Orientation, RodsFile, Update};

/// A type that the value of a key can have.
pub(in crate::scene) trait Field: serde::de::DeserializeOwned + std::fmt::Debug {
    /// The value from TOML; `None` if it has another type.
    fn from_toml(value: toml::Value) -> Option<Self> {
        value.try_into().ok()
    }

    fn allowed(&self, _holds: &Holds) -> bool {
        true
    }

    /// The value as it appears in an error.
    fn shown(&self) -> String {
        format!("{self:?}")
    }

    /// False if the key is not given.
    fn is_given(&self) -> bool {
        true
    }

    /// The value if a scene file lacks the key.
    fn absent(default: Self) -> Self {
        default
    }
}

impl<T: Field> Field for Option<T> {
    fn from_toml(value: toml::Value) -> Option<Self> {
        T::from_toml(value).map(Some)
    }

    fn allowed(&self, holds: &Holds) -> bool {
        self.as_ref().is_none_or(|value| value.allowed(holds))
    }

    fn shown(&self) -> String {
        self.as_ref().map_or_else(String::new, T::shown)
    }

    fn is_given(&self) -> bool {
        self.is_some()
    }

    fn absent(_: Self) -> Self {
        None
    }
}

impl Field for f64 {
    fn allowed(&self, holds: &Holds) -> bool {
        holds.allows(*self)
    }

    fn shown(&self) -> String {
        decimal(*self)
    }
}

impl Field for u64 {
    fn allowed(&self, holds: &Holds) -> bool {
        matches!(holds, Holds::Whole { least, most } if (least..=most).contains(&self))
    }
}

impl Field for usize {
    fn allowed(&self, holds: &Holds) -> bool {
        (*self as u64).allowed(holds)
    }
}

impl Field for String {}
impl Field for Update {}
impl Field for RodsFile {}
impl Field for crate::model::shape::Correlation {}

impl Field for Orientation {
    fn allowed(&self, _: &Holds) -> bool {
        match self {
            Self::Random(_) => true,
            Self::Given { phi_deg, theta_deg } => phi_deg.is_finite() && (0.0..=180.0).contains(theta_deg),
        }
    }

    fn shown(&self) -> String {
        match self {
            Self::Random(_) => "\"isotropic\"".to_owned(),
            Self::Given { phi_deg, theta_deg } => {
                format!("{{ phi_deg = {phi_deg}, theta_deg = {theta_deg} }}")
            }
        }
    }
}

impl Field for [f64; 3] {
    /// Reads a list of three: reading into an array would ignore further elements.
    fn from_toml(value: toml::Value) -> Option<Self> {
        Vec::from_toml(value)?.try_into().ok()
    }

    fn allowed(&self, _: &Holds) -> bool {
        self.iter().all(|side| side.is_finite() && *side > 0.0)
    }
}

impl Field for [[f64; 3]; 3] {
    fn from_toml(value: toml::Value) -> Option<Self> {
        let rows: Option<Vec<[f64; 3]>> =
            Vec::<toml::Value>::from_toml(value)?.into_iter().map(Field::from_toml).collect();
        rows?.try_into().ok()
    }

    fn allowed(&self, _: &Holds) -> bool {
        self.iter().flatten().all(|component| component.is_finite())
    }
}

impl Field for Vec<toml::Value> {}

impl Field for Vec<FlowStep> {
    fn allowed(&self, _: &Holds) -> bool {
        (1..=MAX_FLOW_STEPS).contains(&self.len()) && self.iter().all(FlowStep::is_allowed)
    }

    fn shown(&self) -> String {
        as_toml(&toml::Value::try_from(self).unwrap_or_else(|_| Vec::<i64>::new().into()))
    }
}

/// Times of outputs. Whether they coincide with outputs depends on other keys.
impl Field for Vec<f64> {
    fn allowed(&self, _: &Holds) -> bool {
        self.iter().all(|time| time.is_finite() && *time >= 0.0) && self.is_sorted_by(|a, b| a < b)
    }
}

impl Field for Vec<Observable> {
    fn allowed(&self, _: &Holds) -> bool {
        !self.is_empty() && self.iter().enumerate().all(|(k, one)| !self[..k].contains(one))
    }

    fn shown(&self) -> String {
        format!("{:?}", self.iter().map(|one| one.name()).collect::<Vec<_>>())
    }
}
