//! `shearbed compare`: the changes between two reports.

use super::{Failure, print};
use serde::Deserialize;
use shearbed_validation::files::text::Shown;
use shearbed_validation::files::{FileError, bounded};
use shearbed_validation::judge::accept::Verdict;
use shearbed_validation::present::report::{self, FORMAT};
use shearbed_validation::present::table::{ReportTable, number, words};
use shearbed_validation::studies::work_precision::study::time;
use std::path::{Path, PathBuf};

#[derive(clap::Args)]
#[command(after_help = "Example:\n  shearbed compare old/report.json new/report.json")]
pub(super) struct Args {
    /// A report.json
    #[arg(value_name = "A/report.json")]
    before: PathBuf,
    /// Another one
    #[arg(value_name = "B/report.json")]
    after: PathBuf,
}

/// The parts of a report that are read.
#[derive(Deserialize)]
struct Report {
    format: u32,
    summary: Summary,
    cases: Vec<Case>,
    #[serde(default)]
    studies: Vec<StudyTime>,
    origin: Origin,
}

#[derive(Deserialize)]
struct Summary {
    full: bool,
    seed: u64,
}

#[derive(Deserialize)]
struct Origin {
    commit: String,
    processor: String,
}

#[derive(Deserialize)]
struct StudyTime {
    name: String,
    seconds: f64,
}

#[derive(Deserialize)]
struct Case {
    name: String,
    verdict: Verdict,
    seconds: f64,
    evidence: Vec<Line>,
    #[serde(default)]
    controls: Vec<Control>,
}

#[derive(Deserialize)]
struct Control {
    mistake: String,
    caught: bool,
}

#[derive(Deserialize)]
struct Line {
    what: String,
    /// Null if the error is not finite.
    error: Option<f64>,
    tolerance: Option<f64>,
    judged_by: Rule,
}

#[derive(Deserialize)]
struct Rule {
    rule: String,
    mean: Option<f64>,
    se: Option<f64>,
}

/// A line of evidence that moved between two reports.
struct Moved<'a> {
    case: &'a str,
    what: &'a str,
    before: Option<f64>,
    after: Option<f64>,
    by: String,
}

/// Means count as changed if they differ by more than this number of standard errors: 1 in 15 000 does so by chance.
const NOISE: f64 = 4.0;

/// Errors without noise count as changed if they change by this share of their tolerance.
const PART: f64 = 0.01;

pub(super) fn compare(args: &Args) -> Result<(), Failure> {
    let (a, b) = (read(&args.before)?, read(&args.after)?);
    let [before, after] = [&args.before, &args.after].map(|path| path.shown());
    if of_both(&a, &b).next().is_none() {
        return Err(Failure::Input(format!("{before} and {after} have no case in common: nothing can be compared")));
    }
    let mut text = format!("A: {before}, commit {}\nB: {after}, commit {}\n", a.origin.commit, b.origin.commit);
    if (a.summary.full, a.summary.seed) != (b.summary.full, b.summary.seed) {
        text += "The two differ in --full or --seed: other samples, so that means move by chance.\n";
    }
    text.push('\n');
    text += &verdicts(&a, &b);
    text += &judged_otherwise(&a, &b);
    let moved = moved(&a, &b);
    if moved.is_empty() {
        text += "No error moved beyond its noise.\n\n";
    } else {
        text += &moved_table(moved).text();
    }
    text += &speeds(&a, &b).text();
    if a.origin.processor != b.origin.processor {
        text += &format!("Times are of two processors: {} and {}.\n", a.origin.processor, b.origin.processor);
    }
    print(&text)
}

/// The largest size of a report, in bytes.
const MOST_BYTES: u64 = 256 << 20;

fn read(path: &Path) -> Result<Report, Failure> {
    let text = bounded::text(path, MOST_BYTES).map_err(|error| FileError::unreadable(path, &error))?;
    let report = parse(&text).and_then(|report| report::check(&text).map(|()| report));
    Ok(report.map_err(|why| FileError::whole(path, why))?)
}

/// Parses a report of this version's format.
fn parse(text: &str) -> Result<Report, String> {
    let report: Report = serde_json::from_str(text)
        .map_err(|error| format!("is no report.json that `shearbed validate` wrote: {error}"))?;
    if report.format != FORMAT {
        return Err(format!(
            "format = {} is not allowed: expected {FORMAT}, of this version of shearbed",
            report.format
        ));
    }
    Ok(report)
}

/// Lists cases with different verdicts, and those that only one report has.
fn verdicts(a: &Report, b: &Report) -> String {
    let mut lines = Vec::new();
    for before in &a.cases {
        let after = b.cases.iter().find(|case| case.name == before.name);
        if after.is_none_or(|after| after.verdict != before.verdict) {
            let after = after.map_or("not in B".to_owned(), |after| after.verdict.to_string());
            lines.push(format!("{}: {} → {after}", before.name, before.verdict));
        }
    }
    let new = b.cases.iter().filter(|case| !a.cases.iter().any(|other| other.name == case.name));
    lines.extend(new.map(|case| format!("{}: not in A → {}", case.name, case.verdict)));
    if lines.is_empty() {
        format!("Verdicts: none of {} changed.\n", a.cases.len())
    } else {
        format!("Verdicts that changed:\n  {}\n", lines.join("\n  "))
    }
}

/// The cases that both reports have.
fn of_both<'a>(a: &'a Report, b: &'a Report) -> impl Iterator<Item = (&'a Case, &'a Case)> {
    (a.cases.iter()).filter_map(|case| Some((case, b.cases.iter().find(|other| other.name == case.name)?)))
}

impl Case {
    fn line(&self, what: &str) -> Option<&Line> {
        self.evidence.iter().find(|line| line.what == what)
    }

