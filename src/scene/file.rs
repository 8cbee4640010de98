//! Reading a scene from TOML text, with errors that name file, line, key, value and what is allowed: all that can be
//! told at once, not the first alone.

mod places;
#[cfg(test)]
mod tests;

use crate::scene::{self, Invalid, KEYS, Scene, TABLES, find, required};
use places::{Lines, shortened, stopped_at};
use std::ops::Range;
use toml::de::{DeTable, DeValue};
use toml::{Table, Value};

/// Why a scene file was refused. Printed, each problem has a line.
///
/// ```
/// let refused = shearbed::scene::parse("mine.toml", "title = 1").unwrap_err();
/// assert!(refused.to_string().contains("mine.toml:1: title = 1 is not allowed: a text in quotes"));
/// ```
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[error("{}", self.lines())]
pub struct SceneError {
    /// The file's name as given.
    pub file: String,
    /// What is wrong, in the order of lines; at least one.
    pub problems: Vec<Problem>,
}

/// One thing that is wrong with a scene file.
///
/// ```
/// let refused = shearbed::scene::parse("mine.toml", "\n\nseed = 1").unwrap_err();
/// assert!(refused.problems.iter().any(|problem| problem.line == 3 && problem.message.contains("seed")));
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Problem {
    /// The line at fault, from 1.
    pub line: usize,
    /// The key, its value and what is allowed.
    pub message: String,
}

impl SceneError {
    fn lines(&self) -> String {
        let line = |problem: &Problem| format!("{}:{}: {}", self.file, problem.line, problem.message);
        let lines: Vec<_> = self.problems.iter().map(line).collect();
        lines.join("\n")
    }
}

/// A place in the text, and what is wrong there.
type Found = (usize, String);

/// Reads and checks a scene; `file` names the text in errors.
///
/// # Errors
///
/// Everything that can be told to be wrong at once, each with its line.
pub fn parse(file: &str, text: &str) -> Result<Scene, SceneError> {
    let lines = Lines::of(text);
    read(&lines, text).map_err(|mut found| {
        found.sort();
        let problem = |(offset, message)| Problem { line: lines.number(offset), message };
        SceneError { file: file.to_owned(), problems: found.into_iter().map(problem).collect() }
    })
}

/// What [`crate::Plan::new`] found in a scene that was read from this text, at the line of its key.
pub fn located(file: &str, text: &str, invalid: Invalid) -> SceneError {
    let lines = Lines::of(text);
    let keys = DeTable::parse(text).map(|document| keys(text, "", document.get_ref(), &mut Vec::new()));
    let (offset, message) = as_written(&keys.unwrap_or_default(), invalid);
    SceneError { file: file.to_owned(), problems: vec![Problem { line: lines.number(offset), message }] }
}

/// The most unknown keys of which each has a line; the rest have one together.
const MOST_UNKNOWN: usize = 20;

fn read(lines: &Lines<'_>, text: &str) -> Result<Scene, Vec<Found>> {
    let reported = |error: toml::de::Error| vec![as_reported(lines, text, &error)];
    let document = DeTable::parse(text).map_err(reported)?;
    let mut unknown = Vec::new();
    let keys = keys(text, "", document.get_ref(), &mut unknown);
    // A number that no float holds spoils the whole text.
    let values: Table = text.parse().unwrap_or_default();
    unknown.sort();
    let more = unknown.split_off(unknown.len().min(MOST_UNKNOWN));
    let meant: Vec<_> = unknown.iter().filter_map(|(_, path)| nearest(path)).collect();
    let mut found = missing(&keys, &meant);
    found.extend(one_shape(&keys, &meant));
    found.extend(one_start(&keys, &meant));
    let line = |(start, path): &Found| (*start, format!("{}: {}", lines.line(*start), self::unknown(path)));
    found.extend(unknown.iter().map(line));
    let count = more.len();
    found
        .extend((more.first()).map(|(start, _)| (*start, format!("{count} more unknown keys from here on"))));
    let (mut scene, mut known) = (example(), Vec::new());
    for key in &keys {
        match key.put_into(&mut scene, &values) {
            Ok(()) => known.push(key.path.as_str()),
            Err(message) => found.push((key.span.start, message)),
        }
    }
    if found.is_empty() {
        let scene: Scene = toml::from_str(text).map_err(reported)?;
        let problems = scene.problems().into_iter();
        found.extend(problems.map(|invalid| as_written(&keys, invalid)));
        return if found.is_empty() { Ok(scene) } else { Err(found) };
    }
    // What can be read is checked key by key; what does not go together waits until all can be.
    let readable = scene.try_into::<Scene>();
    let ranges = readable.map_or(Vec::new(), |scene| scene.out_of_range());
    let own = (ranges.into_iter()).filter(|invalid| known.contains(&invalid.key));
    found.extend(own.map(|invalid| as_written(&keys, invalid)));
    Err(found)
}

