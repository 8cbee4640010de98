//! What a report shows beside its cases, as plain data.

use crate::present::study::{Exhibit, Findings, ReportFigure, ScenePlan, Study};
use crate::present::table::ReportTable;
use serde::Serialize;

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

/// A study with what it found.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReportStudy {
    /// Its name, in words joined by `-`; its anchor is `study-NAME`.
    pub name: String,
    /// What it is about.
    pub title: String,
    /// What it asks.
    pub question: String,
    /// The answer, in a sentence.
    pub answer: String,
    /// The command that repeats it.
    pub command: String,
    /// The cases that judge it.
    pub cases: Vec<String>,
    /// Pictures beside their tables.
    pub exhibits: Vec<Exhibit>,
    /// The scenes behind it.
    pub(crate) plans: Vec<ScenePlan>,
    /// Wall time.
    pub seconds: f64,
}

impl ReportStudy {
    /// What a study found, and how long it took.
    pub fn new(study: &Study, found: Findings, seconds: f64) -> Self {
        Self {
            name: study.name.into(),
            title: study.title.into(),
            question: study.question.into(),
            answer: found.answer,
            command: study.command.into(),
            cases: study.cases.iter().map(|case| (*case).into()).collect(),
            exhibits: found.exhibits,
            plans: found.plans,
            seconds,
        }
    }
}

/// What a report shows beside its cases.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sections {
    /// The studies.
    pub studies: Vec<ReportStudy>,
    /// Every equation of the paper.
    pub equations: Vec<ReportEquation>,
    /// Every scene behind a study.
    pub plans: Vec<ScenePlan>,
}

impl Sections {
    /// Adds a study, and its scenes to those of all.
    pub fn add(&mut self, mut study: ReportStudy) {
        self.plans.append(&mut study.plans);
        self.studies.push(study);
    }

    /// All pictures.
    pub fn figures(&self) -> impl Iterator<Item = &ReportFigure> {
        self.exhibits().filter_map(|exhibit| exhibit.figure.as_ref())
    }

    /// All pictures, to be completed.
    pub fn figures_mut(&mut self) -> impl Iterator<Item = &mut ReportFigure> {
        let exhibits = self.studies.iter_mut().flat_map(|study| &mut study.exhibits);
        exhibits.filter_map(|exhibit| exhibit.figure.as_mut())
    }

    /// All tables.
    pub fn tables(&self) -> impl Iterator<Item = &ReportTable> {
        self.exhibits().filter_map(|exhibit| exhibit.table.as_ref())
    }

    fn exhibits(&self) -> impl Iterator<Item = &Exhibit> {
        self.studies.iter().flat_map(|study| &study.exhibits)
    }
}
