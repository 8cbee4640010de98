//! Reference problems for any program: the question, the start, and the answer, as folders of files.
//!
//! `all` is the registry. `export` writes one folder per problem: `problem.json` ([`Problem`]), `start.csv` for given
//! rods, `inputs.csv` for given pairs in contact and rows of a formula, `certified.csv`, `README.md`. `read` reads
//! such folders back. A folder with the name of a built-in problem is refused if it differs from that problem; a
//! folder of another name is [`Origin::Foreign`].

mod archive;
mod asked;
mod brownian;
mod check;
mod closed;
pub(crate) mod contact;
mod ensemble;
mod export;
mod flows;
mod folgar_tucker;
pub(crate) mod formula;
mod origin;
mod page;
mod problem;
mod read;
mod rods;
mod table;
mod tensor;
mod tolerance;

pub use archive::archive;
pub use check::tolerances;
pub use contact::certify as certify_contacts;
pub use export::{SCHEMA, export, files};
pub use formula::Formula;
pub use problem::{Closed, Ensemble, FORMAT, Kind, LoadedProblem, Metric, Origin, Problem};
pub use read::read;
pub use table::Table;

use problem::CORRECTED;
use rayon::prelude::*;
use std::path::PathBuf;
use std::sync::{LazyLock, OnceLock};

/// A problem with its tables as text: certified numbers have more digits than a double.
#[derive(Clone, Debug, PartialEq)]
pub struct Built {
    /// The question.
    pub problem: Problem,
    /// p of each rod at t = 0, if rods are given.
    pub start: Vec<[f64; 3]>,
    /// The rows of `inputs.csv` below its header.
    pub inputs: Vec<Vec<f64>>,
    /// The rows of `certified.csv` below its header.
    pub certified: Vec<Vec<String>>,
}

/// A problem of the registry.
pub struct ProblemDef {
    /// The name of the problem and of its folder.
    pub name: &'static str,
    /// The title, one line.
    pub title: &'static str,
    build: Build,
    built: OnceLock<Built>,
}

type Build = Box<dyn Fn(&ProblemDef) -> Built + Send + Sync>;

impl ProblemDef {
    fn new(name: &'static str, title: &'static str, build: impl Fn(&Self) -> Built + Send + Sync + 'static) -> Self {
        Self { name, title, build: Box::new(build), built: OnceLock::new() }
    }

    /// The problem with its certified answer, which is computed once.
    pub fn built(&self) -> &Built {
        if let Some(built) = self.built.get() {
            return built;
        }
        // Not under the lock: a thread that waits for parts of the work may start another task that needs the lock.
        let built = (self.build)(self);
        self.built.get_or_init(|| built)
    }
}

impl Built {
    /// A problem without a start or inputs.
    fn new(problem: Problem, certified: Vec<Vec<String>>) -> Self {
        Self { problem, start: Vec::new(), inputs: Vec::new(), certified }
    }

    /// The problem as it would be read from the folder `dir` after an export.
    ///
    /// # Panics
    ///
    /// If a certified number cannot be parsed: the tests of the problems exclude that.
    pub fn loaded(&self, dir: PathBuf) -> LoadedProblem {
        let number = |text: &String| text.parse::<f64>().expect("a certified number");
        let rows = self.certified.iter().map(|row| row.iter().map(number).collect());
        LoadedProblem {
            dir,
            origin: Origin::BuiltIn,
            own_tolerance: self.problem.tolerance,
            problem: self.problem.clone(),
            start: self.start.clone(),
            inputs: self.problem.input_columns().map(|columns| Table::numbered(&columns, &self.inputs)),
            certified: Table { columns: self.problem.columns.clone(), rows: rows.collect(), lines: Vec::new() },
        }
    }
}

/// Every problem.
pub fn all() -> &'static [ProblemDef] {
    static ALL: LazyLock<Vec<ProblemDef>> = LazyLock::new(|| {
        let kinds = [
            rods::problems(),
            tensor::problems(),
            folgar_tucker::problems(),
            brownian::problems(),
            closed::problems(),
            formula::problems(),
            contact::problems(),
            ensemble::problems(),
        ];
        kinds.into_iter().flatten().collect()
    });
    &ALL
}

/// Computes a table of certified answers, with twelve decimals; an error says why it cannot be certified.
pub type Certify = fn() -> Result<String, String>;

/// The tables that are computed in moments, by the names of their files in `data`.
pub const TABLES: [(&str, Certify); 4] = [
    ("brownian", || folgar_tucker::certified(&brownian::problems())),
    ("closed", closed::certify),
    ("folgar-tucker", || folgar_tucker::certified(&folgar_tucker::problems())),
    ("formulas", formula::certify),
];

/// Every problem with its certified answer.
pub fn built() -> Vec<&'static Built> {
    all().par_iter().map(ProblemDef::built).collect()
}

/// The names of the problems of given free rods in steady flow, which any code for rods is asked.
pub fn free_rods() -> Vec<&'static str> {
    let steady = |def: &&ProblemDef| def.built().problem.rotation_rad_per_s.is_none();
    rods::problems().iter().filter(steady).map(|def| def.name).collect()
}

/// The problem of this name with its certified answer, or none.
pub fn named(name: &str) -> Option<&'static Built> {
    all().iter().find(|def| def.name == name).map(ProblemDef::built)
}

/// The problem of this name as it would be read from a folder of its name.
#[cfg(test)]
pub(crate) fn loaded(name: &str) -> LoadedProblem {
    named(name).expect("a problem of this name").loaded(name.into())
}
