//! A problem, as in `problem.json`, and a problem as read from its folder.

use super::asked::{AXES, COUETTE, matrix};
use super::{Formula, ProblemDef, Table, check, ensemble, formula};
use crate::methods::tensors::{Closure, Model};
use crate::oracle::diffusion::{self, NoAnswer};
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};
use shearbed::model::flow::VelocityGradient;
use std::path::PathBuf;

/// The version of the file format.
pub const FORMAT: u32 = 1;

/// The problems that were once wrong: the name, the version of the first right one, and what was wrong before.
pub(super) const CORRECTED: [(&str, u32, &str); 3] = [
    ("folgar-tucker-planar-extension", 2, "up to 2026-11-26 its certified a_ij were wrong by up to 1.8e-4"),
    ("contact-rule", 2, SHORT_ARMS),
    ("contact-angles", 2, SHORT_ARMS),
];
const SHORT_ARMS: &str = "up to 2026-11-27 no arm was longer than a rod, so that a code which clips arms there passed";

/// The version of a problem of this program: 1 if it has never been corrected.
fn version(name: &str) -> u32 {
    CORRECTED.iter().find(|(of, ..)| *of == name).map_or(1, |(_, version, _)| *version)
}

/// The version of a problem that does not state one.
fn first() -> u32 {
    1
}

fn is_first(version: &u32) -> bool {
    *version == first()
}

/// What a problem asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// The directions of given rods at given times. Keys of a row: `time_s`, `rod`.
    Rods,
    /// Means over infinitely many rods, free or with rotary diffusion, that are isotropic at t = 0 or, with diffusion,
    /// at random in a plane. Key of a row: `time_s`.
    Tensor,
    /// The rates or angles of given pairs of rods after the contact rule. Key of a row: `snapshot`.
    Contact,
    /// A formula without time, for each of given rows. Key of a row: `row`.
    Formula,
    /// Means over replicas of a suspension with collisions, with standard errors. Key of a row: `time_s`.
    Ensemble,
}

impl Kind {
    /// The columns that identify a row; they come first.
    pub fn keys(self) -> &'static [&'static str] {
        match self {
            Self::Rods => &["time_s", "rod"],
            Self::Tensor | Self::Ensemble => &["time_s"],
            Self::Contact => &["snapshot"],
            Self::Formula => &["row"],
        }
    }
}

/// The measure of an answer's error. The largest over all rows counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Metric {
    /// The angle between the answer's axis and the certified one, rad; p and −p are the same.
    Angle,
    /// The largest |answer − certified| of a row.
    Absolute,
    /// For each rod of a row (columns `a_…` and `b_…`): the length of answer − certified over the length of certified.
    Relative,
    /// |answer − reference| / (se² + reference se²)^½, the largest of a row; column `x` has its error in `x_se`.
    StandardErrors,
}

/// The author of a problem.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Origin {
    /// A problem of this program, unchanged.
    BuiltIn,
    /// A problem of another author, whose certified values have not been checked.
    Foreign,
}

/// One problem, as in `problem.json`. Numbers are exact: an answer belongs to these doubles.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Problem {
    /// The version of the format, [`FORMAT`].
    pub format: u32,
    /// The version of the problem; above 1 if its certified answer has been corrected.
    #[serde(default = "first", skip_serializing_if = "is_first")]
    pub version: u32,
    /// The folder's name.
    pub name: String,
    /// The title, one line.
    pub title: String,
    /// The question, and why it is hard, in words.
    pub summary: String,
    /// The kind of answer.
    pub kind: Kind,
    /// L, row i and column j: ∂u_i/∂x_j, 1/s.
    pub gradient_per_s: [[f64; 3]; 3],
    /// ω in rad/s of a gradient that turns: L(t) = Q L Qᵀ + S with L as above, S p = ω × p and Q = exp(St), the
    /// rotation about ω by the angle |ω|t, right-handed where positive. So the flow turns by ω as seen from the axes,
    /// and the axes turn by −ω. None for a steady gradient.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rotation_rad_per_s: Option<[f64; 3]>,
    /// r_e (1); the mean where rods are unequal.
    pub aspect_ratio: f64,
    /// Standard deviation of r_e, percent of the mean.
    #[serde(default)]
    pub aspect_ratio_sd_percent: f64,
    /// C_I of rods with the rotary diffusivity C_I (2D:D)^½; none for free rods.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub c_i: Option<f64>,
    /// D_r in 1/s of rods with rotary diffusion, in place of C_I.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub d_r_per_s: Option<f64>,
    /// True if rods with diffusion start at random in the plane of axes 1 and 2 in place of all directions.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub planar_start: bool,
    /// The period T in s of a flow that oscillates, gradient_per_s times cos 2πt/T; none for a steady one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub oscillation_period_s: Option<f64>,
    /// The closed equation to solve; none if the answer is that of the distribution itself.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub closed: Option<Closed>,
    /// The formula that is asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub formula: Option<Formula>,
    /// Times of the answer, s, ascending; empty where no time passes.
    pub times_s: Vec<f64>,
    /// Δt of A.14, s, if the answer has angles after a step.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub time_step_s: Option<f64>,
    /// The columns of the answer, keys first.
    pub columns: Vec<String>,
    /// The measure of the error.
    pub metric: Metric,
    /// The largest error that passes, in the metric's unit.
    pub tolerance: f64,
    /// The reason for this tolerance.
    pub because: String,
    /// The source of the certified values, in words, with equation numbers of Lee & Springer (1982) or another source.
    pub equations: Vec<String>,
    /// Names of the axes, and conventions.
    pub axes: String,
    /// The suspension of an ensemble problem.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ensemble: Option<Ensemble>,
}

