//! The report: the outcomes of all cases as plain data, and its writers.

mod curves;
mod first;
mod formats;
mod html;
mod json;
mod junit;
mod markdown;
mod origin;
mod prose;
mod row;
mod sections;
#[cfg(test)]
mod tests;

pub use curves::csv as figure_csv;
pub(crate) use formats::digits;
pub(crate) use html::rendered;
pub use json::{FORMAT, check, passed};
pub(crate) use prose::typeset;

use crate::files::output::Output;
use crate::input::experiment::stated;
use crate::judge::accept::{FALSE_ALARM_BUDGET, Verdict};
use crate::judge::case::{Effort, Judges, Outcome};
use crate::present::study::{ReportFigure, ScenePlan};
use crate::present::table::ReportTable;
pub use origin::Origin;
pub use row::{CaseRow, Line};
pub use sections::{ReportEquation, ReportStudy, Sections};
use serde::Serialize;

/// Numbers of cases by verdict.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Summary {
    /// Cases whose rules hold, with enough data, and whose controls were all caught.
    pub pass: usize,
    /// Cases in which a rule does not hold, or a control was not caught.
    pub fail: usize,
    /// Cases with too few data to decide.
    pub underpowered: usize,
    /// Cases whose measured points are not available.
    pub nodata: usize,
    /// The same numbers for each kind of case.
    pub parts: Vec<Part>,
    /// The largest probability that correct code fails one of these cases for any reason.
    pub false_alarm: f64,
    /// The seed of all cases.
    pub seed: u64,
    /// True for more replicas and samples than in the quick gate.
    pub full: bool,
    /// Wall time over all cases in s.
    pub seconds: f64,
}

/// Numbers of the cases of one kind.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Part {
    /// The kind of implementation that they judge.
    pub judges: Judges,
    /// Number of cases that pass.
    pub pass: usize,
    /// Number of cases whose data are not available.
    pub nodata: usize,
    /// Number of all cases.
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

/// All results of a run of the suite.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// Numbers of cases by verdict.
    pub summary: Summary,
    /// The cases, in the order of the registry.
    pub cases: Vec<CaseRow>,
    /// Studies, equations and scenes shown beside the cases.
    pub sections: Sections,
    /// Where, when and from which sources the report was made.
    pub origin: Origin,
}

/// Makes a report from the outcomes of cases that the command line `command` ran with `effort`.
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
        // They were read before: here nothing is missing.
        origin: Origin::here(command, &sections.plans, stated(effort.data.as_deref()).unwrap_or_default()),
        sections,
    }
}

impl Report {
    /// The report as one HTML file that needs no network and no script.
    pub fn html(&self) -> Result<String, String> {
        html::write(self)
    }

    /// The report as Markdown, where HTML is not possible.
    pub fn markdown(&self) -> String {
        markdown::write(self)
    }

    /// The data behind figures and tables: names of files, and CSV.
    pub fn data(&self) -> Result<Vec<Output>, String> {
        let figures = self.sections.figures();
        let curves = figures.map(|figure| Ok((format!("curves/{}.csv", figure.name), curves::csv(&figure.figure)?)));
        let tables = self.sections.tables();
        let tables = tables.map(|table| Ok((format!("tables/{}.csv", table.name), table.csv()?)));
        curves.chain(tables).collect()
    }

    /// The report as JSON; values that are not finite are null. `schemas/report.schema.json` describes it.
    pub fn json(&self) -> String {
        json::write(self)
    }

    /// The report as JUnit XML, a test case for each case.
    pub fn junit(&self) -> String {
        junit::write(self)
    }

    /// 1 if a case failed or was underpowered, or if the false-alarm probability is above the budget; else 0.
    pub fn exit_code(&self) -> u8 {
        let red = self.summary.fail + self.summary.underpowered > 0;
        u8::from(red || self.summary.false_alarm > FALSE_ALARM_BUDGET)
    }

    /// What passes, by kind, what does not, and the false-alarm probability.
    pub fn headline(&self) -> String {
        let parts: Vec<_> = self.summary.parts.iter().map(Part::to_string).collect();
        let Summary { fail, underpowered, .. } = self.summary;
        format!("Passed: {}. {fail} fail, {underpowered} under-powered. {}", parts.join("; "), self.alarms())
    }

    /// The false-alarm probability, in words.
    pub fn alarms(&self) -> String {
        let summary = &self.summary;
        let over = if summary.false_alarm > FALSE_ALARM_BUDGET {
            format!(", over the budget of {}", formats::number(FALSE_ALARM_BUDGET))
        } else {
            String::new()
        };
        format!(
            "By chance alone statistical checks turn correct code red with a probability of at most {}{over}.",
            formats::number(summary.false_alarm)
        )
    }
}
