//! LAMMPS dumps of quaternions: `dump custom` with `id` and the quaternion of `compute property/atom`
//! (docs.lammps.org/dump.html, docs.lammps.org/compute_property_atom.html).

use super::answer::{Answer, Collector};
use super::axes::Axes;
use super::layout::number;
use crate::files::FileError;
use crate::files::csv::Lines;
use crate::serve::problems::{Kind, LoadedProblem};
use nalgebra::{Quaternion, UnitQuaternion, Vector3};

/// Options for a LAMMPS dump.
#[derive(Clone, Copy, Debug)]
pub struct DumpOptions {
    /// The length of a time step in s, for a dump without `ITEM: TIME`.
    pub timestep_s: Option<f64>,
    /// The rod's axis in its body frame, 0 to 2; `None` for the axis that the columns shapex, shapey, shapez single
    /// out.
    pub rod_axis: Option<usize>,
}

/// The indices of the columns of a dump that are used.
struct Columns {
    count: usize,
    id: usize,
    quaternion: [usize; 4],
    shape: Option<[usize; 3]>,
}

/// Finds the columns by name, the quaternion (w, i, j, k) as that of the atoms or as c_ID[1] to c_ID[4] of a compute.
fn columns(header: &str) -> Result<Columns, String> {
    let names: Vec<_> = header.split_whitespace().collect();
    let at = |name: &str| names.iter().position(|found| *found == name);
    let all = |wanted: [&str; 4]| wanted.map(at).into_iter().collect::<Option<Vec<_>>>()?.try_into().ok();
    let compute = names.iter().find_map(|name| name.strip_suffix("[1]"));
    let of_compute = || {
        let names = [1, 2, 3, 4].map(|k| format!("{}[{k}]", compute.unwrap_or_default()));
        all(names.each_ref().map(String::as_str))
    };
    let quaternion = all(["quatw", "quati", "quatj", "quatk"])
        .or_else(|| all(["c_quatw", "c_quati", "c_quatj", "c_quatk"]))
        .or_else(of_compute)
        .ok_or("no quaternion: columns quatw quati quatj quatk or c_ID[1] to c_ID[4] are asked for")?;
    let shape = || Some([at("shapex")?, at("shapey")?, at("shapez")?]);
    Ok(Columns { count: names.len(), id: at("id").ok_or("no column id")?, quaternion, shape: shape() })
}

/// Reads a dump whose first line is `first`. Rod k is the atom with the (k+1)-th smallest id.
pub(super) fn read(
    mut lines: Lines,
    first: String,
    problem: &LoadedProblem,
    axes: Axes,
    options: &DumpOptions,
) -> Result<Answer, FileError> {
    if problem.problem.kind != Kind::Rods {
        return Err(lines.error(0, "a dump of quaternions answers problems about rods only"));
    }
    let mut collector = Collector::new(problem);
    let mut item = Some(first);
    let mut time_s: Option<f64> = None;
    let mut atoms = 0;
    while let Some(line) = item {
        match line.strip_prefix("ITEM:").map(str::trim) {
            Some("TIMESTEP") => {
                let step = value(&mut lines)?;
                // `ITEM: TIME`, if present, comes first.
                let by_steps = options.timestep_s.map(|length| step * length);
                if let (Some(stated), Some(by_steps)) = (time_s, by_steps)
                    && (stated - by_steps).abs() > SAME * stated.abs()
                {
                    let message = format!(
                        "ITEM: TIME is {stated}, by --timestep-s it is {by_steps}: leave --timestep-s out, or \
                         correct it"
                    );
                    return Err(lines.error(1, message));
                }
                time_s = time_s.or(by_steps);
            }
            Some("TIME") => time_s = Some(value(&mut lines)?),
            Some("NUMBER OF ATOMS") => {
                let found = value(&mut lines)?;
                atoms = problem.start.len();
                if found != atoms as f64 {
                    return Err(lines.error(1, format!("{found} atoms; the problem has {atoms} rods")));
                }
            }
            Some(units) if units.starts_with("UNITS") => drop(next(&mut lines)?),
            Some(bounds) if bounds.starts_with("BOX BOUNDS") => (0..3).try_for_each(|_| next(&mut lines).map(drop))?,
            Some(header) if header.starts_with("ATOMS") => {
                const NO_TIME: &str =
                    "no time: --timestep-s must say how long a step is, or the dump must have ITEM: TIME";
                let time = time_s.take().ok_or_else(|| lines.error(0, NO_TIME))?;
                let columns = columns(&header["ATOMS".len()..]).map_err(|message| lines.error(0, message))?;
                snapshot(&mut lines, &mut collector, &columns, atoms, time, axes, options)?;
            }
            _ => return Err(lines.error(0, "no ITEM of a dump")),
        }
        item = lines.next_line()?;
    }
    let (path, last) = (lines.path().to_owned(), lines.number().saturating_sub(1));
    collector.finish(&path, last)
}

