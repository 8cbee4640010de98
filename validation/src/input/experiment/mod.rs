//! Measured points of experiments: reading them, and comparing them with the model.
//!
//! Each source has a folder under a data folder, laid out as `validation/data`; the folder has pairs of files,
//! `NAME.toml` with the provenance and `NAME.csv` with the points. Formats and formulas are in
//! `docs/src/validation/points.md`.

mod bias;
mod compare;
mod comparison;
mod covariance;
mod curves;
mod keys;
mod model;
mod provenance;
mod provenance_file;
pub(crate) mod table;
#[cfg(test)]
mod tests;

pub use bias::{Bias, bias};
pub use compare::{Runs, alpha, compare};
pub use comparison::{AlphaFit, Comparison, Point};
pub use provenance::{Axis, Key, Layout, OBSERVABLES, PERCENT, Projection, Provenance, Stated, Time};

use crate::files::text::{Shown, line};
use crate::files::{FileError, bounded, entries};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// A paper with measured points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Source {
    /// The name of its folder.
    pub folder: &'static str,
    /// The paper of which points belong there.
    pub label: &'static str,
    /// The built-in scenes of its conditions.
    pub scenes: &'static [&'static str],
    /// The latest t/T of points that are judged; later points are read and drawn.
    pub judged_up_to: f64,
}

/// Fig. 4. Up to twenty periods: the oscillations are damped out long before, and a longer simulation only costs time.
pub const OKAGAWA_MASON: Source = Source {
    folder: "okagawa-mason-1973",
    label: "Okagawa & Mason (1973)",
    scenes: &["fig4-n20", "fig4-n50", "fig4-n100"],
    judged_up_to: 20.0,
};

/// Fig. 5. The paper claims agreement at t/T = 3, and says that the experiment drifts at later times for an unknown
/// reason.
pub const ANCZUROWSKI: Source = Source {
    folder: "anczurowski-cox-mason-1967",
    label: "Anczurowski, Cox & Mason (1967)",
    scenes: &["fig5"],
    judged_up_to: 3.0,
};

/// Every source.
pub const SOURCES: [Source; 2] = [OKAGAWA_MASON, ANCZUROWSKI];

/// A measured point in the model's units.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// Paper and figure by the points' own file, for a legend.
    pub label: String,
    /// Name of the observable: x1, x2 or x3.
    pub observable: &'static str,
    /// Time t/T.
    pub x: f64,
    /// The mean projection, as a fraction of the rod's length.
    pub y: f64,
    /// One standard deviation of x.
    pub u_x: f64,
    /// One standard deviation of y.
    pub u_y: f64,
}

/// The measured points of one observable under the conditions of one scene.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredCurve {
    /// Name of a built-in scene.
    pub scene: &'static str,
    /// Index of the observable: 0, 1, 2 for x1, x2, x3.
    pub channel: usize,
    /// The points, sorted by time.
    pub points: Vec<Measured>,
    /// Provenance of the points.
    pub provenance: Provenance,
}

/// All curves of a source under `data`; empty if the source has no folder or no files there.
pub fn read(data: &Path, source: &Source) -> Result<Vec<MeasuredCurve>, FileError> {
    let folder = data.join(source.folder);
    if !folder.exists() {
        return Ok(Vec::new());
    }
    let paths = entries(&folder)?;
    let with = |extension: &str| {
        let extension = extension.to_owned();
        paths.iter().filter(move |path| path.extension().is_some_and(|found| *found == *extension))
    };
    if let Some(alone) = with("csv").find(|path| !path.with_extension("toml").is_file()) {
        let message = "it has no provenance file of the same name beside it, ending in .toml";
        return Err(FileError::whole(alone, message));
    }
    let mut found: Vec<MeasuredCurve> = Vec::new();
    for path in with("toml") {
        let new = curves::read(path, source)?;
        let again =
            |curve: &&MeasuredCurve| found.iter().any(|old| (old.scene, old.channel) == (curve.scene, curve.channel));
        if let Some(curve) = new.iter().find(again) {
            let name = OBSERVABLES[curve.channel];
            let message = format!("{name} of {} is in another file already: points count once", curve.scene);
            return Err(FileError::whole(path, message));
        }
        found.extend(new);
    }
    Ok(found)
}

