//! The results as text for the terminal and as JSON, Markdown and JUnit files.

use super::live::Studies;
use super::{Graded, Verdict};
use crate::files::text::{escaped, readable};
use crate::present::markup;
use crate::present::table::{ReportTable, of_words, wrapped};
use crate::serve::problems::Origin;
use serde::Serialize;

/// All results of a program.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    /// The version of the report's format.
    pub format: u32,
    /// The version of shearbed.
    pub shearbed: String,
    /// The source of the problems.
    pub reference: String,
    /// The source of the answers: a folder, or a command.
    pub answers: String,
    /// The result on each problem.
    pub problems: Vec<Graded>,
    /// Studies of a running program, beyond verdicts.
    pub live: Option<Studies>,
    /// Findings from several problems together.
    pub diagnosis: Vec<String>,
    /// Other remarks.
    pub remarks: Vec<String>,
    /// True if every problem needs an answer: a missing one is then a failure, and otherwise neither a pass nor a
    /// failure, like a case without data in `validate`.
    #[serde(skip)]
    pub all: bool,
}

impl Report {
    fn title(&self) -> String {
        format!("{} on {}", self.answers, self.reference)
    }

    fn count(&self, verdict: Verdict) -> usize {
        self.problems.iter().filter(|graded| graded.verdict == verdict).count()
    }

    /// True if at least one problem passes and none fails.
    pub fn passes(&self) -> bool {
        self.count(Verdict::Pass) > 0 && !self.problems.iter().any(|graded| self.is_failure(graded.verdict))
    }

    fn is_failure(&self, verdict: Verdict) -> bool {
        match verdict {
            Verdict::Pass => false,
            Verdict::Fail | Verdict::NotReached => true,
            Verdict::Missing | Verdict::Refused => self.all,
        }
    }

    /// The counts of verdicts, as text.
    pub fn counts(&self) -> String {
        self.counted(|_| "")
    }

    /// The number of problems with each verdict, each followed by the text `meaning`.
    fn counted(&self, meaning: impl Fn(Verdict) -> &'static str) -> String {
        let others = [Verdict::Fail, Verdict::Refused, Verdict::Missing, Verdict::NotReached];
        let found = others.into_iter().filter(|verdict| self.count(*verdict) > 0);
        let found = found.map(|v| format!(", {} {}{}", self.count(v), v.word(), meaning(v)));
        let pass = self.count(Verdict::Pass);
        format!("{pass} of {} problems pass{}", self.problems.len(), found.collect::<String>())
    }

    /// The counts of verdicts with explanations.
    pub fn headline(&self) -> String {
        let mut words = self.counted(|verdict| match verdict {
            Verdict::Missing if self.all => " (no answer: not passed)",
            Verdict::Missing => " (no answer: neither passed nor failed)",
            Verdict::Refused if self.all => " (the program's own error: not passed)",
            Verdict::Refused => " (the program's own error: neither passed nor failed)",
            Verdict::NotReached => " (time ran out: not passed)",
            Verdict::Pass | Verdict::Fail => "",
        });
        let foreign = self.problems.iter().filter(|graded| graded.reference == Origin::Foreign);
        match foreign.count() {
            0 => {}
            count => {
                words += &format!("; {count} FOREIGN (no problem of this program: its certified answer is unchecked)");
            }
        }
        words
    }
}

fn number(value: Option<f64>) -> String {
    value.map_or(NOTHING.into(), |value| format!("{value:.1e}"))
}

fn origin(graded: &Graded) -> &'static str {
    match graded.reference {
        Origin::BuiltIn => BUILT_IN,
        Origin::Foreign => "FOREIGN",
    }
}

/// The text of a number or of its absence.
type Format = fn(Option<f64>) -> String;

/// A column of the table of verdicts, after the verdict and the problem's name.
#[derive(Clone, Copy, Serialize)]
pub(super) struct Column {
    title: &'static str,
    numeric: bool,
    /// A problem's cell, with numbers in the given format.
    #[serde(skip)]
    pub(super) of: fn(&Graded, Format) -> String,
}

