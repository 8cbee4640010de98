//! The folder of a sweep: `sweep.json` has the scene and the grid, `points/` a folder of tables with a record
//! (`shearbed.json`) for each finished point, `sweep.csv` one row a point. Every file and every point's folder appears
//! whole or not at all.

use super::axis::{Axis, shown};
use super::{Pairs, Point, at, count, pairs};
use crate::files::build::BUILD;
use crate::files::csv::{self, Table};
use crate::files::difference::difference;
use crate::files::output::{Claim, Origin, Output, OutputError, RECORD, Record, Refused, ResultFolder};
use crate::files::text::{self, Shown, cell};
use crate::files::{FileError, bounded};
use serde_json::{Value, json};
use shearbed::Scene;
use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// The inputs of a sweep, everything on which its results depend: this build, the scene without the swept keys, the
/// grid, the warnings of the points' plans, and the checksums of files with initial directions.
pub fn inputs(scene: &Scene, axes: &[Axis], points: &[Point], warnings: &[String]) -> Value {
    let mut inputs = json!(BUILD);
    inputs["scene"] = json!(scene.resolved());
    inputs["over"] = json!(axes);
    inputs["warnings"] = json!(warnings);
    let starts = points.iter().filter_map(|point| point.plan.scene().particles.rods.as_ref());
    let starts: BTreeMap<_, _> = starts.map(|rods| (&rods.file, &rods.crc32)).collect();
    if !starts.is_empty() {
        inputs[STARTS] = json!(starts);
    }
    inputs
}

/// The name in a sweep's inputs of the checksums of files with initial directions.
const STARTS: &str = "starts_crc32";

/// The name of a point in the inputs of its record, where its keys and values are.
pub const POINT: &str = "point";

/// The name of the folder of point `k`, counted from 0, of `count`, such as `points/03`; it counts from 1.
pub fn point_name(k: usize, count: usize) -> String {
    let width = count.to_string().len();
    format!("points/{:0width$}", k + 1)
}

/// The largest size of a point's table or record, in bytes.
const MOST_BYTES: u64 = 1 << 30;

/// The points of a sweep with the names of their tables.
#[derive(Clone)]
pub struct Points {
    /// The keys and values of each point; no two are equal.
    pub pairs: Vec<Pairs>,
    /// The names of the tables that each point has.
    pub tables: Vec<String>,
    /// Those of them whose last rows are not in `sweep.csv`: all their rows are in a table of the same name.
    pub beside: Vec<String>,
}

/// The folder of one sweep; no other process writes to it during the lifetime of this value.
pub struct Folder {
    folder: ResultFolder,
    /// `sweep.json`, with which a sweep begins.
    first: Vec<Output>,
    points: Points,
    claim: Claim,
}

/// Indices of points with their tables.
pub type Finished = Vec<(usize, Vec<Output>)>;

/// The tables of the finished points of an earlier sweep in `dir` with fewer values on its axes, each with the index of
/// its point in this sweep; `None` if there is no such sweep.
///
/// # Errors
///
/// Those of [`Folder::open`], as where more than values of the axes differs.
pub fn smaller(dir: &Path, inputs: &Value, points: &Points) -> Result<Option<Finished>, Refused> {
    let Ok(Some(Record { origin: found, .. })) = Record::read(dir) else { return Ok(None) };
    let over = found.inputs.get("over").filter(|_| found.command == "sweep");
    let axes: Vec<Axis> = over.and_then(|over| serde_json::from_value(over.clone()).ok()).unwrap_or_default();
    let here: BTreeMap<&Pairs, usize> = points.pairs.iter().zip(0..).collect();
    let before: Vec<Pairs> = (0..count(&axes).unwrap_or(0)).map(|k| pairs(&axes, &at(&axes, k))).collect();
    let places: Option<Vec<usize>> = before.iter().map(|pair| here.get(pair).copied()).collect();
    let Some(places) = places.filter(|places| (1..points.pairs.len()).contains(&places.len())) else {
        return Ok(None);
    };
    let mut inputs = inputs.clone();
    for key in ["over", "warnings"] {
        inputs[key] = found.inputs[key].clone();
    }
    let known = found.inputs.get(STARTS).and_then(Value::as_object);
    match (known, inputs.get_mut(STARTS).and_then(Value::as_object_mut)) {
        (Some(known), Some(files)) => files.retain(|file, _| known.contains_key(file)),
        _ => drop(inputs.as_object_mut().and_then(|inputs| inputs.remove(STARTS))),
    }
    let folder = ResultFolder::new(dir, "sweep", inputs.clone(), false);
    let earlier = Folder::open(folder, &inputs, Points { pairs: before, ..points.clone() })?;
    earlier.finished().into_iter().map(|k| Ok((places[k], earlier.tables(k)?))).collect::<Result<_, _>>().map(Some)
}

