//! Messages on the terminal.

use super::readable;
use std::borrow::Cow;
use std::io::Write;

/// Writes a text to standard error in one call: a reader of several processes' output joins the pieces as they arrive,
/// possibly with another process's in between. Errors are ignored: then only the exit code and the files show the
/// failure.
pub fn complain(text: &str) {
    let _ = std::io::stderr().write_all(text.as_bytes());
}

/// Limit of a message on the terminal, in characters.
const MOST: usize = 8192;

/// The text, with the middle left out if it is too long: the error is at the start of a message, and what is allowed at
/// the end.
pub(crate) fn shortened(text: &str) -> Cow<'_, str> {
    let length = text.chars().count();
    if length <= MOST {
        return Cow::Borrowed(text);
    }
    let cut = |at: usize| text.char_indices().nth(at).map_or(text.len(), |(byte, _)| byte);
    let (head, tail) = (&text[..cut(MOST / 4)], &text[cut(length - MOST / 4)..]);
    let left_out = length - MOST / 4 * 2;
    Cow::Owned(format!("{head} … ({left_out} characters are left out here) … {tail}"))
}

/// A message for the terminal: what commands one is written out, a number of many digits is a power of ten, the
/// system's numbers of errors go, and the middle of a long text is left out.
pub fn message(text: &str) -> String {
    readable(&shortened(&with_short_numbers(&without_codes(text)))).into_owned()
}

/// A text without ` (os error 2)` behind the system's words for it.
fn without_codes(text: &str) -> String {
    let mut parts = text.split(" (os error ");
    let first = parts.next().unwrap_or_default().to_owned();
    parts.fold(first, |text, part| {
        let rest = part.trim_start_matches(|c: char| c.is_ascii_digit() || c == '-');
        match rest.strip_prefix(')') {
            Some(rest) if rest.len() + 1 < part.len() => text + rest,
            _ => text + " (os error " + part,
        }
    })
}

/// The most characters of a number in a message.
const DIGITS: usize = 24;

/// A text in which a longer number is a power of ten. One that is cut, with `…` behind it, stays.
fn with_short_numbers(text: &str) -> String {
    let is_of_number = |c: char| c.is_ascii_digit() || c == '.';
    let (mut short, mut rest) = (String::new(), text);
    while let Some(start) = rest.find(is_of_number) {
        let (before, from) = rest.split_at(start);
        let (run, after) = from.split_at(from.find(|c| !is_of_number(c)).unwrap_or(from.len()));
        // A full stop ends the sentence.
        let number = run.trim_end_matches('.');
        let value = number.parse::<f64>().ok().filter(|value| value.is_finite());
        short += before;
        match value {
            Some(value) if number.len() > DIGITS && !after.trim_start().starts_with(['…', 'e']) => {
                short += &format!("{value:e}{}", &run[number.len()..]);
            }
            _ => short += run,
        }
        rest = after;
    }
    short + rest
}
