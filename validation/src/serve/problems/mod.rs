//! Reference problems for any program: what is asked, from which start, and the certified answer, as folders of files.
//!
//! `all` is the registry. `export` writes a folder a problem: `problem.json` ([`Problem`]), `start.csv` where rods are
//! given, `inputs.csv` where pairs in contact are given, `certified.csv`, `README.md`. `read` reads such folders back. A folder
//! with the name of a built-in problem is refused where it differs from it; one of another name is [`Origin::Foreign`].

mod archive;
mod asked;
mod check;
pub mod closed;
pub(crate) mod contact;
mod ensemble;
mod export;
mod flows;
pub mod folgar_tucker;
mod origin;
mod page;
mod read;
mod rods;
mod table;
mod tensor;
mod tolerance;

pub use archive::archive;
pub use check::tolerances;
pub use contact::certify as certify_contacts;
pub use export::{SCHEMA, export, files};
pub use read::read;
pub use table::{ReadError, Table};

use crate::methods::tensors::{Closure, Model};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;
use std::sync::{LazyLock, OnceLock};

/// The version of the files' format that is written and read.
pub const FORMAT: u32 = 1;

/// What a problem asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// The directions of given rods at given times. Keys of a row: `time_s`, `rod`.
    Rods,
    /// Means over infinitely many rods, free or with rotary diffusion, that are isotropic at t = 0. Key of a row: `time_s`.
    Tensor,
    /// What the contact rule makes of given pairs of rods. Key of a row: `snapshot`.
    Contact,
    /// Means over replicas of a suspension with collisions, with standard errors. Key of a row: `time_s`.
    Ensemble,
}

impl Kind {
    /// The columns that tell rows apart; they come first.
    pub fn keys(self) -> &'static [&'static str] {
        match self {
            Self::Rods => &["time_s", "rod"],
            Self::Tensor | Self::Ensemble => &["time_s"],
            Self::Contact => &["snapshot"],
        }
    }
}

/// How an answer's error is measured. The largest over all rows counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Metric {
    /// The angle between the answer's axis and the certified one, rad; p and −p are the same.
    Angle,
    /// The largest |answer − certified| of a row.
    Absolute,
    /// Of a row, for each rod (columns `a_…` and `b_…`): the length of answer − certified over the length of certified.
    Relative,
    /// |answer − certified| / (se² + certified se²)^½, the largest of a row; column `x` has its error in `x_se`.
    StandardErrors,
}

/// Whose problem it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Origin {
    /// A problem of this program, unchanged.
    BuiltIn,
    /// Somebody else's: what it certifies has not been checked.
    Foreign,
}

/// One problem, as in `problem.json`. Numbers are exact: an answer belongs to these doubles.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Problem {
    /// The version of the format, [`FORMAT`].
    pub format: u32,
    /// The folder's name.
    pub name: String,
    /// One line.
    pub title: String,
    /// What is asked and why it is hard, in words.
    pub summary: String,
    /// What is asked for.
    pub kind: Kind,
    /// L, row i and column j: ∂u_i/∂x_j, 1/s.
    pub gradient_per_s: [[f64; 3]; 3],
    /// r_e (1); the mean where rods are unequal.
    pub aspect_ratio: f64,
    /// Standard deviation of r_e, percent of the mean.
    #[serde(default)]
    pub aspect_ratio_sd_percent: f64,
    /// C_I of rods with the rotary diffusivity C_I (2D:D)^½; none of free rods.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub c_i: Option<f64>,
    /// The closed equation whose answer is asked for; none where it is the distribution's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub closed: Option<Closed>,
    /// When answers are wanted, s, ascending; empty where no time passes.
    pub times_s: Vec<f64>,
    /// Δt of A.14, s, where the answer has angles after a step.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub time_step_s: Option<f64>,
    /// The columns of the answer, keys first.
    pub columns: Vec<String>,
    /// How the error is measured.
    pub metric: Metric,
    /// The largest error that passes, in the metric's unit.
    pub tolerance: f64,
    /// Why that much.
    pub because: String,
    /// Where the certified values come from, in words, with equation numbers of Lee & Springer (1982) or another source.
    pub equations: Vec<String>,
    /// Which axis is which.
    pub axes: String,
    /// What an ensemble is made of.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ensemble: Option<Ensemble>,
}

/// A closed equation of a_ij, and where it starts.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Closed {
    /// What stands for a_ijkl.
    pub closure: Closure,
    /// The model with its parameters.
    pub model: Model,
    /// a_ij at t = 0.
    pub start: [[f64; 3]; 3],
}

/// An ensemble of suspensions after Lee & Springer (1982).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Ensemble {
    /// N, rods in the control volume.
    pub count: u64,
    /// a, the full length of a rod, mm.
    pub length_mm: f64,
    /// n, rods per cm³.
    pub concentration_per_cm3: f64,
    /// α of eq. 7.
    pub alpha: f64,
    /// m of eq. 7.
    pub m: f64,
    /// Steps a period of the mean aspect ratio; P_c has no Δt, so this is part of the model.
    pub steps_per_period: u64,
    /// How many replicas the certified means are from.
    pub certified_replicas: u64,
    /// A larger standard error of an answer is too little data to judge.
    pub largest_standard_error: f64,
}

