//! The density of directions of rods with diffusion: values, maps, and that of φ alone.

use super::{Args, refused, unit};
use crate::{Failure, plot};
use shearbed_validation::files::text::Shown;
use shearbed_validation::oracle::reference::diffusing::Diffusing;
use shearbed_validation::oracle::reference::table::NoValue;
use shearbed_validation::present::plot::{Figure, Grid, Map};
use std::f64::consts::PI;
use std::path::Path;

/// Between two angles in the files, in degrees; a cell of a map is twice as wide.
const EVERY: u16 = 5;

/// A file with its contents and a note on it.
pub(super) type File<'a> = (&'a Path, Vec<u8>, String);

/// The files that are asked for at these times, and a note on each.
pub(super) fn files<'a>(args: &'a Args, rods: &Diffusing, times: &[f64]) -> Result<Vec<File<'a>>, Failure> {
    let heads = times.iter().map(|time| rods.head(*time, unit(args))).collect::<Result<Vec<_>, _>>();
    let seconds: Vec<f64> = heads.map_err(|why| refused(args, why))?.iter().filter_map(|head| head[0]).collect();
    let failed = |why| refused(args, NoValue::Diffusion(why));
    let note = |path: &Path, of: &str, error: f64| {
        format!("note: {}: {of}, to within {:.0e}\n", path.shown(), error.max(5e-12))
    };
    let mut files = Vec::new();
    if let Some(path) = &args.density {
        let (values, error) = rods.densities(&seconds, &directions()).map_err(failed)?;
        let bytes = if path.extension().is_some_and(|ending| ending == "csv") {
            csv(&seconds, &values, error).into_bytes()
        } else {
            plot::drawn(path, &map(&seconds, &values))?
        };
        files.push((path.as_path(), bytes, note(path, "ψ in 1/sr", error)));
    }
    if let Some(path) = &args.marginal {
        let angles: Vec<f64> = (0..360).step_by(EVERY.into()).map(|phi| f64::from(phi).to_radians()).collect();
        let (values, error) = rods.marginals(&seconds, &angles).map_err(failed)?;
        let mut text = String::from("time_s,phi_deg,psi_per_rad\n");
        for (time_s, values) in seconds.iter().zip(&values) {
            for (k, value) in values.iter().enumerate() {
                text += &format!("{time_s:?},{},{value:.*}\n", usize::from(EVERY) * k, decimals(error));
            }
        }
        files.push((path.as_path(), text.into_bytes(), note(path, "the density of φ in 1/rad", error)));
    }
    Ok(files)
}

fn decimals(error: f64) -> usize {
    (-(2.0 * error.max(1e-12)).log10()).clamp(0.0, 11.0) as usize
}

/// φ and θ in degrees: θ from axis 3 to the plane of 1 and 2, as the other half is the same.
fn angles() -> impl Iterator<Item = (u16, u16)> {
    (0..=90).step_by(EVERY.into()).flat_map(|theta| (0..360).step_by(EVERY.into()).map(move |phi| (phi, theta)))
}

fn directions() -> Vec<[f64; 3]> {
    let direction = |(phi, theta): (u16, u16)| {
        let [(sine, cosine), (along, down)] = [phi, theta].map(|angle| f64::from(angle).to_radians().sin_cos());
        [along * cosine, along * sine, down]
    };
    angles().map(direction).collect()
}

fn csv(seconds: &[f64], values: &[Vec<f64>], error: f64) -> String {
    let mut text = String::from("time_s,phi_deg,theta_deg,psi_per_sr\n");
    for (time_s, values) in seconds.iter().zip(values) {
        for ((phi, theta), value) in angles().zip(values) {
            text += &format!("{time_s:?},{phi},{theta},{value:.*}\n", decimals(error));
        }
    }
    text
}

/// A map of ψ for each time, in steps of a factor 2 about that of isotropic rods.
fn map(seconds: &[f64], values: &[Vec<f64>]) -> Figure {
    let classes = ["< ¼", "¼ to ½", "½ to 1", "1 to 2", "2 to 4", "4 to 8", "> 8"].map(str::to_owned);
    let class = |value: &f64| ((4.0 * PI * value).log2() + 3.0).floor().clamp(0.0, classes.len() as f64 - 1.0) as usize;
    let row_of = 360 / usize::from(EVERY);
    let of_time = |(time_s, values): (&f64, &Vec<f64>)| {
        let rows = values.chunks(row_of).step_by(2);
        let cells = rows.map(|row| row.iter().step_by(2).map(class).collect()).collect();
        Map { title: format!("t = {time_s} s"), cells, limit: Vec::new() }
    };
    let every = 2 * EVERY;
    let named = |angle: u16, each: u16| if angle.is_multiple_of(each) { angle.to_string() } else { String::new() };
    let grid = Grid {
        maps: seconds.iter().zip(values).map(of_time).collect(),
        columns: (0..360).step_by(every.into()).map(|phi| named(phi, 90)).collect(),
        values: (0..360).step_by(every.into()).map(|phi| phi.to_string()).collect(),
        rows: (0..=90).step_by(every.into()).map(|theta| named(theta, 30)).collect(),
        classes: classes.into(),
        shades: true,
        ..Grid::default()
    };
    Figure {
        title: "Density of directions over that of isotropic rods".into(),
        x_name: "φ (°)".into(),
        y_name: "θ (°)".into(),
        grid: Some(grid),
        ..Figure::default()
    }
}
