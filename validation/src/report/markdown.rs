//! The report as Markdown.

use super::words::{bounds, kind, seconds, verdict};
use super::{Report, Row};

pub(super) fn write(report: &Report) -> String {
    let origin = &report.origin;
    let mut text = format!("# shearbed: validation report\n\n{}\n\n", report.headline());
    text +=
        "| verdict | case | kind | claim | source | error | tolerance | because | controls caught | time |\n";
    text += "| --- | --- | --- | --- | --- | ---: | ---: | --- | ---: | ---: |\n";
    for case in &report.cases {
        text += &row(case);
    }
    text += "\nError and tolerance are those of the worst line of evidence; for a goodness-of-fit test they are \
             its p-value and the smallest allowed. To repeat one case: \
             `cargo run --release -- validate --case NAME`.\n\n";
    text += &format!(
        "Made {} by `{}` (shearbed {}, commit {}, {}, {} build) on {}, {} threads, {}. Seeds: {}.\n",
        origin.date,
        origin.command,
        origin.version,
        origin.commit,
        origin.rustc,
        origin.build,
        origin.processor,
        origin.threads,
        origin.system,
        origin.seeds
    );
    text
}

fn row(case: &Row) -> String {
    let (symbol, word) = verdict(case.verdict);
    let (error, tolerance) = case.worst().map_or(("–".into(), "–".into()), bounds);
    let because = case.worst().map_or("no evidence", |line| &line.because);
    format!(
        "| {symbol} {word} | `{}` | {} | {} | {} | {error} | {tolerance} | {} | {} of {} | {} |\n",
        case.name,
        kind(case.kind),
        escape(&case.claim),
        escape(&case.source),
        escape(because),
        case.caught,
        case.controls.len(),
        seconds(case.seconds)
    )
}

/// A text that stays in its cell and is no markup.
fn escape(text: &str) -> String {
    let mut escaped = String::new();
    for c in text.chars() {
        match c {
            '\n' => escaped.push(' '),
            '<' => escaped.push_str("&lt;"),
            '&' => escaped.push_str("&amp;"),
            '|' | '*' | '_' | '`' | '\\' | '[' => escaped.extend(['\\', c]),
            _ => escaped.push(c),
        }
    }
    escaped
}
