//! A TOML text as a tree of values with their line numbers, so that errors can name the line; single values can be
//! replaced.
//!
//! ```
//! use shearbed::scene::document::Document;
//! let mut document = Document::parse("bed.toml", "[bed]\nwidth_mm = 3\n")?;
//! let bed = document.root().table("bed").expect("a table");
//! assert_eq!((bed.read::<f64>("width_mm"), bed.line("width_mm")), (Some(3.0), 2));
//! let problem = bed.refused("depth_mm", "expected a number > 0");
//! assert_eq!((problem.line, &problem.message[..]), (Some(1), "bed.depth_mm is missing: expected a number > 0"));
//! document.set("bed.width_mm", 4.5.into())?;
//! let bed = document.root().table("bed").expect("a table");
//! assert_eq!((bed.read("width_mm"), bed.line("width_mm")), (Some(4.5), 1)); // set without a line
//! # Ok::<(), shearbed::Error>(())
//! ```

mod lines;

use super::error::{Error, SceneProblem};
#[cfg(test)]
pub(super) use lines::LOOKED_THROUGH;
pub(super) use lines::shortened;
use lines::{Lines, stopped_at};
use serde::de::DeserializeOwned;
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;
use toml::Value;
use toml::de::{DeTable, DeValue};

/// A parsed TOML text, or values that were set without a text.
#[derive(Clone, Debug)]
pub struct Document {
    file: String,
    text: Arc<str>,
    lines: Lines,
    root: toml::Table,
    places: Places,
}

/// By the keys on the way to a value, the byte offset of its key and the byte range of the value; without values that
/// were set later. An array's tables have their indices as keys.
type Places = BTreeMap<Vec<String>, (usize, Range<usize>)>;

/// The value in `text`, which has nothing else in it, as a scene file has it behind `=`; `None` if it is none.
pub fn value(text: &str) -> Option<Value> {
    let value = DeValue::parse(text).ok()?;
    (value.span() == (0..text.len())).then(|| read(value.get_ref(), &mut Vec::new(), &mut Places::new()))
}

impl Document {
    /// Reads a text; `file` names it in errors.
    ///
    /// # Errors
    ///
    /// Names the first place that is not TOML.
    pub fn parse(file: &str, text: &str) -> Result<Self, Error> {
        let (lines, root) = (Lines::of(text), DeTable::parse(text));
        let root = root.map_err(|error| {
            let offset = stopped_at(text, &error);
            let message = shortened(&error.message().trim_end().replace('\n', "; "));
            let message = format!("{}: {message}", lines.line(text, offset));
            let line = Some(lines.number(offset));
            Error::Text { file: file.to_owned(), problems: vec![SceneProblem { line, message }] }
        })?;
        let mut places = Places::new();
        let root = read_table(root.get_ref(), &mut Vec::new(), &mut places);
        Ok(Self { file: file.to_owned(), text: text.into(), lines, root, places })
    }

    /// A document of the values in `table`, which have no lines.
    pub(super) fn of(table: toml::Table) -> Self {
        Self { file: String::new(), text: "".into(), lines: Lines::of(""), root: table, places: Places::new() }
    }

