//! Where measured points come from: the TOML file beside each CSV file.

use super::Source;
use super::error::DataError;
use super::keys::{Table, line_of};
use crate::scenes;
use serde::Serialize;
use shearbed::{Scene, jeffery};
use toml::de::DeTable;

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
            Self::Seconds { shear_rate_per_s } => jeffery::period_s(shear_rate_per_s, aspect_ratio),
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
    ("concentration_per_cm3", |scene| {
        Some(&mut scene.interaction.as_mut()?.concentration_per_cm3)
    }),
    ("length_mm", |scene| Some(&mut scene.particles.length_mm)),
    ("aspect_ratio", |scene| Some(&mut scene.particles.aspect_ratio)),
    ("aspect_ratio_sd_percent", |scene| {
        Some(&mut scene.particles.aspect_ratio_sd_percent)
    }),
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

const CALIBRATION: &str = "the values of the axis's reference points, two different numbers at least";
const UNCERTAINTY: &str = "one standard deviation of what was read off, a number > 0 in the unit of quantity";
const QUANTITY_X: &str = "\"t_over_T\", \"t_s\" or \"strain\": the unit is in the name";
const QUANTITY_Y: &str = "\"fraction\" (of the rod's length) or \"mm\": the unit is in the name";

/// Reads a provenance file of a source.
pub(super) fn parse(file: &str, text: &str, source: &Source) -> Result<Provenance, DataError> {
    let document = DeTable::parse(text).map_err(|error| {
        let offset = error.span().map_or(0, |span| span.start);
        let message = error.message().trim_end().replace('\n', "; ");
        DataError::at(file, line_of(text, offset), message)
    })?;
    let all = Table::of_file(file, text, document.get_ref());
    all.only(&[
        "paper",
        "figure",
        "digitised_by",
        "tool",
        "date",
        "csv",
        "rods",
        "x",
        "y",
        "curve",
        "inputs",
    ])?;
    let layouts = "\"columns\" or \"webplotdigitizer\"";
    let csv = match all.text("csv", layouts)?.as_str() {
        "columns" => Layout::Columns,
        "webplotdigitizer" => Layout::WebPlotDigitizer,
        _ => return Err(all.refused("csv", layouts)),
    };
    let rods = match all.has("rods") {
        true => Some(all.number("rods", "a whole number ≥ 1", |n| n >= 1.0 && n.fract() == 0.0)?),
        false => None,
    };
    Ok(Provenance {
        paper: all.text("paper", "the paper that shows the points, as a text")?,
        figure: all.text("figure", "the figure or table, as a text")?,
        digitised_by: all.text("digitised_by", "who read the points off, as a text")?,
        tool: all.text("tool", "with which tool and version, as a text")?,
        date: date(&all)?,
        csv,
        rods,
        x: axis(&all.table("x", "the table [x] of the time axis")?, time)?,
        y: axis(
            &all.table("y", "the table [y] of the axis of projections")?,
            projection,
        )?,
        curves: curves(&all, csv, source)?,
        inputs: inputs(&all)?,
    })
}

fn date(all: &Table<'_>) -> Result<String, DataError> {
    let allowed = "the day of reading off, as \"YYYY-MM-DD\"";
    let date = all.text("date", allowed)?;
    let shape: String = date
        .chars()
        .map(|c| if c.is_ascii_digit() { '0' } else { c })
        .collect();
    match shape.as_str() {
        "0000-00-00" => Ok(date),
        _ => Err(all.refused("date", allowed)),
    }
}