fn next(lines: &mut Lines) -> Result<String, FileError> {
    lines.next_line()?.ok_or_else(|| lines.error(0, "the dump ends here"))
}

fn value(lines: &mut Lines) -> Result<f64, FileError> {
    number(next(lines)?.trim()).map_err(|message| lines.error(1, message))
}

fn snapshot(
    lines: &mut Lines,
    collector: &mut Collector<'_>,
    columns: &Columns,
    atoms: usize,
    time_s: f64,
    axes: Axes,
    options: &DumpOptions,
) -> Result<(), FileError> {
    // LAMMPS writes atoms in any order: the id identifies the rod.
    let mut found = Vec::new();
    for _ in 0..atoms {
        let line = next(lines)?;
        let fields: Vec<_> = line.split_whitespace().collect();
        if fields.len() != columns.count {
            let message = format!("{} fields; the snapshot has {} columns", fields.len(), columns.count);
            return Err(lines.error(fields.len(), message));
        }
        let at = |column: usize| number(fields[column]).map_err(|message| lines.error(column + 1, message));
        let [w, i, j, k] = columns.quaternion;
        let q = [at(w)?, at(i)?, at(j)?, at(k)?];
        let shape = columns.shape.map(|[x, y, z]| Ok([at(x)?, at(y)?, at(z)?])).transpose()?;
        let by_shape = shape.and_then(odd_one);
        if let (Some(given), Some(by_shape)) = (options.rod_axis, by_shape)
            && given != by_shape
        {
            let [given, by_shape] = [given, by_shape].map(|axis| ["x", "y", "z"][axis]);
            let message = format!(
                "--rod-axis {given}, but by shapex shapey shapez the rod lies along {by_shape}: leave --rod-axis out, \
                 or correct it"
            );
            return Err(lines.error(0, message));
        }
        let axis = options.rod_axis.or(by_shape).ok_or_else(|| {
            lines.error(0, "which axis of the body is the rod's? --rod-axis x, y or z, or columns shapex shapey shapez")
        })?;
        found.push((at(columns.id)?, lines.number(), direction(q, axis)));
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    for (rod, (id, line, p)) in found.iter().enumerate() {
        if rod > 0 && found[rod - 1].0 == *id {
            return Err(FileError::at(lines.path(), *line, columns.id as u64 + 1, format!("atom {id} is there twice")));
        }
        let ours = axes.to_ours((*p).into());
        let added = collector.add(*line, &[time_s, rod as f64], ours.to_vec());
        added.map_err(|(_, message)| FileError::at(lines.path(), *line, 0, message))?;
    }
    Ok(())
}

/// The largest relative difference of two times that count as the same: that of a time with six digits.
const SAME: f64 = 1e-5;

/// The axis whose diameter differs from the other two, which are equal.
fn odd_one([x, y, z]: [f64; 3]) -> Option<usize> {
    match (x == y, y == z, x == z) {
        (true, false, false) => Some(2),
        (false, true, false) => Some(0),
        (false, false, true) => Some(1),
        _ => None,
    }
}

/// An axis of the body in space, by the quaternion w + ix + jy + kz.
fn direction([w, i, j, k]: [f64; 4], axis: usize) -> Vector3<f64> {
    UnitQuaternion::new_normalize(Quaternion::new(w, i, j, k)) * Vector3::ith(axis, 1.0)
}

#[cfg(test)]
mod tests {
    use super::odd_one;

    #[test]
    fn the_axis_of_a_body_is_the_one_whose_diameter_differs() {
        assert_eq!(odd_one([3.0, 1.0, 1.0]), Some(0));
        assert_eq!(odd_one([1.0, 3.0, 1.0]), Some(1));
        assert_eq!(odd_one([1.0, 1.0, 3.0]), Some(2));
        assert_eq!([[1.0, 1.0, 1.0], [1.0, 2.0, 3.0]].map(odd_one), [None; 2]);
    }
}
