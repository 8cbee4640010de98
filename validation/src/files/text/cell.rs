//! Cells of tables that a spreadsheet opens.

use super::readable;

/// A CSV cell that no spreadsheet treats as a formula: a text that begins like a formula gets an apostrophe before it.
/// Numbers are unchanged.
pub(crate) fn cell(text: &str) -> String {
    // Full-width forms too, which East Asian spreadsheets treat like the others.
    let formula = text.starts_with(['=', '+', '-', '@', '\t', '\r', '\n', '|', '%', '＝', '＋', '－', '＠']);
    let number = text.parse::<f64>().is_ok();
    let mark = if formula && !number { "'" } else { "" };
    format!("{mark}{}", readable(text))
}
