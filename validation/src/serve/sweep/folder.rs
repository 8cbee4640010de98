//! The folder of a sweep: `sweep.json` says which sweep it is, `points/` has a folder of tables for each point that
//! is finished, with a `point.json` that says which point it is and has the tables' checksums, `sweep.csv` one row a
//! point. Every file and every point's folder appears whole or not at all.

use super::Point;
use super::axis::{Axis, shown};
use crate::files::bounded;
use crate::files::build;
use crate::files::difference::difference;
use crate::files::output::{self, Author, Claim, Output, OutputError, RECORD, Refused};
use crate::files::text::Shown;
use crate::files::text::cell;
use serde_json::{Value, json};
use shearbed::Scene;
use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Which sweep it is: what the results depend on.
pub struct Identity(Value);

impl Identity {
    /// A sweep of `scene`, as it is without the swept keys, by this build of the program, with what its points' plans
    /// warn of and the checksums of the files that their rods start from.
    pub fn new(scene: &Scene, axes: &[Axis], points: &[Point], warnings: &[String]) -> Self {
        let over = axes.iter().map(|axis| {
            let values: Vec<_> = axis.values.iter().map(shown).collect();
            format!("{}={}", axis.key, values.join(","))
        });
        let mut identity = build::record();
        identity["scene"] = json!(scene.resolved());
        identity["over"] = over.collect();
        identity["warnings"] = json!(warnings);
        let starts = points.iter().filter_map(|point| point.plan.scene().particles.rods.as_ref());
        let starts: BTreeMap<_, _> = starts.map(|rods| (&rods.file, &rods.crc32)).collect();
        if !starts.is_empty() {
            identity["starts_crc32"] = json!(starts);
        }
        Self(identity)
    }

    /// As plain data.
    pub fn value(&self) -> &Value {
        &self.0
    }

    fn text(&self) -> String {
        format!("{:#}\n", self.0)
    }
}

/// The longest table of a point, and the longest record.
const MOST_BYTES: u64 = 1 << 30;

/// The points of a sweep, as its folder knows them.
pub struct Points {
    /// Each point in words, which no two share.
    pub described: Vec<String>,
    /// The names of the tables that each point has.
    pub tables: Vec<String>,
}

/// The folder of one sweep, in which no other process writes while this lives.
pub struct Folder<'a> {
    dir: PathBuf,
    author: &'a Author,
    /// What `sweep.json` says.
    identity: String,
    points: Points,
    claim: Claim,
}

impl<'a> Folder<'a> {
    /// Opens the folder, or makes it. One that holds another sweep, files of unknown origin under the names of a
    /// sweep's, or a point that is not as it was written is refused and left as it is, but by the author's force, which
    /// empties it of what stood there of a sweep; so is one in which another process is at work.
    pub fn open(
        dir: &Path,
        author: &'a Author,
        identity: &Identity,
        points: Points,
    ) -> Result<Self, Refused> {
        let claim = Claim::new(dir, Duration::ZERO)?;
        let own = author.has_written(dir);
        // Without a record, points are of unknown origin too.
        let names = ["sweep.json", "sweep.csv", "points"];
        author.check(dir, if own { &names[..2] } else { &names })?;
        let folder = Self { dir: dir.to_owned(), author, identity: identity.text(), points, claim };
        if !own {
            folder.begin()?;
        }
        (folder.finished().into_iter()).try_for_each(|k| folder.kept(k).map(drop))?;
        Ok(folder)
    }

    /// Makes the folder this sweep's: what another one left in it goes.
    fn begin(&self) -> Result<(), OutputError> {
        let points = self.dir.join("points");
        let failed = |reason| OutputError { path: points.clone(), reason };
        for entry in fs::read_dir(&points).into_iter().flatten() {
            let path = entry.map_err(failed)?.path();
            if path.join(POINT).is_file() {
                fs::remove_dir_all(&path).map_err(failed)?;
            }
        }
        let files = vec![("sweep.json".to_owned(), self.identity.clone())];
        let mut left_over = output::left_over(&self.dir, &["sweep.json".to_owned()]);
        left_over.push("sweep.csv".to_owned());
        let record = (RECORD.to_owned(), self.author.record(&files));
        self.claim.write_all(&[files, vec![record]].concat(), &left_over)
    }

    /// The folder of point k, from 0; its name counts from 1.
    pub fn point(&self, k: usize) -> PathBuf {
        let mut path = self.dir.join(name_of(self.points.described.len(), k));
        path.pop();
        path
    }

    /// The finished points, in order.
    pub fn finished(&self) -> Vec<usize> {
        let all = 0..self.points.described.len();
        all.filter(|k| self.point(*k).is_dir()).collect()
    }

    /// Keeps the tables of a point.
    pub fn keep(&self, k: usize, tables: &[Output]) -> Result<(), OutputError> {
        let mut files = tables.to_vec();
        files.push((POINT.to_owned(), self.record(k, tables)));
        self.is_there()?;
        // Where it went meanwhile, that is the reason.
        output::write_folder(&self.point(k), &files).map_err(|error| self.is_there().err().unwrap_or(error))
    }

