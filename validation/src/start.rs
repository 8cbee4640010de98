//! Rods of which a file beside the scene says what each is: length, r_e, direction and place.

use shearbed::scene::{OwnRods, RodsFile, Scene};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The columns that are read, in groups of which a file has all or none.
const P: [&str; 3] = ["p1", "p2", "p3"];
const PLACE: [&str; 3] = ["x1_mm", "x2_mm", "x3_mm"];
const ASPECT_RATIO: [&str; 1] = ["aspect_ratio"];
const LENGTH: [&str; 1] = ["length_mm"];

/// The column that numbers the rods: ascending, each number once.
const ROD: &str = "rod";

/// The columns that say of which replica and time a row is: one value each in all rows.
const ONE_VALUE: [&str; 2] = ["replica", "time_s"];

/// What else may stand in the file, as in `rods.csv`.
const OTHERS: [&str; 2] = ["strain", "collided"];

/// How far the length of p may be from 1: a direction in five decimals or more. It is divided out.
const OFF_UNIT: f64 = 1e-5;

/// The files that were read for scenes of one folder: each is read once, and its rods are held once.
#[derive(Clone, Debug, Default)]
pub struct Starts {
    folder: PathBuf,
    read: BTreeMap<String, Start>,
}

#[derive(Clone, Debug)]
struct Start {
    crc32: String,
    own: Arc<OwnRods>,
    /// The line of each rod.
    lines: Arc<Vec<u64>>,
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

    /// The files that were read.
    pub fn files(&self) -> impl Iterator<Item = PathBuf> {
        self.read.keys().map(|file| self.folder.join(file))
    }

    /// Gives a scene whose rods a file has what the file says of them; others are left as they are.
    ///
    /// # Errors
    ///
    /// The file, line, column and value, and what is allowed.
    pub fn fill(&mut self, scene: &mut Scene) -> Result<(), String> {
        let Some(RodsFile { file, crc32, .. }) = &scene.particles.rods else {
            return Ok(());
        };
        let path = self.folder.join(file);
        let refused = |what: String| format!("particles.rods: {}{what}", path.display());
        let start = match self.read.get(file) {
            Some(start) => start.clone(),
            None => {
                let bytes = crate::input::bytes(&path, 1 << 31)
                    .map_err(|error| refused(format!(": cannot be read: {error}")))?;
                let (own, lines) = read(&bytes).map_err(|error| refused(format!(":{error}")))?;
                let start = Start {
                    crc32: format!("{:08x}", crc32fast::hash(&bytes)),
                    own: Arc::new(own),
                    lines: Arc::new(lines),
                };
                self.read.insert(file.clone(), start.clone());
                start
            }
        };
        if let Some(expected) = crc32.as_deref().filter(|expected| *expected != start.crc32) {
            let found = &start.crc32;
            return Err(refused(format!(
                ": has crc32 = {found}; {expected:?} is allowed, or no crc32"
            )));
        }
        fits(scene, &start).map_err(refused)?;
        if let Some(rods) = &mut scene.particles.rods {
            (rods.crc32, rods.own) = (Some(start.crc32), Some(start.own));
        }
        Ok(())
    }
}

/// Whether the rods of a file can be those of the scene, or the line of the first that cannot.
fn fits(scene: &Scene, start: &Start) -> Result<(), String> {
    let (count, rows, own) = (scene.particles.count, start.lines.len(), &start.own);
    if rows != count {
        return Err(format!(
            ": has {rows} rows; as many as particles.count = {count} are allowed"
        ));
    }
    match scene.misfit(own) {
        Some(misfit) => Err(format!(
            ":{}: {} = {:?} is not allowed: {}",
            start.lines[misfit.rod], misfit.column, misfit.value, misfit.allowed
        )),
        None => Ok(()),
    }
}

/// The columns of a group that the file has.
struct Group<const K: usize>(Option<[usize; K]>);

impl<const K: usize> Group<K> {
    fn new(names: [&str; K], place: impl Fn(&str) -> Option<usize>) -> Result<Self, String> {
        let places = names.map(&place);
        let missing = names.iter().zip(places).find(|(_, place)| place.is_none());
        match missing {
            None => Ok(Self(Some(places.map(Option::unwrap_or_default)))),
            Some(_) if places.iter().all(Option::is_none) => Ok(Self(None)),
            Some((name, _)) => Err(format!(
                "1: column {name} is missing; {} go together",
                names.join(", ")
            )),
        }
    }

