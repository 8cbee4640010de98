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
            if !(0.0..=180.0).contains(&theta_deg) {
                return Err(row.error(format!("theta_deg = {theta_deg}: 0 to 180 is allowed, from the vorticity axis")));
            }
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
