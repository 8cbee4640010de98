//! The report as one self-contained HTML file with its pictures.

use super::report::{BUILT_IN, COLUMNS, Column, NOTHING, missing, tables, words};
use super::{Graded, Report, Verdict};
use crate::files::text::readable;
use crate::present::report::{digits, typeset};
use crate::present::table::ReportTable;
use minijinja::value::Serde;
use minijinja::{Environment, UndefinedBehavior, Value};
use serde::Serialize;

#[derive(Serialize)]
struct Page<'a> {
    style: &'static str,
    answers: &'a str,
    reference: &'a str,
    shearbed: &'a str,
    headline: String,
    good: bool,
    columns: Vec<Column>,
    rows: Vec<ProblemRow<'a>>,
    reasons: Vec<Reason<'a>>,
    pictures: Vec<&'a str>,
    tables: Vec<ReportTable>,
    diagnosis: &'a [String],
    missing: Option<String>,
    remarks: &'a [String],
}

#[derive(Serialize)]
struct ProblemRow<'a> {
    word: &'static str,
    class: &'static str,
    name: &'a str,
    /// One cell for each column that is shown.
    cells: Vec<String>,
    said: Vec<&'a str>,
}

fn shown(number: Option<f64>) -> String {
    number.map_or(NOTHING.into(), |number| digits(number, 2))
}

/// A reason for a tolerance, and the problems to which it applies.
#[derive(Serialize)]
struct Reason<'a> {
    text: &'a str,
    names: Vec<&'a str>,
}

fn reasons<'a>(graded: &[&'a Graded]) -> Vec<Reason<'a>> {
    let mut reasons: Vec<Reason> = Vec::new();
    for graded in graded {
        match reasons.iter_mut().find(|reason| reason.text == graded.because) {
            Some(reason) => reason.names.push(&graded.name),
            None => reasons.push(Reason { text: &graded.because, names: vec![&graded.name] }),
        }
    }
    reasons
}

/// The report as an HTML page, with `pictures` as SVG.
pub fn html(report: &Report, good: bool, pictures: &[&str]) -> Result<String, String> {
    let mut environment = Environment::new();
    environment.set_undefined_behavior(UndefinedBehavior::Strict);
    environment.add_filter("prose", |text: &str| Value::from_safe_string(typeset(text)));
    let mut answered: Vec<&Graded> = report.problems.iter().filter(|g| g.verdict != Verdict::Missing).collect();
    // Failures come first.
    answered.sort_by_key(|graded| graded.verdict == Verdict::Pass);
    let says = |cell: String| ![NOTHING, BUILT_IN].contains(&&cell[..]);
    let said = |column: &Column| answered.iter().any(|graded| says((column.of)(graded, shown)));
    let columns: Vec<Column> = COLUMNS.into_iter().filter(said).collect();
    let page = Page {
        style: include_str!("../../present/report/report.css"),
        answers: &report.answers,
        reference: &report.reference,
        shearbed: &report.shearbed,
        headline: report.headline(),
        good,
        rows: answered.iter().map(|graded| row(graded, &columns)).collect(),
        reasons: reasons(&answered),
        columns,
        pictures: pictures.to_vec(),
        // The first table repeats the rows above.
        tables: tables(report).split_off(1),
        diagnosis: &report.diagnosis,
        missing: missing(report),
        remarks: &report.remarks,
    };
    // The extension of the name turns escaping on.
    environment
        .template_from_named_str("grade.html", include_str!("grade.html.j2"))
        .and_then(|template| template.render(Serde(&page)))
        .map(|page| readable(&page).into_owned())
        .map_err(|error| format!("cannot write the report: {error}"))
}

fn row<'a>(graded: &'a Graded, columns: &[Column]) -> ProblemRow<'a> {
    ProblemRow {
        word: graded.verdict.word(),
        class: match graded.verdict {
            Verdict::Pass => "pass",
            Verdict::Fail => "fail",
            Verdict::Missing | Verdict::Refused => "nodata",
            Verdict::NotReached => "underpowered",
        },
        name: &graded.name,
        cells: columns.iter().map(|column| (column.of)(graded, shown)).collect(),
        said: words(graded),
    }
}
