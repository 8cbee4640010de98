//! Reads the keys of a provenance file, with errors that name file, line, key, value and what is allowed.

use crate::files::FileError;
use shearbed::Error;
use shearbed::scene::SceneProblem;
use shearbed::scene::document::{Document, Table};

pub(super) fn document(file: &str, text: &str) -> Result<Document, FileError> {
    Document::parse(file, text).map_err(|error| match error {
        Error::Text { mut problems, .. } if !problems.is_empty() => located(file, problems.remove(0)),
        other => FileError::whole(file, other.to_string()),
    })
}

fn located(file: &str, SceneProblem { line, message, .. }: SceneProblem) -> FileError {
    FileError::line(file, line.unwrap_or(0) as u64, message)
}

/// A table of the file.
pub(super) struct Keys<'a> {
    file: &'a str,
    /// Prefix of the dotted paths of its keys, such as `x.`; empty for the whole file.
    path: String,
    table: Table<'a>,
}

impl<'a> Keys<'a> {
    pub(super) fn of_file(file: &'a str, document: &'a Document) -> Self {
        Self { file, path: String::new(), table: document.root() }
    }

    fn inner(&self, key: &str, table: Table<'a>) -> Self {
        Self { path: format!("{}{key}.", self.path), table, ..*self }
    }

    /// The line of `key`, or of its table if the key is missing.
    pub(super) fn line(&self, key: &str) -> usize {
        self.table.line(key)
    }

    /// The error that `key` is missing or has a value other than `allowed`.
    pub(super) fn refused(&self, key: &str, allowed: &str) -> FileError {
        located(self.file, self.table.refused(key, format!("expected {allowed}")))
    }

    pub(super) fn has(&self, key: &str) -> bool {
        self.table.has(key)
    }

    /// The text at `key`, trimmed and not empty.
    pub(super) fn text(&self, key: &str, allowed: &str) -> Result<String, FileError> {
        let text = self.table.read::<String>(key).map(|text| text.trim().to_owned());
        text.filter(|text| !text.is_empty()).ok_or_else(|| self.refused(key, allowed))
    }

    /// The finite number at `key`, for which `holds` must be true.
    pub(super) fn number(&self, key: &str, allowed: &str, holds: impl Fn(f64) -> bool) -> Result<f64, FileError> {
        let number = self.table.read::<f64>(key).filter(|number| number.is_finite() && holds(*number));
        number.ok_or_else(|| self.refused(key, allowed))
    }

    /// The array of finite numbers at `key`.
    pub(super) fn numbers(&self, key: &str, allowed: &str) -> Result<Vec<f64>, FileError> {
        let numbers = self.table.read::<Vec<f64>>(key);
        let finite = |numbers: &Vec<f64>| numbers.iter().all(|number| number.is_finite());
        numbers.filter(finite).ok_or_else(|| self.refused(key, allowed))
    }

    pub(super) fn table(&self, key: &str, allowed: &str) -> Result<Self, FileError> {
        let table = self.table.table(key).ok_or_else(|| self.refused(key, allowed))?;
        Ok(self.inner(key, table))
    }

    /// The array of tables at `key`, at least one.
    pub(super) fn tables(&self, key: &str, allowed: &str) -> Result<Vec<Self>, FileError> {
        let tables = self.table.tables(key).ok_or_else(|| self.refused(key, allowed))?;
        Ok(tables.into_iter().map(|table| self.inner(key, table)).collect())
    }

    /// Fails if the table has a key that is not among `known`.
    pub(super) fn only(&self, known: &[&str]) -> Result<(), FileError> {
        let unknown = self.table.keys().find(|name| !known.contains(name));
        unknown.map_or(Ok(()), |name| {
            let message = format!("{}{name} is an unknown key; allowed are {}", self.path, known.join(", "));
            Err(FileError::line(self.file, self.line(name) as u64, message))
        })
    }
}