/// Reads all measured points under `data`, and returns warnings; fails if there are files in folders that no source
/// reads.
pub fn check(data: &Path) -> Result<Vec<String>, FileError> {
    let mut warnings = Vec::new();
    for source in &SOURCES {
        for Provenance { stated, unread, .. } in read(data, source)?.into_iter().map(|curve| curve.provenance) {
            warnings.extend(not_read(&data.join(source.folder).join(stated.file).with_extension("csv"), &unread));
        }
    }
    // Curves of one file have one provenance.
    warnings.dedup();
    let folders = SOURCES.map(|source| source.folder);
    let strange = |path: &PathBuf| path.is_dir() && !folders.iter().any(|folder| path.ends_with(folder));
    let inside = entries(data)?;
    let mut unread: Vec<PathBuf> = inside.iter().filter(|path| path.is_file()).cloned().collect();
    for folder in inside.iter().filter(|path| strange(path)) {
        unread.extend(entries(folder)?);
    }
    match unread.iter().find(|path| path.extension().is_some_and(|extension| extension == "csv")) {
        Some(path) => {
            let message = format!("the folder belongs to no source; allowed are {}", folders.join(", "));
            Err(FileError::whole(path, message))
        }
        None => Ok(warnings),
    }
}

/// The warning that a file has columns that are not read.
pub fn not_read(file: &Path, columns: &[String]) -> Option<String> {
    (!columns.is_empty()).then(|| format!("{}: not read: {}", file.shown(), line(&columns.join(", "))))
}

/// The checksums (CRC-32) of all files read under `data`, by their path relative to `data`.
pub fn digest(data: &Path) -> Result<BTreeMap<String, u32>, FileError> {
    let mut sums = BTreeMap::new();
    for source in &SOURCES {
        let folder = data.join(source.folder);
        if !folder.exists() {
            continue;
        }
        for path in entries(&folder)?.iter().filter(|path| path.is_file()) {
            let (_, crc32) =
                bounded::length_and_crc32(path, MOST_BYTES).map_err(|error| FileError::unreadable(path, &error))?;
            let name = path.strip_prefix(data).unwrap_or(path).display().to_string();
            sums.insert(name, crc32);
        }
    }
    Ok(sums)
}

/// What all files under `data` say of their points, in the order of the sources; empty without data.
pub fn stated(data: Option<&Path>) -> Result<Vec<Stated>, FileError> {
    let mut all: Vec<Stated> = Vec::new();
    for source in &SOURCES {
        let curves = data.map_or(Ok(Vec::new()), |data| read(data, source))?;
        all.extend(curves.into_iter().map(|curve| curve.provenance.stated));
    }
    all.dedup();
    Ok(all)
}

/// All measured points under the conditions of a scene, for pictures; empty without data.
pub fn points_for(data: Option<&Path>, scene_name: &str) -> Result<Vec<Measured>, FileError> {
    let mut points = Vec::new();
    for source in SOURCES.iter().filter(|source| source.scenes.contains(&scene_name)) {
        let curves = data.map_or(Ok(Vec::new()), |data| read(data, source))?;
        let here = curves.into_iter().filter(|curve| curve.scene == scene_name);
        points.extend(here.flat_map(|curve| curve.points));
    }
    Ok(points)
}

/// Size limit in bytes of a file of measured points.
pub const MOST_BYTES: u64 = 64 << 20;

/// The text of a file in UTF-8.
pub fn read_text(path: &Path) -> Result<String, FileError> {
    let text = bounded::text(path, MOST_BYTES).map_err(|error| FileError::unreadable(path, &error))?;
    let text = text.strip_prefix('\u{feff}').map_or(text.clone(), str::to_owned);
    if text.trim().is_empty() { Err(FileError::line(path, 1, "the file is empty")) } else { Ok(text) }
}
