//! The report as one HTML file: the data for its template.

use super::first::{cards, closest, sizes, thumbnails};
use super::formats::{bounds, detail, number, seconds, share, verdict};
use super::prose::{Anchors, breakable};
use super::{CaseRow, Line, Report, ReportEquation, ReportFigure, ReportTable};
use crate::files::text::readable;
use crate::judge::accept::Verdict;
use crate::judge::case::Judges;
use crate::present::plot;
use crate::present::study::Exhibit;
use minijinja::value::{Serde, Value};
use minijinja::{Environment, UndefinedBehavior};
use serde_json::{Value as Json, json};

pub(super) fn write(report: &Report) -> Result<String, String> {
    let anchors = Anchors::of(report);
    let attention =
        (report.cases.iter()).filter(|row| matches!(row.verdict, Verdict::Fail | Verdict::Underpowered)).map(case_link);
    let page = json!({
        "style": include_str!("report.css"),
        "script": include_str!("report.js"),
        "alarms": report.alarms(),
        "sizes": sizes(report),
        "good": report.exit_code() == 0,
        "cards": cards(report),
        "thumbnails": thumbnails(report)?,
        // The cases to look at first: failed ones, then those nearest to their bounds.
        "attention": attention.collect::<Vec<_>>(),
        "closest": closest(report),
        "studies": studies(report)?,
        "groups": groups(report),
        "equations": equations(report),
        "plans": report.sections.plans,
        "false_alarm": number(report.summary.false_alarm),
        "full": report.summary.full,
        "time": seconds(report.summary.seconds),
        "origin": report.origin,
    });
    rendered("report.html", include_str!("report.html.j2"), &page, move |text: &str| anchors.html(text))
}

/// A page by its template, in which `prose` typesets texts.
pub(crate) fn rendered(
    name: &str,
    template: &str,
    page: &Json,
    prose: impl Fn(&str) -> String + Send + Sync + 'static,
) -> Result<String, String> {
    let mut environment = Environment::new();
    environment.set_undefined_behavior(UndefinedBehavior::Strict);
    environment.add_filter("code", |text: &str| Value::from_safe_string(breakable(text)));
    environment.add_filter("prose", move |text: &str| Value::from_safe_string(prose(text)));
    // The name's extension turns escaping on.
    let template = environment.template_from_named_str(name, template);
    let page = template.and_then(|template| template.render(Serde(page)));
    page.map(|page| readable(&page).into_owned()).map_err(|error| format!("cannot write the report: {error}"))
}

fn groups(report: &Report) -> Vec<Json> {
    let cases = |judges| report.cases.iter().filter(move |row| row.judges == judges);
    let kinds = Judges::ALL.into_iter().filter(|judges| cases(*judges).next().is_some());
    let group = |judges: Judges| {
        json!({
            "tag": judges.tag(),
            "name": judges.title(),
            "means": super::first::means(judges),
            "cases": cases(judges).map(|row| case(report, row)).collect::<Vec<_>>(),
        })
    };
    kinds.map(group).collect()
}

fn case(report: &Report, row: &CaseRow) -> Json {
    let (symbol, word) = verdict(row.verdict);
    let equations = (report.sections.equations.iter())
        .filter(|equation| equation.cases.contains(&row.name))
        .map(|equation| format!(" eq-{}", equation.number));
    let figures = report.sections.figures().filter(|f| f.cases.contains(&row.name));
    let worst = row.worst().filter(|_| row.verdict != Verdict::NoData);
    json!({
        "name": row.name,
        "claim": row.claim,
        "tags": row.judges.tag().to_owned() + &equations.collect::<String>(),
        "source": row.source,
        "class": row.verdict,
        "symbol": symbol,
        "word": word,
        "used": worst.map(|line| share(line.used)),
        "size": worst.map_or("–".into(), Line::size),
        "bar": worst.map(|line| bar(line.used)),
        "evidence": row.evidence.iter().map(line).collect::<Vec<_>>(),
        "caught": row.caught,
        "controls": row.controls,
        "time": seconds(row.seconds),
        "command": row.command,
        "figures": figures
            .map(|f| link(format!("figure-{}", f.name), &f.figure.title, None))
            .collect::<Vec<_>>(),
    })
}