    /// The table at the root of the document.
    pub fn root(&self) -> Table<'_> {
        Table { document: self, path: String::new(), keys: Vec::new(), offset: Some(0), entries: &self.root }
    }

    /// Sets the value of a dotted key such as `interaction.alpha`; makes the tables above it if they are missing.
    ///
    /// # Errors
    ///
    /// If a part of the key before the last is not a table.
    pub fn set(&mut self, key: &str, value: Value) -> Result<(), Error> {
        let (mut entries, mut rest) = (&mut self.root, key);
        while let Some((first, inner)) = rest.split_once('.') {
            let made = || Value::Table(toml::Table::new());
            let Value::Table(next) = entries.entry(first.to_owned()).or_insert_with(made) else {
                let message = format!("{first} is not a table: it has no key {inner}");
                let problems = vec![SceneProblem { line: None, message }];
                return Err(Error::Text { file: self.file.clone(), problems });
            };
            (entries, rest) = (next, inner);
        }
        entries.insert(rest.to_owned(), value);
        let set: Vec<_> = key.split('.').collect();
        self.places.retain(|keys, _| !keys.iter().map(String::as_str).take(set.len()).eq(set.iter().copied()));
        Ok(())
    }

    /// Takes a dotted key of the text out; one that was set stays.
    pub(super) fn drop_written(&mut self, key: &str) {
        if self.is_of_text(key) {
            self.remove(key);
        }
    }

    /// True for a dotted key of the text, also if it was taken out since, but not if it was set.
    pub(super) fn is_of_text(&self, key: &str) -> bool {
        self.places.contains_key(&key.split('.').map(str::to_owned).collect::<Vec<_>>())
    }

    /// Takes a dotted key out, where it is.
    pub fn remove(&mut self, key: &str) {
        let (mut entries, mut rest) = (&mut self.root, key);
        while let Some((first, inner)) = rest.split_once('.') {
            let Some(Value::Table(next)) = entries.get_mut(first) else { return };
            (entries, rest) = (next, inner);
        }
        entries.remove(rest);
    }

    /// Adds the line of each key to an error of the scene that was read from this document; returns other errors
    /// unchanged.
    pub fn located(&self, error: Error) -> Error {
        let Error::Scene(invalid) = error else {
            return error;
        };
        let root = self.root();
        let places = invalid.into_iter().map(|mut invalid| {
            let (table, name) = invalid.key.split_once('.').unwrap_or(("", invalid.key));
            let within = root.table(table);
            let within = within.as_ref().unwrap_or(&root);
            if let (Some(written), Some(value)) = (within.written(name), &mut invalid.value) {
                *value = written;
            }
            (within.offset(name), invalid.to_string())
        });
        self.refused(places.collect())
    }

    /// The error with these messages, sorted by line; each comes with the byte offset of its line.
    pub(super) fn refused(&self, mut found: Vec<(Option<usize>, String)>) -> Error {
        found.sort();
        let problem =
            |(at, message): (Option<usize>, String)| SceneProblem { line: at.map(|at| self.lines.number(at)), message };
        Error::Text { file: self.file.clone(), problems: found.into_iter().map(problem).collect() }
    }

    /// The line that contains the byte `offset` of the text, shortened.
    pub(super) fn line(&self, offset: usize) -> String {
        self.lines.line(&self.text, offset)
    }
}

/// A table of a document.
#[derive(Clone, Debug)]
pub struct Table<'a> {
    document: &'a Document,
    /// Prefix of the dotted paths of its keys, such as `x.`; empty for the whole document.
    path: String,
    /// Its place in the document.
    keys: Vec<String>,
    offset: Option<usize>,
    entries: &'a toml::Table,
}

impl<'a> Table<'a> {
    /// The names of the table's keys.
    pub fn keys(&self) -> impl Iterator<Item = &'a str> {
        self.entries.keys().map(String::as_str)
    }

    /// True if the table has the key `key`.
    pub fn has(&self, key: &str) -> bool {
        self.entries.contains_key(key)
    }

    /// The value of `key` if it has the type `T`, else `None`. Read sequences of a fixed length as `Vec`: an array
    /// accepts longer ones too.
    pub fn read<T: DeserializeOwned>(&self, key: &str) -> Option<T> {
        self.value(key)?.try_into().ok()
    }

    /// The value of `key`, or `None`.
    pub fn value(&self, key: &str) -> Option<Value> {
        self.entries.get(key).cloned()
    }

    /// The keys and values.
    pub fn whole(&self) -> toml::Table {
        self.entries.clone()
    }

    /// The table at `key`; `None` if there is no table.
    pub fn table(&self, key: &str) -> Option<Table<'a>> {
        self.inner(key, vec![key.to_owned()], self.entries.get(key)?)
    }

    /// The array of tables at `key`; `None` if there is none, or if it is empty.
    pub fn tables(&self, key: &str) -> Option<Vec<Table<'a>>> {
        let all = self.entries.get(key)?.as_array().filter(|all| !all.is_empty())?.iter().enumerate();
        all.map(|(k, value)| self.inner(key, vec![key.to_owned(), k.to_string()], value)).collect()
    }

    fn inner(&self, key: &str, below: Vec<String>, value: &'a Value) -> Option<Table<'a>> {
        let (document, path, keys) = (self.document, format!("{}{key}.", self.path), [&self.keys[..], &below].concat());
        let offset = document.places.get(&keys).map(|(at, _)| *at);
        Some(Table { document, path, keys, offset, entries: value.as_table()? })
    }

    fn place(&self, key: &str) -> Option<&(usize, Range<usize>)> {
        self.document.places.get(&[&self.keys[..], &[key.to_owned()]].concat())
    }

    /// The line of `key`, or of this table if the key is missing; 1 for values set without a text.
    pub fn line(&self, key: &str) -> usize {
        self.offset(key).map_or(1, |at| self.document.lines.number(at))
    }

    pub(super) fn offset(&self, key: &str) -> Option<usize> {
        if self.has(key) { self.place(key).map(|(at, _)| *at) } else { self.offset }
    }

    /// The value of `key` as written in the text, on one line and shortened.
    pub fn written(&self, key: &str) -> Option<String> {
        let value = self.entries.get(key)?;
        let written = match self.place(key) {
            Some((_, span)) => self.document.text.get(span.clone()).unwrap_or_default().to_owned(),
            None => as_toml(value),
        };
        Some(shortened(&written.split_whitespace().collect::<Vec<_>>().join(" ")))
    }

    /// The problem of a key that is missing or whose value is not allowed; `allowed` says what is.
    pub fn refused(&self, key: &str, allowed: impl std::fmt::Display) -> SceneProblem {
        let line = self.offset(key).map(|at| self.document.lines.number(at));
        SceneProblem { line, message: self.refusal(key, allowed) }
    }

    pub(super) fn refusal(&self, key: &str, allowed: impl std::fmt::Display) -> String {
        match self.written(key) {
            Some(written) => format!("{}{key} = {written} is not allowed: {allowed}", self.path),
            None => format!("{}{key} is missing: {allowed}", self.path),
        }
    }
}

