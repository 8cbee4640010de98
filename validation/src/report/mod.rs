//! The report: what every case said, as plain data, and its writers.

mod html;
mod markdown;
mod origin;
mod row;
#[cfg(test)]
mod tests;
mod words;

use crate::accept::FAMILY_FALSE_ALARM_RATE;
use crate::case::{Effort, Outcome, Verdict};
use crate::plot::Figure;
pub use origin::Origin;
pub use row::{Line, Row};
use serde::Serialize;

/// A picture with what to see in it.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct ReportFigure {
    /// Its name, in words joined by `-`; its anchor is `figure-NAME`.
    pub name: String,
    /// The picture.
    pub figure: Figure,
    /// What to see.
    pub caption: String,
    /// Equations and figures of the paper.
    pub source: String,
    /// The cases that judge what is shown, which link here.
    pub cases: Vec<String>,
}

/// A table: a study that is no case, in plain text. A text in backticks is code, and a link where it is a case's name.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct ReportTable {
    /// Its name, in words joined by `-`; its anchor is `table-NAME`.
    pub name: String,
    /// What it holds, in a few words.
    pub title: String,
    /// What to see.
    pub caption: String,
    /// The heads of the columns, with units.
    pub columns: Vec<String>,
    /// The cells, row by row.
    pub rows: Vec<Vec<String>>,
}

/// An equation of the paper, the code that is made from it and the cases that test it.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct ReportEquation {
    /// Its number in the paper, as `15` or `A.7`; its anchor is `equation-NUMBER`.
    pub number: String,
    /// What it says, in a few words.
    pub says: String,
    /// The items of the code.
    pub code: Vec<String>,
    /// The names of the cases.
    pub cases: Vec<String>,
}

/// How a scene behind a figure was run.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct ScenePlan {
    /// The built-in scene's name.
    pub scene: String,
    /// The seed of its random numbers.
    pub seed: u64,
    /// What ran and what was left out, as `shearbed plan` prints it.
    pub text: String,
}

/// What a report shows beside its cases.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Sections {
    /// The pictures.
    pub figures: Vec<ReportFigure>,
    /// The studies.
    pub tables: Vec<ReportTable>,
    /// Every equation of the paper.
    pub equations: Vec<ReportEquation>,
    /// Every scene behind a figure.
    pub plans: Vec<ScenePlan>,
}

/// How many cases ended how.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Summary {
    /// Rules hold, with enough data, and every control was caught.
    pub pass: usize,
    /// A rule does not hold, or a control was not caught.
    pub fail: usize,
    /// Too little data to say.
    pub underpowered: usize,
    /// Measured points are not at hand.
    pub nodata: usize,
    /// The probability that correct code fails by chance in a run of the whole registry, at most.
    pub family_false_alarm_rate: f64,
    /// The share of it that each statistical check has.
    pub level: f64,
    /// More replicas and samples than in the quick gate.
    pub full: bool,
    /// Wall time over all cases.
    pub seconds: f64,
}

/// Everything a run of the suite found.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    /// How many cases ended how.
    pub summary: Summary,
    /// The cases, in the order of the registry.
    pub cases: Vec<Row>,
    /// What is shown beside them.
    #[serde(flatten)]
    pub sections: Sections,
    /// Where, when and from what.
    pub origin: Origin,
}

/// Gathers a report from what cases, run with `effort` by the command line `command`, said.
pub fn build(outcomes: Vec<Outcome>, sections: Sections, effort: &Effort, command: String) -> Report {
    let count = |verdict| outcomes.iter().filter(|o| o.verdict == verdict).count();
    Report {
        summary: Summary {
            pass: count(Verdict::Pass),
            fail: count(Verdict::Fail),
            underpowered: count(Verdict::Underpowered),
            nodata: count(Verdict::NoData),
            family_false_alarm_rate: FAMILY_FALSE_ALARM_RATE,
            level: effort.level,
            full: effort.full,
            seconds: outcomes.iter().map(|o| o.seconds).sum(),
        },
        cases: (outcomes.into_iter())
            .map(|outcome| Row::new(outcome, effort))
            .collect(),
        origin: Origin::here(command, &sections.plans),
        sections,
    }
}

impl Report {
    /// One file that needs no network and no script.
    pub fn html(&self) -> Result<String, String> {
        html::write(self)
    }

    /// The table, for where HTML cannot go.
    pub fn markdown(&self) -> String {
        markdown::write(self)
    }

    /// Everything as data; numbers that are not finite are null.
    pub fn json(&self) -> String {
        serde_json::to_string_pretty(self).unwrap_or_else(|error| format!("{{\"error\": \"{error}\"}}"))
    }

    /// 1 when a case failed or had too little data to say, else 0.
    pub fn exit_code(&self) -> u8 {
        u8::from(self.summary.fail + self.summary.underpowered > 0)
    }

    /// The one line that a report opens with.
    pub fn headline(&self) -> String {
        let summary = &self.summary;
        format!(
            "{} pass, {} fail, {} under-powered, {} without data; family-wise false-alarm rate at most {} \
             (the chance that correct code fails).",
            summary.pass,
            summary.fail,
            summary.underpowered,
            summary.nodata,
            words::number(summary.family_false_alarm_rate),
        )
    }
}
