//! The contract of a study: records, a table whose columns are declared once, a picture declared as data.
//!
//! A study is a module with a `STUDY` ([`Study`]): its `run` measures records, and returns [`Findings`]. The tables are
//! [`ReportTable`]s over the records, the pictures [`ReportFigure`]s of [`Curve`]s and [`Points`] over the same
//! records, and the exported rows are written by [`columns_csv`](crate::present::table::columns_csv) from columns, or
//! by [`rows_csv`](crate::present::table::rows_csv) from what the records serialize to.

use crate::files::cluster;
use crate::files::output::Output;
use crate::judge::case::Effort;
use crate::present::plot::{Curve, Figure, Points};
use crate::present::table::ReportTable;
use serde::{Deserialize, Serialize};

/// A study, declared once.
pub struct Study {
    /// Name, in words joined by `-`; the anchor is `study-NAME`.
    pub name: &'static str,
    /// Title of the study.
    pub title: &'static str,
    /// The question that it answers.
    pub question: &'static str,
    /// The cases that judge the study.
    pub cases: &'static [&'static str],
    /// The command that repeats the study.
    pub command: &'static str,
    /// Names of its parts for `shearbed bench --case`, in the order of a run. A study without parts appears only in the
    /// report.
    pub parts: &'static [&'static str],
    /// True if ranks share its work; otherwise only the root runs it.
    pub shared: bool,
    /// Runs the study. A shared study returns `None` on all ranks but the root.
    pub run: fn(&Request) -> Result<Option<Findings>, String>,
}

impl Study {
    /// Runs the study on the ranks that share it. `None` if no part is requested, and on all ranks but the root.
    pub fn found(&self, request: &Request) -> Result<Option<Findings>, String> {
        let wanted = self.parts.is_empty() || self.parts.iter().any(|part| (request.wanted)(part));
        if wanted && (self.shared || cluster::is_root()) { (self.run)(request) } else { Ok(None) }
    }
}

/// The request to run a study.
pub struct Request<'a> {
    /// The effort and the seed.
    pub effort: &'a Effort,
    /// True for the requested parts.
    pub wanted: &'a dyn Fn(&str) -> bool,
    /// Called after each piece of work, in studies with many.
    pub finished: &'a dyn Fn(),
}

/// The findings of a study.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Findings {
    /// The answer to its question, in a sentence.
    pub answer: String,
    /// Pictures beside their tables.
    pub exhibits: Vec<Exhibit>,
    /// Its records: names and contents of files.
    pub files: Vec<Output>,
    /// The scenes that were run.
    pub plans: Vec<ScenePlan>,
}

impl Findings {
    /// The usual result of a study.
    pub fn new(
        answer: impl Into<String>,
        exhibits: Vec<Exhibit>,
        files: impl IntoIterator<Item = (&'static str, String)>,
    ) -> Self {
        let files = files.into_iter().map(|(name, text)| (name.to_owned(), text));
        Self { answer: answer.into(), exhibits, files: files.collect(), plans: Vec::new() }
    }
}

/// A picture beside its table, or one of them alone.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Exhibit {
    /// The picture.
    pub figure: Option<ReportFigure>,
    /// The table.
    pub table: Option<ReportTable>,
}

impl Exhibit {
    /// A picture beside its table.
    pub fn both(figure: ReportFigure, table: ReportTable) -> Self {
        Self { figure: Some(figure), table: Some(table) }
    }
}

impl From<ReportFigure> for Exhibit {
    fn from(figure: ReportFigure) -> Self {
        Self { figure: Some(figure), table: None }
    }
}

impl From<ReportTable> for Exhibit {
    fn from(table: ReportTable) -> Self {
        Self { figure: None, table: Some(table) }
    }
}

/// A picture with its caption.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ReportFigure {
    /// Name, in words joined by `-`; the anchor is `figure-NAME`.
    pub name: String,
    /// The picture.
    pub figure: Figure,
    /// A caption that says what to see.
    pub caption: String,
    /// Equations and figures of the paper.
    pub source: String,
    /// The cases that judge the picture, which link to it.
    pub cases: Vec<String>,
}

impl ReportFigure {
    /// A picture from its name and title, its caption, and the names of its axes with units. A name that starts with
    /// `log ` makes the axis logarithmic; this word is not shown.
    pub fn new([name, title]: [&str; 2], caption: impl Into<String>, [x, y]: [&str; 2]) -> Self {
        let axis = |name: &str| match name.strip_prefix("log ") {
            Some(name) => (name.to_owned(), true),
            None => (name.to_owned(), false),
        };
        let ((x_name, x_log), (y_name, y_log)) = (axis(x), axis(y));
        let figure = Figure { title: title.into(), x_name, y_name, x_log, y_log, ..Default::default() };
        Self { name: name.into(), figure, caption: caption.into(), ..Default::default() }
    }

    /// Adds curves.
    pub fn curves(mut self, curves: impl IntoIterator<Item = Curve>) -> Self {
        self.figure.curves.extend(curves);
        self
    }

    /// Adds points.
    pub fn points(mut self, points: impl IntoIterator<Item = Points>) -> Self {
        self.figure.points.extend(points);
        self
    }

    /// Sets the ranges, from low to high, that the axes cover at least.
    pub fn spans(mut self, x: Option<(f64, f64)>, y: Option<(f64, f64)>) -> Self {
        (self.figure.x_span, self.figure.y_span) = (x, y);
        self
    }

    /// Sets the source, and the cases that judge the picture.
    pub fn judged(self, source: &str, cases: &[&str]) -> Self {
        let cases = cases.iter().map(|case| (*case).to_owned()).collect();
        Self { source: source.into(), cases, ..self }
    }
}

/// How a scene behind a figure was run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ScenePlan {
    /// Name of the built-in scene.
    pub scene: String,
    /// Title of the scene.
    pub title: String,
    /// Seed of its random numbers.
    pub seed: u64,
    /// The command that repeats the run.
    pub command: String,
    /// The stages that ran and those that were dropped, as `shearbed plan` prints them.
    pub text: String,
}