fn shear_rate_per_s(gradient_per_s: Matrix3<f64>) -> Option<f64> {
    VelocityGradient::new(gradient_per_s)?.shear_rate_per_s()
}

/// From this strain on, a tensor problem asks for the steady state.
const LATE: f64 = 1e6;

impl Problem {
    /// A problem in plane Couette flow with the metric and the keys of its kind; what is left is empty.
    pub(super) fn new(def: &ProblemDef, kind: Kind, columns: &[&str]) -> Self {
        Self {
            format: FORMAT,
            version: version(def.name),
            name: def.name.into(),
            title: def.title.into(),
            summary: String::new(),
            kind,
            gradient_per_s: COUETTE,
            rotation_rad_per_s: None,
            aspect_ratio: 11.6,
            aspect_ratio_sd_percent: 0.0,
            c_i: None,
            d_r_per_s: None,
            planar_start: false,
            oscillation_period_s: None,
            closed: None,
            formula: None,
            times_s: Vec::new(),
            time_step_s: None,
            columns: kind.keys().iter().chain(columns).map(|name| (*name).into()).collect(),
            metric: check::form(kind).0,
            tolerance: 0.0,
            because: String::new(),
            equations: Vec::new(),
            axes: AXES.into(),
            ensemble: None,
        }
    }

    /// The velocity gradient L in 1/s.
    pub fn gradient(&self) -> Matrix3<f64> {
        matrix(&self.gradient_per_s)
    }

    /// S in 1/s, S p = ω × p, of a gradient that turns; 0 of a steady one.
    pub fn spin(&self) -> Matrix3<f64> {
        Vector3::from(self.rotation_rad_per_s.unwrap_or_default()).cross_matrix()
    }

    /// The motion of rods with rotary diffusion; `None` for others.
    pub fn diffusing(&self) -> Option<diffusion::Motion> {
        let (l, r) = (self.gradient_per_s, self.aspect_ratio);
        match (self.c_i, self.d_r_per_s) {
            (Some(c_i), _) => Some(diffusion::Motion::new(l, r, c_i)),
            (None, d_r) => Some(diffusion::Motion::diffusing(l, r, d_r?)),
        }
    }

    /// True if a_ij is that of rods with rotary diffusion, or of a closed equation.
    pub fn is_diffusive(&self) -> bool {
        self.closed.is_some() || self.diffusing().is_some()
    }

    /// The directions of rods with rotary diffusion at t = 0.
    pub fn directions(&self) -> diffusion::Start<'static> {
        if self.planar_start { diffusion::Start::Plane([0.0, 0.0, 1.0]) } else { diffusion::Start::Isotropic }
    }

    /// The period in s and the phase in rad of a flow that oscillates.
    pub fn oscillation(&self) -> Option<[f64; 2]> {
        self.oscillation_period_s.map(|period_s| [period_s, 0.0])
    }

    /// Means over rods that move so, at the first `count` times, in a flow with this oscillation.
    ///
    /// # Errors
    ///
    /// Those of the oracle.
    pub fn distribution(
        &self,
        motion: &diffusion::Motion,
        count: usize,
        oscillation: Option<[f64; 2]>,
    ) -> Result<Vec<diffusion::Means>, NoAnswer> {
        let times = &self.times_s[..count];
        match oscillation {
            Some(oscillation) => diffusion::oscillating(motion, oscillation, self.directions(), times),
            None if self.is_steady() => Ok(vec![diffusion::steady(motion)?]),
            None => diffusion::at(motion, self.directions(), times),
        }
    }

    /// The factor of the gradient at a time.
    pub fn flow_at(&self, time_s: f64) -> f64 {
        self.oscillation_period_s.map_or(1.0, |period_s| (std::f64::consts::TAU * time_s / period_s).cos())
    }

    /// True if the steady state is asked for: by a single time, so late that any later one has the same answer.
    pub fn is_steady(&self) -> bool {
        self.kind == Kind::Tensor
            && self.oscillation_period_s.is_none()
            && matches!(self.times_s[..], [time] if time * self.gradient().norm() > LATE)
    }

    /// G in 1/s in plane Couette flow u_2 = G x_1; `None` in other flows.
    pub fn shear_rate_per_s(&self) -> Option<f64> {
        shear_rate_per_s(self.gradient()).filter(|_| self.rotation_rad_per_s.is_none())
    }

    /// a_ij at t = 0 of a tensor problem.
    pub fn start_tensor(&self) -> [[f64; 3]; 3] {
        let along = if self.planar_start { [0.5, 0.5, 0.0] } else { [1.0 / 3.0; 3] };
        let diagonal = Matrix3::from_diagonal(&along.into()).into();
        self.closed.map_or(diagonal, |closed| closed.start)
    }

    /// The columns of `inputs.csv`; none where the problem has no such file.
    pub fn input_columns(&self) -> Option<Vec<&'static str>> {
        match self.kind {
            Kind::Contact => Some(INPUT_COLUMNS.into()),
            _ => self.formula.map(|formula| formula.inputs()),
        }
    }
}