fn axis<Q>(
    table: &Table<'_>,
    quantity: fn(&Table<'_>) -> Result<Q, DataError>,
) -> Result<Axis<Q>, DataError> {
    table.only(&[
        "quantity",
        "shear_rate_per_s",
        "calibration",
        "standard_uncertainty",
    ])?;
    let axis = Axis {
        quantity: quantity(table)?,
        calibration: table.numbers("calibration", CALIBRATION)?,
        standard_uncertainty: table.number("standard_uncertainty", UNCERTAINTY, |u| u > 0.0)?,
    };
    let (least, most) = axis.range();
    match least < most {
        true => Ok(axis),
        false => Err(table.refused("calibration", CALIBRATION)),
    }
}

fn time(table: &Table<'_>) -> Result<Time, DataError> {
    let quantity = match table.text("quantity", QUANTITY_X)?.as_str() {
        "t_over_T" => Time::Periods,
        "strain" => Time::Strain,
        "t_s" => {
            let allowed = "the experiment's shear rate, a number > 0, to turn seconds into periods";
            return Ok(Time::Seconds {
                shear_rate_per_s: table.number("shear_rate_per_s", allowed, |g| g > 0.0)?,
            });
        }
        _ => return Err(table.refused("quantity", QUANTITY_X)),
    };
    no_shear_rate(table)?;
    Ok(quantity)
}

fn projection(table: &Table<'_>) -> Result<Projection, DataError> {
    no_shear_rate(table)?;
    match table.text("quantity", QUANTITY_Y)?.as_str() {
        "fraction" => Ok(Projection::Fraction),
        "mm" => Ok(Projection::Millimetres),
        _ => Err(table.refused("quantity", QUANTITY_Y)),
    }
}

fn no_shear_rate(table: &Table<'_>) -> Result<(), DataError> {
    match table.has("shear_rate_per_s") {
        true => Err(table.refused("shear_rate_per_s", "only for x.quantity = \"t_s\"")),
        false => Ok(()),
    }
}

fn curves(all: &Table<'_>, csv: Layout, source: &Source) -> Result<Vec<Key>, DataError> {
    let tables = all.tables("curve", "one [[curve]] for each dataset of the CSV file")?;
    let mut keys: Vec<Key> = Vec::new();
    for table in &tables {
        table.only(&["scene", "observable", "dataset"])?;
        let scenes = format!("a scene of {}: {}", source.folder, source.scenes.join(", "));
        let name = table.text("scene", &scenes)?;
        let scene = source
            .scenes
            .iter()
            .find(|scene| **scene == name && scenes::find(scene).is_some());
        let scene = scene.ok_or_else(|| table.refused("scene", &scenes))?;
        let names = "\"x1\", \"x2\" or \"x3\"";
        let observable = table.text("observable", names)?;
        let channel = OBSERVABLES.iter().position(|name| *name == observable);
        let dataset = match table.has("dataset") {
            true if csv == Layout::Columns => {
                return Err(table.refused("dataset", "only in a WebPlotDigitizer export"));
            }
            true => Some(table.text("dataset", "the dataset's name, as a text")?),
            false => None,
        };
        let key = Key {
            scene,
            channel: channel.ok_or_else(|| table.refused("observable", names))?,
            dataset,
            line: table.line("observable"),
        };
        let first = keys.first().map(|key| key.scene);
        if csv == Layout::Columns && first.is_some_and(|first| first != key.scene) {
            return Err(table.refused("scene", "one scene in a file of csv = \"columns\""));
        }
        let repeats = |other: &Key| (other.scene, other.channel) == (key.scene, key.channel);
        if keys.iter().any(repeats) {
            return Err(table.refused("observable", "each observable of a scene once in a file"));
        }
        let same_dataset = |other: &Key| key.dataset.is_some() && other.dataset == key.dataset;
        if keys.iter().any(same_dataset) {
            return Err(table.refused("dataset", "each dataset once"));
        }
        keys.push(key);
    }
    Ok(keys)
}

fn inputs(all: &Table<'_>) -> Result<Vec<(usize, f64)>, DataError> {
    if !all.has("inputs") {
        return Ok(Vec::new());
    }
    let table = all.table("inputs", "the table [inputs] of standard uncertainties")?;
    table.only(&INPUTS.map(|(name, _)| name))?;
    let stated = INPUTS.iter().enumerate().filter(|(_, (name, _))| table.has(name));
    stated
        .map(|(index, (name, _))| {
            let allowed = "one standard deviation in the scene's unit, a number > 0";
            Ok((index, table.number(name, allowed, |u| u > 0.0)?))
        })
        .collect()
}
