//! What a study is: from parameters to plain records to tables, whose columns are declared once, and pictures.

use crate::files::cluster;
use crate::files::output::Output;
use crate::judge::case::Effort;
use crate::present::plot::Figure;
use crate::present::table::ReportTable;
use serde::{Deserialize, Serialize};

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

impl Study {
    /// Of a study without parts that `shearbed bench` takes.
    pub(crate) fn no_parts() -> Vec<String> {
        Vec::new()
    }

    /// Runs it on the ranks that share it: what it found on the root, nothing elsewhere.
    pub fn found(&self, extent: &Extent) -> Result<Option<Found>, String> {
        match self.shared || cluster::is_root() {
            true => (self.run)(extent),
            false => Ok(None),
        }
    }
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
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
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

/// A picture with what to see in it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
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

/// How a scene behind a figure was run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
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
