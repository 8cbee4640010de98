//! A table of rods in CSV, in the columns of `rods.csv`.

use crate::files::FileError;
use crate::files::csv::{Row, Table};
use crate::files::text::{Shown, start};
use shearbed::model::orientation::from_degrees;
use shearbed::scene::OwnRods;
use std::path::Path;

/// The columns that are read, in groups; a file has all columns of a group or none.
const P: [&str; 3] = ["p1", "p2", "p3"];
const PLACE: [&str; 3] = ["x1_mm", "x2_mm", "x3_mm"];
const ASPECT_RATIO: [&str; 1] = ["aspect_ratio"];
const LENGTH: [&str; 1] = ["length_mm"];
const ANGLES: [&str; 2] = ["phi_deg", "theta_deg"];

/// The column of the rods' numbers, ascending without repetition.
const ROD: &str = "rod";

/// The columns of replica, time and strain: each has the same value in all rows.
const ONE_VALUE: [&str; 3] = ["replica", "time_s", "strain"];

/// Another column that the file may have, as `rods.csv` does; it is ignored.
const OTHERS: [&str; 1] = ["collided"];

/// The largest deviation of |p| from 1, as for directions of three decimals; p is then normalised.
const OFF_UNIT: f64 = 1e-3;

/// The same without a warning, as for directions of five or more decimals.
const ROUNDED: f64 = 1e-5;

/// The columns of a group in the file, `None` if it has none.
type Group<const K: usize> = Option<[usize; K]>;

fn group<const K: usize>(names: [&str; K], table: &Table<&[u8]>) -> Result<Group<K>, FileError> {
    let places = names.map(|name| table.place(name));
    match names.iter().zip(places).find(|(_, place)| place.is_none()) {
        None => Ok(Some(places.map(Option::unwrap_or_default))),
        Some(_) if places.iter().all(Option::is_none) => Ok(None),
        Some((name, _)) => Err(table.error(format!("column {name} is missing; {} go together", names.join(", ")))),
    }
}

/// The numbers of a row in a group.
fn values<const K: usize>(
    group: Group<K>,
    number: impl Fn(usize) -> Result<f64, FileError>,
) -> Result<Option<[f64; K]>, FileError> {
    let Some(places) = group else { return Ok(None) };
    let mut values = [0.0; K];
    for (value, place) in values.iter_mut().zip(places) {
        *value = number(place)?;
    }
    Ok(Some(values))
}

/// The rods, row by row, the line of each, and a warning where directions had to be normalised.
pub(super) fn read(path: &Path, bytes: &[u8]) -> Result<(OwnRods, Vec<u64>, Option<String>), FileError> {
    let mut table = Table::new(path, bytes)?;
    let described = P.iter().chain(&PLACE).chain(&ASPECT_RATIO).chain(&LENGTH).chain(&ANGLES);
    let known: Vec<&str> = described.chain([&ROD]).chain(&ONE_VALUE).chain(&OTHERS).copied().collect();
    if let Some(name) = table.names().iter().find(|name| !known.contains(&name.as_str())) {
        // The start alone, so that a file of other content is not shown in full.
        let name = start(name, 20);
        let known = known.join(", ");
        return Err(table
            .error(format!("unknown column {name:?}; allowed are those of rods.csv, separated by commas: {known}")));
    }
    let (p, places) = (group(P, &table)?, group(PLACE, &table)?);
    let (shape, length) = (group(ASPECT_RATIO, &table)?, group(LENGTH, &table)?);
    let angles = group(ANGLES, &table)?;
    if p.is_some() && angles.is_some() {
        return Err(
            table.error("p1, p2, p3 and phi_deg, theta_deg: each gives the directions; one of the two is allowed")
        );
    }
    if p.is_none() && angles.is_none() && places.is_none() && shape.is_none() && length.is_none() {
        let needed = "p1, p2 and p3, phi_deg and theta_deg, aspect_ratio, length_mm, or x1_mm, x2_mm and x3_mm";
        return Err(table.error(format!("no column of what a rod is: {needed}")));
    }
    let mut order = Order::new(&table);
    let mut rods = OwnRods::default();
    let (mut lines, mut most_off) = (Vec::new(), 0f64);
    while let Some(row) = table.next_row()? {
        let number = |place: usize| row.finite(place);
        let positive = |place: usize| row.positive(place, "a finite number > 0");
        order.next(&row)?;
        if let Some(direction) = values(p, number)? {
            // Only exactly rounded operations, for the same bits on every machine.
            let length = direction.map(|x| x * x).iter().sum::<f64>().sqrt();
            most_off = most_off.max((length - 1.0).abs());
            if (length - 1.0).abs() > OFF_UNIT {
                let [p1, p2, p3] = direction;
                let allowed = format!("1 within {OFF_UNIT:e} is allowed");
                return Err(row.error(format!("p = ({p1}, {p2}, {p3}) has length {length}: {allowed}")));
            }
            push(&mut rods.p, direction.map(|x| x / length));
        }
        if let Some([phi_deg, theta_deg]) = values(angles, number)? {
            push(&mut rods.p, from_degrees(phi_deg, theta_deg).into_inner().into());
        }
        // Free rods have no position, and empty cells in rods.csv.
        if !places.is_some_and(|places| places.iter().all(|place| row.is_blank(*place))) {
            if rods.place_mm.is_none() && !lines.is_empty() && places.is_some() {
                return Err(row.error("the rods before have no place: all have one, or none"));
            }
            if let Some(x) = values(places, number)? {
                push(&mut rods.place_mm, x);
            }
        } else if rods.place_mm.is_some() {
            return Err(row.error("the rods before have a place: all have one, or none"));
        }
        if let Some([r]) = values(shape, positive)? {
            rods.aspect_ratio.get_or_insert_default().push(r);
        }
        if let Some([a]) = values(length, positive)? {
            rods.length_mm.get_or_insert_default().push(a);
        }
        lines.push(row.line);
    }
    let normalised = || {
        format!(
            "{}: directions have lengths that differ from 1 by up to {most_off:.1e}, and are normalised",
            path.shown()
        )
    };
    Ok((rods, lines, (most_off > ROUNDED).then(normalised)))
}

