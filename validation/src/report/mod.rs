//! The report: what every case said, as plain data, and its writers.

mod curves;
mod html;
mod markdown;
mod origin;
mod prose;
mod row;
mod sections;
#[cfg(test)]
mod tests;
mod words;

pub(crate) use markdown::{equation_table, markdown_table};

use crate::accept::{FAMILY_FALSE_ALARM_RATE, Verdict};
use crate::case::{Effort, Outcome};
use crate::output::Output;
pub use origin::Origin;
pub use row::{Line, Row};
pub use sections::{ReportEquation, ReportFigure, ReportTable, ScenePlan, Sections};
use serde::Serialize;

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

    /// The tables behind the figures: names of files, and CSV.
    pub fn curves(&self) -> Result<Vec<Output>, String> {
        let figures = self.sections.figures.iter();
        figures
            .map(|figure| Ok((format!("{}.csv", figure.name), curves::csv(figure)?)))
            .collect()
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