/// A closed equation of a_ij, and its start.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Closed {
    /// The closure for a_ijkl.
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
    /// Steps per period of the mean aspect ratio; P_c has no Δt, so this is part of the model.
    pub steps_per_period: u64,
    /// The number of replicas behind the reference means.
    pub certified_replicas: u64,
    /// The largest standard error of an answer; above it there is too little data to judge.
    pub largest_standard_error: f64,
}

/// A problem as read from its folder.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadedProblem {
    /// The problem's folder.
    pub dir: PathBuf,
    /// The author of the problem.
    pub origin: Origin,
    /// `problem.json`.
    pub problem: Problem,
    /// `start.csv`: p of each rod at t = 0, in order of `rod` from 0; empty where none are given.
    pub start: Vec<[f64; 3]>,
    /// `inputs.csv`: the pairs of a contact problem, the rows of a formula.
    pub inputs: Option<Table>,
    /// `certified.csv`: its columns are `problem.columns`.
    pub certified: Table,
    /// The tolerance in `problem.json`; the one in `problem` may be a user's.
    pub own_tolerance: f64,
}

/// The largest standard error of an a_ij by random numbers, as of 3·10⁴ rods: a bias of 0.008 is then seen.
const LARGEST_STANDARD_ERROR: f64 = 2e-3;

impl LoadedProblem {
    /// The largest standard error of an answer that is judged by its own.
    pub fn largest_standard_error(&self) -> f64 {
        match &self.problem.ensemble {
            Some(ensemble) => ensemble.largest_standard_error,
            None if self.problem.metric == Metric::StandardErrors => LARGEST_STANDARD_ERROR,
            None => f64::INFINITY,
        }
    }

    /// The problem's own tolerance, and the one that passes.
    pub fn tolerances(&self) -> [f64; 2] {
        [self.own_tolerance, self.problem.tolerance]
    }

    /// True if all that is asked is in plane Couette flow, u_2 = G x_1.
    pub fn is_couette(&self) -> bool {
        match (&self.problem.formula, &self.inputs) {
            (Some(Formula::Closure { .. }), _) => false,
            (Some(_), Some(inputs)) => {
                inputs.rows.iter().all(|row| shear_rate_per_s(formula::inputs::gradient(row)).is_some())
            }
            _ => self.problem.shear_rate_per_s().is_some(),
        }
    }

    /// The problem of a_ij as asked of a code with random numbers: each mean has its standard error, in a column `_se`.
    pub fn with_standard_errors(&self) -> Self {
        let mut loaded = self.clone();
        let Problem { columns, metric, tolerance, because, .. } = &mut loaded.problem;
        let value = |name: &String| [name.clone(), format!("{name}_se")];
        *columns = columns[..1].iter().cloned().chain(columns[1..].iter().flat_map(value)).collect();
        for row in &mut loaded.certified.rows {
            *row = row[..1].iter().copied().chain(row[1..].iter().flat_map(|value| [*value, 0.0])).collect();
        }
        let count = self.certified.rows.len() * (self.problem.columns.len() - 1);
        *tolerance = ensemble::tolerance(count);
        *because = ensemble::because(count, "the problem");
        *metric = Metric::StandardErrors;
        loaded.own_tolerance = *tolerance;
        loaded.certified.columns.clone_from(columns);
        loaded
    }

    /// The problem with a larger tolerance, given by `whom`; a smaller one changes nothing.
    pub fn with_tolerance(mut self, tolerance: f64, whom: &str) -> Self {
        if tolerance > self.own_tolerance {
            self.problem.tolerance = tolerance;
            self.problem.because =
                format!("{whom}. The problem's own is {:e}: {}", self.own_tolerance, self.problem.because);
        }
        self
    }
}

/// The columns of `start.csv`.
pub(super) const START: [&str; 4] = ["rod", "p1", "p2", "p3"];

/// The columns of `inputs.csv`: centre (mm), axis and r_e of the rods a and b.
#[rustfmt::skip]
const INPUT_COLUMNS: [&str; 15] = [
    "snapshot",
    "a_x1_mm", "a_x2_mm", "a_x3_mm", "a_p1", "a_p2", "a_p3", "a_aspect_ratio",
    "b_x1_mm", "b_x2_mm", "b_x3_mm", "b_p1", "b_p2", "b_p3", "b_aspect_ratio",
];
