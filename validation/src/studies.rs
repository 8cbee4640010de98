//! What a study is, and the registry of all: the report, `shearbed bench` and their files are made from it.
//!
//! A study goes from parameters to plain records to tables, whose columns are declared once, and pictures.

use crate::case::Effort;
use crate::output::Output;
use crate::report::{ReportFigure, ScenePlan};
use crate::table::ReportTable;
use crate::{cluster, coefficients, figures, kicks, readings, speed, stability, suspensions, work_precision};

/// A study, declared once.
pub struct Study {
    /// Its name, in words joined by `-`; its anchor is `study-NAME`.
    pub name: &'static str,
    /// What it is about.
    pub title: &'static str,
    /// What it asks.
    pub question: &'static str,
    /// The cases that judge it.
    pub cases: &'static [&'static str],
    /// The command that repeats it.
    pub command: &'static str,
    /// Its parts that `shearbed bench --case` takes by name, in the order in which they run.
    pub benches: fn() -> Vec<String>,
    /// Whether ranks share its work; what is not shared runs on the root.
    pub shared: bool,
    /// Measures it; nothing but on the root.
    pub run: fn(&Extent) -> Result<Option<Found>, String>,
}

/// How much of a study is wanted.
pub struct Extent<'a> {
    /// How hard to work, and with which seed.
    pub effort: &'a Effort,
    /// The parts that are wanted, of those that have names.
    pub wanted: &'a dyn Fn(&str) -> bool,
    /// Called for each piece of work that is done, where there are many.
    pub finished: &'a dyn Fn(),
}

/// What a study found.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Found {
    /// The answer to its question, in a sentence.
    pub answer: String,
    /// Pictures beside their tables.
    pub exhibits: Vec<Exhibit>,
    /// Its records: names of files, and what is in them.
    pub files: Vec<Output>,
    /// The scenes behind it.
    pub plans: Vec<ScenePlan>,
}

/// A picture beside its table, or one of them alone.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Exhibit {
    /// The picture.
    pub figure: Option<ReportFigure>,
    /// The table.
    pub table: Option<ReportTable>,
}

impl Exhibit {
    /// A picture beside its table.
    pub fn both(figure: ReportFigure, table: ReportTable) -> Self {
        Self {
            figure: Some(figure),
            table: Some(table),
        }
    }
}

impl From<ReportFigure> for Exhibit {
    fn from(figure: ReportFigure) -> Self {
        Self {
            figure: Some(figure),
            table: None,
        }
    }
}

impl From<ReportTable> for Exhibit {
    fn from(table: ReportTable) -> Self {
        Self {
            figure: None,
            table: Some(table),
        }
    }
}

/// No parts that `shearbed bench` takes.
pub(crate) fn none() -> Vec<String> {
    Vec::new()
}

/// Every study, in the order of the report.
pub const ALL: [Study; 9] = [
    figures::STUDY,
    readings::STUDY,
    kicks::chapter::STUDY,
    work_precision::chapter::STUDY,
    stability::chapter::STUDY,
    suspensions::chapter::FREE,
    suspensions::chapter::INTERACTING,
    coefficients::chapter::STUDY,
    speed::STUDY,
];

impl Study {
    /// Runs it on the ranks that share it: what it found on the root, nothing elsewhere.
    pub fn found(&self, extent: &Extent) -> Result<Option<Found>, String> {
        match self.shared || cluster::is_root() {
            true => (self.run)(extent),
            false => Ok(None),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cases;
    use std::collections::BTreeSet;

    #[test]
    fn studies_name_cases_that_there_are_and_themselves_once() {
        let known: BTreeSet<_> = cases::all().iter().map(|case| case.about.name).collect();
        let mut names = BTreeSet::new();
        for study in ALL {
            assert!(names.insert(study.name), "{} twice", study.name);
            assert!(
                study.question.ends_with('?') && !study.cases.is_empty(),
                "{}",
                study.name
            );
            for case in study.cases {
                assert!(known.contains(case), "{}: {case}", study.name);
            }
        }
    }
}