pub(super) const NOTHING: &str = "–";
pub(super) const BUILT_IN: &str = "built-in";

pub(super) const COLUMNS: [Column; 8] = [
    Column { title: "reference", numeric: false, of: |graded, _| origin(graded).into() },
    Column { title: "error", numeric: true, of: |graded, number| number(graded.error) },
    Column { title: "tolerance", numeric: true, of: |graded, number| number(Some(graded.tolerance)) },
    Column { title: "order", numeric: true, of: |graded, _| graded.order_text() },
    Column { title: "setting", numeric: false, of: |graded, _| graded.setting_text() },
    Column { title: "|p| off by", numeric: true, of: |graded, number| number(graded.length_drift) },
    Column { title: "C_b drift", numeric: true, of: |graded, number| number(graded.orbit_drift) },
    Column { title: "phase lost/period", numeric: true, of: |graded, number| number(graded.phase_lost_per_period) },
];

/// The table of verdicts with these columns and names, without problems that have no answer.
fn verdicts(report: &Report, title: &str, columns: &[Column], name: impl Fn(&Graded) -> String) -> ReportTable {
    let row = |graded: &Graded| {
        let cells = columns.iter().map(|column| (column.of)(graded, number));
        [graded.verdict.word().to_owned(), name(graded)].into_iter().chain(cells).collect()
    };
    let titles: Vec<_> = ["verdict", "problem"].into_iter().chain(columns.iter().map(|column| column.title)).collect();
    of_words(
        "grade",
        title,
        &format!("{}.", report.headline()),
        &titles,
        report.problems.iter().filter(|graded| graded.verdict != Verdict::Missing).map(row).collect(),
    )
}

/// The parts that there are, as one text.
pub(super) fn joined(parts: impl IntoIterator<Item = Option<String>>) -> String {
    parts.into_iter().flatten().collect::<Vec<_>>().join("; ")
}

pub(super) fn words(graded: &Graded) -> Vec<&str> {
    let parts = [graded.diagnosis.as_deref(), graded.note.as_deref()];
    parts.into_iter().flatten().collect()
}

/// Each key with all its values, in the order of the first of each.
pub(super) fn grouped<K: PartialEq, V>(pairs: impl Iterator<Item = (K, V)>) -> Vec<(K, Vec<V>)> {
    let mut groups: Vec<(K, Vec<V>)> = Vec::new();
    for (key, value) in pairs {
        match groups.iter_mut().find(|(known, _)| *known == key) {
            Some((_, values)) => values.push(value),
            None => groups.push((key, vec![value])),
        }
    }
    groups
}

/// Findings from several problems, the remarks on each (equal ones once, faults of a running program only where the
/// other remarks have them), all missing problems in one line, and the other remarks.
fn lines<'a>(report: &'a Report) -> Vec<String> {
    let remark = |graded: &'a Graded| {
        let words = words(graded);
        ((graded.verdict, words[usize::from(graded.is_said_over_all)..].join("; ")), graded.name.as_str())
    };
    let answered = report.problems.iter().filter(|graded| graded.verdict != Verdict::Missing);
    let is_fault = |text: &str| {
        let cause = text.strip_prefix("asked for ").and_then(|text| text.split_once(": "));
        let cause = cause.map_or(text, |(_, cause)| cause);
        report.remarks.iter().any(|remark| remark.contains(cause))
    };
    let of = |((verdict, text), names): ((Verdict, String), Vec<&str>)| {
        (!text.is_empty() && !is_fault(&text)).then(|| format!("{} {}: {text}", verdict.word(), names.join(", ")))
    };
    let mut lines = report.diagnosis.clone();
    lines.extend(grouped(answered.map(remark)).into_iter().filter_map(of));
    lines.extend(missing(report));
    lines.extend(report.remarks.iter().cloned());
    lines
}

/// The largest number of problems without an answer that are named.
const MOST_MISSING: usize = 12;