/// A known key of the document, as `particles.count`.
struct Key {
    path: String,
    known: &'static scene::Key,
    span: Range<usize>,
    /// Its value as written.
    text: String,
    is_table: bool,
}

/// Every known key of the document, a table of a scene before the keys in it; the others' places and names go to `unknown`.
fn keys(text: &str, above: &str, table: &DeTable<'_>, unknown: &mut Vec<Found>) -> Vec<Key> {
    let mut found = Vec::new();
    for (name, value) in table {
        let path = format!("{above}{}", name.get_ref());
        let Some(known) = find(&path) else {
            unknown.push((name.span().start, path));
            continue;
        };
        found.push(Key {
            path: path.clone(),
            known,
            span: name.span(),
            text: text.get(value.span()).unwrap_or_default().to_owned(),
            is_table: value.get_ref().is_table(),
        });
        if let DeValue::Table(inner) = value.get_ref()
            && is_table(&path)
        {
            found.extend(keys(text, &format!("{path}."), inner, unknown));
        }
    }
    found
}

impl Key {
    /// The value as written, on one line; the start of a long one.
    fn value(&self) -> String {
        shortened(&self.text.split_whitespace().collect::<Vec<_>>().join(" "))
    }

    /// Gives the scene this key's value, where it can have it; or says why not.
    fn put_into(&self, scene: &mut Table, values: &Table) -> Result<(), String> {
        let path = self.path.as_str();
        let refused = || format!("{path} = {} is not allowed: {}", self.value(), self.known.holds);
        if is_table(path) {
            return if self.is_table { Ok(()) } else { Err(refused()) };
        }
        let value = if self.is_table {
            // What stands at the key may be a header alone.
            let (table, key) = path.split_once('.').unwrap_or(("", path));
            let within = values.get(table).and_then(Value::as_table);
            within.unwrap_or(values).get(key).cloned()
        } else {
            let read: Result<Table, _> = format!("value = {}", self.text).parse();
            read.ok().and_then(|mut table| table.remove("value"))
        };
        // No key takes a date, which would be read as a text.
        let value = value.filter(|value| !value.is_datetime()).ok_or_else(refused)?;
        let mut tried = scene.clone();
        put(&mut tried, path, value);
        match tried.clone().try_into::<Scene>() {
            Ok(_) => {
                *scene = tried;
                Ok(())
            }
            Err(_) => Err(refused()),
        }
    }
}

fn put(scene: &mut Table, path: &str, value: Value) {
    let (table, key) = path.split_once('.').unwrap_or(("", path));
    match scene.get_mut(table) {
        Some(Value::Table(inner)) => inner.insert(key.to_owned(), value),
        _ => scene.insert(key.to_owned(), value),
    };
}

/// A scene in which one value after the other can be tried.
fn example() -> Table {
    let text = "title = \"\"\nflow = {}\nensemble = {}\noutput = {}\ntime = {}\n\
        [particles]\ncount = 1\nlength_mm = 1\naspect_ratio = 2\norientation = \"isotropic\"\n\
        [interaction]\nconcentration_per_cm3 = 1\nalpha = 1\n";
    text.parse().unwrap_or_default()
}

/// Tables and keys that must be there and are not; one that is `meant` by an unknown key is told of there.
fn missing(keys: &[Key], meant: &[&str]) -> Vec<Found> {
    let has = |path: &str| keys.iter().find(|key| key.path == path);
    let mut found = Vec::new();
    for table in ["", "particles", "interaction"] {
        let at = match table {
            "" => Some(0),
            _ => has(table).filter(|key| key.is_table).map(|key| key.span.start),
        };
        let lacks = |key: &&scene::Key| has(key.path).is_none() && !meant.contains(&key.path);
        for (at, key) in at.into_iter().flat_map(|at| required(table).filter(lacks).map(move |key| (at, key)))
        {
            found.push((at, format!("{} is missing: {}", key.path, key.holds)));
        }
    }
    found
}

