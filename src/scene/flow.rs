//! `[flow]`: the imposed velocity gradient.

use super::keys::{Absent::Other, Field, Holds, table};
use super::read::Reader;
use crate::model::flow::VelocityGradient;
use nalgebra::Matrix3;
use serde::{Deserialize, Deserializer, Serialize};

/// The flow of a scene, by one of the three keys of `[flow]`.
///
/// ```
/// use shearbed::scene::{Flow, Scene, Time};
/// // Planar extension in place of shear: it has no period, so its time is given in strain.
/// let flow = Flow::Gradient { gradient_per_s: [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0; 3]] };
/// let scene = Scene { flow, time: Time::strain(3.0), ..Scene::default() };
/// assert!(shearbed::Plan::new(&scene).is_ok());
/// ```
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(into = "FlowKeys")]
pub enum Flow {
    /// Plane Couette flow u_2 = G x_1.
    Shear {
        /// The shear rate G in 1/s.
        shear_rate_per_s: f64,
    },
    /// Any constant velocity gradient.
    Gradient {
        /// The velocity gradient in 1/s; row i and column j hold ∂u_i/∂x_j.
        gradient_per_s: [[f64; 3]; 3],
    },
    /// A sequence of flows, for free rods: start-up, reversal, a path line.
    Steps {
        /// The flows in the order of time; at least one.
        steps: Vec<FlowStep>,
    },
}

/// A flow that lasts for a given strain.
///
/// ```
/// use shearbed::scene::{Flow, FlowStep, Scene, Time};
/// // Sheared by 10 and back: every rod ends as it began.
/// let steps = vec![FlowStep::shear(0.5, 10.0), FlowStep::shear(-0.5, 10.0)];
/// let scene = Scene { flow: Flow::Steps { steps }, time: Time::strain(20.0), ..Scene::default() };
/// assert!(shearbed::Plan::new(&scene).is_ok());
/// ```
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FlowStep {
    /// The velocity gradient in 1/s; row i and column j hold ∂u_i/∂x_j.
    pub gradient_per_s: [[f64; 3]; 3],
    /// Duration as a shear strain ∫(2D:D)^½ dt.
    pub strain: f64,
}

impl<'de> Deserialize<'de> for FlowStep {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let step = Self::of_keys(toml::Table::deserialize(deserializer)?);
        step.map_err(|(key, allowed)| serde::de::Error::custom(format!("{key}: {allowed}")))
    }
}

fn is_positive(x: f64) -> bool {
    x.is_finite() && x > 0.0
}

impl FlowStep {
    /// Plane Couette flow u_2 = G x_1 with the shear rate G in 1/s, which may be negative.
    pub fn shear(shear_rate_per_s: f64, strain: f64) -> Self {
        Self { gradient_per_s: [[0.0; 3], [shear_rate_per_s, 0.0, 0.0], [0.0; 3]], strain }
    }

    /// Reads a step from its keys in a scene file, with one of the two rates; the error is the wrong key, and what is
    /// allowed.
    fn of_keys(mut keys: toml::Table) -> Result<Self, (String, &'static str)> {
        const RATES: [&str; 2] = ["shear_rate_per_s", "gradient_per_s"];
        let wrong = |key: &str, allowed| (key.to_owned(), allowed);
        if let Some(unknown) = keys.keys().find(|key| *key != "strain" && !RATES.contains(&&key[..])) {
            return Err(wrong(unknown, "strain, shear_rate_per_s and gradient_per_s are the keys of a step"));
        }
        let strain = keys.remove("strain").and_then(f64::from_toml).filter(|strain| is_positive(*strain));
        let strain = strain.ok_or(wrong("strain", "expected a finite number > 0"))?;
        let (key, allowed, step) = match RATES.map(|key| keys.remove(key)) {
            [Some(rate), None] => {
                let step = f64::from_toml(rate).map(|rate| Self::shear(rate, strain));
                (RATES[0], "expected a finite number other than 0", step)
            }
            [None, Some(rows)] => {
                let step = Field::from_toml(rows).map(|gradient_per_s| Self { gradient_per_s, strain });
                (RATES[1], "expected three rows of three finite numbers, with a rate of strain", step)
            }
            _ => (RATES[0], "either it or gradient_per_s", None),
        };
        step.filter(Self::is_allowed).ok_or(wrong(key, allowed))
    }

