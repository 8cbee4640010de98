//! Byte offsets in a text, and the lines that contain them.

use toml::de::DeTable;

/// The byte at which the TOML parser stopped. The parser gives no place for a key with too many parts; then this is the
/// start of the first line up to which the text has that error.
pub(super) fn stopped_at(text: &str, error: &toml::de::Error) -> usize {
    let placeless = |end: usize| {
        let (_, errors) = DeTable::parse_recoverable(&text[..end]);
        errors.iter().any(|error| error.span().is_none())
    };
    match error.span() {
        Some(span) => span.start,
        None if placeless(text.len()) => {
            let ends: Vec<usize> = text.match_indices('\n').map(|(at, _)| at + 1).collect();
            let lines_before = ends.partition_point(|&end| !placeless(end));
            lines_before.checked_sub(1).map_or(0, |last| ends[last])
        }
        None => 0,
    }
}

/// The byte offset at which each line of a text starts.
#[derive(Clone, Debug)]
pub(super) struct Lines {
    starts: Vec<usize>,
}

impl Lines {
    pub fn of(text: &str) -> Self {
        count(text.len());
        let after = text.match_indices('\n').map(|(at, _)| at + 1);
        Self { starts: std::iter::once(0).chain(after).collect() }
    }

    /// The number, from 1, of the line that contains the byte `offset`.
    pub fn number(&self, offset: usize) -> usize {
        self.starts.partition_point(|start| *start <= offset)
    }

    /// The line that contains the byte `offset`, trimmed and shortened.
    pub fn line(&self, text: &str, offset: usize) -> String {
        let start = self.starts[self.number(offset) - 1];
        if start == text.len() {
            return "(end of file)".to_owned();
        }
        // Searches no further than is shown: one line may have many keys.
        let rest = text[start..].char_indices();
        let end = |(at, c): &(usize, char)| *c == '\n' || *at > 4 * SHOWN;
        let end = rest.clone().find(end).map_or(text.len(), |(at, _)| start + at);
        count(end - start);
        shortened(text[start..end].trim())
    }
}

/// The largest number of characters shown of a line or a value.
const SHOWN: usize = 160;

/// The text, cut to the length shown; a mark stands for the rest.
pub(in crate::scene) fn shortened(text: &str) -> String {
    match text.char_indices().nth(SHOWN) {
        Some((end, _)) => format!("{} …", &text[..end]),
        None => text.to_owned(),
    }
}

#[cfg(test)]
thread_local! {
    /// Number of bytes of text searched on this thread.
    pub(in crate::scene) static LOOKED_THROUGH: std::cell::Cell<usize> = const { std::cell::Cell::new(0) };
}

#[cfg(test)]
fn count(bytes: usize) {
    LOOKED_THROUGH.set(LOOKED_THROUGH.get() + bytes);
}

#[cfg(not(test))]
fn count(_: usize) {}
