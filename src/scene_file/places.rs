//! Places in a text, and the lines that they are in.

use toml::de::DeTable;

/// Where the reader stopped. Of a key with more parts than it takes it does not say where that is: then, the start of
/// the first line up to which the text has the error.
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

/// The line of the byte `offset`, without the space around it.
pub(super) fn line_at(text: &str, offset: usize) -> String {
    let line = text.lines().nth(line_of(text, offset) - 1);
    line.map_or("(end of file)", str::trim).to_owned()
}

/// The number of the line of the byte `offset`, from 1.
pub(super) fn line_of(text: &str, offset: usize) -> usize {
    let before = &text.as_bytes()[..offset.min(text.len())];
    1 + before.iter().filter(|byte| **byte == b'\n').count()
}
