//! `[flow]`: the imposed velocity gradient.

use super::keys::{Absent::Other, Holds, table};
use super::read::Reader;
use crate::model::flow::VelocityGradient;
use nalgebra::Matrix3;
use serde::Serialize;

/// `[flow]`: one of its two keys.
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
        /// G.
        shear_rate_per_s: f64,
    },
    /// Any flow.
    Gradient {
        /// Row i and column j hold ∂u_i/∂x_j.
        gradient_per_s: [[f64; 3]; 3],
    },
}

/// G = 0.5 1/s.
impl Default for Flow {
    fn default() -> Self {
        Self::Shear { shear_rate_per_s: 0.5 }
    }
}

table! {
    /// The keys of `[flow]`.
    pub(super) struct FlowKeys in "flow" {
        shear_rate_per_s: Option<f64> = None, "1/s", Holds::Positive, Other("gradient_per_s"),
            "G of plane Couette flow u_2 = G x_1";
        gradient_per_s: Option<[[f64; 3]; 3]> = None, "1/s", Holds::Gradient, Other("shear_rate_per_s"),
            "row i and column j hold ∂u_i/∂x_j";
    }
}

impl From<Flow> for FlowKeys {
    fn from(flow: Flow) -> Self {
        Self { shear_rate_per_s: flow.shear_rate_per_s(), gradient_per_s: flow.gradient_per_s() }
    }
}

impl Flow {
    /// G of plane Couette flow where it is given as that.
    pub fn shear_rate_per_s(&self) -> Option<f64> {
        match self {
            Self::Shear { shear_rate_per_s } => Some(*shear_rate_per_s),
            Self::Gradient { .. } => None,
        }
    }

    /// The gradient where it is given as that.
    pub fn gradient_per_s(&self) -> Option<[[f64; 3]; 3]> {
        match self {
            Self::Shear { .. } => None,
            Self::Gradient { gradient_per_s } => Some(*gradient_per_s),
        }
    }

    /// The flow; `None` where a value is not allowed.
    pub(crate) fn gradient(&self) -> Option<VelocityGradient> {
        match self {
            Self::Shear { shear_rate_per_s } => VelocityGradient::plane_couette(*shear_rate_per_s),
            Self::Gradient { gradient_per_s } => {
                VelocityGradient::new(Matrix3::from_fn(|i, j| gradient_per_s[i][j]))
            }
        }
    }

    pub(super) fn read(reader: &mut Reader<'_>) -> Option<Self> {
        reader.one_of(
            ["flow.shear_rate_per_s", "flow.gradient_per_s"],
            "shear_rate_per_s or gradient_per_s must be given",
        );
        match FlowKeys::read_keys(reader)? {
            FlowKeys { shear_rate_per_s: Some(shear_rate_per_s), .. } => {
                Some(Self::Shear { shear_rate_per_s })
            }
            FlowKeys { gradient_per_s, .. } => Some(Self::Gradient { gradient_per_s: gradient_per_s? }),
        }
    }
}