impl Folder {
    /// Opens the folder, or creates it.
    ///
    /// # Errors
    ///
    /// Another sweep in the folder, files of unknown origin under the names of a sweep's, or a point that was changed:
    /// all are left as they are, unless `folder` has force, which empties the folder of sweeps. Another process at work
    /// in the folder.
    pub fn open(folder: ResultFolder, inputs: &Value, points: Points) -> Result<Self, Refused> {
        // The points may be days of work.
        let folder = folder.from_same_input();
        let text = text::json(inputs).map_err(|error| Refused(error.to_string()))?;
        let first = vec![("sweep.json".to_owned(), text)];
        let begun = Record::new(folder.origin(), &first);
        let all = [&first[..], &[begun.file()]].concat();
        let (claim, _) = Claim::open_or_appear(folder.dir(), Duration::ZERO, &all)?;
        claim.report("points");
        let own = folder.is_own();
        // Without a record, points are of unknown origin, too.
        let mut names = vec!["sweep.json", "sweep.csv"];
        names.extend(points.beside.iter().map(String::as_str));
        names.extend((!own).then_some("points"));
        folder.check(&names)?;
        let folder = Self { folder, first, points, claim };
        // Where its `sweep.json` is gone, a sweep begins again and keeps its points.
        if !own || folder.folder.dir().join("sweep.json").symlink_metadata().is_err() {
            folder.begin(own)?;
        }
        match folder.finished().into_iter().find_map(|k| folder.tables(k).err()) {
            Some(_) if folder.folder.force => folder.begin(false)?,
            Some(why) => return Err(why),
            None => {}
        }
        Ok(folder)
    }

    /// Removes the points of another sweep, unless the sweep is `own`, and writes `sweep.json`.
    fn begin(&self, own: bool) -> Result<(), Refused> {
        let earlier = self.folder.earlier(&self.claim);
        let mut left_over = [&["sweep.csv".to_owned()][..], &self.points.beside].concat();
        if !own {
            self.others()?.iter().try_for_each(|point| self.claim.remove_folder(point))?;
            left_over.extend(earlier.keys().filter(|name| *name != "sweep.json").cloned());
        }
        let record = Record::new(self.folder.origin(), &self.first);
        Ok(self.claim.write(&record, &self.first, earlier, &left_over)?)
    }

