//! `[particles]`: the rods' number, lengths, aspect ratios and initial directions.

use super::keys::{
    Absent::Default as Otherwise, Absent::Other, Absent::Required, Holds, Key, MAX_COUNT, find, table, whole,
};
use super::read::Reader;
use crate::model::shape::{ALLOWED, Correlation};
use crate::model::stress::Body;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;
use std::sync::Arc;

/// The count of a scene whose file of rods has not been loaded, and which gives none.
pub const COUNTED: usize = 0;

table! {
    /// `[particles]`. By default a hundred rods of 0.72 mm with r_e = 11.6, in random directions.
    pub struct Particles in "particles" {
        count: usize = 100, "", whole(1, MAX_COUNT as u64), Other("the rows of particles.rods, else it must be given"),
            "N, rods in the control volume";
        length_mm: f64 = 0.72, "mm", Holds::Positive, Required,
            "a, the full length of a rod, or its mean";
        length_sd_percent: f64 = 0.0, "%", Holds::NotNegative, Otherwise("0"),
            "standard deviation of a Gaussian length, in percent of its mean; below 33.3333",
            unwritten if |particles: &Particles| particles.length_sd_percent == 0.0;
        volume_fraction: Option<f64> = None, "", Holds::Between { least: 1e-100, most: 1.0 },
            Other("concentration_per_cm3 or box_mm"),
            "n times the volume π a³/(6 r_e²) of a spheroid of length a and diameter a/r_e, mean r_e and a³";
        aspect_ratio: f64 = 11.6, "", Holds::Between { least: 1e-100, most: 1e100 }, Other("physical_aspect_ratio"),
            "r_e, or its mean; below 1 a disc; interacting rods need more than 1",
            unwritten if |particles: &Particles| particles.physical_aspect_ratio.is_some();
        physical_aspect_ratio: Option<f64> = None, "", Holds::Between { least: ALLOWED.0, most: ALLOWED.1 },
            Other("aspect_ratio"),
            "length over diameter of a cylinder, of which shape_correlation makes r_e";
        shape_correlation: Option<Correlation> = None, "", Holds::OneOf(&Correlation::NAMES), Other("goes with \
            physical_aspect_ratio"),
            "the formula for r_e of a cylinder";
        aspect_ratio_sd_percent: f64 = 0.0, "%", Holds::NotNegative, Otherwise("0"),
            "σ of a Gaussian r_e, in percent of its mean (eq. 11)";
        rotary_diffusion_per_s: f64 = 0.0, "1/s", Holds::NotNegative, Otherwise("0"),
            "D_r of free rods (Brownian)",
            unwritten if |particles: &Particles| particles.rotary_diffusion_per_s == 0.0;
        orientation: Orientation = Orientation::default(), "degrees", Holds::Orientation, Other("\"isotropic\" with \
            rods, else it must be given"),
            "the directions at t = 0; φ from axis 1 to axis 2, θ from axis 3; used where a file of rods has none";
        rods: Option<RodsFile> = None, "", Holds::Rods, Other("all is drawn"),
            "a CSV file beside the scene with a row for each rod, with columns of rods.csv; missing ones are drawn";
    }
}

impl Particles {
    /// Reads the table: r_e is given once, directly or by a cylinder and a formula; and directions or a file of rods
    /// are given.
    pub(super) fn read(reader: &mut Reader<'_>) -> Option<Self> {
        let r_e = "particles.aspect_ratio";
        let allowed = |key| find(key).map_or_else(String::new, Key::expected);
        let or_cylinder = format!("{}; or physical_aspect_ratio and shape_correlation", allowed(r_e));
        let given = reader.one_of([r_e, "particles.physical_aspect_ratio"], &or_cylinder);
        let start = ["particles.orientation", "particles.rods"];
        if !start.iter().any(|key| reader.has(key) || reader.means(key)) {
            reader.refuse(start[0], &allowed(start[0]));
        }
        let count = "particles.count";
        let counted = !reader.has(count);
        if counted && !reader.has(start[1]) && !reader.means(count) {
            reader.refuse(count, &allowed(count));
        }
        let mut particles = Self::read_keys(reader)?;
        if counted {
            particles.count = COUNTED;
        }
        if given != Some(r_e) {
            let r_e = equivalent(particles.physical_aspect_ratio, particles.shape_correlation);
            particles.aspect_ratio = r_e.unwrap_or(f64::NAN);
        }
        Some(particles)
    }

    /// ⟨a³⟩ over the cube of `length_mm`: from the rods of a file, or 1 + 3σ² for Gaussian lengths.
    pub fn mean_cube(&self) -> f64 {
        match self.own().and_then(|own| own.length_mm.as_ref()) {
            Some(own) => {
                let cubes = own.iter().map(|length| (length / self.length_mm).powi(3));
                cubes.sum::<f64>() / own.len() as f64
            }
            None => 1.0 + 3.0 * (self.length_sd_percent / 100.0).powi(2),
        }
    }

    /// The mean volume in mm³ of spheroids with the rods' lengths and their mean r_e, π⟨a³⟩/(6 r_e²).
    pub(crate) fn spheroid_mm3(&self) -> f64 {
        let diameter = self.length_mm / self.mean_aspect_ratio();
        PI / 6.0 * self.length_mm * diameter.powi(2) * self.mean_cube()
    }

    /// The rods' body for stresses: a cylinder if its length over diameter is given, else a spheroid.
    pub(crate) fn body(&self) -> Body {
        match self.physical_aspect_ratio {
            Some(aspect_ratio) => Body::Cylinder { aspect_ratio },
            None => Body::Spheroid,
        }
    }