    /// Whether nobody has removed or moved the folder.
    fn is_there(&self) -> Result<(), OutputError> {
        if self.dir.join(RECORD).is_file() {
            return Ok(());
        }
        let gone = "the folder of the sweep has gone";
        Err(OutputError { path: self.dir.clone(), reason: io::Error::new(io::ErrorKind::NotFound, gone) })
    }

    /// Which point it is, and the lengths and checksums of its tables.
    fn record(&self, k: usize, tables: &[Output]) -> String {
        let point = &self.points.described[k];
        format!("{:#}\n", json!({ "point": point, "files": output::sums(tables) }))
    }

    /// The tables of a finished point, where they are as they were written.
    pub fn kept(&self, k: usize) -> Result<Vec<Output>, Refused> {
        let dir = self.point(k);
        let read = |name: &str| {
            let path = dir.join(name);
            let why = |error| format!("{}: cannot be read: {error}", path.shown());
            bounded::text(&path, MOST_BYTES).map_err(|error| self.damaged(k, &why(error)))
        };
        let record = read(POINT)?;
        let table = |name: &String| Ok((name.clone(), read(name)?));
        let tables = (self.points.tables.iter()).map(table).collect::<Result<Vec<_>, Refused>>()?;
        let own = self.record(k, &tables);
        if own == record {
            return Ok(tables);
        }
        let [found, own] =
            [&record, &own].map(|text| serde_json::from_str::<Value>(text).unwrap_or_default());
        let why = match difference(&found, &own) {
            Some((key, kept, own)) => {
                format!("{}: not as it was written: {key} was {kept} and is {own} now", dir.shown())
            }
            None => format!("{}: not as it was written", dir.join(POINT).shown()),
        };
        Err(self.damaged(k, &why))
    }

    fn damaged(&self, k: usize, why: &str) -> Refused {
        let dir = self.point(k);
        Refused::Other(format!(
            "{why}; remove {} to have this point run again; nothing was changed",
            dir.shown()
        ))
    }

    /// Writes `sweep.csv` from the tables of all points, which must all be there: the swept values, then the last
    /// row of each of the tables; and the record of all. Numbers are the tables' own texts. Returns the header and the rows.
    pub fn gather(&self, axes: &[Axis], values: &[Vec<toml::Value>]) -> Result<Rows, Refused> {
        let mut rows = Vec::new();
        let mut sums = Vec::new();
        for (k, values) in values.iter().enumerate() {
            let mut head: Vec<_> = axes.iter().map(|axis| axis.key.clone()).collect();
            let mut row: Vec<_> = values.iter().map(|value| cell(&shown(value))).collect();
            let tables = self.kept(k)?;
            sums.push((name_of(self.points.described.len(), k), self.record(k, &tables)));
            for (name, text) in tables {
                let (columns, last) = last_row(&text)
                    .map_err(|why| Refused::Other(format!("{}: {why}", self.point(k).join(&name).shown())))?;
                for (column, value) in columns.into_iter().zip(last) {
                    // Every table has the time.
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
                    return Err(Refused::Other(format!(
                        "{}: its tables have other columns than those of the first point",
                        self.point(k).shown()
                    )));
                }
            }
        }
        let path = self.dir.join("sweep.csv");
        let text = csv(&rows).map_err(|error| Refused::Other(format!("{}: {error}", path.shown())))?;
        let table = ("sweep.csv".to_owned(), text);
        let identity = ("sweep.json".to_owned(), self.identity.clone());
        let record = self.author.record(&[vec![table.clone(), identity], sums].concat());
        self.claim.write_all(&[table, (RECORD.to_owned(), record)], &[])?;
        Ok(rows)
    }
}

/// The record of a point, in its folder.
pub const POINT: &str = "point.json";

/// The record of point k, from 0, of so many; its folder's name counts from 1.
fn name_of(count: usize, k: usize) -> String {
    let width = count.to_string().len();
    format!("points/{:0width$}/{POINT}", k + 1)
}

/// A header and rows.
pub type Rows = Vec<Vec<String>>;

/// A table's header and last row.
fn last_row(text: &str) -> Result<(Vec<String>, Vec<String>), String> {
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let header = reader.headers().map_err(|error| error.to_string())?.clone();
    let last = reader.records().last();
    let last = last.ok_or("no row is there")?;
    let last = last.map_err(|error| error.to_string())?;
    let texts = |record: &csv::StringRecord| record.iter().map(str::to_owned).collect();
    Ok((texts(&header), texts(&last)))
}

fn csv(rows: &Rows) -> Result<String, String> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for row in rows {
        writer.write_record(row).map_err(|error| error.to_string())?;
    }
    let bytes = writer.into_inner().map_err(|error| error.to_string())?;
    String::from_utf8(bytes).map_err(|error| error.to_string())
}
