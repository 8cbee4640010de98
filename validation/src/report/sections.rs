//! What a report shows beside its cases, as plain data.

use crate::plot::Figure;
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
    /// Its title.
    pub title: String,
    /// The seed of its random numbers.
    pub seed: u64,
    /// The command that repeats it.
    pub command: String,
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
