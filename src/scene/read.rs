//! Reads a scene from a document: each key by its row, reporting all mistakes that can be found at once.

#[cfg(test)]
mod tests;

use super::document::{self, Document, as_toml, shortened};
use super::keys::{Field, Holds, Key, TABLES, TITLE, find};
use super::{Absent, Ensemble, Error, Flow, Interaction, Liquid, Output, Particles, Scene, Time, TimeUnit, keys};

/// A byte offset in the text, and a message.
type Mistake = (Option<usize>, String);

/// Reads a scene; `file` names the text in errors. Every value is checked by itself; [`crate::Plan::new`] checks
/// consistency, and [`Document::located`] adds the lines to its error.
///
/// # Errors
///
/// Every mistake found, each with its line.
pub fn parse(file: &str, text: &str) -> Result<Scene, Error> {
    of_document(&Document::parse(file, text)?)
}

/// Reads a scene from a document, in which keys may have been changed.
///
/// ```
/// use shearbed::scene::{document::Document, of_document};
/// let text = "title = 't'\nflow = { shear_rate_per_s = 1 }\ntime = { periods = 1 }\n\
///     [particles]\ncount = 10\nlength_mm = 1\n\
///     aspect_ratio = 5\norientation = 'isotropic'\n";
/// let mut document = Document::parse("s.toml", text)?;
/// document.set("particles.count", 20.into())?;
/// assert_eq!(of_document(&document)?.particles.count, 20);
/// # Ok::<(), shearbed::Error>(())
/// ```
///
/// # Errors
///
/// As [`parse`].
pub fn of_document(document: &Document) -> Result<Scene, Error> {
    let root = document.root();
    let mut wrong = Vec::new();
    let meant = unknown_keys(document, &root, &mut wrong);
    let mut reader = Reader { table: root.clone(), meant: &meant, wrong: &mut wrong };
    let title = reader.key(TITLE.path, String::new());
    let flow = reader.table("flow", Flow::read);
    let liquid = reader.table("liquid", Liquid::read_keys);
    let particles = reader.table("particles", Particles::read);
    let interaction = reader.table("interaction", |reader| Interaction::read_keys(reader).map(Some));
    let time = reader.table("time", Time::read);
    let ensemble = reader.table("ensemble", Ensemble::read_keys);
    let output = reader.table("output", Output::read_keys);
    let scene = || {
        Some(Scene {
            title: title?,
            flow: flow?,
            liquid: liquid?,
            particles: particles?,
            interaction: interaction?,
            time: time?,
            ensemble: ensemble?,
            output: output?,
        })
    };
    match scene().filter(|_| wrong.is_empty()) {
        Some(scene) => in_other_units(document, scene.time.unit).map_or(Ok(scene), Err),
        None => Err(document.refused(wrong)),
    }
}

/// The error for times in the text if a duration in another unit was set: they are in the unit of the text.
fn in_other_units(document: &Document, unit: TimeUnit) -> Option<Error> {
    let was = TimeUnit::ALL.into_iter().find(|other| *other != unit && document.is_of_text(other.duration_key()))?;
    let output = document.root().table("output")?;
    let key = ["times", "rods_at"].into_iter().find(|key| document.is_of_text(&format!("output.{key}")))?;
    let (was, is) = (was.duration_key(), unit.duration_key());
    let allowed = format!("it goes with {was} of the scene; {is} is set, and this key has to be set too");
    Some(document.refused(vec![(output.offset(key), output.refusal(key, allowed))]))
}

/// Reads a table of the document and collects mistakes.
pub(super) struct Reader<'a> {
    table: document::Table<'a>,
    /// Known keys for which unknown ones may be misspellings: these are not reported as missing.
    meant: &'a [&'static str],
    wrong: &'a mut Vec<Mistake>,
}

