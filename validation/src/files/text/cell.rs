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

#[cfg(test)]
mod tests {
    use super::*;

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
}