/// A problem as read from its folder.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadedProblem {
    /// Its folder.
    pub dir: PathBuf,
    /// Whose problem it is.
    pub origin: Origin,
    /// `problem.json`.
    pub problem: Problem,
    /// `start.csv`: p of each rod at t = 0, in order of `rod` from 0; empty where none are given.
    pub start: Vec<[f64; 3]>,
    /// `inputs.csv`: the pairs of a contact problem.
    pub inputs: Option<Table>,
    /// `certified.csv`: its columns are `problem.columns`.
    pub certified: Table,
    /// The tolerance of `problem.json`, where the one in `problem` is a user's.
    pub own_tolerance: f64,
}

impl LoadedProblem {
    /// The problem with a larger tolerance; a smaller one changes nothing.
    pub fn with_tolerance(mut self, tolerance: f64) -> Self {
        if tolerance > self.own_tolerance {
            self.problem.tolerance = tolerance;
            self.problem.because = format!(
                "--tolerance. The problem's own is {:e}: {}",
                self.own_tolerance, self.problem.because
            );
        }
        self
    }
}

/// The columns of `inputs.csv`: of rods a and b the centre (mm), the axis and r_e.
#[rustfmt::skip]
pub const INPUT_COLUMNS: [&str; 15] = [
    "snapshot",
    "a_x1_mm", "a_x2_mm", "a_x3_mm", "a_p1", "a_p2", "a_p3", "a_aspect_ratio",
    "b_x1_mm", "b_x2_mm", "b_x3_mm", "b_p1", "b_p2", "b_p3", "b_aspect_ratio",
];

/// A problem with its tables as they are written: certified numbers have more digits than a double.
#[derive(Clone, Debug, PartialEq)]
pub struct Built {
    /// What is asked.
    pub problem: Problem,
    /// p of each rod at t = 0, where rods are given.
    pub start: Vec<[f64; 3]>,
    /// The rows of `inputs.csv` below its header.
    pub inputs: Vec<Vec<f64>>,
    /// The rows of `certified.csv` below its header.
    pub certified: Vec<Vec<String>>,
}

/// A problem of the registry.
pub struct ProblemDef {
    /// Its name, and its folder's.
    pub name: &'static str,
    /// One line.
    pub title: &'static str,
    build: Build,
    built: OnceLock<Built>,
}

type Build = Box<dyn Fn(&ProblemDef) -> Built + Send + Sync>;

impl ProblemDef {
    fn new(
        name: &'static str,
        title: &'static str,
        build: impl Fn(&Self) -> Built + Send + Sync + 'static,
    ) -> Self {
        Self { name, title, build: Box::new(build), built: OnceLock::new() }
    }

    /// The problem with its certified answer, which is computed once.
    pub fn built(&self) -> &Built {
        if let Some(built) = self.built.get() {
            return built;
        }
        // Not under the lock: a thread that waits for parts of it may take up another task that needs it.
        let built = (self.build)(self);
        self.built.get_or_init(|| built)
    }
}

impl Built {
    /// The problem as it is read from a folder to which it was exported.
    ///
    /// # Panics
    ///
    /// Where a certified number is no number: the tests of the problems hold that none is.
    pub fn loaded(&self, dir: PathBuf) -> LoadedProblem {
        let number = |text: &String| text.parse::<f64>().expect("a certified number");
        let rows = self.certified.iter().map(|row| row.iter().map(number).collect());
        let numbered = |(at, row): (usize, &Vec<f64>)| [&[at as f64], &row[..]].concat();
        LoadedProblem {
            dir,
            origin: Origin::BuiltIn,
            own_tolerance: self.problem.tolerance,
            problem: self.problem.clone(),
            start: self.start.clone(),
            inputs: (!self.inputs.is_empty()).then(|| Table {
                columns: INPUT_COLUMNS.map(String::from).into(),
                rows: self.inputs.iter().enumerate().map(numbered).collect(),
            }),
            certified: Table { columns: self.problem.columns.clone(), rows: rows.collect() },
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
            closed::problems(),
            contact::problems(),
            ensemble::problems(),
        ];
        kinds.into_iter().flatten().collect()
    });
    &ALL
}

/// Every problem with its certified answer.
pub fn built() -> Vec<&'static Built> {
    all().par_iter().map(ProblemDef::built).collect()
}

/// The names of those about given free rods.
pub fn free_rods() -> Vec<&'static str> {
    rods::problems().iter().map(|def| def.name).collect()
}

/// The problem of this name with its certified answer, or none.
pub fn named(name: &str) -> Option<&'static Built> {
    all().iter().find(|def| def.name == name).map(ProblemDef::built)
}