fn read_table(table: &DeTable<'_>, keys: &mut Vec<String>, places: &mut Places) -> toml::Table {
    let mut read = |(key, value): (&toml::Spanned<Cow<'_, str>>, &toml::Spanned<DeValue<'_>>)| {
        keys.push(key.get_ref().to_string());
        places.insert(keys.clone(), (key.span().start, value.span()));
        let value = read(value.get_ref(), keys, places);
        (keys.pop().unwrap_or_default(), value)
    };
    table.iter().map(&mut read).collect()
}

fn read(value: &DeValue<'_>, keys: &mut Vec<String>, places: &mut Places) -> Value {
    match value {
        DeValue::Table(table) => Value::Table(read_table(table, keys, places)),
        DeValue::Array(all) => {
            let mut element = |(k, inner): (usize, &toml::Spanned<DeValue<'_>>)| {
                keys.push(k.to_string());
                if let DeValue::Table(_) = inner.get_ref() {
                    places.insert(keys.clone(), (inner.span().start, inner.span()));
                }
                let element = read(inner.get_ref(), keys, places);
                keys.pop();
                element
            };
            Value::Array(all.iter().enumerate().map(&mut element).collect())
        }
        DeValue::String(text) => Value::String(text.to_string()),
        DeValue::Boolean(is) => Value::Boolean(*is),
        DeValue::Datetime(date) => Value::Datetime(*date),
        DeValue::Float(number) => Value::Float(nearest(number.as_str(), 10)),
        DeValue::Integer(number) => {
            let (digits, radix) = (number.as_str(), number.radix());
            let long = |_| Value::Float(nearest(digits, radix));
            i64::from_str_radix(digits, radix).map_or_else(long, Value::Integer)
        }
    }
}

/// The double nearest to a number; infinite where there is none, which no key allows.
fn nearest(digits: &str, radix: u32) -> f64 {
    match radix {
        10 => digits.parse().unwrap_or(f64::INFINITY),
        _ => u128::from_str_radix(digits, radix).map_or(f64::INFINITY, |whole| whole as f64),
    }
}

/// A number, with a power of ten where it would have many zeros.
pub(crate) fn decimal(number: f64) -> String {
    if number == 0.0 || !number.is_finite() || (1e-5..1e16).contains(&number.abs()) {
        number.to_string()
    } else {
        format!("{number:e}")
    }
}

/// A value in TOML, on one line.
pub(crate) fn as_toml(value: &Value) -> String {
    match value {
        Value::String(text) => format!("{text:?}"),
        Value::Integer(number) => number.to_string(),
        Value::Float(number) if number.fract() == 0.0 && number.abs() < 1e16 => format!("{number:.1}"),
        Value::Float(number) => decimal(*number),
        Value::Boolean(is) => is.to_string(),
        Value::Datetime(date) => date.to_string(),
        Value::Array(all) => format!("[{}]", all.iter().map(as_toml).collect::<Vec<_>>().join(", ")),
        Value::Table(inner) => {
            let pairs = inner.iter().map(|(key, value)| format!("{key} = {}", as_toml(value)));
            format!("{{ {} }}", pairs.collect::<Vec<_>>().join(", "))
        }
    }
}
