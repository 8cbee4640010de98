//! How hard the gate was tried, as the report shows it: the table at the head of `docs/strength.md`.

use crate::table::{ReportTable, of_words, rows_of_markdown};

/// The table as Markdown.
pub const DOCUMENT: &str = include_str!("tried.md");

/// The same for the report.
pub fn table() -> ReportTable {
    let mut lines = rows_of_markdown(DOCUMENT);
    let columns = lines.next().unwrap_or_default();
    of_words(
        "tried",
        "How hard was it tried",
        "What was done to break the program and its checks. docs/strength.md has more of each.",
        &columns,
        lines.collect(),
    )
}
