//! Provenance of measured points: the content of the TOML file beside each CSV file.

use serde::Serialize;
use shearbed::Scene;
use shearbed::model::jeffery;

/// Layout of the CSV file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Layout {
    /// The project's columns, named in the first line.
    Columns,
    /// WebPlotDigitizer's export: two columns without a header, or all datasets side by side.
    WebPlotDigitizer,
}

/// The quantity along x; the column's name contains the unit.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub enum Time {
    /// t/T, T of the scene's mean aspect ratio.
    Periods,
    /// Seconds, in an experiment with this shear rate.
    Seconds {
        /// Shear rate G of the experiment in 1/s.
        shear_rate_per_s: f64,
    },
    /// Strain G·t.
    Strain,
}

impl Time {
    /// The name of the column.
    pub fn column(self) -> &'static str {
        match self {
            Self::Periods => "t_over_T",
            Self::Seconds { .. } => "t_s",
            Self::Strain => "strain",
        }
    }

    /// The length of one period (eq. 15) of rods of this aspect ratio, in this quantity.
    pub fn per_period(self, aspect_ratio: f64) -> f64 {
        match self {
            Self::Periods => 1.0,
            Self::Seconds { shear_rate_per_s } => jeffery::strain_per_period(aspect_ratio) / shear_rate_per_s.abs(),
            Self::Strain => jeffery::strain_per_period(aspect_ratio),
        }
    }
}

/// The quantity along y; the column's name contains the unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Projection {
    /// A fraction of the rod's length.
    Fraction,
    /// Per cent of the rod's length.
    Percent,
    /// Millimetres.
    Millimetres,
}

impl Projection {
    /// What the name of a column has after the observable's.
    pub fn suffix(self) -> &'static str {
        match self {
            Self::Fraction => "",
            Self::Percent => PERCENT,
            Self::Millimetres => "_mm",
        }
    }

    /// The length of a rod of `length_mm`, in this quantity.
    pub fn per_length(self, length_mm: f64) -> f64 {
        match self {
            Self::Fraction => 1.0,
            Self::Percent => 100.0,
            Self::Millimetres => length_mm,
        }
    }
}

/// The end of the name of a column in per cent.
pub const PERCENT: &str = "_percent";

/// A calibrated axis.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Axis<Q> {
    /// The quantity along the axis, with its unit.
    pub quantity: Q,
    /// The values of the reference points of the calibration, in that unit.
    pub calibration: Vec<f64>,
    /// One standard deviation of a reading, in that unit.
    pub standard_uncertainty: f64,
}

impl<Q> Axis<Q> {
    /// The smallest and the largest of the reference points.
    pub fn range(&self) -> (f64, f64) {
        let least = self.calibration.iter().copied().fold(f64::INFINITY, f64::min);
        let most = self.calibration.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        (least, most)
    }

    /// The allowed standard uncertainties: above the rounding of the model, and no larger than the axis.
    pub(super) fn uncertainties(&self) -> [f64; 2] {
        let (least, most) = self.range();
        [1e-12 * (most - least), most - least]
    }
}

/// The scene and observable that a dataset of the CSV file is compared with.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Key {
    /// Name of a built-in scene.
    pub scene: &'static str,
    /// Index of the observable: 0, 1, 2 for x1, x2, x3.
    pub channel: usize,
    /// Name of the dataset, if the file has several.
    pub dataset: Option<String>,
    /// Line number in the provenance file.
    pub line: usize,
}

/// The names of the observables, by channel.
pub const OBSERVABLES: [&str; 3] = ["x1", "x2", "x3"];

/// A key of `[inputs]`, and the value in a scene to which the uncertainty applies; `None` if the scene has no such
/// value.
type Input = (&'static str, fn(&mut Scene) -> Option<&mut f64>);

/// The experiment's conditions that may be uncertain.
pub(super) const INPUTS: [Input; 5] = [
    ("alpha", |scene| Some(&mut scene.interaction.as_mut()?.alpha)),
    ("concentration_per_cm3", |scene| scene.interaction.as_mut()?.concentration_per_cm3.as_mut()),
    ("length_mm", |scene| Some(&mut scene.particles.length_mm)),
    ("aspect_ratio", |scene| Some(&mut scene.particles.aspect_ratio)),
    ("aspect_ratio_sd_percent", |scene| Some(&mut scene.particles.aspect_ratio_sd_percent)),
];

/// The words of a provenance file on its points: claims of whoever wrote it.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Stated {
    /// The name of the file in its source's folder.
    pub file: String,
    /// The paper that shows the points.
    pub paper: String,
    /// The figure or table of the paper.
    pub figure: String,
    /// Who read them off.
    pub digitised_by: String,
    /// With which tool.
    pub tool: String,
    /// When, as YYYY-MM-DD.
    pub date: String,
}

impl Stated {
    /// Paper and figure; the paper is cut after `most` letters.
    pub fn short(&self, most: usize) -> String {
        let cut = self.paper.chars().count() > most;
        let paper: String = self.paper.chars().take(most).collect();
        format!("“{}{}”, {}", paper.trim_end(), if cut { "…" } else { "" }, self.figure)
    }
}

/// The content of a provenance file that the comparison uses.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Provenance {
    /// What the points are, by their own file: its paper and figure, who read them off, with what and when.
    pub stated: Stated,
    /// Layout of the CSV file.
    pub csv: Layout,
    /// Number of rods averaged in each point, if known.
    pub rods: Option<f64>,
    /// The time axis.
    pub x: Axis<Time>,
    /// The axis of projections.
    pub y: Axis<Projection>,
    /// The curves in the CSV file.
    pub curves: Vec<Key>,
    /// One standard deviation of each stated condition, with its index in the list of inputs.
    pub inputs: Vec<(usize, f64)>,
    /// Columns of the CSV file that are not read.
    pub unread: Vec<String>,
}