    fn values(&self, number: impl Fn(usize) -> Result<f64, String>) -> Result<Option<[f64; K]>, String> {
        let Some(places) = self.0 else {
            return Ok(None);
        };
        let mut values = [0.0; K];
        for (value, place) in values.iter_mut().zip(places) {
            *value = number(place)?;
        }
        Ok(Some(values))
    }
}

/// The rods, row by row, and the line of each; of an error the line first.
fn read(bytes: &[u8]) -> Result<(OwnRods, Vec<u64>), String> {
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(bytes);
    let in_words = |error: csv::Error| {
        let line = error.position().map_or(1, csv::Position::line);
        format!("{line}: not a table in CSV: {error}")
    };
    let head = reader.headers().map_err(in_words)?.clone();
    let known = || (P.iter().chain(&PLACE).chain(&ASPECT_RATIO).chain(&LENGTH)).chain([&ROD]);
    for (k, name) in head.iter().enumerate() {
        if !known()
            .chain(&ONE_VALUE)
            .chain(&OTHERS)
            .any(|known| *known == name)
        {
            let name = snippet(name);
            return Err(format!(
                "1: unknown column {name:?}; allowed are those of rods.csv, apart by commas: {}",
                known()
                    .chain(&ONE_VALUE)
                    .chain(&OTHERS)
                    .copied()
                    .collect::<Vec<_>>()
                    .join(", ")
            ));
        }
        if head.iter().take(k).any(|other| other == name) {
            return Err(format!("1: column {name} is there twice; once is allowed"));
        }
    }
    let place = |name: &str| head.iter().position(|other| other == name);
    let (p, places) = (Group::new(P, place)?, Group::new(PLACE, place)?);
    let (shape, length) = (Group::new(ASPECT_RATIO, place)?, Group::new(LENGTH, place)?);
    if p.0.is_none() && places.0.is_none() && shape.0.is_none() && length.0.is_none() {
        return Err("1: no column of what a rod is: p1, p2 and p3, aspect_ratio, length_mm, or x1_mm, x2_mm and x3_mm".into());
    }
    let mut order = Order::new(place);
    let mut own = OwnRods::default();
    let (mut lines, mut at) = (Vec::new(), Place::new(bytes));
    for record in reader.records() {
        let record = record.map_err(in_words)?;
        let line = record.position().map_or(0, |position| at.line(position.byte()));
        let not_allowed = |place: usize, allowed: &str| match record.get(place).unwrap_or_default() {
            "" => format!("{line}: {} is empty: {allowed} is allowed", &head[place]),
            cell => format!(
                "{line}: {} = {} is not allowed: {allowed}",
                &head[place],
                snippet(cell)
            ),
        };
        let number = |place: usize| {
            let parsed = record.get(place).unwrap_or_default().parse().ok();
            let finite = parsed.filter(|value: &f64| value.is_finite());
            finite.ok_or_else(|| not_allowed(place, "a finite number"))
        };
        let positive = |place: usize| match number(place)? {
            value if value > 0.0 => Ok(value),
            _ => Err(not_allowed(place, "a finite number > 0")),
        };
        order.next(&head, line, number)?;
        if let Some(direction) = p.values(number)? {
            // Exact operations only, for the same bits on every machine.
            let length = direction.map(|x| x * x).iter().sum::<f64>().sqrt();
            if (length - 1.0).abs() > OFF_UNIT {
                let [p1, p2, p3] = direction;
                return Err(format!(
                    "{line}: p = ({p1}, {p2}, {p3}) has length {length}: 1 within {OFF_UNIT:e} is allowed"
                ));
            }
            push(&mut own.p, direction.map(|x| x / length));
        }
        // Free rods have no place, and rods.csv empty cells.
        let empty = |places: &[usize; 3]| places.iter().all(|place| record.get(*place) == Some(""));
        if !places.0.as_ref().is_some_and(empty) {
            if own.place_mm.is_none() && !lines.is_empty() && places.0.is_some() {
                return Err(format!(
                    "{line}: the rods before have no place: all have one, or none"
                ));
            }
            if let Some(x) = places.values(number)? {
                push(&mut own.place_mm, x);
            }
        } else if own.place_mm.is_some() {
            return Err(format!(
                "{line}: the rods before have a place: all have one, or none"
            ));
        }
        if let Some([r]) = shape.values(positive)? {
            own.aspect_ratio.get_or_insert_default().push(r);
        }
        if let Some([a]) = length.values(positive)? {
            own.length_mm.get_or_insert_default().push(a);
        }
        lines.push(line);
    }
    Ok((own, lines))
}

