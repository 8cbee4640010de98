//! Writes report.json.

use super::{
    CaseRow, Origin, Report, ReportEquation, ReportFigure, ReportStudy, ReportTable, ScenePlan, Summary,
};
use serde::Serialize;

/// Number of the format, which `schemas/report.schema.json` describes.
pub(crate) const FORMAT: u32 = 2;

#[derive(Serialize)]
struct Written<'a> {
    format: u32,
    summary: &'a Summary,
    cases: &'a [CaseRow],
    studies: &'a [ReportStudy],
    figures: Vec<&'a ReportFigure>,
    tables: Vec<&'a ReportTable>,
    equations: &'a [ReportEquation],
    plans: &'a [ScenePlan],
    origin: &'a Origin,
}

pub(super) fn write(report: &Report) -> String {
    let sections = &report.sections;
    let written = Written {
        format: FORMAT,
        summary: &report.summary,
        cases: &report.cases,
        studies: &sections.studies,
        figures: sections.figures().collect(),
        tables: sections.tables().collect(),
        equations: &sections.equations,
        plans: &sections.plans,
        origin: &report.origin,
    };
    serde_json::to_string_pretty(&written).unwrap_or_else(|error| format!("{{\"error\": \"{error}\"}}"))
}