    /// The velocity gradient; `None` if a component is not finite.
    pub(crate) fn gradient(&self) -> Option<VelocityGradient> {
        VelocityGradient::new(Matrix3::from_fn(|i, j| self.gradient_per_s[i][j]))
    }

    /// The rate of strain (2D:D)^½ in 1/s; NaN if a component is not finite.
    pub(crate) fn rate_per_s(&self) -> f64 {
        self.gradient().map_or(f64::NAN, |flow| {
            // Exactly |G| for plane Couette flow.
            flow.shear_rate_per_s().map_or_else(|| flow.magnitude_per_s(), f64::abs)
        })
    }

    /// True if the strain and its rate are finite and > 0.
    pub(super) fn is_allowed(&self) -> bool {
        is_positive(self.strain) && is_positive(self.rate_per_s())
    }
}

/// Plane Couette flow with G = 0.5 1/s.
impl Default for Flow {
    fn default() -> Self {
        Self::Shear { shear_rate_per_s: 0.5 }
    }
}

table! {
    /// The keys of `[flow]`.
    pub(super) struct FlowKeys in "flow" {
        shear_rate_per_s: Option<f64> = None, "1/s", Holds::Positive, Other("gradient_per_s or steps"),
            "G of plane Couette flow u_2 = G x_1";
        gradient_per_s: Option<[[f64; 3]; 3]> = None, "1/s", Holds::Gradient, Other("shear_rate_per_s or steps"),
            "row i and column j hold ∂u_i/∂x_j";
        steps: Option<Vec<FlowStep>> = None, "", Holds::Steps, Other("shear_rate_per_s or gradient_per_s"),
            "one flow after another, for free rods: each with its strain ∫(2D:D)^½ dt";
    }
}

impl From<Flow> for FlowKeys {
    fn from(flow: Flow) -> Self {
        Self {
            shear_rate_per_s: flow.shear_rate_per_s(),
            gradient_per_s: flow.gradient_per_s(),
            steps: flow.steps().map(<[_]>::to_vec),
        }
    }
}

impl Flow {
    /// G in 1/s if the flow is given by its shear rate, else `None`.
    pub fn shear_rate_per_s(&self) -> Option<f64> {
        match self {
            Self::Shear { shear_rate_per_s } => Some(*shear_rate_per_s),
            Self::Gradient { .. } | Self::Steps { .. } => None,
        }
    }

    /// The gradient in 1/s if the flow is given by its gradient, else `None`.
    pub fn gradient_per_s(&self) -> Option<[[f64; 3]; 3]> {
        match self {
            Self::Shear { .. } | Self::Steps { .. } => None,
            Self::Gradient { gradient_per_s } => Some(*gradient_per_s),
        }
    }

    /// The sequence of flows if the flow is given by steps, else `None`.
    pub fn steps(&self) -> Option<&[FlowStep]> {
        match self {
            Self::Steps { steps } => Some(steps),
            _ => None,
        }
    }

    /// The velocity gradient, of the first flow in a sequence; `None` if a value is not allowed.
    pub(crate) fn gradient(&self) -> Option<VelocityGradient> {
        match self {
            Self::Shear { shear_rate_per_s } => VelocityGradient::plane_couette(*shear_rate_per_s),
            Self::Gradient { gradient_per_s } => VelocityGradient::new(Matrix3::from_fn(|i, j| gradient_per_s[i][j])),
            Self::Steps { steps } => steps.first()?.gradient(),
        }
    }

    pub(super) fn read(reader: &mut Reader<'_>) -> Option<Self> {
        reader.one_of(
            ["flow.shear_rate_per_s", "flow.gradient_per_s", "flow.steps"],
            "shear_rate_per_s, gradient_per_s or steps must be given",
        );
        if reader.refuses_table("flow.steps", |step| FlowStep::of_keys(step).err()) {
            return None;
        }
        match FlowKeys::read_keys(reader)? {
            FlowKeys { shear_rate_per_s: Some(shear_rate_per_s), .. } => Some(Self::Shear { shear_rate_per_s }),
            FlowKeys { gradient_per_s: Some(gradient_per_s), .. } => Some(Self::Gradient { gradient_per_s }),
            FlowKeys { steps, .. } => Some(Self::Steps { steps: steps? }),
        }
    }
}
