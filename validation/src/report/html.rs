//! The report as one HTML file.

use super::prose::Anchors;
use super::words::{bounds, detail, number, seconds, verdict};
use super::{Line, Origin, Report, ReportTable, Row, ScenePlan};
use crate::accept::Verdict;
use crate::case::Control;
use crate::plot;
use crate::text::readable;
use minijinja::value::{Serde, Value};
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
    tables: Vec<TableView<'a>>,
    equations: Vec<EquationView<'a>>,
    plans: &'a [ScenePlan],
    false_alarm: String,
    full: bool,
    time: String,
    origin: &'a Origin,
}

/// A row as text.
#[derive(Serialize)]
struct CaseView<'a> {
    name: &'a str,
    claim: &'a str,
    judges: &'static str,
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

/// A table, and which of its columns hold numbers.
#[derive(Serialize)]
struct TableView<'a> {
    #[serde(flatten)]
    table: &'a ReportTable,
    numeric: Vec<bool>,
}

/// An equation with the cases that test it.
#[derive(Serialize)]
struct EquationView<'a> {
    number: &'a str,
    says: &'a str,
    code: &'a [String],
    cases: Vec<Link<'a>>,
}

/// A link inside the report, to a case with its verdict or to a figure.
#[derive(Serialize)]
struct Link<'a> {
    anchor: String,
    text: &'a str,
    class: Option<Verdict>,
    symbol: &'static str,
}

pub(super) fn write(report: &Report) -> Result<String, String> {
    let mut environment = Environment::new();
    environment.set_undefined_behavior(UndefinedBehavior::Strict);
    let anchors = Anchors::of(report);
    environment.add_filter("prose", move |text: &str| {
        Value::from_safe_string(anchors.html(text))
    });
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
        tables: report.sections.tables.iter().map(table).collect(),
        equations: equations(report),
        plans: &report.sections.plans,
        false_alarm: number(report.summary.false_alarm),
        full: report.summary.full,
        time: seconds(report.summary.seconds),
        origin: &report.origin,
    };
    // The name's ending turns the escaping on.
    environment
        .template_from_named_str("report.html", include_str!("report.html.j2"))
        .and_then(|template| template.render(Serde(&page)))
        .map(|page| readable(&page).into_owned())
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
        judges: row.judges.name(),
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
                class: None,
                symbol: "",
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
            Ok(FigureView {
                name: &figure.name,
                svg: plot::svg(&figure.figure)?,
                caption: &figure.caption,
                source: &figure.source,
                cases: case_links(report, &figure.cases),
            })
        })
        .collect()
}

fn equations(report: &Report) -> Vec<EquationView<'_>> {
    let equations = report.sections.equations.iter();
    equations
        .map(|equation| EquationView {
            number: &equation.number,
            says: &equation.says,
            code: &equation.code,
            cases: case_links(report, &equation.cases),
        })
        .collect()
}

fn table(table: &ReportTable) -> TableView<'_> {
    let starts_a_number = |c: char| c.is_ascii_digit() || "+−-–±<≤>≥".contains(c);
    let is_number = |row: &Vec<String>, column| {
        let cell: Option<&String> = row.get(column);
        cell.is_some_and(|cell| cell.starts_with(starts_a_number))
    };
    TableView {
        numeric: (0..table.columns.len())
            .map(|column| table.rows.iter().all(|row| is_number(row, column)))
            .collect(),
        table,
    }
}

/// Links to the cases of these names that are in the report.
fn case_links<'a>(report: &'a Report, names: &[String]) -> Vec<Link<'a>> {
    let cases = report.cases.iter().filter(|row| names.contains(&row.name));
    cases.map(case_link).collect()
}

fn case_link(row: &Row) -> Link<'_> {
    Link {
        anchor: format!("case-{}", row.name),
        text: &row.name,
        class: Some(row.verdict),
        symbol: verdict(row.verdict).0,
    }
}
