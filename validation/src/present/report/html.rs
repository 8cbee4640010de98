//! The report as one HTML file.

use super::first::{cards, closest, thumbnails};
use super::formats::{bounds, detail, number, seconds, share, verdict};
use super::page::{
    CaseView, EquationView, ExhibitView, FigureView, Group, LineView, Link, Page, StudyView, TableView,
};
use super::prose::Anchors;
use super::{CaseRow, Line, Report, ReportFigure, ReportTable};
use crate::files::text::readable;
use crate::judge::accept::Verdict;
use crate::judge::case::Judges;
use crate::present::plot;
use crate::present::study::Exhibit;
use minijinja::value::{Serde, Value};
use minijinja::{Environment, UndefinedBehavior};

pub(super) fn write(report: &Report) -> Result<String, String> {
    let mut environment = Environment::new();
    environment.set_undefined_behavior(UndefinedBehavior::Strict);
    let anchors = Anchors::of(report);
    environment.add_filter("prose", move |text: &str| Value::from_safe_string(anchors.html(text)));
    let attention = (report.cases.iter())
        .filter(|row| matches!(row.verdict, Verdict::Fail | Verdict::Underpowered))
        .map(case_link);
    let page = Page {
        style: include_str!("report.css"),
        script: include_str!("report.js"),
        headline: report.headline(),
        good: report.exit_code() == 0,
        cards: cards(report),
        thumbnails: thumbnails(report)?,
        attention: attention.collect(),
        closest: closest(report),
        studies: studies(report)?,
        groups: groups(report),
        equations: equations(report),
        plans: &report.sections.plans,
        false_alarm: number(report.summary.false_alarm),
        full: report.summary.full,
        time: seconds(report.summary.seconds),
        origin: &report.origin,
    };
    // The name's extension turns escaping on.
    environment
        .template_from_named_str("report.html", include_str!("report.html.j2"))
        .and_then(|template| template.render(Serde(&page)))
        .map(|page| readable(&page).into_owned())
        .map_err(|error| format!("cannot write the report: {error}"))
}

fn groups(report: &Report) -> Vec<Group<'_>> {
    let group = |judges: &Judges| Group {
        tag: judges.tag(),
        name: super::first::title(*judges),
        means: super::first::means(*judges),
        cases: (report.cases.iter())
            .filter(|row| row.judges == *judges)
            .map(|row| case(report, row))
            .collect(),
    };
    let groups = Judges::ALL.iter().map(group);
    groups.filter(|group| !group.cases.is_empty()).collect()
}

fn case<'a>(report: &'a Report, row: &'a CaseRow) -> CaseView<'a> {
    let (symbol, word) = verdict(row.verdict);
    let equations = (report.sections.equations.iter())
        .filter(|equation| equation.cases.contains(&row.name))
        .map(|equation| format!(" eq-{}", equation.number));
    let figures = report.sections.figures().filter(|f| f.cases.contains(&row.name));
    let used = row.worst().filter(|_| row.verdict != Verdict::NoData).map(|line| line.used);
    CaseView {
        name: &row.name,
        claim: &row.claim,
        tags: row.judges.tag().to_owned() + &equations.collect::<String>(),
        source: &row.source,
        class: row.verdict,
        symbol,
        word,
        used: used.map_or("–".into(), share),
        bar: used.map(bar),
        because: row.worst().map_or("no evidence", |line| &line.because),
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

/// The used share of the tolerance as the length of a bar in percent, on a logarithmic scale from 10⁻⁴ to 10.
fn bar(used: f64) -> f64 {
    match used.is_nan() {
        true => 100.0,
        false => (20.0 * (used.max(1e-300).log10() + 4.0)).clamp(0.0, 100.0).round(),
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

fn studies(report: &Report) -> Result<Vec<StudyView<'_>>, String> {
    (report.sections.studies.iter())
        .map(|study| {
            Ok(StudyView {
                name: &study.name,
                title: &study.title,
                question: &study.question,
                answer: &study.answer,
                command: &study.command,
                time: seconds(study.seconds),
                cases: case_links(report, &study.cases),
                exhibits: (study.exhibits.iter())
                    .map(|exhibit| view(report, exhibit))
                    .collect::<Result<_, String>>()?,
            })
        })
        .collect()
}

fn view<'a>(report: &'a Report, exhibit: &'a Exhibit) -> Result<ExhibitView<'a>, String> {
    /// Largest width in letters of a table beside a picture.
    const BESIDE: usize = 68;
    let figure = exhibit.figure.as_ref().map(|f| self::figure(report, f));
    let narrow = exhibit.table.as_ref().is_some_and(|table| table.letters_across() <= BESIDE);
    Ok(ExhibitView {
        figure: figure.transpose()?,
        table: exhibit.table.as_ref().map(table),
        beside: exhibit.figure.is_some() && narrow,
    })
}

fn figure<'a>(report: &'a Report, figure: &'a ReportFigure) -> Result<FigureView<'a>, String> {
    Ok(FigureView {
        name: &figure.name,
        title: &figure.figure.title,
        svg: plot::svg(&figure.figure)?,
        caption: &figure.caption,
        source: &figure.source,
        cases: case_links(report, &figure.cases),
    })
}

fn equations(report: &Report) -> Vec<EquationView<'_>> {
    let caught = |cases: &[String]| {
        let rows = report.cases.iter().filter(|row| cases.contains(&row.name));
        let controls = rows.flat_map(|row| &row.controls).filter(|control| control.caught);
        controls.map(|control| control.mistake.as_ref()).collect()
    };
    let equations = report.sections.equations.iter();
    equations
        .map(|equation| EquationView {
            number: &equation.number,
            says: &equation.says,
            code: &equation.code,
            cases: case_links(report, &equation.cases),
            caught: caught(&equation.cases),
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
        name: &table.name,
        title: &table.title,
        caption: &table.caption,
        columns: &table.columns,
        rows: &table.rows,
    }
}

/// Links to those of the cases called `names` that are in the report.
fn case_links<'a>(report: &'a Report, names: &[String]) -> Vec<Link<'a>> {
    let cases = report.cases.iter().filter(|row| names.contains(&row.name));
    cases.map(case_link).collect()
}

fn case_link(row: &CaseRow) -> Link<'_> {
    Link {
        anchor: format!("case-{}", row.name),
        text: &row.name,
        class: Some(row.verdict),
        symbol: verdict(row.verdict).0,
    }
}