impl Reader<'_> {
    /// The value of the key `path`; `default` if an optional key is not given; `None` if the key is refused.
    pub fn key<T: Field>(&mut self, path: &'static str, default: T) -> Option<T> {
        let key = find(path)?;
        match self.table.value(last(path)) {
            None if key.absent != Absent::Required => return Some(T::absent(default)),
            None if self.means(path) => (),
            None => self.refuse(path, &key.expected()),
            Some(value) => {
                let list = value.as_array().cloned();
                // No key takes a date, which would otherwise be read as a text.
                let value = Some(value).filter(|value| !value.is_datetime());
                if let Some(value) = value.and_then(|value| allowed(value, &key.holds)) {
                    return Some(value);
                }
                let at_fault = list.map_or(String::new(), |list| at_fault::<T>(&list, &key.holds));
                self.refuse(path, &(key.expected() + &at_fault));
            }
        }
        None
    }

    fn table<T: Default>(&mut self, path: &'static str, read: impl Fn(&mut Reader<'_>) -> Option<T>) -> Option<T> {
        let key = find(path)?;
        match self.table.table(path) {
            Some(table) => read(&mut Reader { table, meant: self.meant, wrong: self.wrong }),
            None if !self.has(path) && key.absent != Absent::Required => Some(T::default()),
            None => {
                if self.has(path) || !self.means(path) {
                    self.refuse(path, &key.expected());
                }
                None
            }
        }
    }

    /// The key of `keys` that is given, if it is the only one. Reports two at the first of them, and none with the
    /// message `missing`.
    pub fn one_of<const N: usize>(&mut self, keys: [&'static str; N], missing: &str) -> Option<&'static str> {
        let given: Vec<_> = keys.into_iter().filter(|key| self.has(key)).collect();
        match given.as_slice() {
            [one] => return Some(one),
            [] if !keys.iter().any(|key| self.means(key)) => self.refuse(keys[0], missing),
            [] => (),
            [first, second, ..] => {
                self.refuse(first, &format!("either {} or {}, not both", last(first), last(second)));
            }
        }
        None
    }

    /// Reports the first table in the array `path` for which `wrong_key` returns a key, at its line; true if there is
    /// one.
    pub fn refuses_table<'t>(
        &mut self,
        path: &str,
        wrong_key: impl Fn(toml::Table) -> Option<(String, &'t str)>,
    ) -> bool {
        let tables = self.table.tables(last(path)).unwrap_or_default();
        let refused = tables.iter().find_map(|table| Some((table, wrong_key(table.whole())?)));
        if let Some((table, (key, allowed))) = &refused {
            self.wrong.push((table.offset(key), table.refusal(key, allowed)));
        }
        refused.is_some()
    }

    pub fn has(&self, path: &str) -> bool {
        self.table.has(last(path))
    }

    /// True if an unknown key may be a misspelling of this one.
    pub fn means(&self, path: &str) -> bool {
        self.meant.contains(&path)
    }

    pub fn refuse(&mut self, path: &str, allowed: &str) {
        self.wrong.push((self.table.offset(last(path)), self.table.refusal(last(path), allowed)));
    }
}

fn allowed<T: Field>(value: toml::Value, holds: &Holds) -> Option<T> {
    T::from_toml(value).filter(|value| value.allowed(holds))
}

/// Which value of a refused list is the first at fault, by its place from 1: with it, the list up to there is refused.
/// Empty for an empty list, and for one of a fixed length.
fn at_fault<T: Field>(list: &[toml::Value], holds: &Holds) -> String {
    if !matches!(holds, Holds::Times | Holds::Observables) {
        return String::new();
    }
    let ends: Vec<usize> = (1..=list.len()).collect();
    let place = ends.partition_point(|end| allowed::<T>(list[..*end].to_vec().into(), holds).is_some());
    let value = list.get(place).map(|value| shortened(&as_toml(value)));
    value.map_or(String::new(), |value| format!("; the first wrong one is number {}: {value}", place + 1))
}

/// The largest number of unknown keys that are reported singly.
const MOST_UNKNOWN: usize = 20;

/// Reports unknown tables and keys; returns the known ones of which they may be misspellings.
fn unknown_keys(document: &Document, root: &document::Table<'_>, wrong: &mut Vec<Mistake>) -> Vec<&'static str> {
    let mut unknown: Vec<(Option<usize>, String)> = Vec::new();
    let mut look = |table: &document::Table<'_>, above: &str, known: &dyn Fn(&str) -> bool| {
        let names = table.keys().filter(|name| !known(name));
        unknown.extend(names.map(|name| (table.offset(name), format!("{above}{name}"))));
    };
    look(root, "", &|name| name == TITLE.path || TABLES.iter().any(|table| table.key.path == name));
    for of in &TABLES {
        if let Some(table) = root.table(of.key.path) {
            look(&table, &format!("{}.", of.key.path), &|name| of.keys.iter().any(|key| last(key.path) == name));
        }
    }
    unknown.sort();
    let more = unknown.split_off(unknown.len().min(MOST_UNKNOWN));
    for (at, path) in &unknown {
        let line = at.map_or_else(|| written(root, path), |at| document.line(at));
        wrong.push((*at, format!("{line}: {}", unknown_key(path))));
    }
    if let Some((at, _)) = more.first() {
        wrong.push((*at, format!("{} more unknown keys from here on", more.len())));
    }
    unknown.iter().filter_map(|(_, path)| nearest(path)).collect()
}

/// A key that was set without a text, with its value.
fn written(root: &document::Table<'_>, path: &str) -> String {
    let within = root.table(above(path));
    let written = within.as_ref().unwrap_or(root).written(last(path)).unwrap_or_default();
    format!("{path} = {written}")
}

/// A message that lists the known keys beside an unknown one, and the key that it may be a misspelling of.
fn unknown_key(path: &str) -> String {
    let known = all_paths().filter(|key| above(key) == above(path));
    let known: Vec<_> = known.map(|key| format!("`{}`", last(key))).collect();
    let expected = match known.as_slice() {
        [one, other] => format!("{one} or {other}"),
        _ => format!("one of {}", known.join(", ")),
    };
    let meant = nearest(path).map_or(String::new(), |key| {
        let misplaced = above(key).is_empty() && !above(path).is_empty();
        let place = if misplaced { ", which comes before all tables" } else { "" };
        format!("; did you mean {key}{place}?")
    });
    format!("unknown key `{}`, expected {expected}{meant}", shortened(last(path)))
}

/// How similar a word is to a known name, from 0 to 1 (Jaro–Winkler).
pub fn likeness(word: &str, name: &str) -> f64 {
    // Comparing megabytes takes seconds, and a word ten times as long as any name is similar to none.
    if word.len() > 200 { 0.0 } else { strsim::jaro_winkler(word, name) }
}

/// The key or table whose last part is most similar to that of an unknown one; `None` if none is similar.
fn nearest(path: &str) -> Option<&'static str> {
    let likeness = |key| likeness(last(path), last(key));
    let is_key = |key: &&str| keys().any(|known| known.path == *key);
    let all = all_paths().filter(|key| above(path).is_empty() || is_key(key));
    let (best, key) = all.map(|key| (likeness(key), key)).reduce(|a, b| if b.0 > a.0 { b } else { a })?;
    // With one letter missing, added or exchanged, words of five letters are more similar than this.
    (best > 0.85).then_some(key)
}

/// The paths of all keys, then of all tables.
fn all_paths() -> impl Iterator<Item = &'static str> {
    const ALL: &[super::Table] = &TABLES;
    keys().map(|key: &Key| key.path).chain(ALL.iter().map(|table| table.key.path))
}

fn above(path: &str) -> &str {
    path.rsplit_once('.').map_or("", |(table, _)| table)
}

fn last(path: &str) -> &str {
    path.rsplit('.').next().unwrap_or(path)
}