    /// The folders of the points of another sweep.
    ///
    /// # Errors
    ///
    /// A file in one of them that the sweep did not write, or a folder in the way of a point: force does not remove
    /// these.
    fn others(&self) -> Result<Vec<String>, Refused> {
        let points = self.folder.dir().join("points");
        let list = |dir: &Path| -> Result<Vec<PathBuf>, Refused> {
            let failed = |reason| OutputError { path: dir.to_owned(), reason };
            match fs::read_dir(dir) {
                Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(Vec::new()),
                entries => entries.map_err(failed)?.map(|entry| Ok(entry.map_err(failed)?.path())).collect(),
            }
        };
        let foreign = |path: &Path| {
            let what = "was not written by `shearbed sweep`: move it away";
            Refused(format!("{}: {what}; nothing was changed", path.shown()))
        };
        let ours: Vec<PathBuf> = (0..self.points.pairs.len()).map(|k| self.point(k)).collect();
        let name = |file: &Path| file.file_name().and_then(|name| name.to_str()).map(str::to_owned);
        // What somebody copied, renamed or linked is theirs, whatever is in it.
        let is_point = |name: &String| name.bytes().all(|byte| byte.is_ascii_digit());
        let mut found = Vec::new();
        for path in list(&points)? {
            let point = name(&path).filter(is_point).filter(|_| !path.is_symlink());
            let record = Record::read(&path).ok().flatten();
            let record = record.filter(|record| record.origin.inputs.get(POINT).is_some());
            let Some((point, record)) = point.zip(record) else {
                if ours.contains(&path) {
                    return Err(foreign(&path));
                }
                continue;
            };
            let is_own =
                |file: &&PathBuf| name(file).is_some_and(|name| name == RECORD || record.files.contains_key(&name));
            if let Some(file) = list(&path)?.iter().find(|file| !is_own(file)) {
                return Err(foreign(file));
            }
            found.push(format!("points/{point}"));
        }
        Ok(found)
    }

    /// The folder of point `k`, counted from 0; its name counts from 1.
    pub fn point(&self, k: usize) -> PathBuf {
        self.folder.dir().join(self.name(k))
    }

    fn name(&self, k: usize) -> String {
        point_name(k, self.points.pairs.len())
    }

    /// The indices of the finished points, in order.
    pub fn finished(&self) -> Vec<usize> {
        let all = 0..self.points.pairs.len();
        all.filter(|k| self.point(*k).is_dir()).collect()
    }

    /// Writes the tables of a point with their record.
    pub fn write(&self, k: usize, tables: &[Output]) -> Result<(), OutputError> {
        let files = [tables, &[self.record(k, tables).file()]].concat();
        self.is_there()?;
        // If the folder is gone meanwhile, that is the reason to report.
        self.claim.write_folder(&self.name(k), &files).map_err(|error| self.is_there().err().unwrap_or(error))
    }

    /// Fails if somebody has removed or moved the folder.
    fn is_there(&self) -> Result<(), OutputError> {
        let path = self.folder.dir();
        if path.join(RECORD).is_file() {
            return Ok(());
        }
        let gone = io::Error::new(io::ErrorKind::NotFound, "the folder of the sweep has gone");
        Err(OutputError { path: path.to_owned(), reason: gone })
    }

    /// The record of point `k` with these tables.
    fn record(&self, k: usize, tables: &[Output]) -> Record {
        let Origin { command, mut inputs } = self.folder.origin().clone();
        inputs[POINT] = json!(self.points.pairs[k]);
        Record::new(&Origin { command, inputs }, tables)
    }

    /// The tables of a finished point.
    ///
    /// # Errors
    ///
    /// A table or the record cannot be read or was changed.
    pub fn tables(&self, k: usize) -> Result<Vec<Output>, Refused> {
        let dir = self.point(k);
        let read = |name: &str| {
            let path = dir.join(name);
            let why = |error| format!("{}: cannot be read: {error}", path.shown());
            bounded::text(&path, MOST_BYTES).map_err(|error| self.damaged(k, &why(error)))
        };
        let record = read(RECORD)?;
        let table = |name: &String| Ok((name.clone(), read(name)?));
        let tables = (self.points.tables.iter()).map(table).collect::<Result<Vec<_>, Refused>>()?;
        let (_, own) = self.record(k, &tables).file();
        if own == record {
            return Ok(tables);
        }
        let [found, own] = [&record, &own].map(|text| serde_json::from_str::<Value>(text).unwrap_or_default());
        let why = match difference(&found, &own) {
            Some((key, was, is)) => {
                let key = key.strip_prefix("inputs.").unwrap_or(&key);
                format!("{}: not as it was written: {key} was {was} and is {is} now", dir.shown())
            }
            None => format!("{}: not as it was written", dir.join(RECORD).shown()),
        };
        Err(self.damaged(k, &why))
    }

