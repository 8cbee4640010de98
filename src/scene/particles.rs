//! `[particles]`: the rods, how they are shaped and where they point at the start.

use crate::shape::Correlation;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// `[particles]`.
///
/// ```
/// use shearbed::scene::{Particles, Scene};
/// let particles = Particles { count: 1000, aspect_ratio: 20.0, ..Particles::default() };
/// assert!(shearbed::Plan::new(&Scene { particles, ..Scene::default() }).is_ok());
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(from = "Written", into = "Written")]
pub struct Particles {
    /// N, the rods in the control volume.
    pub count: usize,
    /// a, the full length of a rod.
    pub length_mm: f64,
    /// r_e, or its mean: as given, or what the correlation makes of the physical aspect ratio.
    pub aspect_ratio: f64,
    /// Length over diameter of a cylinder, given in place of r_e.
    pub physical_aspect_ratio: Option<f64>,
    /// Which formula makes r_e of it.
    pub shape_correlation: Option<Correlation>,
    /// σ of the Gaussian r_e in percent of its mean (eq. 11).
    pub aspect_ratio_sd_percent: f64,
    /// The directions at t = 0.
    pub orientation: Orientation,
}

/// As it stands in a file: r_e, or what it is made of.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Written {
    count: usize,
    length_mm: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    aspect_ratio: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    physical_aspect_ratio: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    shape_correlation: Option<Correlation>,
    #[serde(default)]
    aspect_ratio_sd_percent: f64,
    orientation: Orientation,
}

/// Without any r_e it is NaN, which is refused.
impl From<Written> for Particles {
    fn from(written: Written) -> Self {
        let (physical, correlation) = (written.physical_aspect_ratio, written.shape_correlation);
        Self {
            count: written.count,
            length_mm: written.length_mm,
            aspect_ratio: (written.aspect_ratio)
                .or(equivalent(physical, correlation))
                .unwrap_or(f64::NAN),
            physical_aspect_ratio: physical,
            shape_correlation: correlation,
            aspect_ratio_sd_percent: written.aspect_ratio_sd_percent,
            orientation: written.orientation,
        }
    }
}

impl From<Particles> for Written {
    fn from(particles: Particles) -> Self {
        Self {
            count: particles.count,
            length_mm: particles.length_mm,
            aspect_ratio: Some(particles.aspect_ratio).filter(|_| particles.physical_aspect_ratio.is_none()),
            physical_aspect_ratio: particles.physical_aspect_ratio,
            shape_correlation: particles.shape_correlation,
            aspect_ratio_sd_percent: particles.aspect_ratio_sd_percent,
            orientation: particles.orientation,
        }
    }
}

/// r_e of a cylinder by a formula, where both are given and it gives one.
pub(super) fn equivalent(physical: Option<f64>, correlation: Option<Correlation>) -> Option<f64> {
    correlation?.formula().equivalent(physical?)
}

/// A hundred rods of 0.72 mm with r_e = 11.6, in random directions.
impl Default for Particles {
    fn default() -> Self {
        Self {
            count: 100,
            length_mm: 0.72,
            aspect_ratio: 11.6,
            physical_aspect_ratio: None,
            shape_correlation: None,
            aspect_ratio_sd_percent: 0.0,
            orientation: Orientation::Random(Isotropic::Isotropic),
        }
    }
}

/// The directions at t = 0.
///
/// ```
/// use shearbed::scene::{Orientation, Particles};
/// let along_the_flow = Orientation::Given { phi_deg: 90.0, theta_deg: 90.0 };
/// let particles = Particles { orientation: along_the_flow, ..Particles::default() };
/// assert_ne!(particles, Particles::default());
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(
    untagged,
    deny_unknown_fields,
    expecting = "\"isotropic\", { phi_deg = number, theta_deg = number } or { file = text } is allowed"
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
    /// Each rod's own, the same in every replica.
    Each {
        /// The file that has them: a name, for the core reads no files.
        file: String,
        /// The CRC-32 of the file in hexadecimal digits: where it is given, the file must have it.
        #[serde(skip_serializing_if = "Option::is_none")]
        crc32: Option<String>,
        /// p₁, p₂ and p₃ of every rod, |p| = 1; `None` where nobody has read the file yet.
        #[serde(skip)]
        p: Option<Arc<[Vec<f64>; 3]>>,
    },
}

/// The word `"isotropic"`.
///
/// ```
/// use shearbed::scene::{Isotropic, Orientation, Particles};
/// assert_eq!(Particles::default().orientation, Orientation::Random(Isotropic::Isotropic));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Isotropic {
    /// Every direction is equally likely.
    Isotropic,
}