fn push(axes: &mut Option<[Vec<f64>; 3]>, values: [f64; 3]) {
    for (axis, value) in axes.get_or_insert_default().iter_mut().zip(values) {
        axis.push(value);
    }
}

/// Checks that rows belong to one replica at one time and are in the order of the rods' numbers.
///
/// Rods are read row by row: rows in another order, or of two times or replicas, would be another suspension.
struct Order {
    rod: Option<usize>,
    one_value: [Option<usize>; ONE_VALUE.len()],
    /// The last rod; and the line and the values of the first row.
    last: Option<f64>,
    first: Option<(u64, [Option<f64>; ONE_VALUE.len()])>,
}

impl Order {
    fn new(table: &Table<&[u8]>) -> Self {
        let one_value = ONE_VALUE.map(|name| table.place(name));
        Self { rod: table.place(ROD), one_value, last: None, first: None }
    }

    fn next(&mut self, row: &Row<'_>) -> Result<(), FileError> {
        let read = |place: Option<usize>| place.map(|place| row.finite(place)).transpose();
        let mut values = [None; ONE_VALUE.len()];
        for (value, place) in values.iter_mut().zip(self.one_value) {
            *value = read(place)?;
        }
        let (first_line, first) = *self.first.get_or_insert((row.line, values));
        for ((name, value), first) in ONE_VALUE.iter().zip(values).zip(first) {
            if let (Some(value), Some(first)) = (value, first)
                && value != first
            {
                return Err(row.error(format!(
                    "{name} = {value} is not allowed: line {first_line} has {first}, and a start has the rods of one \
                     replica at one time; keep the rows of one"
                )));
            }
        }
        let Some(rod) = read(self.rod)? else {
            return Ok(());
        };
        if !(rod >= 0.0 && rod.fract() == 0.0) {
            return Err(row.error(format!("rod = {rod} is not allowed: expected a whole number from 0 on")));
        }
        match self.last.replace(rod) {
            Some(last) if rod <= last => Err(row.error(format!(
                "rod = {rod} is not allowed after rod {last}: each rod has one row; sort the rows by rod"
            ))),
            _ => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<(OwnRods, Vec<u64>), FileError> {
        super::read(Path::new("f"), text.as_bytes()).map(|(own, lines, _)| (own, lines))
    }

    /// Three decimals are taken, with a warning, and angles are the same directions.
    #[test]
    fn directions_are_rounded_or_angles() {
        let of = |text: &str| super::read(Path::new("f"), text.as_bytes()).unwrap();
        let (rounded, _, warning) = of("p1,p2,p3\n0.577,0.577,0.577\n0,0,1\n");
        assert_eq!(
            warning.unwrap(),
            "f: directions have lengths that differ from 1 by up to 6.1e-4, and are normalised"
        );
        let (exact, _, none) = of("phi_deg,theta_deg\n45,54.735610317245346\n0,0\n");
        assert_eq!(none, None);
        for (rounded, exact) in rounded.p.unwrap().iter().flatten().zip(exact.p.unwrap().iter().flatten()) {
            assert!((rounded - exact).abs() < 1e-15, "{rounded} {exact}");
        }
        assert_eq!(of("p1,p2,p3\n0.70711,0.70711,0\n").2, None);
    }

    /// The error without the file's name.
    fn refused(text: &str) -> String {
        read(text).unwrap_err().to_string().split_off("f:".len())
    }

    #[test]
    fn rows_are_rods_in_any_order_of_columns() {
        let text = "rod,p3,p1,p2,time_s,replica\n0,0.8,0.6,0,2.5,1\n7, -0.70711 ,0,0.70711,2.5,1\n";
        let (own, lines) = read(text).unwrap();
        let [p1, p2, p3] = own.p.unwrap();
        assert_eq!((p1, p3[0], lines), (vec![0.6, 0.0], 0.8, vec![2, 3]));
        // 0.70711² · 2 = 1.0000091 is normalised.
        assert!((p2[1] - 0.5f64.sqrt()).abs() < 1e-15 && (p3[1] + 0.5f64.sqrt()).abs() < 1e-15);
        assert!(own.aspect_ratio.is_none() && own.length_mm.is_none() && own.place_mm.is_none());

        let text = "length_mm,x2_mm,x1_mm,x3_mm,aspect_ratio\n0.5,2,1,3,11\n0.7,5,4,6,12\n";
        let (own, lines) = read(text).unwrap();
        assert_eq!((own.length_mm, own.aspect_ratio), (Some(vec![0.5, 0.7]), Some(vec![11.0, 12.0])));
        let places = [[1.0, 4.0], [2.0, 5.0], [3.0, 6.0]].map(Vec::from);
        assert_eq!((own.place_mm, own.p, lines), (Some(places), None, vec![2, 3]));
        // Free rods, as in rods.csv.
        let (own, _) = read("length_mm,x1_mm,x2_mm,x3_mm\n0.5,,,\n0.5,,,\n").unwrap();
        assert_eq!((own.place_mm, own.length_mm), (None, Some(vec![0.5, 0.5])));
    }

    #[test]
    fn what_is_wrong_is_named_with_its_line() {
        for (text, said) in [
            ("p1,p2\n1,0\n", "1: column p3 is missing; p1, p2, p3 go together"),
            ("x1_mm\n1\n", "1: column x2_mm is missing"),
            ("rod,time_s\n0,0\n", "1: no column of what a rod is"),
            ("length_mm\n1\n0\n", "3: column length_mm: `0` is not allowed: expected a finite number > 0"),
            ("length_mm\n-1\n", "2: column length_mm: `-1` is not allowed"),
            ("length_mm\nNaN\n", "2: column length_mm: `NaN` is not allowed: expected a finite number"),
            ("aspect_ratio\n-2\n", "2: column aspect_ratio: `-2` is not allowed"),
            ("x1_mm,x2_mm,x3_mm\n1,2,3\n,,\n", "3: the rods before have a place"),
            ("x1_mm,x2_mm,x3_mm\n,,\n1,2,3\n", "3: the rods before have no place"),
            ("x1_mm,x2_mm,x3_mm\n1,,3\n", "2: column x2_mm: `` is not allowed: expected a finite number"),
            ("p1,p2,p3,p1\n1,0,0,1\n", "1: column `p1` is there twice"),
            ("p1,p2,p3,theta\n1,0,0,1\n", "1: unknown column \"theta\""),
            ("p1,p2,p3\n1,0,0\n1,zero,0\n", "3: column p2: `zero` is not allowed"),
            ("p1,p2,p3\n1,0,nan\n", "2: column p3: `nan` is not allowed"),
            ("p1,p2,p3\n1,0,1e999\n", "2: column p3: `1e999` is not allowed"),
            ("p1,p2,p3\n1,0,0\n0.6,0.8,0.1\n", "3: p = (0.6, 0.8, 0.1) has length 1.00498"),
            ("p1,p2,p3\n0.57,0.57,0.57\n", "2: p = (0.57, 0.57, 0.57) has length 0.987"),
            ("phi_deg,p1,p2,p3\n1,0,0,1\n", "1: column theta_deg is missing; phi_deg, theta_deg go together"),
            ("phi_deg,theta_deg,p1,p2,p3\n0,0,0,0,1\n", "1: p1, p2, p3 and phi_deg, theta_deg: each gives"),
            ("p1,p2,p3\n0,0,0\n", "2: p = (0, 0, 0) has length 0"),
            ("p1,p2,p3\n1,0\n", "2: 2 cells; the header has 3"),
            (
                "rod,p1,p2,p3\n2,1,0,0\n1,0,1,0\n",
                "3: rod = 1 is not allowed after rod 2: each rod has one row; sort the rows by rod",
            ),
            ("rod,p1,p2,p3\n1,1,0,0\n1,0,1,0\n", "3: rod = 1 is not allowed after rod 1"),
            ("rod,p1,p2,p3\n0.5,1,0,0\n", "2: rod = 0.5 is not allowed: expected a whole number from 0 on"),
            ("rod,p1,p2,p3\n-1,1,0,0\n", "2: rod = -1 is not allowed"),
            ("replica,p1,p2,p3\n0,1,0,0\n0,1,0,0\n1,0,1,0\n", "4: replica = 1 is not allowed: line 2 has 0"),
            (
                "time_s,p1,p2,p3\n0,1,0,0\n73.7,0,1,0\n",
                "3: time_s = 73.7 is not allowed: line 2 has 0, and a start has the rods of one replica at one time",
            ),
            ("time_s,p1,p2,p3\nnow,1,0,0\n", "2: column time_s: `now` is not allowed"),
            ("strain,p1,p2,p3\n0,1,0,0\n1,0,1,0\n", "3: strain = 1 is not allowed: line 2 has 0"),
            // A file of other content is shown by its first letters at most.
            ("-----BEGIN PRIVATE KEY OF SOMEBODY-----\nMIIE\n", "1: unknown column \"-----BEGIN PRIVATE K…\"; allowed"),
        ] {
            let refused = refused(text);
            assert!(refused.starts_with(said), "{refused}");
        }
    }
}
