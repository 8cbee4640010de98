//! Where measured points come from: what the TOML file beside each CSV file says.

use serde::Serialize;
use shearbed::Scene;
use shearbed::model::jeffery;

/// How the CSV file is laid out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Layout {
    /// The project's columns, named in the first line.
    Columns,
    /// WebPlotDigitizer's export: two columns without a header, or all datasets side by side.
    WebPlotDigitizer,
}

/// The quantity along x; the name holds the unit.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub enum Time {
    /// t/T, T of the scene's mean aspect ratio.
    Periods,
    /// Seconds, in an experiment of this shear rate.
    Seconds {
        /// G of the experiment.
        shear_rate_per_s: f64,
    },
    /// G·t.
    Strain,
}

impl Time {
    /// The name of its column.
    pub fn column(self) -> &'static str {
        match self {
            Self::Periods => "t_over_T",
            Self::Seconds { .. } => "t_s",
            Self::Strain => "strain",
        }
    }

    /// How much of it is one period of rods of this aspect ratio (eq. 15).
    pub fn per_period(self, aspect_ratio: f64) -> f64 {
        match self {
            Self::Periods => 1.0,
            Self::Seconds { shear_rate_per_s } => {
                jeffery::strain_per_period(aspect_ratio) / shear_rate_per_s.abs()
            }
            Self::Strain => jeffery::strain_per_period(aspect_ratio),
        }
    }
}

/// The quantity along y; the name holds the unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Projection {
    /// Of the rod's length.
    Fraction,
    /// Millimetres.
    Millimetres,
}

/// A calibrated axis.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Axis<Q> {
    /// What is drawn along it, and in which unit.
    pub quantity: Q,
    /// The values of the reference points by which it was calibrated, in that unit.
    pub calibration: Vec<f64>,
    /// One standard deviation of what was read off, in that unit.
    pub standard_uncertainty: f64,
}

impl<Q> Axis<Q> {
    /// The least and the most of the reference points.
    pub fn range(&self) -> (f64, f64) {
        let least = self.calibration.iter().copied().fold(f64::INFINITY, f64::min);
        let most = self.calibration.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        (least, most)
    }
}

/// Which scene and observable a dataset of the CSV file is compared with.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Key {
    /// A built-in scene.
    pub scene: &'static str,
    /// 0, 1, 2 for x1, x2, x3.
    pub channel: usize,
    /// The dataset's name, where the file has several.
    pub dataset: Option<String>,
    /// Its line in the provenance file.
    pub line: usize,
}

/// The names of the observables, by channel.
pub const OBSERVABLES: [&str; 3] = ["x1", "x2", "x3"];

/// A key of `[inputs]` with the value in a scene that it is an uncertainty of; `None` where the scene has none.
type Input = (&'static str, fn(&mut Scene) -> Option<&mut f64>);

/// What the experiment's conditions are known to only so well.
pub(super) const INPUTS: [Input; 5] = [
    ("alpha", |scene| Some(&mut scene.interaction.as_mut()?.alpha)),
    ("concentration_per_cm3", |scene| scene.interaction.as_mut()?.concentration_per_cm3.as_mut()),
    ("length_mm", |scene| Some(&mut scene.particles.length_mm)),
    ("aspect_ratio", |scene| Some(&mut scene.particles.aspect_ratio)),
    ("aspect_ratio_sd_percent", |scene| Some(&mut scene.particles.aspect_ratio_sd_percent)),
];

/// Everything a provenance file says.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Provenance {
    /// The paper that shows the points.
    pub paper: String,
    /// Its figure or table.
    pub figure: String,
    /// Who read them off.
    pub digitised_by: String,
    /// With which tool and version.
    pub tool: String,
    /// When, as YYYY-MM-DD.
    pub date: String,
    /// How the CSV file is laid out.
    pub csv: Layout,
    /// Rods that each point is a mean over, where that is known.
    pub rods: Option<f64>,
    /// The time axis.
    pub x: Axis<Time>,
    /// The axis of projections.
    pub y: Axis<Projection>,
    /// What is in the CSV file.
    pub curves: Vec<Key>,
    /// One standard deviation of the experiment's conditions, by the index in the list of inputs.
    pub inputs: Vec<(usize, f64)>,
}
