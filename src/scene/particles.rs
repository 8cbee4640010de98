//! `[particles]`: the rods, how long and how slender they are, and where they point at the start.

use crate::model::shape::Correlation;
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
    /// a, the full length of a rod, or its mean.
    pub length_mm: f64,
    /// The standard deviation of a Gaussian length in percent of its mean, independent of r_e.
    pub length_sd_percent: f64,
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
    /// Rods of which a file says what each is: what it has is taken, what it lacks is drawn as the other keys say.
    pub rods: Option<RodsFile>,
}

/// As it stands in a file: r_e, or what it is made of.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Written {
    count: usize,
    length_mm: f64,
    #[serde(default, skip_serializing_if = "is_zero")]
    length_sd_percent: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    aspect_ratio: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    physical_aspect_ratio: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    shape_correlation: Option<Correlation>,
    #[serde(default)]
    aspect_ratio_sd_percent: f64,
    #[serde(default)]
    orientation: Orientation,
    #[serde(skip_serializing_if = "Option::is_none")]
    rods: Option<RodsFile>,
}

/// Rods of one length are written as before there were others.
fn is_zero(percent: &f64) -> bool {
    *percent == 0.0
}

/// Without any r_e it is NaN, which is refused.
impl From<Written> for Particles {
    fn from(written: Written) -> Self {
        let (physical, correlation) = (written.physical_aspect_ratio, written.shape_correlation);
        Self {
            count: written.count,
            length_mm: written.length_mm,
            length_sd_percent: written.length_sd_percent,
            aspect_ratio: (written.aspect_ratio).or(equivalent(physical, correlation)).unwrap_or(f64::NAN),
            physical_aspect_ratio: physical,
            shape_correlation: correlation,
            aspect_ratio_sd_percent: written.aspect_ratio_sd_percent,
            orientation: written.orientation,
            rods: written.rods,
        }
    }
}

impl From<Particles> for Written {
    fn from(particles: Particles) -> Self {
        Self {
            count: particles.count,
            length_mm: particles.length_mm,
            length_sd_percent: particles.length_sd_percent,
            aspect_ratio: Some(particles.aspect_ratio).filter(|_| particles.physical_aspect_ratio.is_none()),
            physical_aspect_ratio: particles.physical_aspect_ratio,
            shape_correlation: particles.shape_correlation,
            aspect_ratio_sd_percent: particles.aspect_ratio_sd_percent,
            orientation: particles.orientation,
            rods: particles.rods,
        }
    }
}

impl Particles {
    /// ⟨a³⟩ over the cube of `length_mm`: of the rods of a file, or 1 + 3σ² of Gaussian lengths.
    pub fn mean_cube(&self) -> f64 {
        match self.own().and_then(|own| own.length_mm.as_ref()) {
            Some(own) => {
                let cubes = own.iter().map(|length| (length / self.length_mm).powi(3));
                cubes.sum::<f64>() / own.len() as f64
            }
            None => 1.0 + 3.0 * (self.length_sd_percent / 100.0).powi(2),
        }
    }

    /// The mean r_e: of the rods of a file, or `aspect_ratio`.
    pub fn mean_aspect_ratio(&self) -> f64 {
        match self.own_aspect_ratios() {
            Some(own) => own.iter().sum::<f64>() / own.len() as f64,
            None => self.aspect_ratio,
        }
    }

    /// The least r_e, the scene's and the largest; of a Gaussian one those three standard deviations off.
    pub(crate) fn extreme_aspect_ratios(&self) -> [f64; 3] {
        let r = self.aspect_ratio;
        let [least, most] = match self.own_aspect_ratios() {
            Some(own) => (own.iter()).fold([r; 2], |[least, most], r| [r.min(least), r.max(most)]),
            None => {
                [-3.0, 3.0].map(|deviations| r * (1.0 + deviations * self.aspect_ratio_sd_percent / 100.0))
            }
        };
        [least, r, most]
    }

    /// What a file says of each rod.
    pub(crate) fn own(&self) -> Option<&OwnRods> {
        self.rods.as_ref()?.own.as_deref()
    }

