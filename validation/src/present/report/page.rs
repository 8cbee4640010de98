//! Data for the template of the HTML report, made by [`super::html`].

use super::first::{Card, Closest, Thumbnail};
use super::{Origin, ScenePlan};
use crate::judge::accept::Verdict;
use crate::judge::case::Control;
use serde::Serialize;

/// All data for the template.
#[derive(Serialize)]
pub(super) struct Page<'a> {
    pub(super) style: &'static str,
    pub(super) script: &'static str,
    pub(super) headline: String,
    pub(super) good: bool,
    pub(super) cards: Vec<Card>,
    pub(super) thumbnails: Vec<Thumbnail<'a>>,
    /// The cases to look at first: failed ones, then those nearest to their bounds.
    pub(super) attention: Vec<Link<'a>>,
    pub(super) closest: Vec<Closest<'a>>,
    pub(super) studies: Vec<StudyView<'a>>,
    pub(super) groups: Vec<Group<'a>>,
    pub(super) equations: Vec<EquationView<'a>>,
    pub(super) plans: &'a [ScenePlan],
    pub(super) false_alarm: String,
    pub(super) full: bool,
    pub(super) time: String,
    pub(super) origin: &'a Origin,
}

/// The cases of one kind.
#[derive(Serialize)]
pub(super) struct Group<'a> {
    pub(super) tag: &'static str,
    pub(super) name: &'static str,
    pub(super) means: &'static str,
    pub(super) cases: Vec<CaseView<'a>>,
}

/// A study with its pictures and tables.
#[derive(Serialize)]
pub(super) struct StudyView<'a> {
    pub(super) name: &'a str,
    pub(super) title: &'a str,
    pub(super) question: &'a str,
    pub(super) answer: &'a str,
    pub(super) command: &'a str,
    pub(super) time: String,
    pub(super) cases: Vec<Link<'a>>,
    pub(super) exhibits: Vec<ExhibitView<'a>>,
}

/// A picture beside its table.
#[derive(Serialize)]
pub(super) struct ExhibitView<'a> {
    pub(super) figure: Option<FigureView<'a>>,
    pub(super) table: Option<TableView<'a>>,
    /// True if the table is narrow enough to be beside the picture.
    pub(super) beside: bool,
}

/// A case as text.
#[derive(Serialize)]
pub(super) struct CaseView<'a> {
    pub(super) name: &'a str,
    pub(super) claim: &'a str,
    pub(super) tags: String,
    pub(super) source: &'a str,
    pub(super) class: Verdict,
    pub(super) symbol: &'static str,
    pub(super) word: &'static str,
    pub(super) used: String,
    /// Length of the bar of the used tolerance, in percent.
    pub(super) bar: Option<f64>,
    pub(super) because: &'a str,
    pub(super) evidence: Vec<LineView<'a>>,
    pub(super) caught: usize,
    pub(super) controls: &'a [Control],
    pub(super) time: String,
    pub(super) command: &'a str,
    pub(super) figures: Vec<Link<'a>>,
}

/// A line of evidence as text.
#[derive(Serialize)]
pub(super) struct LineView<'a> {
    pub(super) what: &'a str,
    pub(super) class: Verdict,
    pub(super) symbol: &'static str,
    pub(super) word: &'static str,
    pub(super) error: String,
    pub(super) tolerance: String,
    pub(super) because: &'a str,
    pub(super) detail: String,
}

/// A picture as SVG.
#[derive(Serialize)]
pub(super) struct FigureView<'a> {
    pub(super) name: &'a str,
    pub(super) title: &'a str,
    pub(super) svg: String,
    pub(super) caption: &'a str,
    pub(super) source: &'a str,
    pub(super) cases: Vec<Link<'a>>,
}

/// A table; marks the columns of numbers.
#[derive(Serialize)]
pub(super) struct TableView<'a> {
    pub(super) name: &'a str,
    pub(super) title: &'a str,
    pub(super) caption: &'a str,
    pub(super) columns: &'a [String],
    pub(super) rows: &'a [Vec<String>],
    pub(super) numeric: Vec<bool>,
}

/// An equation with the cases that test it, and the mistakes that they caught.
#[derive(Serialize)]
pub(super) struct EquationView<'a> {
    pub(super) number: &'a str,
    pub(super) says: &'a str,
    pub(super) code: &'a [String],
    pub(super) cases: Vec<Link<'a>>,
    pub(super) caught: Vec<&'a str>,
}

/// A link inside the report, to a case with its verdict or to a figure.
#[derive(Serialize)]
pub(super) struct Link<'a> {
    pub(super) anchor: String,
    pub(super) text: &'a str,
    pub(super) class: Option<Verdict>,
    pub(super) symbol: &'static str,
}
