//! Reading keys of a TOML file one by one, with errors that name file, line, key, value and what is allowed.

use super::error::DataError;
use toml::de::{DeTable, DeValue};

/// A table of the file with its place, for messages.
pub(super) struct Table<'a> {
    file: &'a str,
    text: &'a str,
    /// What stands before its keys, as `x.`; nothing for the whole file.
    path: String,
    /// Where the table starts.
    line: usize,
    entries: &'a DeTable<'a>,
}

impl<'a> Table<'a> {
    /// The table of a whole file.
    pub(super) fn of_file(file: &'a str, text: &'a str, entries: &'a DeTable<'a>) -> Self {
        Self { file, text, path: String::new(), line: 1, entries }
    }

    fn inner(&self, key: &str, offset: usize, entries: &'a DeTable<'a>) -> Self {
        Self { path: format!("{}{key}.", self.path), line: line_of(self.text, offset), entries, ..*self }
    }

    /// The line of a key, or of its table where it is missing.
    pub(super) fn line(&self, key: &str) -> usize {
        let offset = self.entries.get_key_value(key).map(|(name, _)| name.span().start);
        offset.map_or(self.line, |offset| line_of(self.text, offset))
    }

    /// The error that `key` does not hold what is allowed, or is missing.
    pub(super) fn refused(&self, key: &str, allowed: &str) -> DataError {
        let path = format!("{}{key}", self.path);
        let message = match self.entries.get(key) {
            None => format!("{path} is missing: {allowed}"),
            Some(value) => {
                let written = self.text.get(value.span()).unwrap_or_default();
                let written = written.split_whitespace().collect::<Vec<_>>().join(" ");
                format!("{path} = {written} is not allowed: {allowed}")
            }
        };
        DataError::at(self.file, self.line(key), message)
    }

    /// Whether the key is there.
    pub(super) fn has(&self, key: &str) -> bool {
        self.entries.get(key).is_some()
    }

    /// A text that is not empty.
    pub(super) fn text(&self, key: &str, allowed: &str) -> Result<String, DataError> {
        let text = self.entries.get(key).and_then(|value| value.get_ref().as_str());
        match text.map(str::trim) {
            Some(text) if !text.is_empty() => Ok(text.to_owned()),
            _ => Err(self.refused(key, allowed)),
        }
    }

    /// A number for which `holds`.
    pub(super) fn number(
        &self,
        key: &str,
        allowed: &str,
        holds: impl Fn(f64) -> bool,
    ) -> Result<f64, DataError> {
        let number = self.entries.get(key).and_then(|value| number(value.get_ref()));
        number.filter(|number| holds(*number)).ok_or_else(|| self.refused(key, allowed))
    }

    /// Every number of an array of numbers.
    pub(super) fn numbers(&self, key: &str, allowed: &str) -> Result<Vec<f64>, DataError> {
        let array = self.entries.get(key).and_then(|value| value.get_ref().as_array());
        let numbers = array.and_then(|array| array.iter().map(|value| number(value.get_ref())).collect());
        numbers.ok_or_else(|| self.refused(key, allowed))
    }

    /// The table of this key.
    pub(super) fn table(&self, key: &str, allowed: &str) -> Result<Table<'a>, DataError> {
        let value = self.entries.get(key);
        let found = value.and_then(|value| Some((value.span().start, value.get_ref().as_table()?)));
        let (offset, entries) = found.ok_or_else(|| self.refused(key, allowed))?;
        Ok(self.inner(key, offset, entries))
    }

    /// The array of tables of this key: one at least.
    pub(super) fn tables(&self, key: &str, allowed: &str) -> Result<Vec<Table<'a>>, DataError> {
        let array = self.entries.get(key).and_then(|value| value.get_ref().as_array());
        let tables: Option<Vec<_>> = array.and_then(|array| {
            let inner = |value: &'a toml::Spanned<DeValue<'a>>| {
                Some(self.inner(key, value.span().start, value.get_ref().as_table()?))
            };
            array.iter().map(inner).collect()
        });
        match tables {
            Some(tables) if !tables.is_empty() => Ok(tables),
            _ => Err(self.refused(key, allowed)),
        }
    }

    /// Refuses keys that are none of these.
    pub(super) fn only(&self, known: &[&str]) -> Result<(), DataError> {
        let unknown = self.entries.keys().find(|name| !known.contains(&name.get_ref().as_ref()));
        unknown.map_or(Ok(()), |name| {
            let message =
                format!("{}{} is no key here; there are {}", self.path, name.get_ref(), known.join(", "));
            Err(DataError::at(self.file, line_of(self.text, name.span().start), message))
        })
    }
}

fn number(value: &DeValue<'_>) -> Option<f64> {
    let number: f64 = match value {
        DeValue::Float(float) => float.as_str().parse().ok()?,
        DeValue::Integer(integer) if integer.radix() == 10 => integer.as_str().parse().ok()?,
        _ => return None,
    };
    number.is_finite().then_some(number)
}

/// The line, from 1, of an offset in bytes.
pub(super) fn line_of(text: &str, offset: usize) -> usize {
    let before = &text.as_bytes()[..offset.min(text.len())];
    1 + before.iter().filter(|byte| **byte == b'\n').count()
}
