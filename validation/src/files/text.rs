//! Makes texts of other people harmless: on a terminal, in cells of a table, in a shell.

use std::borrow::Cow;
use std::ffi::OsStr;
use std::io::Write;
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
    let written = |text: &mut String, c: char| if commands(c) { text.extend(c.escape_unicode()) } else { text.push(c) };
    let mut all = String::new();
    text.chars().for_each(|c| written(&mut all, c));
    Cow::Owned(all)
}

/// JSON in which the characters that [`readable`] writes out are escaped too; it has the same values.
pub(crate) fn json(text: &str) -> String {
    let written = |text: &mut String, c: char| {
        if commands(c) {
            c.encode_utf16(&mut [0; 2]).iter().for_each(|unit| *text += &format!("\\u{unit:04x}"))
        } else {
            text.push(c)
        }
    };
    let mut all = String::new();
    text.chars().for_each(|c| written(&mut all, c));
    all
}

/// Writes a text to standard error in one call: a reader of several processes' output joins the pieces as they arrive,
/// possibly with another process's in between. Errors are ignored: then only the exit code and the files show the
/// failure.
pub fn complain(text: &str) {
    let _ = std::io::stderr().write_all(text.as_bytes());
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
pub fn line(text: &str) -> String {
    readable(text).replace('\n', "\\n").replace('\t', " ")
}

/// A path in a message.
pub trait Shown {
    /// The path on one line, as [`line`] writes it.
    fn shown(&self) -> String;
}

impl Shown for Path {
    fn shown(&self) -> String {
        line(&self.to_string_lossy())
    }
}

/// Limit of a message on the terminal, in characters.
const MOST: usize = 8192;

/// Limit of a value from a user's file in a message, in characters.
const SNIPPET: usize = 40;

/// The first `most` characters of a text, with `…` if there are more.
pub fn start(text: &str, most: usize) -> String {
    match text.char_indices().nth(most) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_owned(),
    }
}

/// The start of a value in quotes, for a message: enough to find it in its file, and little of what may be private.
pub fn snippet(value: &str) -> String {
    format!("\"{}\"", line(&start(value, SNIPPET)).replace('"', "\\\""))
}

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

/// A number with four decimals, or as a power of ten where it would have hundreds of digits.
pub fn four_decimals(x: f64) -> String {
    if x.abs() < 1e12 { format!("{x:.4}") } else { format!("{x:.4e}") }
}

/// Rows of cells as lines of columns that are aligned on the left.
pub fn left_aligned(rows: &[Vec<String>]) -> String {
    aligned(rows, |cell, width| format!("{cell:<width$}"))
}

/// Rows of cells as lines of columns that are aligned on the right.
pub fn right_aligned(rows: &[Vec<String>]) -> String {
    aligned(rows, |cell, width| format!("{cell:>width$}"))
}

fn aligned(rows: &[Vec<String>], pad: impl Fn(&str, usize) -> String) -> String {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |column: usize| {
        let cells = rows.iter().filter_map(|row| row.get(column));
        cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
    };
    let widths: Vec<_> = (0..columns).map(width).collect();
    let line = |row: &Vec<String>| {
        let cells: Vec<_> = row.iter().zip(&widths).map(|(cell, width)| pad(cell, *width)).collect();
        cells.join("  ").trim_end().to_owned() + "\n"
    };
    rows.iter().map(line).collect()
}

/// A CSV cell that no spreadsheet treats as a formula: a text that begins like a formula gets an apostrophe before it.
/// Numbers are unchanged.
pub(crate) fn cell(text: &str) -> String {
    // Full-width forms too, which East Asian spreadsheets treat like the others.
    let formula = text.starts_with(['=', '+', '-', '@', '\t', '\r', '\n', '|', '%', '＝', '＋', '－', '＠']);
    let number = text.parse::<f64>().is_ok();
    let mark = if formula && !number { "'" } else { "" };
    format!("{mark}{}", readable(text))
}

