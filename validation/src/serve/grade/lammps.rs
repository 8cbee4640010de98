//! LAMMPS dumps of quaternions: `dump custom` with `id` and the quaternion of `compute property/atom`
//! (docs.lammps.org/dump.html, docs.lammps.org/compute_property_atom.html).

use super::answer::{Answer, Collector};
use super::axes::Axes;
use super::layout::{FileOptions, number};
use crate::files::FileError;
use crate::files::csv::Lines;
use crate::methods::integrators::apart_rad;
use crate::serve::problems::{Kind, LoadedProblem};
use nalgebra::{Quaternion, UnitQuaternion, Vector3};

/// Options for a LAMMPS dump.
#[derive(Clone, Copy, Debug, Default)]
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
    /// Of w, i, j, k, in each order that the header allows.
    quaternion: Vec<[usize; 4]>,
    shape: Option<[usize; 3]>,
}

/// Finds the columns by name, the quaternion as that of the atoms or as four columns of a compute, whose order only its
/// input script tells: w, i, j, k or i, j, k, w.
fn columns(header: &str, options: &FileOptions) -> Result<Columns, String> {
    let names: Vec<_> = header.split_whitespace().collect();
    let given: Option<Vec<_>> = options.columns.as_ref().map(|given| given.iter().map(String::as_str).collect());
    let names = given.filter(|given| given.len() == names.len()).unwrap_or(names);
    let at = |name: &str| names.iter().position(|found| *found == name);
    fn all<const N: usize>(found: [Option<usize>; N]) -> Option<[usize; N]> {
        found.into_iter().collect::<Option<Vec<_>>>()?.try_into().ok()
    }
    let of = |stem: &str, k: usize| at(&format!("{stem}[{k}]"));
    let stems = || names.iter().filter_map(|name| name.strip_suffix("[1]"));
    let four = || stems().find_map(|stem| all([1, 2, 3, 4].map(|k| of(stem, k))));
    let named =
        ["", "c_"].iter().find_map(|head| all(["w", "i", "j", "k"].map(|axis| at(&format!("{head}quat{axis}")))));
    let quaternion = match (named, four()) {
        (Some(named), _) => vec![named],
        (None, Some([a, b, c, d])) => vec![[a, b, c, d], [d, a, b, c]],
        _ => return Err("no quaternion: columns quatw quati quatj quatk or c_ID[1] to c_ID[4] are asked for".into()),
    };
    let three = || stems().find_map(|stem| all([1, 2, 3].map(|k| of(stem, k))).filter(|_| of(stem, 4).is_none()));
    let shape = all(["x", "y", "z"].map(|axis| at(&format!("shape{axis}")))).or_else(three);
    Ok(Columns { count: names.len(), id: at("id").ok_or("no column id")?, quaternion, shape })
}

/// Reads a dump whose first line is `first`. Rod k is the atom with the (k+1)-th smallest id.
pub(super) fn read(
    mut lines: Lines,
    first: String,
    problem: &LoadedProblem,
    form: &FileOptions,
    options: &DumpOptions,
) -> Result<Answer, FileError> {
    if problem.problem.kind != Kind::Rods {
        return Err(lines.error(0, "a dump of quaternions answers problems about rods only"));
    }
    let mut collector = Collector::new(problem);
    let mut item = Some(first);
    let mut time_s: Option<f64> = None;
    let mut atoms = 0;
    let mut order = None;
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
                let columns = columns(&header["ATOMS".len()..], form).map_err(|message| lines.error(0, message))?;
                let line = lines.number();
                let found = snapshot(&mut lines, &columns, atoms, options)?;
                let order = match order {
                    Some(order) => order,
                    None => *order.insert(
                        ordered(&found, time, problem, form.axes)
                            .map_err(|why| FileError::at(lines.path(), line, 0, why))?,
                    ),
                };
                for (rod, (id, line, all)) in found.iter().enumerate() {
                    if rod > 0 && found[rod - 1].0 == *id {
                        let message = format!("atom {id} is there twice");
                        return Err(FileError::at(lines.path(), *line, columns.id as u64 + 1, message));
                    }
                    let ours = form.axes.to_ours(all[order].into());
                    let added = collector.add(*line, &[time, rod as f64], ours.to_vec());
                    added.map_err(|(_, message)| FileError::at(lines.path(), *line, 0, message))?;
                }
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

/// The id of an atom, its line, and its direction by each order of the quaternion.
type Atom = (f64, u64, Vec<Vector3<f64>>);

/// Which order of the quaternion gives the problem's directions at t = 0, if the header allows two.
fn ordered(atoms: &[Atom], time_s: f64, problem: &LoadedProblem, axes: Axes) -> Result<usize, String> {
    /// Six digits and an axis of the body that is given by hand.
    const NEAR: f64 = 1e-3;
    if atoms.iter().all(|(.., all)| all.len() == 1) {
        return Ok(0);
    }
    let starts = |order: &usize| {
        let near = |(atom, start): (&Atom, &[f64; 3])| {
            apart_rad(&Vector3::from(axes.to_ours(atom.2[*order].into())), &Vector3::from(*start)) < NEAR
        };
        time_s == 0.0 && atoms.iter().zip(&problem.start).all(near)
    };
    let fitting: Vec<_> = [0, 1].into_iter().filter(starts).collect();
    match fitting[..] {
        [order] => Ok(order),
        _ => Err(
            "the order of the quaternion is not known: the header has c_ID[1] to c_ID[4], and no snapshot at t = 0 \
                  comes first that shows the start; --columns names the columns, as in id,quatw,quati,quatj,quatk"
                .to_owned(),
        ),
    }
}

/// The largest difference of a quaternion's norm from 1: that of three digits.
const UNIT: f64 = 1e-3;

fn snapshot(lines: &mut Lines, columns: &Columns, atoms: usize, options: &DumpOptions) -> Result<Vec<Atom>, FileError> {
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
        let of = |[w, i, j, k]: &[usize; 4]| {
            let quaternion = [at(*w)?, at(*i)?, at(*j)?, at(*k)?];
            let norm = quaternion.iter().map(|x| x * x).sum::<f64>().sqrt();
            if (norm - 1.0).abs() > UNIT {
                let message = format!("the quaternion has the norm {norm:.4}; that of a rotation is 1");
                return Err(lines.error(*w + 1, message));
            }
            Ok(direction(quaternion, axis))
        };
        let all = columns.quaternion.iter().map(of).collect::<Result<_, FileError>>()?;
        found.push((at(columns.id)?, lines.number(), all));
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    Ok(found)
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
