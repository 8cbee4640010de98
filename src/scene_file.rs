//! Reading a scene from TOML text, with errors that name file, line, key, value and what is allowed.

use crate::scene::{Invalid, Scene, allowed};
use std::ops::Range;
use toml::de::{DeTable, DeValue};

/// Why a scene file was refused.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{file}:{line}: {message}")]
pub struct SceneError {
    /// The file's name as given.
    pub file: String,
    /// The line at fault, from 1.
    pub line: usize,
    /// The key, its value and what is allowed.
    pub message: String,
}

/// Reads and checks a scene; `file` names the text in errors.
pub fn parse(file: &str, text: &str) -> Result<Scene, SceneError> {
    let refused = |(offset, message): (usize, String)| SceneError {
        file: file.to_owned(),
        line: line_of(text, offset),
        message,
    };
    let document = DeTable::parse(text).map_err(|error| refused(as_reported(text, &error)))?;
    let keys = keys(text, "", document.get_ref());
    let scene: Scene = toml::from_str(text).map_err(|error| refused(explained(text, &keys, &error)))?;
    scene
        .check()
        .map_err(|invalid| refused(as_written(&keys, invalid)))?;
    Ok(scene)
}

/// A key of the document, as `particles.count`.
struct Key {
    path: String,
    span: Range<usize>,
    value_span: Range<usize>,
    /// The value as written, on one line.
    value: String,
}

/// Every key of the document, a table before the keys in it.
fn keys(text: &str, above: &str, table: &DeTable<'_>) -> Vec<Key> {
    let mut found = Vec::new();
    for (name, value) in table {
        let path = format!("{above}{}", name.get_ref());
        let written = text.get(value.span()).unwrap_or_default();
        found.push(Key {
            path: path.clone(),
            span: name.span(),
            value_span: value.span(),
            value: written.split_whitespace().collect::<Vec<_>>().join(" "),
        });
        if let DeValue::Table(inner) = value.get_ref() {
            found.extend(keys(text, &format!("{path}."), inner));
        }
    }
    found
}

/// Where a checked scene is wrong: the key, or where it is missing its table.
fn as_written(keys: &[Key], mut invalid: Invalid) -> (usize, String) {
    let key = keys.iter().find(|key| key.path == invalid.key);
    if let (Some(key), Some(value)) = (key, &mut invalid.value) {
        value.clone_from(&key.value);
    }
    let table = invalid.key.split('.').next().unwrap_or_default();
    let place = key.or_else(|| keys.iter().find(|key| key.path == table));
    (place.map_or(0, |key| key.span.start), invalid.to_string())
}

/// The reader's error in terms of key, value and what is allowed, where it is about a missing key or about the
/// value of a known key.
fn explained(text: &str, keys: &[Key], error: &toml::de::Error) -> (usize, String) {
    // What is missing from the whole file has an empty span.
    let offset = error
        .span()
        .filter(|span| !span.is_empty())
        .map(|span| span.start);
    let holds = |key: &&Key| offset.is_some_and(|at| key.span.contains(&at) || key.value_span.contains(&at));
    let known = keys
        .iter()
        .filter(holds)
        .rfind(|key| allowed(&key.path).is_some());
    let message = error.message();
    if let Some(name) = message.strip_prefix("missing field ") {
        let table = known.map_or(String::new(), |table| format!("{}.", table.path));
        let path = format!("{table}{}", name.trim_matches('`'));
        let allowed = allowed(&path).unwrap_or_default();
        return (offset.unwrap_or(0), format!("{path} is missing: {allowed}"));
    }
    match known {
        Some(Key {
            path, span, value, ..
        }) if !message.starts_with("unknown field") => {
            let allowed = allowed(path).unwrap_or_default();
            (span.start, format!("{path} = {value} is not allowed: {allowed}"))
        }
        _ => as_reported(text, error),
    }
}

/// The reader's own words after the line as written, which holds the key and the value.
fn as_reported(text: &str, error: &toml::de::Error) -> (usize, String) {
    let offset = error.span().map_or(0, |span| span.start);
    let line = text.lines().nth(line_of(text, offset) - 1);
    let line = line.map_or("(end of file)", str::trim);
    let message = error.message().trim_end().replace('\n', "; ");
    let message = message.replace("unknown field", "unknown key");
    (offset, format!("{line}: {message}"))
}

fn line_of(text: &str, offset: usize) -> usize {
    let before = &text.as_bytes()[..offset.min(text.len())];
    1 + before.iter().filter(|byte| **byte == b'\n').count()
}