/// The problems without an answer, in one line.
pub(super) fn missing(report: &Report) -> Option<String> {
    let names: Vec<_> = (report.problems.iter())
        .filter(|graded| graded.verdict == Verdict::Missing)
        .map(|graded| graded.name.as_str())
        .collect();
    let first = report.problems.iter().find(|graded| graded.verdict == Verdict::Missing)?;
    let why = match (names.len(), &first.note) {
        (1, Some(note)) => format!("; {note}"),
        _ => String::new(),
    };
    let more = match names.len().checked_sub(MOST_MISSING) {
        Some(more @ 1..) => format!(" and {more} more"),
        _ => String::new(),
    };
    let shown = names[..names.len().min(MOST_MISSING)].join(", ");
    Some(format!("{} MISSING, no answer: {shown}{more}{why}", names.len()))
}

/// The table of verdicts, then those of the studies.
pub(super) fn tables(report: &Report) -> Vec<ReportTable> {
    let mut tables = vec![verdicts(report, &report.title(), &COLUMNS, |graded| graded.name.clone())];
    tables.extend(report.live.iter().flat_map(Studies::tables));
    tables
}

/// The report for the terminal, in 80 columns: missing answers share a line; the drifts are only in the files.
pub fn terminal(report: &Report) -> String {
    // Two blanks in a row would mark a table's row.
    let title = report.title().split_whitespace().collect::<Vec<_>>().join(" ");
    let table = verdicts(report, &title, &COLUMNS[1..5], |graded| match graded.reference {
        Origin::Foreign => format!("{} (FOREIGN)", graded.name),
        Origin::BuiltIn => graded.name.clone(),
    });
    let mut parts = vec![table.text(), lines(report).join("\n")];
    parts.extend(tables(report).iter().skip(1).map(ReportTable::text));
    let parts: Vec<&str> = parts.iter().map(|part| part.trim_end()).filter(|part| !part.is_empty()).collect();
    wrapped(&parts.join("\n\n"))
}

/// The content of grade.md.
pub fn markdown(report: &Report) -> String {
    let mut text = String::from("# Grades\n");
    for (k, table) in tables(report).iter().enumerate() {
        let [title, caption] = [&table.title, &table.caption].map(|text| markup::markdown(text));
        text += &format!("\n## {title}\n\n{caption}\n\n{}", table.cells_as_markdown(markup::markdown));
        if k == 0 {
            text += "\n";
            text += &lines(report).iter().map(|line| format!("- {}\n", markup::markdown(line))).collect::<String>();
        }
    }
    readable(&text).into_owned()
}

/// The content of junit.xml: a test case for each problem. A missing answer is skipped, or a failure if all are needed;
/// a problem that was not reached is a failure.
pub fn junit(report: &Report) -> String {
    let failed = report.problems.iter().filter(|graded| report.is_failure(graded.verdict)).count();
    let skipped = report.problems.len() - failed - report.count(Verdict::Pass);
    let mut xml = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n<testsuite name=\"shearbed grade\" tests=\"{}\" \
         failures=\"{failed}\" errors=\"0\" skipped=\"{skipped}\" time=\"{:.3}\">\n",
        report.problems.len(),
        report.problems.iter().map(|graded| graded.seconds).sum::<f64>()
    );
    for graded in &report.problems {
        let name = escaped(&graded.name);
        xml += &format!("<testcase classname=\"shearbed\" name=\"{name}\" time=\"{:.3}\">", graded.seconds);
        if graded.verdict != Verdict::Pass {
            let message = format!(
                "{}: error {}, tolerance {}; {}",
                graded.verdict.word(),
                number(graded.error),
                number(Some(graded.tolerance)),
                words(graded).join("; ")
            );
            let element = if report.is_failure(graded.verdict) { "failure" } else { "skipped" };
            xml += &format!("<{element} message=\"{}\"></{element}>", escaped(&message));
        }
        xml += "</testcase>\n";
    }
    xml + "</testsuite>\n</testsuites>\n"
}

#[cfg(test)]
mod tests;
