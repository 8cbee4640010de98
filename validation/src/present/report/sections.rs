//! The sections of a report beside its cases, as plain data.

use crate::present::study::{Exhibit, Findings, ReportFigure, ScenePlan, Study};
use crate::present::table::ReportTable;
use serde::{Serialize, Serializer};
use serde_json::json;

/// An equation of the paper, the code that implements it and the cases that test it.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct ReportEquation {
    /// Number in the paper, such as `15` or `A.7`; the anchor is `equation-NUMBER`.
    pub number: String,
    /// Content of the equation, in a few words.
    pub says: String,
    /// Items of the code.
    pub code: Vec<String>,
    /// Names of the cases.
    pub cases: Vec<String>,
}

/// A study with its findings. Its record has its pictures and tables by name: they are listed beside the studies.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct ReportStudy {
    /// Name, in words joined by `-`; the anchor is `study-NAME`.
    pub name: String,
    /// Title of the study.
    pub title: String,
    /// The question that it answers.
    pub question: String,
    /// The answer, in a sentence.
    pub answer: String,
    /// The command that repeats the study.
    pub command: String,
    /// The cases that judge the study.
    pub cases: Vec<String>,
    /// Wall time in s.
    pub seconds: f64,
    /// Pictures beside their tables.
    #[serde(serialize_with = "names")]
    pub exhibits: Vec<Exhibit>,
    /// The scenes that were run.
    #[serde(skip)]
    pub(crate) plans: Vec<ScenePlan>,
}

fn names<S: Serializer>(exhibits: &[Exhibit], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(exhibits.iter().map(|exhibit| {
        json!({
            "figure": exhibit.figure.as_ref().map(|figure| &figure.name),
            "table": exhibit.table.as_ref().map(|table| &table.name),
        })
    }))
}

impl ReportStudy {
    /// A study with its findings and its wall time.
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

/// The sections of a report beside its cases.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sections {
    /// The studies.
    pub studies: Vec<ReportStudy>,
    /// All equations of the paper.
    pub equations: Vec<ReportEquation>,
    /// All scenes behind studies.
    pub plans: Vec<ScenePlan>,
}

impl Sections {
    /// Adds a study, and moves its scenes to the list of all.
    pub fn add(&mut self, mut study: ReportStudy) {
        self.plans.append(&mut study.plans);
        self.studies.push(study);
    }

    /// All pictures.
    pub fn figures(&self) -> impl Iterator<Item = &ReportFigure> {
        self.exhibits().filter_map(|exhibit| exhibit.figure.as_ref())
    }

    /// All pictures, for changes.
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