/// r_e is given once.
fn one_shape(keys: &[Key], meant: &[&str]) -> Option<Found> {
    let has = |path: &str| keys.iter().find(|key| key.path == path);
    let particles = has("particles").filter(|key| key.is_table)?;
    match (has("particles.aspect_ratio"), has("particles.physical_aspect_ratio")) {
        (Some(given), Some(_)) => {
            let message = format!(
                "particles.aspect_ratio = {} is not allowed: either aspect_ratio or physical_aspect_ratio, not both",
                given.value()
            );
            Some((given.span.start, message))
        }
        (None, None) if !meant.contains(&"particles.aspect_ratio") => {
            let allowed = find("particles.aspect_ratio")?.holds;
            let message = format!(
                "particles.aspect_ratio is missing: {allowed}; or physical_aspect_ratio and shape_correlation"
            );
            Some((particles.span.start, message))
        }
        _ => None,
    }
}

/// Directions are given, or a file that has them or leaves them to chance.
fn one_start(keys: &[Key], meant: &[&str]) -> Option<Found> {
    const START: [&str; 2] = ["particles.orientation", "particles.rods"];
    let has = |path: &str| keys.iter().find(|key| key.path == path);
    let particles = has("particles").filter(|key| key.is_table)?;
    let given = START.iter().any(|path| has(path).is_some() || meant.contains(path));
    let allowed = find(START[0])?.holds;
    (!given).then(|| (particles.span.start, format!("{} is missing: {allowed}", START[0])))
}

/// What is known in place of an unknown key.
fn unknown(path: &str) -> String {
    let known = paths(&KEYS).chain(paths(&TABLES)).filter(|key| table(key) == table(path));
    let known: Vec<_> = known.map(|key| format!("`{}`", last(key))).collect();
    let expected = match known.as_slice() {
        [one, other] => format!("{one} or {other}"),
        _ => format!("one of {}", known.join(", ")),
    };
    let meant = nearest(path).map_or(String::new(), |key| {
        let misplaced = table(key).is_empty() && !table(path).is_empty();
        let place = if misplaced { ", which comes before all tables" } else { "" };
        format!("; did you mean {key}{place}?")
    });
    format!("unknown key `{}`, expected {expected}{meant}", shortened(last(path)))
}

/// The key or table that an unknown one may stand for, by its last word.
fn nearest(path: &str) -> Option<&'static str> {
    // To compare a line of megabytes takes seconds, and what is ten times as long as any key is like none.
    if last(path).len() > 200 {
        return None;
    }
    let tables = paths(&TABLES).filter(|_| table(path).is_empty());
    let likeness = |key| strsim::jaro_winkler(last(path), last(key));
    let all = paths(&KEYS).chain(tables).map(|key| (likeness(key), key));
    let (best, key) = all.reduce(|a, b| if b.0 > a.0 { b } else { a })?;
    // A letter too many, too few or exchanged leaves more than this in words of five letters.
    (best > 0.85).then_some(key)
}

fn paths(keys: &'static [scene::Key]) -> impl Iterator<Item = &'static str> {
    keys.iter().map(|key| key.path)
}

fn is_table(path: &str) -> bool {
    paths(&TABLES).any(|table| table == path)
}

fn table(path: &str) -> &str {
    path.rsplit_once('.').map_or("", |(table, _)| table)
}

fn last(path: &str) -> &str {
    path.rsplit('.').next().unwrap_or(path)
}

/// The reader's own words after the line as written, which holds the key and the value.
fn as_reported(lines: &Lines<'_>, text: &str, error: &toml::de::Error) -> Found {
    let offset = stopped_at(text, error);
    let message = error.message().trim_end().replace('\n', "; ");
    (offset, format!("{}: {}", lines.line(offset), shortened(&message)))
}

/// Where a checked scene is wrong: the key, or where it is missing its table.
fn as_written(keys: &[Key], mut invalid: Invalid) -> Found {
    let key = keys.iter().find(|key| key.path == invalid.key);
    if let (Some(key), Some(value)) = (key, &mut invalid.value) {
        *value = key.value();
    }
    let table = invalid.key.split('.').next().unwrap_or_default();
    let place = key.or_else(|| keys.iter().find(|key| key.path == table));
    (place.map_or(0, |key| key.span.start), invalid.to_string())
}
