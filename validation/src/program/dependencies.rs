//! What the program is built from, as the report shows it: read from `docs/dependencies.md`, which a test keeps in
//! step with the manifests.

use crate::present::table::{ReportTable, of_markdown};

/// The document.
pub const DOCUMENT: &str = include_str!("dependencies.md");

/// The table of the document, under the sentence that counts the crates.
pub fn table() -> ReportTable {
    of_markdown(
        "dependencies",
        "Dependencies, and what each is for",
        &format!(
            "The program is built from {} crates of others. Those that it asks for itself, and those of its tests:",
            crates().unwrap_or_default()
        ),
        // Links lead nowhere from the report.
        &DOCUMENT.replace("[cluster.md](cluster.md)", "docs/cluster.md"),
    )
}

/// How many crates of others the document says the program is built from.
pub fn crates() -> Option<usize> {
    let (before, _) = DOCUMENT.split_once(" crates of others")?;
    before.split_whitespace().last()?.parse().ok()
}