    /// The r_e of each rod of a file, where they are not all `aspect_ratio`.
    pub(crate) fn own_aspect_ratios(&self) -> Option<&[f64]> {
        let own = self.own()?.aspect_ratio.as_deref()?;
        own.iter().any(|r| *r != self.aspect_ratio).then_some(own)
    }

    /// The length of each rod of a file, where they are not all `length_mm`.
    pub(crate) fn own_lengths_mm(&self) -> Option<&[f64]> {
        let own = self.own()?.length_mm.as_deref()?;
        own.iter().any(|length| *length != self.length_mm).then_some(own)
    }

    /// φ and θ in degrees of the direction in which all rods start, where they do.
    pub fn common_start_deg(&self) -> Option<[f64; 2]> {
        let of_file = self.own().is_some_and(|own| own.p.is_some());
        match self.orientation {
            Orientation::Given { phi_deg, theta_deg } if !of_file => Some([phi_deg, theta_deg]),
            _ => None,
        }
    }

    /// Whether rods differ in r_e.
    pub fn of_several_shapes(&self) -> bool {
        match self.own().and_then(|own| own.aspect_ratio.as_ref()) {
            Some(_) => self.own_aspect_ratios().is_some(),
            None => self.aspect_ratio_sd_percent > 0.0,
        }
    }

    /// Whether rods differ in length.
    pub(crate) fn of_several_lengths(&self) -> bool {
        match self.own().and_then(|own| own.length_mm.as_ref()) {
            Some(_) => self.own_lengths_mm().is_some(),
            None => self.length_sd_percent > 0.0,
        }
    }
}

/// r_e of a cylinder by a formula, where both are given and it gives one.
pub(crate) fn equivalent(physical: Option<f64>, correlation: Option<Correlation>) -> Option<f64> {
    correlation?.formula().equivalent(physical?)
}

/// A hundred rods of 0.72 mm with r_e = 11.6, in random directions.
impl Default for Particles {
    fn default() -> Self {
        Self {
            count: 100,
            length_mm: 0.72,
            length_sd_percent: 0.0,
            aspect_ratio: 11.6,
            physical_aspect_ratio: None,
            shape_correlation: None,
            aspect_ratio_sd_percent: 0.0,
            orientation: Orientation::default(),
            rods: None,
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

impl Default for Orientation {
    fn default() -> Self {
        Self::Random(Isotropic::Isotropic)
    }
}

/// A file that says what each rod is, the same in every replica.
///
/// ```
/// use shearbed::scene::{OwnRods, Particles, RodsFile, Scene};
/// // One along the flow, and one of twice the length along the vorticity axis.
/// let own = OwnRods {
///     p: Some([vec![0.0, 0.0], vec![1.0, 0.0], vec![0.0, 1.0]]),
///     length_mm: Some(vec![0.72, 1.44]),
///     ..OwnRods::default()
/// };
/// let particles = Particles { count: 2, rods: Some(RodsFile::with("two.csv", own)), ..Particles::default() };
/// assert!(shearbed::Plan::new(&Scene { particles, ..Scene::default() }).is_ok());
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RodsFile {
    /// Its name: the core reads no files.
    pub file: String,
    /// The CRC-32 of the file in hexadecimal digits: where it is given, the file must have it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub crc32: Option<String>,
    /// What it has; `None` where nobody has read it yet.
    #[serde(skip)]
    pub own: Option<Arc<OwnRods>>,
}

impl RodsFile {
    /// A file of this name that has been read.
    pub fn with(file: &str, own: OwnRods) -> Self {
        Self { file: file.to_owned(), crc32: None, own: Some(own.into()) }
    }
}

/// What each rod is, as structure of arrays: as many numbers as there are rods, or `None` where that is drawn.
///
/// ```
/// assert_eq!(shearbed::scene::OwnRods::default().p, None);
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OwnRods {
    /// p₁, p₂ and p₃, |p| = 1.
    pub p: Option<[Vec<f64>; 3]>,
    /// r_e.
    pub aspect_ratio: Option<Vec<f64>>,
    /// The full length a.
    pub length_mm: Option<Vec<f64>>,
    /// The place of the centre in the control volume of interacting rods.
    pub place_mm: Option<[Vec<f64>; 3]>,
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
