//! Writes report.json.

use super::{CaseRow, Origin, Report, ReportEquation, ReportFigure, ReportStudy, ReportTable, ScenePlan, Summary};
use crate::files::build::SOURCES;
use crate::files::output::Sum;
use crate::files::text;
use crate::judge::case::GATE_SEED;
use serde::Serialize;
use serde_json::{Value, json};
use std::collections::BTreeSet;

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
    let text = text::json(&written).unwrap_or_else(|error| format!("{{\"error\": \"{error}\"\n}}\n"));
    let before = text.strip_suffix("\n}\n").unwrap_or(&text);
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

/// The cases that passed in the report with this text, if the sources of this very build made it by plain `validate`,
/// where every case gets the same bits again; else none.
pub fn passed(text: &str) -> BTreeSet<String> {
    let report: Value = serde_json::from_str(text).unwrap_or_default();
    let (origin, summary) = (&report["origin"], &report["summary"]);
    let made_here = origin["sources"] == SOURCES && origin["points"] == json!([]);
    if check(text).is_err() || !made_here || summary["seed"] != GATE_SEED || summary["full"] != false {
        return BTreeSet::new();
    }
    let cases = report["cases"].as_array().into_iter().flatten();
    let cases = cases.filter(|case| case["verdict"] == "pass");
    cases.filter_map(|case| case["name"].as_str()).map(str::to_owned).collect()
}