/// A command line that a POSIX shell splits into these words; a word that is not valid text is quoted in the form of
/// bash and zsh.
pub fn command<W: AsRef<OsStr>>(words: impl IntoIterator<Item = W>) -> String {
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
        assert_eq!(readable(hostile), r"a\u{1b}]0;x\u{7}\u{9b}2J\u{d}b\u{202e}c\u{7f}");
        assert_eq!(line("a\nerror: b\tc"), r"a\nerror: b c");
        let unseen = "a\u{200b}b\u{ad}c\u{feff}d\u{2060}e\u{e0041}";
        assert_eq!(readable(unseen), r"a\u{200b}b\u{ad}c\u{feff}d\u{2060}e\u{e0041}");
        assert_eq!(readable("X̄₁, é, 中文, العربية"), "X̄₁, é, 中文, العربية");
    }

    #[test]
    fn a_number_of_hundreds_of_digits_is_a_power_of_ten() {
        for (text, short) in [
            (format!("periods = {}: at most 1e6.", 1e300), "periods = 1e300: at most 1e6."),
            (format!("-{} and {}.", 1.5e299, 1e-300), "-1.5e299 and 1e-300."),
            ("0.1234567890123456789, 1.2.3, 2e5".into(), "0.1234567890123456789, 1.2.3, 2e5"),
        ] {
            assert_eq!(with_short_numbers(&text), short);
        }
        let kept = [format!("{} …", 1e30), format!("{}e5", 1e30), "9".repeat(400)];
        kept.iter().for_each(|text| assert_eq!(with_short_numbers(text), *text));
    }

    #[test]
    fn the_systems_words_have_no_number() {
        let text = "a: Not found (os error 2); b: (os error ), c: denied (os error 13)\n";
        assert_eq!(without_codes(text), "a: Not found; b: (os error ), c: denied\n");
    }

    #[test]
    fn json_that_is_escaped_has_the_same_values() {
        let value = serde_json::json!({ "a\u{202e}": "\u{9b}2J \u{1b} α\n\u{e0041}\u{7f}" });
        let text = json(&serde_json::to_string_pretty(&value).unwrap());
        assert!(!text.contains(commands) && text.contains("\\udb40\\udc41") && text.contains('α'), "{text}");
        assert_eq!(serde_json::from_str::<serde_json::Value>(&text).unwrap(), value);
    }

    #[test]
    fn a_path_stays_on_its_line() {
        let path = Path::new("a\nerror: \u{200b}b.toml");
        assert_eq!(path.shown(), r"a\nerror: \u{200b}b.toml");
    }

    #[test]
    fn of_a_value_only_the_start_is_repeated() {
        assert_eq!(snippet("zero"), "\"zero\"");
        assert_eq!(snippet("a\nb\u{1b}\"c"), r#""a\nb\u{1b}\"c""#);
        let secret = "x".repeat(40) + "the rest";
        assert_eq!(snippet(&secret), format!("\"{}…\"", "x".repeat(40)));
    }

    #[test]
    fn columns_are_as_wide_as_their_widest_cell() {
        let rows = [vec!["α".to_owned(), "x1".to_owned()], vec!["0.25".to_owned(), "7".to_owned()]];
        assert_eq!(left_aligned(&rows), "α     x1\n0.25  7\n");
        assert_eq!(right_aligned(&rows), "   α  x1\n0.25   7\n");
        assert_eq!(left_aligned(&[]), "");
    }

    #[test]
    fn a_text_in_xml_is_no_markup() {
        assert_eq!(escaped("<a href=\"x\">&\u{1}"), r"&lt;a href=&quot;x&quot;&gt;&amp;\u{1}");
    }

    #[test]
    fn a_long_message_keeps_its_ends() {
        let text = format!("key = {} is not allowed: ü", "é".repeat(1_000_000));
        let short = shortened(&text);
        assert!(short.chars().count() < 5000);
        assert!(short.starts_with("key = é") && short.ends_with("is not allowed: ü"), "{short}");
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
            ("＝1+1", "'＝1+1"),
            ("＋1", "'＋1"),
            ("－1", "'－1"),
            ("＠SUM(1)", "'＠SUM(1)"),
            ("-1e-300", "-1e-300"),
            ("+5", "+5"),
            ("-inf", "-inf"),
            ("rotation", "rotation"),
            ("a\u{1b}b", r"a\u{1b}b"),
        ] {
            assert_eq!(cell(text), expected);
        }
    }

    /// The words into which bash splits the command line.
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
        let output = std::process::Command::new("bash").args(["-c", &script]).output().unwrap();
        let found: Vec<_> = output.stdout.split(|byte| *byte == 0).collect();
        assert_eq!(found[..words.len()], words);
        assert!(!line.contains('\u{1b}'));
    }

    #[test]
    fn no_number_has_hundreds_of_digits() {
        let shown = [0.0, -2.5, 1e11, 1e12, -1e300].map(four_decimals);
        assert_eq!(shown, ["0.0000", "-2.5000", "100000000000.0000", "1.0000e12", "-1.0000e300"]);
    }
}
