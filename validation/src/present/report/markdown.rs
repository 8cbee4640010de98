//! The report as Markdown.

use super::first::sizes;
use super::formats::{bounds, seconds, verdict};
use super::{CaseRow, Report, ReportEquation, ReportStudy};
use crate::files::text::readable;
use crate::judge::accept::Verdict;
use crate::present::markup::typeset_markdown as markdown;
use crate::present::table::{ReportTable, of_words};

pub(super) fn write(report: &Report) -> String {
    let origin = &report.origin;
    let mut text = "# shearbed: verification report\n\n".to_owned();
    text.extend(sizes(report).iter().map(|line| format!("{}\n\n", markdown(line))));
    text += &format!("{}\n\n± is one standard error; bands and bars in figures are 95 %.\n\n", report.headline());
    text +=
        "| verdict | case | judges | claim | source | error | tolerance | unit | because | controls caught | time |\n";
    text += "| --- | --- | --- | --- | --- | ---: | ---: | --- | --- | ---: | ---: |\n";
    for case in &report.cases {
        text += &row(case);
    }
    text += "\nError and tolerance are those of the worst line of evidence; for a goodness-of-fit test they are its \
        p-value and the smallest allowed. To repeat one case: `cargo run --release -- validate --case NAME`.\n\n";
    text += &report.sections.studies.iter().map(study).collect::<String>();
    if !report.sections.equations.is_empty() {
        text += &section("##", &equation_table(&report.sections.equations));
    }
    for given in &origin.points {
        let (file, words) = (code(&given.file), markdown(&given.short(usize::MAX)));
        let (who, tool) = (markdown(&given.digitised_by), markdown(&given.tool));
        text += &format!("Points of {file}: {words}; read off by {who} with {tool}, {}.\n\n", given.date);
    }
    text += &format!(
        "Made {} by {} (shearbed {}, commit {}, {}, {} build) on {}, {} threads, {}. Seeds: {}.\n",
        origin.date,
        code(&origin.command),
        origin.version,
        origin.commit,
        markdown(&origin.rustc),
        origin.build,
        markdown(&origin.processor),
        origin.threads,
        origin.system,
        markdown(&origin.seeds)
    );
    readable(&text).into_owned()
}

fn row(case: &CaseRow) -> String {
    let (symbol, word) = verdict(case.verdict);
    let (error, tolerance) = case.worst().map_or(("–".into(), "–".into()), bounds);
    let (unit, because) = case.worst().map_or(("–", "no evidence"), |line| (&line.unit, &line.because));
    format!(
        "| {symbol} {word} | `{}` | {} | {} | {} | {error} | {tolerance} | {unit} | {} | {} | {} |\n",
        case.name,
        case.judges.name(),
        markdown(&case.claim),
        markdown(&case.source),
        markdown(because),
        match case.controls.len() {
            0 if case.verdict == Verdict::NoData => "–".into(),
            0 => "none".into(),
            all => format!("{} of {all}", case.caught),
        },
        seconds(case.seconds)
    )
}

/// A study: question, answer, and data and table of each picture.
fn study(study: &ReportStudy) -> String {
    let mut text = format!(
        "## {}\n\n*{}* {}\n\nIn full: {}\n\n",
        markdown(&study.title),
        markdown(&study.question),
        markdown(&study.answer),
        code(&study.command)
    );
    for exhibit in &study.exhibits {
        if let Some(figure) = &exhibit.figure {
            let (title, caption) = (markdown(&figure.figure.title), markdown(&figure.caption));
            text += &format!("**{title}** (`curves/{}.csv`): {caption}\n\n", figure.name);
        }
        if let Some(table) = &exhibit.table {
            text += &section("###", table);
        }
    }
    text
}

fn section(level: &str, table: &ReportTable) -> String {
    format!(
        "{level} {}\n\n{}\n\n{}\n",
        markdown(&table.title),
        markdown(&table.caption),
        table.cells_as_markdown(markdown)
    )
}

/// The equations as a table.
pub(crate) fn equation_table(equations: &[ReportEquation]) -> ReportTable {
    let code = |items: &[String]| items.iter().map(|item| format!("`{item}`")).collect::<Vec<_>>();
    of_words(
        "equations",
        "Equations",
        "From each equation of the paper to the code that is made from it and the cases that test it.",
        &["equation", "says", "code, in `src/`", "cases"],
        (equations.iter())
            .map(|e| vec![e.number.clone(), e.says.clone(), code(&e.code).join(", "), code(&e.cases).join(", ")])
            .collect(),
    )
}

/// A text as code, with any backticks in it: in CommonMark a span ends at as many backticks as it begins with.
fn code(text: &str) -> String {
    let text = text.replace('\n', " ");
    let runs = text.split(|c| c != '`').map(str::len);
    let fence = "`".repeat(runs.max().unwrap_or(0) + 1);
    if text.contains('`') { format!("{fence} {text} {fence}") } else { format!("{fence}{text}{fence}") }
}