    /// The mean r_e: that of the rods in a file, or `aspect_ratio`.
    pub fn mean_aspect_ratio(&self) -> f64 {
        match self.own_aspect_ratios() {
            Some(own) => own.iter().sum::<f64>() / own.len() as f64,
            None => self.aspect_ratio,
        }
    }

    /// The smallest r_e, the scene's and the largest; for Gaussian r_e the extremes are three standard deviations from
    /// the mean.
    pub(crate) fn extreme_aspect_ratios(&self) -> [f64; 3] {
        let r = self.aspect_ratio;
        let [least, most] = match self.own_aspect_ratios() {
            Some(own) => (own.iter()).fold([r; 2], |[least, most], r| [r.min(least), r.max(most)]),
            None => [-3.0, 3.0].map(|deviations| r * (1.0 + deviations * self.aspect_ratio_sd_percent / 100.0)),
        };
        [least, r, most]
    }

    /// The rods of a file, or `None`.
    pub(crate) fn own(&self) -> Option<&OwnRods> {
        self.rods.as_ref()?.own.as_deref()
    }

    /// The r_e of each rod in a file; `None` if there is none, or if all equal `aspect_ratio`.
    pub(crate) fn own_aspect_ratios(&self) -> Option<&[f64]> {
        let own = self.own()?.aspect_ratio.as_deref()?;
        own.iter().any(|r| *r != self.aspect_ratio).then_some(own)
    }

    /// The length of each rod in a file, in mm; `None` if there is none, or if all equal `length_mm`.
    pub(crate) fn own_lengths_mm(&self) -> Option<&[f64]> {
        let own = self.own()?.length_mm.as_deref()?;
        own.iter().any(|length| *length != self.length_mm).then_some(own)
    }

    /// φ and θ in degrees of the common initial direction; `None` if rods start in different directions.
    pub fn common_start_deg(&self) -> Option<[f64; 2]> {
        let of_file = self.own().is_some_and(|own| own.p.is_some());
        match self.orientation {
            Orientation::Given { phi_deg, theta_deg } if !of_file => Some([phi_deg, theta_deg]),
            _ => None,
        }
    }

    /// The reason why rods do not disturb each other, by their initial directions; `None` if they do, or if directions
    /// are drawn. Parallel rods have no contact line; in the shear plane it is along axis 3, along which nothing moves.
    pub fn undisturbed(&self) -> Option<&'static str> {
        if let Some([p1, p2, p3]) = self.own().and_then(|own| own.p.as_ref()) {
            let vanish = |p: &[f64]| p.iter().all(|p| *p == 0.0);
            let in_plane = vanish(p3).then_some("all rods start in the shear plane");
            return in_plane.or((vanish(p1) && vanish(p2)).then_some("all rods start along the vorticity axis"));
        }
        let [_, theta_deg] = self.common_start_deg()?;
        match theta_deg.rem_euclid(180.0) {
            90.0 => Some("all rods start parallel in the shear plane"),
            0.0 => Some("all rods start along the vorticity axis"),
            _ if !self.of_several_shapes() => Some("all rods start parallel with one r_e"),
            _ => None,
        }
    }

    /// True if rods differ in r_e.
    pub fn of_several_shapes(&self) -> bool {
        match self.own().and_then(|own| own.aspect_ratio.as_ref()) {
            Some(_) => self.own_aspect_ratios().is_some(),
            None => self.aspect_ratio_sd_percent > 0.0,
        }
    }

    pub(crate) fn of_several_lengths(&self) -> bool {
        match self.own().and_then(|own| own.length_mm.as_ref()) {
            Some(_) => self.own_lengths_mm().is_some(),
            None => self.length_sd_percent > 0.0,
        }
    }
}

/// r_e of a cylinder by a formula; `None` if one of the two is missing, or the formula gives no value.
pub(crate) fn equivalent(physical: Option<f64>, correlation: Option<Correlation>) -> Option<f64> {
    correlation?.formula().equivalent(physical?)
}

/// The initial directions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(
    untagged,
    deny_unknown_fields,
    expecting = "\"isotropic\" or { phi_deg = number, theta_deg = number } is allowed"
)]
pub enum Orientation {
    /// Random directions, drawn by eq. 12.
    Random(Isotropic),
    /// The same direction for every rod.
    Given {
        /// φ in degrees, from axis 1 towards axis 2.
        phi_deg: f64,
        /// θ in degrees, from axis 3.
        theta_deg: f64,
    },
}

impl Default for Orientation {
    fn default() -> Self {
        Self::Random(Isotropic::Isotropic)
    }
}

/// A file with values for each rod, the same in every replica.
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
    /// The file's name; this crate reads no files.
    pub file: String,
    /// The CRC-32 of the file in hexadecimal digits, which the file must have if it is given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub crc32: Option<String>,
    /// The content; `None` if the file has not been loaded.
    #[serde(skip)]
    pub own: Option<Arc<OwnRods>>,
}

impl RodsFile {
    /// The file named `file` with its content `own`.
    pub fn with(file: &str, own: OwnRods) -> Self {
        Self { file: file.to_owned(), crc32: None, own: Some(own.into()) }
    }
}

/// Values of each rod, as structure of arrays, with one element per rod; `None` for values that are drawn.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OwnRods {
    /// Directions p₁, p₂ and p₃ with |p| = 1.
    pub p: Option<[Vec<f64>; 3]>,
    /// Equivalent aspect ratios r_e.
    pub aspect_ratio: Option<Vec<f64>>,
    /// Full lengths a in mm.
    pub length_mm: Option<Vec<f64>>,
    /// Positions in mm of the centres of interacting rods in the control volume.
    pub place_mm: Option<[Vec<f64>; 3]>,
}

/// The word `"isotropic"`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Isotropic {
    /// Every direction is equally likely.
    Isotropic,
}
