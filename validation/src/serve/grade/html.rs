//! The report as one HTML file with its pictures, which needs nothing else.

use super::report::{missing, number, origin, tables, words};
use super::{Graded, Report, Verdict};
use crate::files::text::readable;
use crate::present::table::ReportTable;
use minijinja::value::Serde;
use minijinja::{Environment, UndefinedBehavior};
use serde::Serialize;

/// All that the template shows.
#[derive(Serialize)]
struct Page<'a> {
    style: &'static str,
    answers: &'a str,
    reference: &'a str,
    shearbed: &'a str,
    headline: String,
    good: bool,
    rows: Vec<ProblemRow<'a>>,
    pictures: Vec<&'a str>,
    tables: Vec<ReportTable>,
    diagnosis: &'a [String],
    missing: Option<String>,
    remarks: &'a [String],
}

/// A problem as text.
#[derive(Serialize)]
struct ProblemRow<'a> {
    word: &'static str,
    class: &'static str,
    name: &'a str,
    origin: &'static str,
    error: String,
    tolerance: String,
    because: &'a str,
    order: String,
    setting: String,
    length: String,
    orbit: String,
    phase: String,
    said: Vec<&'a str>,
}

/// The page, with pictures as SVG.
pub fn html(report: &Report, good: bool, pictures: &[&str]) -> Result<String, String> {
    let mut environment = Environment::new();
    environment.set_undefined_behavior(UndefinedBehavior::Strict);
    let page = Page {
        style: include_str!("../../present/report/report.css"),
        answers: &report.answers,
        reference: &report.reference,
        shearbed: &report.shearbed,
        headline: report.headline(),
        good,
        rows: report.problems.iter().filter(|graded| graded.verdict != Verdict::Missing).map(row).collect(),
        pictures: pictures.to_vec(),
        // The first is that of the rows.
        tables: tables(report).split_off(1),
        diagnosis: &report.diagnosis,
        missing: missing(report),
        remarks: &report.remarks,
    };
    // The name's ending turns the escaping on.
    environment
        .template_from_named_str("grade.html", include_str!("grade.html.j2"))
        .and_then(|template| template.render(Serde(&page)))
        .map(|page| readable(&page).into_owned())
        .map_err(|error| format!("cannot write the report: {error}"))
}

fn row(graded: &Graded) -> ProblemRow<'_> {
    ProblemRow {
        word: graded.verdict.word(),
        class: match graded.verdict {
            Verdict::Pass => "pass",
            Verdict::Fail => "fail",
            Verdict::Missing => "nodata",
            Verdict::NotReached => "underpowered",
        },
        name: &graded.name,
        origin: origin(graded),
        error: number(graded.error),
        tolerance: number(Some(graded.tolerance)),
        because: &graded.because,
        order: graded.order_text(),
        setting: graded.setting_text(),
        length: number(graded.length_drift),
        orbit: number(graded.orbit_drift),
        phase: number(graded.phase_lost_per_period),
        said: words(graded),
    }
}