/// Lines of bytes from the first on. The reader of CSV counts blank lines, and the second half of CRLF, to the row after them.
struct Place<'a> {
    bytes: &'a [u8],
    line: u64,
    offset: usize,
}

impl<'a> Place<'a> {
    fn new(bytes: &'a [u8]) -> Self {
        Self {
            bytes,
            line: 1,
            offset: 0,
        }
    }

    /// The line of what stands at this place, or after line ends there; places must grow.
    fn line(&mut self, byte: u64) -> u64 {
        let start = (byte as usize).min(self.bytes.len());
        let blank = self.bytes[start..]
            .iter()
            .take_while(|byte| matches!(byte, b'\r' | b'\n'))
            .count();
        let passed = &self.bytes[self.offset.min(start + blank)..start + blank];
        self.line += passed.iter().filter(|byte| **byte == b'\n').count() as u64;
        self.offset = start + blank;
        self.line
    }
}

fn push(axes: &mut Option<[Vec<f64>; 3]>, values: [f64; 3]) {
    for (axis, value) in axes.get_or_insert_default().iter_mut().zip(values) {
        axis.push(value);
    }
}

/// The rows of one replica at one time, in the order of their rods' numbers.
///
/// Rods are taken row by row: rows in another order, or of two times or replicas, would be another suspension.
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
        read(text.as_bytes()).unwrap_err()
    }

    #[test]
    fn rows_are_rods_in_any_order_of_columns() {
        let text = "rod,p3,p1,p2,time_s,replica\n0,0.8,0.6,0,2.5,1\n7, -0.70711 ,0,0.70711,2.5,1\n";
        let (own, lines) = read(text.as_bytes()).unwrap();
        let [p1, p2, p3] = own.p.unwrap();
        assert_eq!((p1, p3[0], lines), (vec![0.6, 0.0], 0.8, vec![2, 3]));
        // 0.70711² · 2 = 1.0000091 is divided out.
        assert!((p2[1] - 0.5f64.sqrt()).abs() < 1e-15 && (p3[1] + 0.5f64.sqrt()).abs() < 1e-15);
        assert!(own.aspect_ratio.is_none() && own.length_mm.is_none() && own.place_mm.is_none());

        let text = "length_mm,x2_mm,x1_mm,x3_mm,aspect_ratio\n0.5,2,1,3,11\n0.7,5,4,6,12\n";
        let (own, lines) = read(text.as_bytes()).unwrap();
        assert_eq!(
            (own.length_mm, own.aspect_ratio),
            (Some(vec![0.5, 0.7]), Some(vec![11.0, 12.0]))
        );
        let places = [[1.0, 4.0], [2.0, 5.0], [3.0, 6.0]].map(Vec::from);
        assert_eq!((own.place_mm, own.p, lines), (Some(places), None, vec![2, 3]));
        // As rods.csv has free rods.
        let (own, _) = read(b"length_mm,x1_mm,x2_mm,x3_mm\n0.5,,,\n0.5,,,\n").unwrap();
        assert_eq!((own.place_mm, own.length_mm), (None, Some(vec![0.5, 0.5])));
    }

    fn of_a_file(count: usize, interacting: bool) -> Scene {
        let name = if interacting { "fig4-n50" } else { "extension" };
        let text = crate::scenes::find(name).unwrap().text;
        let mut scene = shearbed::scene_file::parse("s", text).unwrap();
        scene.particles.count = count;
        scene.particles.rods = Some(RodsFile {
            file: "start.csv".into(),
            crc32: None,
            own: None,
        });
        scene
    }

    /// Removed after it was read: a file that is read again would be missed.
    #[test]
    fn a_file_is_read_and_held_once_for_all_scenes() {
        let first = of_a_file(1, false);
        let of = |scene: &Scene| scene.particles.rods.as_ref().unwrap().own.clone().unwrap();
        let dir = tempfile::tempdir().unwrap();
        let file = dir.path().join("start.csv");
        let mut starts = Starts::beside(dir.path());
        let (mut a, mut b) = (first.clone(), first);
        std::fs::write(&file, "p1,p2,p3\n1,0,0\n").unwrap();
        starts.fill(&mut a).unwrap();
        std::fs::remove_file(&file).unwrap();
        starts.fill(&mut b).unwrap();
        assert!(Arc::ptr_eq(&of(&a), &of(&b)));
    }

    /// Two rods at 50 per cm³: H = 3.42 mm.
    #[test]
    fn rods_that_the_scene_cannot_have_are_told_with_their_line() {
        let dir = tempfile::tempdir().unwrap();
        let fill = |text: &str, interacting: bool| {
            std::fs::write(dir.path().join("start.csv"), text).unwrap();
            Starts::beside(dir.path()).fill(&mut of_a_file(2, interacting))
        };
        for (text, said) in [
            (
                "length_mm\n1\n",
                "start.csv: has 1 rows; as many as particles.count = 2",
            ),
            ("length_mm\n1\n1\n1\n", "start.csv: has 3 rows"),
            (
                "aspect_ratio\n2\n1\n",
                "start.csv:3: aspect_ratio = 1.0 is not allowed: interacting rods need a number > 1",
            ),
            (
                "x1_mm,x2_mm,x3_mm\n1,2,3\n3,4,1\n",
                "start.csv:3: x2_mm = 4.0 is not allowed: the control volume reaches from 0 to 3.41",
            ),
            (
                "x1_mm,x2_mm,x3_mm\n1,2,-3\n3,1,1\n",
                "start.csv:2: x3_mm = -3.0 is not allowed",
            ),
        ] {
            let refused = fill(text, true).unwrap_err();
            assert!(
                refused.starts_with("particles.rods: ") && refused.contains(said),
                "{refused}"
            );
        }
        // Free rods may be discs, and are nowhere.
        assert_eq!(
            fill("aspect_ratio,x1_mm,x2_mm,x3_mm\n2,1,2,3\n0.5,3,4,1\n", false),
            Ok(())
        );
    }

    #[test]
    fn lines_are_counted_as_an_editor_does() {
        for (text, line) in [
            ("length_mm\r\n1\r\n1\r\nx\r\n", 4),
            ("length_mm\n1\n\n\n1\nx\n", 6),
            ("length_mm\r\n\r\n1\r\nx", 4),
            ("length_mm\nx\n", 2),
        ] {
            let said = format!("{line}: length_mm = x is not allowed");
            assert!(refused(text).starts_with(&said), "{text:?}: {}", refused(text));
        }
    }

    #[test]
    fn what_is_wrong_is_told_with_its_line() {
        for (text, said) in [
            ("p1,p2\n1,0\n", "1: column p3 is missing; p1, p2, p3 go together"),
            ("x1_mm\n1\n", "1: column x2_mm is missing"),
            ("rod,time_s\n0,0\n", "1: no column of what a rod is"),
            (
                "length_mm\n1\n0\n",
                "3: length_mm = 0 is not allowed: a finite number > 0",
            ),
            ("length_mm\n-1\n", "2: length_mm = -1 is not allowed"),
            (
                "length_mm\nNaN\n",
                "2: length_mm = NaN is not allowed: a finite number",
            ),
            ("aspect_ratio\n-2\n", "2: aspect_ratio = -2 is not allowed"),
            (
                "x1_mm,x2_mm,x3_mm\n1,2,3\n,,\n",
                "3: the rods before have a place",
            ),
            (
                "x1_mm,x2_mm,x3_mm\n,,\n1,2,3\n",
                "3: the rods before have no place",
            ),
            (
                "x1_mm,x2_mm,x3_mm\n1,,3\n",
                "2: x2_mm is empty: a finite number is allowed",
            ),
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
        ] {
            let found = refused(text);
            assert!(found.starts_with(said), "{found}");
        }
    }
}
