//! Reading a scene from TOML text, with errors that name file, line, key, value and what is allowed.

use crate::scene::Scene;
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
    let scene: Scene = toml::from_str(text).map_err(|error| {
        let line = line_of(text, error.span().map_or(0, |span| span.start));
        refused(
            file,
            line,
            &format!("{}: {}", quoted(text, line), error.message()),
        )
    })?;
    scene.check().map_err(|invalid| {
        let line = locate(text, invalid.key).map_or(1, |span| line_of(text, span.start));
        refused(file, line, &invalid.to_string())
    })?;
    Ok(scene)
}

fn refused(file: &str, line: usize, message: &str) -> SceneError {
    SceneError {
        file: file.to_owned(),
        line,
        message: message.trim_end().replace('\n', "; "),
    }
}

fn line_of(text: &str, offset: usize) -> usize {
    1 + text.as_bytes()[..offset.min(text.len())]
        .iter()
        .filter(|b| **b == b'\n')
        .count()
}

/// The line as written, which holds the key and the value.
fn quoted(text: &str, line: usize) -> &str {
    text.lines().nth(line - 1).map_or("(end of file)", str::trim)
}

/// Where `table.key` stands in the text; its table where the key is missing.
fn locate(text: &str, key: &str) -> Option<Range<usize>> {
    let document = DeTable::parse(text).ok()?;
    let mut table = document.get_ref();
    let mut span = None;
    for part in key.split('.') {
        let Some((name, value)) = table.iter().find(|(name, _)| name.get_ref() == part) else {
            break;
        };
        span = Some(name.span());
        match value.get_ref() {
            DeValue::Table(inner) => table = inner,
            _ => break,
        }
    }
    span
}
