//! The directions that rods start with, from a file beside the scene.

use shearbed::scene::{Orientation, Scene};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The columns that are read.
const P: [&str; 3] = ["p1", "p2", "p3"];

/// The column that numbers the rods: ascending, each number once.
const ROD: &str = "rod";

/// The columns that say of which replica and time a row is: one value each in all rows.
const ONE_VALUE: [&str; 2] = ["replica", "time_s"];

/// What else may stand in the file, as in `rods.csv`; none of it is a start, but an r_e must be the scene's.
const OTHERS: [&str; 9] = [
    ROD,
    ONE_VALUE[0],
    ONE_VALUE[1],
    "strain",
    "aspect_ratio",
    "x1_mm",
    "x2_mm",
    "x3_mm",
    "collided",
];

/// How far a length may be from 1: a direction in five decimals or more. It is divided out.
const LENGTH: f64 = 1e-5;

/// The files that were read for scenes of one folder: each is read once, and its directions are held once.
#[derive(Clone, Debug, Default)]
pub struct Starts {
    folder: PathBuf,
    read: BTreeMap<String, Start>,
}

#[derive(Clone, Debug)]
struct Start {
    crc32: String,
    p: Arc<[Vec<f64>; 3]>,
    /// The r_e of its rods, where it has them.
    aspect_ratio: Option<f64>,
}

impl Starts {
    /// For scenes whose files are in this folder; nothing is read yet.
    pub fn beside(folder: &Path) -> Self {
        Self {
            folder: folder.to_owned(),
            read: BTreeMap::new(),
        }
    }

    /// The checksum (CRC-32) of each file that was read.
    pub fn checksums(&self) -> BTreeMap<&str, &str> {
        (self.read.iter())
            .map(|(file, start)| (file.as_str(), start.crc32.as_str()))
            .collect()
    }

    /// Gives a scene whose rods start as a file says the directions of that file; others are left as they are.
    ///
    /// # Errors
    ///
    /// The file, line, column and value, and what is allowed.
    pub fn fill(&mut self, scene: &mut Scene) -> Result<(), String> {
        let (count, aspect_ratio) = (scene.particles.count, scene.particles.aspect_ratio);
        let Orientation::Each { file, crc32, p } = &mut scene.particles.orientation else {
            return Ok(());
        };
        let path = self.folder.join(&*file);
        let refused = |what: String| format!("particles.orientation: {}{what}", path.display());
        let asked_for = |found: &str| match crc32.as_deref().filter(|expected| *expected != found) {
            Some(expected) => Err(refused(format!(
                ": has crc32 = {found}; {expected:?} is allowed, or no crc32"
            ))),
            None => Ok(()),
        };
        let own = |start: &&Start| start.aspect_ratio.is_none_or(|own| own == aspect_ratio);
        let start = match self.read.get(file).filter(own) {
            Some(start) => {
                asked_for(&start.crc32)?;
                start.clone()
            }
            None => {
                let bytes = crate::input::bytes(&path, 1 << 31)
                    .map_err(|error| refused(format!(": cannot be read: {error}")))?;
                let found = format!("{:08x}", crc32fast::hash(&bytes));
                asked_for(&found)?;
                let (directions, shaped) =
                    read(&bytes, aspect_ratio).map_err(|error| refused(format!(":{error}")))?;
                let start = Start {
                    crc32: found,
                    p: Arc::new(directions),
                    aspect_ratio: shaped.then_some(aspect_ratio),
                };
                self.read.insert(file.clone(), start.clone());
                start
            }
        };
        if start.p[0].len() != count {
            return Err(refused(format!(
                ": has {} rows; as many as particles.count = {count} are allowed",
                start.p[0].len()
            )));
        }
        (*crc32, *p) = (Some(start.crc32), Some(start.p));
        Ok(())
    }
}