/// The used share of the tolerance as the length of a bar in percent, on a logarithmic scale from 10⁻⁴ to 10.
fn bar(used: f64) -> f64 {
    if used.is_nan() { 100.0 } else { (20.0 * (used.max(1e-300).log10() + 4.0)).clamp(0.0, 100.0).round() }
}

fn line(line: &Line) -> Json {
    let (symbol, word) = verdict(line.verdict);
    let (error, tolerance) = bounds(line);
    json!({
        "what": line.what,
        "unit": line.unit,
        "class": line.verdict,
        "symbol": symbol,
        "word": word,
        "error": error,
        "tolerance": tolerance,
        "because": line.because,
        "detail": detail(&line.judged_by),
    })
}

fn studies(report: &Report) -> Result<Vec<Json>, String> {
    (report.sections.studies.iter())
        .map(|study| {
            let exhibits = study.exhibits.iter().map(|exhibit| view(report, exhibit));
            let mut page = json!(study);
            page["time"] = seconds(study.seconds).into();
            page["cases"] = case_links(report, &study.cases).into();
            page["exhibits"] = exhibits.collect::<Result<Vec<_>, String>>()?.into();
            Ok(page)
        })
        .collect()
}

/// A picture, its table, and whether the table is narrow enough to be beside the picture.
fn view(report: &Report, exhibit: &Exhibit) -> Result<Json, String> {
    /// Largest width in letters of a table beside a picture.
    const BESIDE: usize = 68;
    let figure = exhibit.figure.as_ref().map(|f| self::figure(report, f));
    let narrow = exhibit.table.as_ref().is_some_and(|table| table.letters_across() <= BESIDE);
    Ok(json!({
        "figure": figure.transpose()?,
        "table": exhibit.table.as_ref().map(table),
        "beside": exhibit.figure.is_some() && narrow,
    }))
}

fn figure(report: &Report, figure: &ReportFigure) -> Result<Json, String> {
    Ok(json!({
        "name": figure.name,
        "svg": plot::svg(&figure.figure)?,
        "narrow": plot::narrow(&figure.figure)?,
        "map": figure.figure.grid.is_some(),
        "caption": figure.caption,
        "source": figure.source,
        "cases": case_links(report, &figure.cases),
    }))
}

/// Each equation with the cases that test it, and the mistakes that they caught.
fn equations(report: &Report) -> Vec<Json> {
    let caught = |cases: &[String]| -> Vec<_> {
        let rows = report.cases.iter().filter(|row| cases.contains(&row.name));
        let controls = rows.flat_map(|row| &row.controls).filter(|control| control.caught);
        controls.map(|control| control.mistake.clone()).collect()
    };
    let page = |equation: &ReportEquation| {
        let mut page = json!(equation);
        page["cases"] = case_links(report, &equation.cases).into();
        page["caught"] = caught(&equation.cases).into();
        page
    };
    report.sections.equations.iter().map(page).collect()
}

/// A table, with a mark for each column of numbers.
fn table(table: &ReportTable) -> Json {
    let starts_a_number = |c: char| c.is_ascii_digit() || "+−-–±<≤>≥".contains(c);
    let is_number = |cell: &String| cell.starts_with(starts_a_number);
    let is_numeric = |column: usize| table.rows.iter().all(|row| row.get(column).is_some_and(is_number));
    json!({
        "numeric": (0..table.columns.len()).map(is_numeric).collect::<Vec<_>>(),
        "name": table.name,
        "title": table.title,
        "caption": table.caption,
        "columns": table.columns,
        "rows": table.rows,
    })
}

/// Links to those of the cases called `names` that are in the report.
fn case_links(report: &Report, names: &[String]) -> Vec<Json> {
    let cases = report.cases.iter().filter(|row| names.contains(&row.name));
    cases.map(case_link).collect()
}

fn case_link(row: &CaseRow) -> Json {
    link(format!("case-{}", row.name), &row.name, Some(row.verdict))
}

/// A link inside the report: to a case with its verdict, or to a figure.
fn link(anchor: String, text: &str, of: Option<Verdict>) -> Json {
    let symbol = of.map_or("", |of| verdict(of).0);
    json!({ "anchor": anchor, "text": text, "class": of, "symbol": symbol })
}
