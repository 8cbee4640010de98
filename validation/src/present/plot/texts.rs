//! Texts: their styles, how wide they are, and how they are cut and broken into lines and rows.

use super::style::{FINE, MARGIN, TITLE};
use plotters::prelude::*;

/// The style of dark text of this size, in the units of the view.
pub(super) fn text(size: f64) -> TextStyle<'static> {
    styled(size, FontStyle::Normal)
}

/// The style of bold dark text of this size.
pub(super) fn bold(size: f64) -> TextStyle<'static> {
    styled(size, FontStyle::Bold)
}

fn styled(size: f64, style: FontStyle) -> TextStyle<'static> {
    // Plotters divides by 1.24 when it writes SVG.
    let font = ("sans-serif", size * 1.24 * f64::from(FINE)).into_font();
    font.style(style).color(&RGBColor(34, 34, 34))
}

/// Largest number of lines of a title.
const MOST_LINES: usize = 4;

/// The width of a text in the widest font that a browser or a printer falls back to: DejaVu Sans, bold for sizes that
/// may be bold.
pub(super) fn text_width(text: &str, size: f64) -> i32 {
    let bold = size >= TITLE || size == SMALL_BOLD;
    (super::letters::ems(text, bold) * size * f64::from(FINE)).ceil() as i32
}

/// Size of the letters of a map's title.
pub(super) const SMALL_BOLD: f64 = 13.5;

/// The part of a text that fits into `room`; `…` stands for the rest.
pub(super) fn cut(text: &str, room: i32, size: f64) -> String {
    if text_width(text, size) <= room {
        return text.to_owned();
    }
    let fits = |end: &usize| text_width(&text[..*end], size) + text_width("…", size) <= room;
    let end = text.char_indices().map(|(at, _)| at).take_while(fits).last().unwrap_or(0);
    format!("{}…", &text[..end])
}

/// Items, each with its width, in rows no wider than a figure: at least one row, and the left edge of each item.
pub(super) fn in_rows<T>(items: impl Iterator<Item = (T, i32)>, width: i32) -> Vec<Vec<(T, i32)>> {
    let mut rows = vec![Vec::new()];
    let mut x = MARGIN;
    for (item, own) in items {
        if x + own > width - MARGIN && x > MARGIN {
            rows.push(Vec::new());
            x = MARGIN;
        }
        if let Some(row) = rows.last_mut() {
            row.push((item, x));
        }
        x += own;
    }
    rows
}

/// The words of a text; a number is one with its sign and its unit.
fn words(text: &str) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match words.last_mut() {
            Some(last) if last.ends_with(['=', '±']) || ["=", "%", "cm⁻³"].contains(&word) => {
                *last += " ";
                *last += word;
            }
            _ => words.push(word.into()),
        }
    }
    words
}

/// The lines of a text within the width `room`, four at most; a word that is too wide is cut.
pub(super) fn wrap(text: &str, room: i32, size: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in words(text) {
        let word = &cut(&word, room, size);
        let full = lines.len() == MOST_LINES;
        match lines.last_mut() {
            Some(line) if text_width(line, size) + text_width(word, size) < room => {
                line.push(' ');
                line.push_str(word);
            }
            Some(last) if full => {
                *last = cut(&format!("{last} {word}"), room, size);
                break;
            }
            _ => lines.push(word.to_string()),
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::super::style::TEXT;
    use super::*;

    #[test]
    fn texts_are_wrapped_at_words() {
        let room = text_width("a picture of", TEXT) + 1;
        assert_eq!(wrap("a picture of two words", room, TEXT), ["a picture of", "two words"]);
        assert_eq!(wrap("pictures of σ = 3.6 %", room, TEXT), ["pictures of", "σ = 3.6 %"]);
        assert!(wrap("", room, TEXT).is_empty());
        let cut = &wrap("incomprehensibilities", room, TEXT)[0];
        assert!(cut.starts_with("incomp") && cut.ends_with('…') && text_width(cut, TEXT) <= room);
        let long = wrap(&"word ".repeat(100), room, TEXT);
        assert!(long.len() == MOST_LINES && long[MOST_LINES - 1].ends_with('…'), "{long:?}");
    }
}
