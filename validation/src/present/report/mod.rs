//! The report: what every case said, as plain data, and its writers.

mod curves;
mod first;
mod formats;
mod html;
mod json;
mod junit;
mod markdown;
mod origin;
mod page;
mod prose;
mod row;
mod sections;
#[cfg(test)]
mod tests;

pub(crate) use formats::digits;
pub(crate) use json::FORMAT;
pub(crate) use prose::typeset;

use crate::files::output::Output;
use crate::judge::accept::{FALSE_ALARM_BUDGET, Verdict};
use crate::judge::case::{Effort, Judges, Outcome};
use crate::present::study::{ReportFigure, ScenePlan};
use crate::present::table::ReportTable;
pub use origin::Origin;
pub use row::{CaseRow, Line};
pub use sections::{ReportEquation, ReportStudy, Sections};
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
    /// How many cases of each kind pass, and of how many.
    pub parts: Vec<Part>,
    /// The probability, at most, that correct code turns one of these cases red for any reason.
    pub false_alarm: f64,
    /// The seed of all cases.
    pub seed: u64,
    /// More replicas and samples than in the quick gate.
    pub full: bool,
    /// Wall time over all cases.
    pub seconds: f64,
}

/// The cases that judge one thing.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Part {
    /// What they judge.
    pub judges: Judges,
    /// How many pass.
    pub pass: usize,
    /// How many need data that are not at hand.
    pub nodata: usize,
    /// How many there are.
    pub cases: usize,
}

impl Part {
    fn of(judges: Judges, outcomes: &[Outcome]) -> Option<Self> {
        let cases: Vec<_> = outcomes.iter().filter(|o| o.about.judges == judges).collect();
        let count = |verdict| cases.iter().filter(|o| o.verdict == verdict).count();
        (!cases.is_empty()).then(|| Self {
            judges,
            pass: count(Verdict::Pass),
            nodata: count(Verdict::NoData),
            cases: cases.len(),
        })
    }
}

impl std::fmt::Display for Part {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} {} of {}", self.judges.name(), self.pass, self.cases)?;
        match self.nodata {
            0 => Ok(()),
            _ => write!(f, " (no data for {})", self.nodata),
        }
    }
}

/// Everything a run of the suite found.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// How many cases ended how.
    pub summary: Summary,
    /// The cases, in the order of the registry.
    pub cases: Vec<CaseRow>,
    /// What is shown beside them.
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
            parts: Judges::ALL.iter().filter_map(|judges| Part::of(*judges, &outcomes)).collect(),
            false_alarm: outcomes.iter().map(Outcome::false_alarm).sum(),
            seed: effort.seed,
            full: effort.full,
            seconds: outcomes.iter().map(|o| o.seconds).sum(),
        },
        cases: (outcomes.into_iter()).map(|outcome| CaseRow::new(outcome, effort)).collect(),
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

    /// The data behind figures and tables: names of files, and CSV.
    pub fn data(&self) -> Result<Vec<Output>, String> {
        let figures = self.sections.figures();
        let curves = figures.map(|figure| Ok((format!("curves/{}.csv", figure.name), curves::csv(figure)?)));
        let tables = self.sections.tables();
        let tables = tables.map(|table| Ok((format!("tables/{}.csv", table.name), table.csv()?)));
        curves.chain(tables).collect()
    }

    /// Everything as data; numbers that are not finite are null. `schemas/report.schema.json` describes it.
    pub fn json(&self) -> String {
        json::write(self)
    }

    /// A test case for each case, for programs that show tests.
    pub fn junit(&self) -> String {
        junit::write(self)
    }

    /// 1 when a case failed or had too little data to say, or where chance alone could do so too often, else 0.
    pub fn exit_code(&self) -> u8 {
        let red = self.summary.fail + self.summary.underpowered > 0;
        u8::from(red || self.summary.false_alarm > FALSE_ALARM_BUDGET)
    }

    /// The lines that a report opens with: what passes, by what it judges, and how often chance alone turns it red.
    pub fn headline(&self) -> String {
        let summary = &self.summary;
        let parts: Vec<_> = summary.parts.iter().map(Part::to_string).collect();
        let over = match summary.false_alarm > FALSE_ALARM_BUDGET {
            true => format!(", over the budget of {}", formats::number(FALSE_ALARM_BUDGET)),
            false => String::new(),
        };
        format!(
            "Passed: {}. {} fail, {} under-powered. By chance alone statistical checks turn correct code red with a probability of \
             at most {}{over}.",
            parts.join("; "),
            summary.fail,
            summary.underpowered,
            formats::number(summary.false_alarm),
        )
    }
}
