//! The folder of a sweep: `sweep.json` says which sweep it is, `points/` has a folder of tables for each point that
//! is finished, `sweep.csv` one row a point. Every file and every point's folder appears whole or not at all.

use super::axis::{Axis, shown};
use crate::output::{self, Output, OutputError};
use serde_json::{Value, json};
use shearbed::Scene;
use std::fs;
use std::path::{Path, PathBuf};

/// Which sweep it is: what the results depend on.
pub struct Identity(Value);

impl Identity {
    /// A sweep of `scene`, as it is without the swept keys, by this version of the program, with what its points' plans
    /// warn of.
    pub fn new(scene: &Scene, axes: &[Axis], warnings: &[String]) -> Self {
        let over = axes.iter().map(|axis| {
            let values: Vec<_> = axis.values.iter().map(shown).collect();
            format!("{}={}", axis.key, values.join(","))
        });
        Self(json!({
            "program": "shearbed",
            "version": env!("CARGO_PKG_VERSION"),
            "scene": scene.resolved(),
            "over": over.collect::<Vec<_>>(),
            "warnings": warnings,
        }))
    }

    fn text(&self) -> String {
        format!("{:#}\n", self.0)
    }
}

/// Why a folder was left as it is.
#[derive(Debug)]
pub enum Refused {
    /// It holds something else.
    Other(String),
    /// It cannot be written.
    Output(OutputError),
}

impl From<OutputError> for Refused {
    fn from(error: OutputError) -> Self {
        Self::Output(error)
    }
}

/// The folder of one sweep.
pub struct Folder {
    dir: PathBuf,
    points: usize,
}

impl Folder {
    /// Opens the folder, or makes it. One that holds another sweep, or files of unknown origin under the names of a
    /// sweep's, is refused and left as it is.
    pub fn open(dir: &Path, identity: &Identity, points: usize) -> Result<Self, Refused> {
        let path = dir.join("sweep.json");
        let at = |what: String| {
            let path = path.display();
            Refused::Other(format!(
                "{path}: {what}; give another --out, or remove the folder; nothing was changed"
            ))
        };
        match fs::read_to_string(&path) {
            Ok(text) => {
                let found: Value = serde_json::from_str(&text)
                    .map_err(|error| at(format!("is no record of a sweep: {error}")))?;
                // As text: what was written and read again is compared with the same.
                let own: Value = serde_json::from_str(&identity.text()).unwrap_or_default();
                if let Some(what) = difference("", &found, &own) {
                    return Err(at(format!("another sweep is kept here: {what}")));
                }
            }
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
                for name in ["points", "sweep.csv"] {
                    if dir.join(name).exists() {
                        return Err(at(format!("is missing beside {name}, whose origin nobody knows")));
                    }
                }
                output::write_all(dir, &[("sweep.json".to_owned(), identity.text())])?;
            }
            Err(error) => return Err(at(format!("cannot be read: {error}"))),
        }
        Ok(Self::at(dir, points))
    }

    /// A folder that was opened.
    pub fn at(dir: &Path, points: usize) -> Self {
        let dir = dir.to_owned();
        Self { dir, points }
    }

    /// The folder of point k, from 0; its name counts from 1.
    pub fn point(&self, k: usize) -> PathBuf {
        let width = self.points.to_string().len();
        self.dir.join("points").join(format!("{:0width$}", k + 1))
    }

    /// The finished points, in order.
    pub fn finished(&self) -> Vec<usize> {
        (0..self.points).filter(|k| self.point(*k).is_dir()).collect()
    }

    /// Keeps the tables of a point.
    pub fn keep(&self, k: usize, tables: &[Output]) -> Result<(), OutputError> {
        output::write_folder(&self.point(k), tables)
    }

    /// Whether the kept tables of a point are these.
    pub fn holds(&self, k: usize, tables: &[Output]) -> bool {
        let dir = self.point(k);
        (tables.iter()).all(|(name, text)| fs::read(dir.join(name)).is_ok_and(|kept| kept == text.as_bytes()))
    }

    /// Writes `sweep.csv` from the tables of all points, which must all be there: the swept values, then the last
    /// row of each of the tables `names`. Numbers are the tables' own texts. Returns the header and the rows.
    pub fn gather(
        &self,
        axes: &[Axis],
        values: &[Vec<toml::Value>],
        names: &[String],
    ) -> Result<Rows, Refused> {
        let mut rows = Vec::new();
        for (k, values) in values.iter().enumerate() {
            let mut head: Vec<_> = axes.iter().map(|axis| axis.key.clone()).collect();
            let mut row: Vec<_> = values.iter().map(shown).collect();
            for name in names {
                let (columns, last) = last_row(&self.point(k).join(name))?;
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
                        self.point(k).display()
                    )));
                }
            }
        }
        let path = self.dir.join("sweep.csv");
        let text = csv(&rows).map_err(|error| Refused::Other(format!("{}: {error}", path.display())))?;
        output::write_all(&self.dir, &[("sweep.csv".to_owned(), text)])?;
        Ok(rows)
    }
}

/// A header and rows.
pub type Rows = Vec<Vec<String>>;

/// A table's header and last row.
fn last_row(path: &Path) -> Result<(Vec<String>, Vec<String>), Refused> {
    let fail = |why: String| Refused::Other(format!("{}: cannot be read: {why}", path.display()));
    let mut reader = csv::Reader::from_path(path).map_err(|error| fail(error.to_string()))?;
    let header = reader.headers().map_err(|error| fail(error.to_string()))?.clone();
    let last = reader.records().last();
    let last = last.ok_or_else(|| fail("no row is there".into()))?;
    let last = last.map_err(|error| fail(error.to_string()))?;
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

/// The first difference of two records, in words.
pub fn difference(path: &str, kept: &Value, own: &Value) -> Option<String> {
    let below = |key: &str| match path {
        "" => key.to_owned(),
        path => format!("{path}.{key}"),
    };
    match (kept, own) {
        (Value::Object(a), Value::Object(b)) => (a.keys().chain(b.keys())).find_map(|key| {
            difference(
                &below(key),
                a.get(key).unwrap_or(&Value::Null),
                b.get(key).unwrap_or(&Value::Null),
            )
        }),
        (Value::Array(a), Value::Array(b)) if a.len() == b.len() => {
            (0..a.len()).find_map(|k| difference(&below(&(k + 1).to_string()), &a[k], &b[k]))
        }
        _ if kept == own => None,
        _ => Some(format!("{path} was {kept} and is {own} now")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_difference_is_named() {
        let a = json!({ "version": "1", "over": ["x=1", "y=1"], "scene": { "m": 3.0 } });
        assert_eq!(difference("", &a, &a.clone()), None);
        let mut b = a.clone();
        b["over"][1] = json!("y=2");
        assert_eq!(
            difference("", &a, &b).unwrap(),
            r#"over.2 was "y=1" and is "y=2" now"#
        );
        b["over"] = json!(["x=1"]);
        let all = difference("", &a, &b).unwrap();
        assert_eq!(all, r#"over was ["x=1","y=1"] and is ["x=1"] now"#);
        let mut b = a.clone();
        b["scene"] = json!({});
        assert_eq!(difference("", &a, &b).unwrap(), "scene.m was 3.0 and is null now");
        assert_eq!(difference("", &b, &a).unwrap(), "scene.m was null and is 3.0 now");
    }
}