/// The directions, row by row, and whether the rows have an r_e, which is then this one; of an error the line first.
fn read(bytes: &[u8], aspect_ratio: f64) -> Result<([Vec<f64>; 3], bool), String> {
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(bytes);
    let in_words = |error: csv::Error| {
        let line = error.position().map_or(1, csv::Position::line);
        format!("{line}: not a table in CSV: {error}")
    };
    let head = reader.headers().map_err(in_words)?.clone();
    for (k, name) in head.iter().enumerate() {
        if !P.contains(&name) && !OTHERS.contains(&name) {
            let name = snippet(name);
            return Err(format!(
                "1: unknown column {name:?}; allowed: p1, p2, p3, and those of rods.csv"
            ));
        }
        if head.iter().take(k).any(|other| other == name) {
            return Err(format!("1: column {name} is there twice; once is allowed"));
        }
    }
    let place = |name: &str| head.iter().position(|other| other == name);
    let mut places = [0; 3];
    for (own, name) in places.iter_mut().zip(P) {
        *own = place(name).ok_or_else(|| format!("1: column {name} is missing; p1, p2 and p3 are needed"))?;
    }
    let shape = place("aspect_ratio");
    let mut order = Order::new(place);
    let mut p = [(); 3].map(|()| Vec::new());
    for record in reader.records() {
        let record = record.map_err(in_words)?;
        let line = record.position().map_or(0, csv::Position::line);
        let number = |place: usize| {
            let cell = record.get(place).unwrap_or_default();
            let parsed = cell.parse().ok().filter(|value: &f64| value.is_finite());
            parsed.ok_or_else(|| {
                let cell = snippet(cell);
                format!(
                    "{line}: {} = {cell} is not allowed: a finite number",
                    &head[place]
                )
            })
        };
        order.next(&head, line, number)?;
        let direction = [number(places[0])?, number(places[1])?, number(places[2])?];
        // Exact operations only, for the same bits on every machine.
        let length = direction.map(|x| x * x).iter().sum::<f64>().sqrt();
        if (length - 1.0).abs() > LENGTH {
            let [p1, p2, p3] = direction;
            return Err(format!(
                "{line}: p = ({p1}, {p2}, {p3}) has length {length}: 1 within {LENGTH:e} is allowed"
            ));
        }
        if let Some(place) = shape
            && number(place)? != aspect_ratio
        {
            return Err(format!(
                "{line}: aspect_ratio = {} is not allowed: the rods have the scene's, {aspect_ratio}, or the column is left out",
                &record[place]
            ));
        }
        for (axis, value) in p.iter_mut().zip(direction) {
            axis.push(value / length);
        }
    }
    Ok((p, shape.is_some()))
}

/// The rows of one replica at one time, in the order of their rods' numbers.
///
/// Directions are taken row by row: rows in another order, or of two times or replicas, would be another suspension.
struct Order {
    rod: Option<usize>,
    one_value: [Option<usize>; 2],
    /// The last rod, and the line and the values of the first row.
    last: Option<f64>,
    first: Option<(u64, [Option<f64>; 2])>,
}

impl Order {
    fn new(place: impl Fn(&str) -> Option<usize>) -> Self {
        Self {
            rod: place(ROD),
            one_value: ONE_VALUE.map(place),
            last: None,
            first: None,
        }
    }

    /// Takes the next row; `number` reads a column of it.
    fn next(
        &mut self,
        head: &csv::StringRecord,
        line: u64,
        number: impl Fn(usize) -> Result<f64, String>,
    ) -> Result<(), String> {
        let read = |place: Option<usize>| place.map(&number).transpose();
        let values = [read(self.one_value[0])?, read(self.one_value[1])?];
        let (first_line, first) = *self.first.get_or_insert((line, values));
        for ((column, value), first) in self.one_value.iter().zip(values).zip(first) {
            if let (Some(column), Some(value), Some(first)) = (column, value, first)
                && value != first
            {
                return Err(format!(
                    "{line}: {} = {value} is not allowed: line {first_line} has {first}, and a start has the rods of one \
                     replica at one time; keep the rows of one",
                    &head[*column]
                ));
            }
        }
        let Some(rod) = read(self.rod)? else {
            return Ok(());
        };
        if !(rod >= 0.0 && rod.fract() == 0.0) {
            return Err(format!(
                "{line}: rod = {rod} is not allowed: a whole number from 0 on"
            ));
        }
        match self.last.replace(rod) {
            Some(last) if rod <= last => Err(format!(
                "{line}: rod = {rod} is not allowed after rod {last}: each rod has one row; sort the rows by rod"
            )),
            _ => Ok(()),
        }
    }
}