    fn control(&self, mistake: &str) -> Option<&Control> {
        self.controls.iter().find(|control| control.mistake == mistake)
    }
}

/// Lists what the cases of both reports judge in one of them alone, or otherwise: evidence, tolerances, controls.
fn judged_otherwise(a: &Report, b: &Report) -> String {
    let mut lines = Vec::new();
    for (before, after) in of_both(a, b) {
        let name = &before.name;
        for (one, other, report) in [(before, after, "A"), (after, before, "B")] {
            let evidence = one.evidence.iter().map(|line| &line.what).filter(|what| other.line(what).is_none());
            let controls = one.controls.iter().map(|control| &control.mistake);
            let alone = evidence.chain(controls.filter(|mistake| other.control(mistake).is_none()));
            lines.extend(alone.map(|what| format!("{name}: {what}: in {report} alone")));
        }
        // That of a mean follows its standard error.
        for line in before.evidence.iter().filter(|line| line.judged_by.rule != "mean") {
            let both = after.line(&line.what).and_then(|same| line.tolerance.zip(same.tolerance));
            if let Some((was, is)) = both.filter(|(was, is)| was != is) {
                lines.push(format!("{name}: {}: tolerance {was:.3e} → {is:.3e}", line.what));
            }
        }
        for control in &before.controls {
            let words = |caught| if caught { "caught" } else { "not caught" };
            if let Some(same) = after.control(&control.mistake).filter(|same| same.caught != control.caught) {
                let change = format!("{} → {}", words(control.caught), words(same.caught));
                lines.push(format!("{name}: {}: {change}", control.mistake));
            }
        }
    }
    if lines.is_empty() { String::new() } else { format!("Judged otherwise:\n  {}\n", lines.join("\n  ")) }
}

fn moved<'a>(a: &'a Report, b: &'a Report) -> Vec<Moved<'a>> {
    let of_case = |(before, after): (&'a Case, &'a Case)| {
        before.evidence.iter().filter_map(move |line| {
            let other = after.line(&line.what)?;
            Some(Moved {
                case: &before.name,
                what: &line.what,
                before: line.judged_by.mean.or(line.error),
                after: other.judged_by.mean.or(other.error),
                by: by(line, other)?,
            })
        })
    };
    of_both(a, b).flat_map(of_case).collect()
}

/// The change of a line of evidence in words; none if it is within the noise.
fn by(a: &Line, b: &Line) -> Option<String> {
    let means = (a.judged_by.mean.zip(a.judged_by.se)).zip(b.judged_by.mean.zip(b.judged_by.se));
    if let Some(((mean_a, se_a), (mean_b, se_b))) = means {
        let deviations = (mean_b - mean_a) / se_a.hypot(se_b);
        return (deviations.abs() > NOISE).then(|| format!("{deviations:+.1} standard errors"));
    }
    match (a.error, b.error) {
        // A p-value is itself noise: only its verdict counts.
        _ if a.judged_by.rule == "p_value" => None,
        (Some(before), Some(after)) => {
            let tolerance = a.tolerance.unwrap_or(0.0).abs();
            let change = after.abs() - before.abs();
            let beyond = if tolerance > 0.0 { change.abs() > PART * tolerance } else { change != 0.0 };
            beyond.then(|| if before == 0.0 { "from 0".into() } else { format!("× {:.3}", after.abs() / before.abs()) })
        }
        (None, None) => None,
        _ => Some("to or from no number".into()),
    }
}

fn moved_table(moved: Vec<Moved>) -> ReportTable {
    let e = |x: f64| format!("{x:.4e}");
    ReportTable::new(
        ["moved", "Errors that moved"],
        format!(
            "Means by more than {NOISE} standard errors of the two; other errors by more than {PART} of their \
             tolerance."
        ),
        moved,
        vec![
            words("case", |m: &Moved| m.case),
            words("what", |m: &Moved| m.what),
            number("A", e, |m: &Moved| m.before),
            number("B", e, |m: &Moved| m.after),
            words("moved by", |m: &Moved| m.by.clone()),
        ],
    )
}

/// Shorter times, in s, are noise and are left out.
const LEAST_SECONDS: f64 = 0.05;

fn speeds(a: &Report, b: &Report) -> ReportTable {
    type Row<'a> = (&'a str, f64, f64);
    let cases = of_both(a, b).map(|(case, other)| (case.name.as_str(), case.seconds, other.seconds));
    let studies = a.studies.iter().filter_map(|study| {
        let other = b.studies.iter().find(|other| other.name == study.name)?;
        Some((study.name.as_str(), study.seconds, other.seconds))
    });
    let both: Vec<Row> = cases.chain(studies).collect();
    let total = both.iter().fold((0.0, 0.0), |sum, row| (sum.0 + row.1, sum.1 + row.2));
    let ratio = |row: &Row| row.2 / row.1;
    let far = |row: &&Row| row.1.min(row.2) > LEAST_SECONDS && !(0.67..1.5).contains(&ratio(row));
    let mut rows: Vec<Row> = both.iter().filter(far).copied().collect();
    rows.sort_by(|x, y| ratio(y).total_cmp(&ratio(x)));
    rows.insert(0, ("all that both have", total.0, total.1));
    ReportTable::new(
        ["speeds", "Times"],
        format!("All together, then what is 1.5 times as slow or as fast and takes more than {LEAST_SECONDS} s."),
        rows,
        vec![
            words("what", |row: &Row| row.0),
            number("A", time, |row: &Row| row.1),
            number("B", time, |row: &Row| row.2),
            number("B / A", |x| format!("{x:.2}"), move |row: &Row| ratio(row)),
        ],
    )
}
