//! How hard the gate was tried, as the report shows it: the table at the head of `docs/strength.md`.

use crate::present::table::{ReportTable, of_markdown};

/// The table as Markdown.
pub const DOCUMENT: &str = include_str!("tried.md");

/// The same for the report.
pub fn table() -> ReportTable {
    of_markdown(
        "tried",
        "How hard was it tried",
        "What was done to break the program and its checks. docs/strength.md has more of each.",
        DOCUMENT,
    )
}
