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
//! assert_eq!(document.root().table("bed").expect("a table").read("width_mm"), Some(4.5));
//! # Ok::<(), shearbed::Error>(())
//! ```

mod lines;

use super::error::{Error, SceneProblem};
#[cfg(test)]
pub(super) use lines::LOOKED_THROUGH;
pub(super) use lines::shortened;
use lines::{Lines, stopped_at};
use serde::de::DeserializeOwned;
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
    root: Entries,
}

type Entries = BTreeMap<String, Node>;

#[derive(Clone, Debug)]
struct Node {
    /// Byte offset of the key and byte range of its value; `None` for values set later.
    place: Option<(usize, Range<usize>)>,
    content: Content,
}

#[derive(Clone, Debug)]
enum Content {
    Table(Entries),
    Array(Vec<Node>),
    Single(Value),
}

/// The value in `text`, which has nothing else in it, as a scene file has it behind `=`; `None` if it is none.
pub fn value(text: &str) -> Option<Value> {
    let value = DeValue::parse(text).ok()?;
    (value.span() == (0..text.len())).then(|| Node::read(0, &value).value())
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
        Ok(Self { file: file.to_owned(), text: text.into(), lines, root: entries(root.get_ref()) })
    }

    /// A document of the values in `table`, which have no lines.
    pub(super) fn of(table: toml::Table) -> Self {
        let root = table.into_iter().map(|(key, value)| (key, Node::set(value))).collect();
        Self { file: String::new(), text: "".into(), lines: Lines::of(""), root }
    }

    /// The table at the root of the document.
    pub fn root(&self) -> Table<'_> {
        Table { document: self, path: String::new(), offset: Some(0), entries: &self.root }
    }

    /// Sets the value of a dotted key such as `interaction.alpha`; makes the tables above it if they are missing.
    ///
    /// # Errors
    ///
    /// If a part of the key before the last is not a table.
    pub fn set(&mut self, key: &str, value: Value) -> Result<(), Error> {
        let (mut entries, mut rest) = (&mut self.root, key);
        while let Some((first, inner)) = rest.split_once('.') {
            let made = || Node { place: None, content: Content::Table(Entries::new()) };
            let node = entries.entry(first.to_owned()).or_insert_with(made);
            match &mut node.content {
                Content::Table(inner) => entries = inner,
                _ => {
                    let message = format!("{first} is not a table: it has no key {inner}");
                    let problems = vec![SceneProblem { line: None, message }];
                    return Err(Error::Text { file: self.file.clone(), problems });
                }
            }
            rest = inner;
        }
        entries.insert(rest.to_owned(), Node::set(value));
        Ok(())
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
    offset: Option<usize>,
    entries: &'a Entries,
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
        self.entries.get(key).map(Node::value)
    }

    /// The whole table as TOML values.
    pub(super) fn whole(&self) -> toml::Table {
        values(self.entries)
    }

    /// The table at `key`; `None` if there is no table.
    pub fn table(&self, key: &str) -> Option<Table<'a>> {
        self.inner(key, self.entries.get(key)?)
    }

    /// The array of tables at `key`; `None` if there is none, or if it is empty.
    pub fn tables(&self, key: &str) -> Option<Vec<Table<'a>>> {
        match &self.entries.get(key)?.content {
            Content::Array(nodes) if !nodes.is_empty() => nodes.iter().map(|node| self.inner(key, node)).collect(),
            _ => None,
        }
    }

    fn inner(&self, key: &str, node: &'a Node) -> Option<Table<'a>> {
        let Content::Table(entries) = &node.content else {
            return None;
        };
        let offset = node.place.as_ref().map(|(at, _)| *at);
        Some(Table { document: self.document, path: format!("{}{key}.", self.path), offset, entries })
    }

    /// The line of `key`, or of this table if the key is missing; 1 for values set without a text.
    pub fn line(&self, key: &str) -> usize {
        self.offset(key).map_or(1, |at| self.document.lines.number(at))
    }

    pub(super) fn offset(&self, key: &str) -> Option<usize> {
        match self.entries.get(key) {
            Some(node) => node.place.as_ref().map(|(at, _)| *at),
            None => self.offset,
        }
    }

    /// The value of `key` as written in the text, on one line and shortened.
    pub fn written(&self, key: &str) -> Option<String> {
        let node = self.entries.get(key)?;
        let written = match &node.place {
            Some((_, span)) => self.document.text.get(span.clone()).unwrap_or_default().to_owned(),
            None => as_toml(&node.value()),
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

fn entries(table: &DeTable<'_>) -> Entries {
    let node = |(key, value): (&toml::Spanned<std::borrow::Cow<'_, str>>, _)| {
        (key.get_ref().to_string(), Node::read(key.span().start, value))
    };
    table.iter().map(node).collect()
}

fn values(entries: &Entries) -> toml::Table {
    entries.iter().map(|(key, node)| (key.clone(), node.value())).collect()
}

impl Node {
    fn read(at: usize, value: &toml::Spanned<DeValue<'_>>) -> Self {
        let single = Content::Single;
        let content = match value.get_ref() {
            DeValue::Table(table) => Content::Table(entries(table)),
            DeValue::Array(all) => {
                Content::Array(all.iter().map(|inner| Self::read(inner.span().start, inner)).collect())
            }
            DeValue::String(text) => single(Value::String(text.to_string())),
            DeValue::Boolean(is) => single(Value::Boolean(*is)),
            DeValue::Datetime(date) => single(Value::Datetime(*date)),
            DeValue::Float(number) => single(Value::Float(nearest(number.as_str(), 10))),
            DeValue::Integer(number) => {
                let (digits, radix) = (number.as_str(), number.radix());
                let long = |_| Value::Float(nearest(digits, radix));
                single(i64::from_str_radix(digits, radix).map_or_else(long, Value::Integer))
            }
        };
        Self { place: Some((at, value.span())), content }
    }

    fn set(value: Value) -> Self {
        let content = match value {
            Value::Table(inner) => {
                Content::Table(inner.into_iter().map(|(key, value)| (key, Self::set(value))).collect())
            }
            Value::Array(all) => Content::Array(all.into_iter().map(Self::set).collect()),
            other => Content::Single(other),
        };
        Self { place: None, content }
    }

    fn value(&self) -> Value {
        match &self.content {
            Content::Table(entries) => Value::Table(values(entries)),
            Content::Array(all) => Value::Array(all.iter().map(Self::value).collect()),
            Content::Single(value) => value.clone(),
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