    fn damaged(&self, k: usize, why: &str) -> Refused {
        let dir = self.point(k);
        Refused(format!(
            "{why}; remove {} to have this point run again, or start over with --force; nothing was changed",
            dir.shown()
        ))
    }

    /// Writes `sweep.csv` from the tables of all points, which must all exist (the swept values, then the last row of
    /// each of the tables), a table of all rows of each one beside, and the record of the sweep. Numbers are copied as
    /// texts from the tables. Returns the header and the rows of `sweep.csv`.
    pub fn gather(&self, axes: &[Axis], values: &[Vec<toml::Value>]) -> Result<Rows, Refused> {
        let mut rows = Vec::new();
        let mut records = Vec::new();
        let mut beside: BTreeMap<String, Rows> = BTreeMap::new();
        for (k, values) in values.iter().enumerate() {
            let mut head: Vec<_> = axes.iter().map(|axis| axis.key.clone()).collect();
            let mut row: Vec<_> = values.iter().map(|value| cell(&shown(value))).collect();
            let tables = self.tables(k)?;
            let (record, text) = self.record(k, &tables).file();
            records.push((format!("{}/{record}", self.name(k)), text));
            for (name, text) in tables {
                let found = rows_of(&self.point(k).join(&name), &text);
                let (columns, own) = found.map_err(|error| Refused(error.to_string()))?;
                if self.points.beside.contains(&name) {
                    let axes = axes.iter().map(|axis| axis.key.clone());
                    let all = beside.entry(name).or_insert_with(|| vec![axes.chain(columns).collect()]);
                    all.extend(own.into_iter().map(|cells| [&row[..values.len()], &cells].concat()));
                    continue;
                }
                let empty =
                    || Refused(format!("{}: there is no row below the header", self.point(k).join(&name).shown()));
                let last = own.into_iter().next_back().ok_or_else(empty)?;
                for (column, value) in columns.into_iter().zip(last) {
                    // Every table has the time; it is copied once.
                    if !head.contains(&column) {
                        head.push(column);
                        row.push(value);
                    }
                }
            }
            match rows.first() {
                None => rows.extend([head, row]),
                Some(first) if *first == head => rows.push(row),
                Some(_) => {
                    return Err(Refused(format!(
                        "{}: its tables have other columns than those of the first point",
                        self.point(k).shown()
                    )));
                }
            }
        }
        let written = |(name, rows): (String, &Rows)| {
            let text = csv::text(rows);
            let text = text.map_err(|error| Refused(format!("{}: {error}", self.folder.dir().join(&name).shown())))?;
            Ok::<_, Refused>((name, text))
        };
        let all = std::iter::once(("sweep.csv".to_owned(), &rows)).chain(beside.iter().map(|(k, v)| (k.clone(), v)));
        let tables = all.map(written).collect::<Result<Vec<_>, _>>()?;
        let record = Record::new(self.folder.origin(), &[&tables[..], &self.first, &records].concat());
        self.claim.write(&record, &tables, self.folder.earlier(&self.claim), &[])?;
        Ok(rows)
    }
}

/// A header and rows.
pub type Rows = Vec<Vec<String>>;

/// A table's header and rows.
fn rows_of(path: &Path, text: &str) -> Result<(Vec<String>, Rows), FileError> {
    let mut table = Table::new(path, text.as_bytes())?;
    let mut rows = Vec::new();
    while let Some(row) = table.next_row()? {
        rows.push(row.cells);
    }
    Ok((table.names().to_vec(), rows))
}
