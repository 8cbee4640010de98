//! The report as one HTML file.

use super::words::{bounds, detail, kind, number, seconds, verdict};
use super::{Line, Origin, Report, Row};
use crate::case::{Control, Verdict};
use crate::plot;
use minijinja::value::Serde;
use minijinja::{Environment, UndefinedBehavior};
use serde::Serialize;

/// All that the template shows.
#[derive(Serialize)]
struct Page<'a> {
    style: &'static str,
    headline: String,
    good: bool,
    /// The cases to look at first.
    attention: Vec<Link<'a>>,
    cases: Vec<CaseView<'a>>,
    figures: Vec<FigureView<'a>>,
    level: String,
    family: String,
    full: bool,
    time: String,
    origin: &'a Origin,
}

/// A row as text.
#[derive(Serialize)]
struct CaseView<'a> {
    name: &'a str,
    claim: &'a str,
    kind: &'static str,
    source: &'a str,
    class: Verdict,
    symbol: &'static str,
    word: &'static str,
    worst: Option<LineView<'a>>,
    evidence: Vec<LineView<'a>>,
    caught: usize,
    controls: &'a [Control],
    time: String,
    command: &'a str,
    figures: Vec<Link<'a>>,
}

/// A line of the evidence as text.
#[derive(Serialize)]
struct LineView<'a> {
    what: &'a str,
    class: Verdict,
    symbol: &'static str,
    word: &'static str,
    error: String,
    tolerance: String,
    because: &'a str,
    detail: String,
}

/// A picture as SVG.
#[derive(Serialize)]
struct FigureView<'a> {
    name: &'a str,
    svg: String,
    caption: &'a str,
    source: &'a str,
    cases: Vec<Link<'a>>,
}

/// A link inside the report.
#[derive(Serialize)]
struct Link<'a> {
    anchor: String,
    text: &'a str,
}

pub(super) fn write(report: &Report) -> Result<String, String> {
    let mut environment = Environment::new();
    environment.set_undefined_behavior(UndefinedBehavior::Strict);
    let cases: Vec<_> = report.cases.iter().map(|row| case(report, row)).collect();
    let figures = figures(report)?;
    let attention: Vec<_> = (report.cases.iter())
        .filter(|row| matches!(row.verdict, Verdict::Fail | Verdict::Underpowered))
        .map(case_link)
        .collect();
    let page = Page {
        style: include_str!("report.css"),
        headline: report.headline(),
        good: report.exit_code() == 0,
        attention,
        cases,
        figures,
        level: number(report.summary.level),
        family: number(report.summary.family_false_alarm_rate),
        full: report.summary.full,
        time: seconds(report.summary.seconds),
        origin: &report.origin,
    };
    // The name's ending turns the escaping on.
    environment
        .template_from_named_str("report.html", include_str!("report.html.j2"))
        .and_then(|template| template.render(Serde(&page)))
        .map_err(|error| format!("cannot write the report: {error}"))
}

fn case<'a>(report: &'a Report, row: &'a Row) -> CaseView<'a> {
    let (symbol, word) = verdict(row.verdict);
    let figures = report
        .sections
        .figures
        .iter()
        .filter(|f| f.cases.contains(&row.name));
    CaseView {
        name: &row.name,
        claim: &row.claim,
        kind: kind(row.kind),
        source: &row.source,
        class: row.verdict,
        symbol,
        word,
        worst: row.worst().map(line),
        evidence: row.evidence.iter().map(line).collect(),
        caught: row.caught,
        controls: &row.controls,
        time: seconds(row.seconds),
        command: &row.command,
        figures: figures
            .map(|f| Link {
                anchor: format!("figure-{}", f.name),
                text: &f.figure.title,
            })
            .collect(),
    }
}

fn line(line: &Line) -> LineView<'_> {
    let (symbol, word) = verdict(line.verdict);
    let (error, tolerance) = bounds(line);
    LineView {
        what: &line.what,
        class: line.verdict,
        symbol,
        word,
        error,
        tolerance,
        because: &line.because,
        detail: detail(&line.judged_by),
    }
}

fn figures(report: &Report) -> Result<Vec<FigureView<'_>>, String> {
    (report.sections.figures.iter())
        .map(|figure| {
            let judges = report.cases.iter().filter(|row| figure.cases.contains(&row.name));
            Ok(FigureView {
                name: &figure.name,
                svg: plot::svg(&figure.figure)?,
                caption: &figure.caption,
                source: &figure.source,
                cases: judges.map(case_link).collect(),
            })
        })
        .collect()
}

fn case_link(row: &Row) -> Link<'_> {
    Link {
        anchor: format!("case-{}", row.name),
        text: &row.name,
    }
}
