//! The report as one self-contained HTML file with its pictures.

use super::report::{BUILT_IN, COLUMNS, Column, NOTHING, grouped, missing, tables, words};
use super::{Graded, Report, Verdict};
use crate::present::report::{digits, rendered, typeset};
use serde_json::{Value as Json, json};

fn shown(number: Option<f64>) -> String {
    number.map_or(NOTHING.into(), |number| digits(number, 2))
}

/// Each reason for a tolerance, with the problems to which it applies.
fn reasons(graded: &[&Graded]) -> Vec<Json> {
    let reasons = grouped(graded.iter().map(|graded| (&graded.because, &graded.name)));
    reasons.into_iter().map(|(text, names)| json!({ "text": text, "names": names })).collect()
}

/// The report as an HTML page, with `pictures` as SVG.
pub fn html(report: &Report, good: bool, pictures: &[&str]) -> Result<String, String> {
    let mut answered: Vec<&Graded> = report.problems.iter().filter(|g| g.verdict != Verdict::Missing).collect();
    // Failures come first.
    answered.sort_by_key(|graded| graded.verdict == Verdict::Pass);
    let says = |cell: String| ![NOTHING, BUILT_IN].contains(&&cell[..]);
    let said = |column: &Column| answered.iter().any(|graded| says((column.of)(graded, shown)));
    let columns: Vec<Column> = COLUMNS.into_iter().filter(said).collect();
    let page = json!({
        "style": include_str!("../../present/report/report.css"),
        "answers": report.answers,
        "reference": report.reference,
        "shearbed": report.shearbed,
        "headline": report.headline(),
        "good": good,
        "rows": answered.iter().map(|graded| row(graded, &columns)).collect::<Vec<_>>(),
        "reasons": reasons(&answered),
        "columns": columns,
        "pictures": pictures,
        // The first table repeats the rows above.
        "tables": tables(report)[1..],
        "diagnosis": report.diagnosis,
        "missing": missing(report),
        "remarks": report.remarks,
    });
    rendered("grade.html", include_str!("grade.html.j2"), &page, typeset)
}

fn row(graded: &Graded, columns: &[Column]) -> Json {
    let class = match graded.verdict {
        Verdict::Pass => "pass",
        Verdict::Fail => "fail",
        Verdict::Missing | Verdict::Refused => "nodata",
        Verdict::NotReached => "underpowered",
    };
    let cells: Vec<_> = columns.iter().map(|column| (column.of)(graded, shown)).collect();
    json!({
        "word": graded.verdict.word(), "class": class, "name": graded.name, "cells": cells, "said": words(graded),
    })
}
