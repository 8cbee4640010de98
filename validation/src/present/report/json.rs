//! Writes report.json.

use super::{CaseRow, Origin, Report, ReportEquation, ReportFigure, ReportStudy, ReportTable, ScenePlan, Summary};
use crate::files::output::Sum;
use serde::Serialize;

/// Number of the format, which `schemas/report.schema.json` describes.
pub const FORMAT: u32 = 3;

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
    let text = serde_json::to_string_pretty(&written).unwrap_or_else(|error| format!("{{\"error\": \"{error}\"\n}}"));
    let before = text.strip_suffix("\n}").unwrap_or(&text);
    format!("{before},\n  \"crc32\": \"{}\"\n}}", Sum::of(before.as_bytes()).crc32)
}

/// Fails if a report's checksum, its last key, is not that of the text before it.
pub fn check(text: &str) -> Result<(), String> {
    let (before, last) = text.rsplit_once(',').unwrap_or((text, ""));
    let last: String = last.split_whitespace().collect();
    match last.strip_prefix("\"crc32\":\"").and_then(|rest| rest.strip_suffix("\"}")) {
        Some(sum) if sum == Sum::of(before.as_bytes()).crc32 => Ok(()),
        Some(_) => {
            Err("was changed after it was written: its checksum is not that of its text; run `shearbed validate` again"
                .into())
        }
        None => Err("has no checksum as its last key: run `shearbed validate` again".into()),
    }
}