/// The start of a cell, for a message: a file that is no start is not shown.
fn snippet(cell: &str) -> String {
    const MOST: usize = 20;
    match cell.char_indices().nth(MOST) {
        Some((end, _)) => format!("{}…", &cell[..end]),
        None => cell.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(text: &str) -> String {
        read(text.as_bytes(), 11.6).unwrap_err()
    }

    #[test]
    fn rows_are_directions_in_any_order_of_columns() {
        let text = "rod,p3,p1,p2,time_s,replica\n0,0.8,0.6,0,2.5,1\n7, -0.70711 ,0,0.70711,2.5,1\n";
        let ([p1, p2, p3], shaped) = read(text.as_bytes(), 11.6).unwrap();
        assert!(!shaped);
        assert_eq!((p1, p3[0]), (vec![0.6, 0.0], 0.8));
        // 0.70711² · 2 = 1.0000091 is divided out.
        assert!((p2[1] - 0.5f64.sqrt()).abs() < 1e-15 && (p3[1] + 0.5f64.sqrt()).abs() < 1e-15);
    }

    /// Removed after it was read: a file that is read again would be missed.
    #[test]
    fn a_file_is_read_and_held_once_for_all_scenes() {
        let text = crate::scenes::find("extension").unwrap().text;
        let mut first = shearbed::scene_file::parse("s", text).unwrap();
        first.particles.count = 1;
        first.particles.orientation = Orientation::Each {
            file: "start.csv".into(),
            crc32: None,
            p: None,
        };
        let mut other = first.clone();
        other.particles.aspect_ratio *= 2.0;
        let of = |scene: &Scene| match &scene.particles.orientation {
            Orientation::Each { p, .. } => p.clone().unwrap(),
            _ => panic!("no file"),
        };
        let dir = tempfile::tempdir().unwrap();
        let file = dir.path().join("start.csv");
        for (rows, same) in [
            ("p1,p2,p3\n1,0,0\n".to_owned(), true),
            (
                format!("p1,p2,p3,aspect_ratio\n1,0,0,{}\n", first.particles.aspect_ratio),
                false,
            ),
        ] {
            let mut starts = Starts::beside(dir.path());
            let (mut a, mut b, mut c) = (first.clone(), first.clone(), other.clone());
            std::fs::write(&file, rows).unwrap();
            starts.fill(&mut a).unwrap();
            std::fs::remove_file(&file).unwrap();
            starts.fill(&mut b).unwrap();
            assert!(Arc::ptr_eq(&of(&a), &of(&b)));
            // Rods that have an r_e in the file are not another r_e's.
            assert_eq!(starts.fill(&mut c).is_ok(), same);
        }
    }

    #[test]
    fn what_is_wrong_is_told_with_its_line() {
        for (text, said) in [
            ("p1,p2\n1,0\n", "1: column p3 is missing"),
            ("p1,p2,p3,p1\n1,0,0,1\n", "1: column p1 is there twice"),
            ("p1,p2,p3,theta\n1,0,0,1\n", "1: unknown column \"theta\""),
            ("p1,p2,p3\n1,0,0\n1,zero,0\n", "3: p2 = zero is not allowed"),
            ("p1,p2,p3\n1,0,nan\n", "2: p3 = nan is not allowed"),
            ("p1,p2,p3\n1,0,1e999\n", "2: p3 = 1e999 is not allowed"),
            (
                "p1,p2,p3\n1,0,0\n0.6,0.8,0.1\n",
                "3: p = (0.6, 0.8, 0.1) has length 1.00498",
            ),
            ("p1,p2,p3\n0,0,0\n", "2: p = (0, 0, 0) has length 0"),
            ("p1,p2,p3\n1,0\n", "2: not a table in CSV"),
            (
                "rod,p1,p2,p3\n2,1,0,0\n1,0,1,0\n",
                "3: rod = 1 is not allowed after rod 2: each rod has one row; sort the rows by rod",
            ),
            (
                "rod,p1,p2,p3\n1,1,0,0\n1,0,1,0\n",
                "3: rod = 1 is not allowed after rod 1",
            ),
            (
                "rod,p1,p2,p3\n0.5,1,0,0\n",
                "2: rod = 0.5 is not allowed: a whole number from 0 on",
            ),
            ("rod,p1,p2,p3\n-1,1,0,0\n", "2: rod = -1 is not allowed"),
            (
                "replica,p1,p2,p3\n0,1,0,0\n0,1,0,0\n1,0,1,0\n",
                "4: replica = 1 is not allowed: line 2 has 0",
            ),
            (
                "time_s,p1,p2,p3\n0,1,0,0\n73.7,0,1,0\n",
                "3: time_s = 73.7 is not allowed: line 2 has 0, and a start has the rods of one replica at one time",
            ),
            ("time_s,p1,p2,p3\nnow,1,0,0\n", "2: time_s = now is not allowed"),
            // Of a file that is no start at most the first letters are shown.
            (
                "-----BEGIN PRIVATE KEY OF SOMEBODY-----\nMIIE\n",
                "1: unknown column \"-----BEGIN PRIVATE K…\"; allowed",
            ),
            (
                "aspect_ratio,p1,p2,p3\n11.5,1,0,0\n",
                "2: aspect_ratio = 11.5 is not allowed",
            ),
        ] {
            let found = refused(text);
            assert!(found.starts_with(said), "{found}");
        }
    }
}
