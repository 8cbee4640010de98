//! Texts of other people where they could do harm: on a terminal, in cells of a table, in a shell.

use std::borrow::Cow;
use std::ffi::OsStr;
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// Whether a character commands a terminal, turns the direction of writing, or is not allowed in HTML and SVG. Line feeds
/// and tabulators are none.
fn commands(c: char) -> bool {
    (c.is_control() && !matches!(c, '\n' | '\t'))
        || matches!(c, '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
        || matches!(c, '\u{2028}' | '\u{2029}' | '\u{fffe}' | '\u{ffff}')
}

/// A text in which every character that is not for reading is written out, as `\u{1b}`.
pub(crate) fn readable(text: &str) -> Cow<'_, str> {
    if !text.contains(commands) {
        return Cow::Borrowed(text);
    }
    let written = |text: &mut String, c: char| match commands(c) {
        true => text.extend(c.escape_unicode()),
        false => text.push(c),
    };
    let mut all = String::new();
    text.chars().for_each(|c| written(&mut all, c));
    Cow::Owned(all)
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

/// A readable text on one line.
pub(crate) fn line(text: &str) -> String {
    readable(text).replace('\n', "\\n").replace('\t', " ")
}

/// The most characters of a message for the terminal.
const MOST: usize = 8192;

/// A text of which the middle is left out where it is too long to be read: what is at fault stands at the start, and what is
/// allowed at the end.
pub(crate) fn shortened(text: &str) -> Cow<'_, str> {
    let length = text.chars().count();
    if length <= MOST {
        return Cow::Borrowed(text);
    }
    let cut = |at: usize| text.char_indices().nth(at).map_or(text.len(), |(byte, _)| byte);
    let (head, tail) = (&text[..cut(MOST / 4)], &text[cut(length - MOST / 4)..]);
    let left_out = length - MOST / 4 * 2;
    Cow::Owned(format!(
        "{head} … ({left_out} characters are left out here) … {tail}"
    ))
}

/// A file of at most so many bytes; a longer one is refused before it fills the memory.
pub(crate) fn read(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    File::open(path)?.take(most + 1).read_to_end(&mut bytes)?;
    match bytes.len() as u64 <= most {
        true => Ok(bytes),
        false => Err(io::Error::other(format!(
            "longer than the {} MB that are allowed",
            most >> 20
        ))),
    }
}

/// A cell of a table in CSV that no spreadsheet takes for a formula: a text that begins as one has an apostrophe before it.
/// Numbers stay as they are.
pub(crate) fn cell(text: &str) -> String {
    let formula = text.starts_with(['=', '+', '-', '@', '\t', '\r', '\n', '|', '%']);
    let number = text.parse::<f64>().is_ok();
    let mark = if formula && !number { "'" } else { "" };
    format!("{mark}{}", readable(text))
}

/// A command line that a POSIX shell reads as these words; a word with bytes that no text has is written as bash and zsh
/// read it.
pub(crate) fn command<W: AsRef<OsStr>>(words: impl IntoIterator<Item = W>) -> String {
    let words: Vec<_> = words.into_iter().map(|word| quoted(word.as_ref())).collect();
    words.join(" ")
}

fn quoted(word: &OsStr) -> String {
    let plain = |c: char| c.is_alphanumeric() || "-_./,:=+@%".contains(c);
    match word.to_str() {
        Some(text) if !text.is_empty() && text.chars().all(plain) => text.to_owned(),
        Some(text) if !text.contains(|c| c == '\n' || c == '\t' || commands(c)) => {
            format!("'{}'", text.replace('\'', r"'\''"))
        }
        _ => {
            let bytes = word.as_encoded_bytes().iter();
            let written = bytes.map(|byte| match byte {
                b'\'' | b'\\' => format!("\\{}", char::from(*byte)),
                b' '..=b'~' => char::from(*byte).to_string(),
                _ => format!("\\x{byte:02x}"),
            });
            format!("$'{}'", written.collect::<String>())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_commands_a_terminal_is_written_out() {
        assert_eq!(readable("α = 0.5\n\tX̄₁"), "α = 0.5\n\tX̄₁");
        let hostile = "a\u{1b}]0;x\u{7}\u{9b}2J\rb\u{202e}c\u{7f}";
        assert_eq!(
            readable(hostile),
            r"a\u{1b}]0;x\u{7}\u{9b}2J\u{d}b\u{202e}c\u{7f}"
        );
        assert_eq!(line("a\nerror: b\tc"), r"a\nerror: b c");
    }

    #[test]
    fn a_text_in_xml_is_no_markup() {
        assert_eq!(
            escaped("<a href=\"x\">&\u{1}"),
            r"&lt;a href=&quot;x&quot;&gt;&amp;\u{1}"
        );
    }

    #[test]
    fn a_long_message_keeps_its_ends() {
        let text = format!("key = {} is not allowed: ü", "é".repeat(1_000_000));
        let short = shortened(&text);
        assert!(short.chars().count() < 5000);
        assert!(
            short.starts_with("key = é") && short.ends_with("is not allowed: ü"),
            "{short}"
        );
        assert!(short.contains("(995928 characters are left out here)"), "{short}");
        assert_eq!(shortened("short"), "short");
    }

    #[test]
    fn no_cell_is_a_formula() {
        for (text, expected) in [
            ("=cmd|' /C calc'!A0", "'=cmd|' /C calc'!A0"),
            ("@SUM(1)", "'@SUM(1)"),
            ("+1+2", "'+1+2"),
            ("-2+3", "'-2+3"),
            ("\t=1", "'\t=1"),
            ("-1e-300", "-1e-300"),
            ("+5", "+5"),
            ("-inf", "-inf"),
            ("rotation", "rotation"),
            ("a\u{1b}b", r"a\u{1b}b"),
        ] {
            assert_eq!(cell(text), expected);
        }
    }

    /// What bash makes of the command line, word by word.
    #[cfg(unix)]
    #[test]
    fn a_shell_reads_the_same_words() {
        use std::os::unix::ffi::OsStrExt;
        let words: [&[u8]; 9] = [
            b"plain-1.0/x=y",
            b"",
            b"two words",
            b"it's $HOME `date` \"q\" \\ !",
            b"*?[a]{b}~;&|<>()#",
            b"\x1b]0;x\x07",
            b"not \xff\xfe text'\\",
            b"a\nb",
            "α=½".as_bytes(),
        ];
        let line = command(words.iter().map(|word| OsStr::from_bytes(word)));
        let script = format!("printf '%s\\0' {line}");
        let output = std::process::Command::new("bash")
            .args(["-c", &script])
            .output()
            .unwrap();
        let found: Vec<_> = output.stdout.split(|byte| *byte == 0).collect();
        assert_eq!(found[..words.len()], words);
        assert!(!line.contains('\u{1b}'));
    }
}
