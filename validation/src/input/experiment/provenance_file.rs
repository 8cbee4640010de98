//! Reads a provenance file, with errors that name the line, the key, its value and what is allowed.

use super::Source;
use super::keys::{Keys, document};
use super::provenance::{Axis, INPUTS, Key, Layout, OBSERVABLES, Projection, Provenance, Stated, Time};
use crate::files::FileError;
use crate::input::scenes;
use std::path::Path;
use toml::value::Datetime;

const CALIBRATION: &str = "the values of the axis's reference points, two different numbers at least";
const UNCERTAINTY: &str = "one standard deviation of what was read off, a number > 0 in the unit of quantity";
const QUANTITY_X: &str = "\"t_over_T\", \"t_s\" or \"strain\": the unit is in the name";
const QUANTITY_Y: &str = "\"fraction\" or \"percent\" (of the rod's length) or \"mm\": the unit is in the name";

/// Reads a provenance file of a source.
pub(super) fn parse(file: &str, text: &str, source: &Source) -> Result<Provenance, FileError> {
    let document = document(file, text)?;
    let all = Keys::of_file(file, &document);
    const KNOWN: &str = "paper figure digitised_by tool date csv rods aspect_ratio x y curve inputs";
    all.only(&KNOWN.split(' ').collect::<Vec<_>>())?;
    let layouts = "\"columns\" or \"webplotdigitizer\"";
    let csv = match all.text("csv", layouts)?.as_str() {
        "columns" => Layout::Columns,
        "webplotdigitizer" => Layout::WebPlotDigitizer,
        _ => return Err(all.refused("csv", layouts)),
    };
    let whole = |n: f64| n >= 1.0 && n.fract() == 0.0;
    let rods = all.has("rods").then(|| all.number("rods", "a whole number ≥ 1", whole)).transpose()?;
    let curves = curves(&all, csv, source)?;
    own_aspect_ratio(&all, &curves)?;
    let day = "the day of reading off, as \"YYYY-MM-DD\"";
    let stated = Stated {
        file: Path::new(file).file_name().unwrap_or_default().display().to_string(),
        paper: all.text("paper", "the paper that shows the points, as a text")?,
        figure: all.text("figure", "the figure or table, as a text")?,
        digitised_by: all.text("digitised_by", "who read the points off, as a text")?,
        tool: all.text("tool", "with which tool and version, as a text")?,
        date: all.text("date", day)?,
    };
    // A calendar day, without a time.
    if !stated.date.parse::<Datetime>().is_ok_and(|day| day.date.is_some() && day.time.is_none()) {
        return Err(all.refused("date", day));
    }
    Ok(Provenance {
        stated,
        csv,
        rods,
        x: axis(&all.table("x", "the table [x] of the time axis")?, time)?,
        y: axis(&all.table("y", "the table [y] of the axis of projections")?, projection)?,
        curves,
        inputs: inputs(&all)?,
        unread: Vec::new(),
    })
}

pub(super) fn uncertainty(least: f64, most: f64) -> String {
    format!("one standard deviation from {least:?} to {most:?}, the width of the axis")
}

fn axis<Q>(table: &Keys<'_>, quantity: fn(&Keys<'_>) -> Result<Q, FileError>) -> Result<Axis<Q>, FileError> {
    table.only(&["quantity", "shear_rate_per_s", "calibration", "standard_uncertainty"])?;
    let axis = Axis {
        quantity: quantity(table)?,
        calibration: table.numbers("calibration", CALIBRATION)?,
        standard_uncertainty: table.number("standard_uncertainty", UNCERTAINTY, |u| u > 0.0)?,
    };
    let (least, most) = axis.range();
    if least >= most {
        return Err(table.refused("calibration", CALIBRATION));
    }
    let [least, most] = axis.uncertainties();
    if (least..=most).contains(&axis.standard_uncertainty) {
        Ok(axis)
    } else {
        Err(table.refused("standard_uncertainty", &uncertainty(least, most)))
    }
}

fn time(table: &Keys<'_>) -> Result<Time, FileError> {
    let quantity = match table.text("quantity", QUANTITY_X)?.as_str() {
        "t_over_T" => Time::Periods,
        "strain" => Time::Strain,
        "t_s" => {
            let allowed = "the experiment's shear rate, a number > 0, to turn seconds into periods";
            return Ok(Time::Seconds { shear_rate_per_s: table.number("shear_rate_per_s", allowed, |g| g > 0.0)? });
        }
        _ => return Err(table.refused("quantity", QUANTITY_X)),
    };
    no_shear_rate(table)?;
    Ok(quantity)
}

fn projection(table: &Keys<'_>) -> Result<Projection, FileError> {
    no_shear_rate(table)?;
    match table.text("quantity", QUANTITY_Y)?.as_str() {
        "fraction" => Ok(Projection::Fraction),
        "percent" => Ok(Projection::Percent),
        "mm" => Ok(Projection::Millimetres),
        _ => Err(table.refused("quantity", QUANTITY_Y)),
    }
}

fn no_shear_rate(table: &Keys<'_>) -> Result<(), FileError> {
    if table.has("shear_rate_per_s") {
        return Err(table.refused("shear_rate_per_s", "only for x.quantity = \"t_s\""));
    }
    Ok(())
}

fn curves(all: &Keys<'_>, csv: Layout, source: &Source) -> Result<Vec<Key>, FileError> {
    let tables = all.tables("curve", "one [[curve]] for each dataset of the CSV file")?;
    let mut keys: Vec<Key> = Vec::new();
    for table in &tables {
        table.only(&["scene", "observable", "dataset"])?;
        let scenes = format!("a scene of {}: {}", source.folder, source.scenes.join(", "));
        let name = table.text("scene", &scenes)?;
        let scene = source.scenes.iter().find(|scene| **scene == name && scenes::find(scene).is_some());
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

/// Fails if the points are of rods with another aspect ratio than the scenes'.
fn own_aspect_ratio(all: &Keys<'_>, curves: &[Key]) -> Result<(), FileError> {
    if !all.has("aspect_ratio") {
        return Ok(());
    }
    for key in curves {
        let own = scenes::scene(key.scene).map_or(f64::NAN, |scene| scene.particles.aspect_ratio);
        let allowed = format!(
            "the mean r_e of the measured rods, {own} in {}; the paper leaves its points of r_e = 3.96 out (Results, \
             after Fig. 5): rods that start parallel in the shear plane do not disturb each other in this model",
            key.scene
        );
        all.number("aspect_ratio", &allowed, |given| given == own)?;
    }
    Ok(())
}

fn inputs(all: &Keys<'_>) -> Result<Vec<(usize, f64)>, FileError> {
    if !all.has("inputs") {
        return Ok(Vec::new());
    }
    let table = all.table("inputs", "the table [inputs] of standard uncertainties")?;
    table.only(&INPUTS.map(|(name, _)| name))?;
    let stated = INPUTS.iter().enumerate().filter(|(_, (name, _))| table.has(name));
    stated
        .map(|(index, (name, _))| {
            let allowed = "one standard deviation in the scene's unit, a number from 1e-6 to 1e6";
            Ok((index, table.number(name, allowed, |u| (1e-6..=1e6).contains(&u))?))
        })
        .collect()
}
