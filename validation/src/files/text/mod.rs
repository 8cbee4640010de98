//! Makes texts of other people harmless: on a terminal, in cells of a table, in a shell.

mod columns;
mod message;
mod shell;

pub(crate) use columns::widths;
pub use columns::{four_decimals, left_aligned, right_aligned};
pub(crate) use message::shortened;
pub use message::{complain, message};
pub use shell::command;

use serde::Serialize;
use std::borrow::Cow;
use std::path::Path;

/// True if a character controls a terminal, changes the direction of writing, is invisible, or is not allowed in HTML
/// and SVG. Line feeds and tabulators are allowed.
fn commands(c: char) -> bool {
    (c.is_control() && !matches!(c, '\n' | '\t'))
        || matches!(c, '\u{2028}' | '\u{2029}' | '\u{fff9}'..='\u{fffb}' | '\u{fffe}' | '\u{ffff}')
        || invisible(c)
}

/// True if fonts should draw nothing for a character (Unicode's Default_Ignorable_Code_Point), such as the zero-width
/// space and those that change the direction of writing: names that differ only by such a character look the same.
fn invisible(c: char) -> bool {
    matches!(c,
        '\u{ad}' | '\u{34f}' | '\u{61c}' | '\u{115f}' | '\u{1160}' | '\u{17b4}' | '\u{17b5}' | '\u{180b}'..='\u{180f}'
        | '\u{200b}'..='\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{3164}'
        | '\u{fe00}'..='\u{fe0f}'
        | '\u{feff}' | '\u{ffa0}' | '\u{fff0}'..='\u{fff8}' | '\u{1bca0}'..='\u{1bca3}' | '\u{1d173}'..='\u{1d17a}'
        | '\u{e0000}'..='\u{e0fff}')
}

/// The text with every character of `commands` escaped, such as `\u{1b}`.
pub fn readable(text: &str) -> Cow<'_, str> {
    if !text.contains(commands) {
        return Cow::Borrowed(text);
    }
    Cow::Owned(written_out(text, |c| c.escape_unicode().to_string()))
}

/// The text with every character of `commands` as `escape` writes it.
fn written_out(text: &str, escape: impl Fn(char) -> String) -> String {
    let mut all = String::new();
    text.chars().for_each(|c| if commands(c) { all += &escape(c) } else { all.push(c) });
    all
}

/// A file of JSON in which the characters that [`readable`] writes out are escaped too.
///
/// # Errors
///
/// Of a map whose keys are no texts.
pub fn json(data: &impl Serialize) -> serde_json::Result<String> {
    let escape = |c: char| c.encode_utf16(&mut [0; 2]).iter().map(|unit| format!("\\u{unit:04x}")).collect();
    Ok(written_out(&serde_json::to_string_pretty(data)?, escape) + "\n")
}

/// A readable text inside XML or HTML, between tags or in quotes.
pub(crate) fn escaped(text: &str) -> String {
    let mut escaped = String::new();
    for letter in readable(text).chars() {
        match letter {
            '&' => escaped += "&amp;",
            '<' => escaped += "&lt;",
            '>' => escaped += "&gt;",
            '"' => escaped += "&quot;",
            letter => escaped.push(letter),
        }
    }
    escaped
}

/// A CSV cell that no spreadsheet treats as a formula: a text that begins like a formula gets an apostrophe before it.
/// Numbers are unchanged.
pub(crate) fn cell(text: &str) -> String {
    // Full-width forms too, which East Asian spreadsheets treat like the others.
    let formula = text.starts_with(['=', '+', '-', '@', '\t', '\r', '\n', '|', '%', '＝', '＋', '－', '＠']);
    let mark = if formula && text.parse::<f64>().is_err() { "'" } else { "" };
    format!("{mark}{}", readable(text))
}

/// A readable text on one line.
pub fn line(text: &str) -> String {
    readable(text).replace('\n', "\\n").replace('\t', " ")
}

/// A path in a message.
pub trait Shown {
    /// The path on one line, as [`line()`] writes it.
    fn shown(&self) -> String;
}

impl Shown for Path {
    fn shown(&self) -> String {
        line(&self.to_string_lossy())
    }
}

/// The first `most` characters of a text, with `…` if there are more.
pub fn start(text: &str, most: usize) -> String {
    match text.char_indices().nth(most) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn json_that_is_escaped_has_the_same_values() {
        let value = serde_json::json!({ "a\u{202e}": "\u{9b}2J \u{1b} α\n\u{e0041}\u{7f}" });
        let text = json(&value).unwrap();
        assert!(!text.contains(commands) && text.contains("\\udb40\\udc41") && text.contains('α'), "{text}");
        assert_eq!(serde_json::from_str::<serde_json::Value>(&text).unwrap(), value);
    }

    #[test]
    fn what_commands_a_terminal_is_written_out() {
        let hostile = "α\n\t\u{1b}]0;x\u{7}\u{9b}2J\rb\u{202e}c\u{7f}\u{200b}\u{ad}\u{feff}\u{2060}\u{e0041}";
        let written = r"]0;x\u{7}\u{9b}2J\u{d}b\u{202e}c\u{7f}\u{200b}\u{ad}\u{feff}\u{2060}\u{e0041}";
        assert_eq!(readable(hostile), format!("α\n\t\\u{{1b}}{written}"));
        assert_eq!(line("a\nerror: b\tc"), r"a\nerror: b c");
        assert_eq!(escaped("<a href=\"x\">&\u{1}"), r"&lt;a href=&quot;x&quot;&gt;&amp;\u{1}");
    }
}
