//! Writes report.json.

use super::{CaseRow, Origin, Report, ReportEquation, ReportFigure, ReportTable, ScenePlan, Summary};
use serde::Serialize;

/// Number of the format, which `schemas/report.schema.json` describes.
pub(crate) const FORMAT: u32 = 2;

#[derive(Serialize)]
struct Written<'a> {
    format: u32,
    summary: &'a Summary,
    cases: &'a [CaseRow],
    studies: Vec<StudyRecord<'a>>,
    figures: Vec<&'a ReportFigure>,
    tables: Vec<&'a ReportTable>,
    equations: &'a [ReportEquation],
    plans: &'a [ScenePlan],
    origin: &'a Origin,
}

/// A study, with its pictures and tables by name.
#[derive(Serialize)]
struct StudyRecord<'a> {
    name: &'a str,
    title: &'a str,
    question: &'a str,
    answer: &'a str,
    command: &'a str,
    cases: &'a [String],
    seconds: f64,
    exhibits: Vec<Exhibit<'a>>,
}

#[derive(Serialize)]
struct Exhibit<'a> {
    figure: Option<&'a str>,
    table: Option<&'a str>,
}

pub(super) fn write(report: &Report) -> String {
    let sections = &report.sections;
    let studies = sections.studies.iter().map(|study| StudyRecord {
        name: &study.name,
        title: &study.title,
        question: &study.question,
        answer: &study.answer,
        command: &study.command,
        cases: &study.cases,
        seconds: study.seconds,
        exhibits: (study.exhibits.iter())
            .map(|exhibit| Exhibit {
                figure: exhibit.figure.as_ref().map(|figure| figure.name.as_str()),
                table: exhibit.table.as_ref().map(|table| table.name.as_str()),
            })
            .collect(),
    });
    let written = Written {
        format: FORMAT,
        summary: &report.summary,
        cases: &report.cases,
        studies: studies.collect(),
        figures: sections.figures().collect(),
        tables: sections.tables().collect(),
        equations: &sections.equations,
        plans: &sections.plans,
        origin: &report.origin,
    };
    serde_json::to_string_pretty(&written).unwrap_or_else(|error| format!("{{\"error\": \"{error}\"}}"))
}
