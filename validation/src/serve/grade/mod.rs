//! Grading any program: its answers to reference problems, from files or over a pipe, with a verdict for each and the
//! known mistake whose curve a wrong answer is. `docs/src/user/grading.md` is the user's page.

mod answer;
mod axes;
mod compare;
mod contact;
mod diagnosis;
mod digits;
mod estimate;
pub mod figures;
mod files;
mod html;
mod lammps;
mod layout;
pub mod live;
mod means;
mod nearness;
mod mistakes;
mod order;
mod overall;
mod read;
mod report;
mod slips;
mod tensors;
mod trace;

pub use crate::files::csv::LineEnds;
pub use axes::Axes;
pub use diagnosis::loose;
pub use digits::single;
pub use files::{Options, grade, grade_one};
pub use html::html;
pub use lammps::DumpOptions;
pub use layout::{FileOptions, Foreign};
pub use nearness::LAID_OUT;
pub use order::{Order, remark, settle};
pub use overall::overall;
pub use report::{Report, junit, markdown, terminal};

use crate::methods::integrators::Setting;
use crate::serve::problems::{Kind, LoadedProblem, Origin};
use serde::Serialize;

/// The verdict on a problem.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "UPPERCASE")]
pub enum Verdict {
    /// The error is at most the tolerance, and a claimed order is not refuted.
    Pass,
    /// The error is larger, or the claimed order is refuted.
    Fail,
    /// There is no answer.
    Missing,
    /// The program answered with an error of its own: it does not claim to solve this problem.
    Refused,
    /// Time ran out before the answers came within the tolerance, or showed that they would not: neither a pass nor a
    /// failure.
    #[serde(rename = "NOT REACHED")]
    NotReached,
}

impl Verdict {
    /// The verdict in capitals.
    pub fn word(self) -> &'static str {
        match self {
            Self::Pass => "PASS",
            Self::Fail => "FAIL",
            Self::Missing => "MISSING",
            Self::Refused => "REFUSED",
            Self::NotReached => "NOT REACHED",
        }
    }
}

/// The result of a program on one problem.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Graded {
    /// The problem.
    pub name: String,
    /// The author of the problem.
    pub reference: Origin,
    /// The kind of problem.
    pub kind: Kind,
    /// The verdict.
    pub verdict: Verdict,
    /// The error in the problem's metric; none without an answer or if the error is not finite.
    pub error: Option<f64>,
    /// The largest error that passes.
    pub tolerance: f64,
    /// The reason for this tolerance.
    pub because: String,
    /// The exponent with which the error falls with the step, with its sign, for the last pair above round-off.
    pub observed_order: Option<f64>,
    /// The comparison of the observed orders with a claimed order.
    pub order_found: Option<Order>,
    /// The known mistake whose curve the answer is.
    pub diagnosis: Option<String>,
    /// The mistakes whose curve the answer is, and the answer.
    #[serde(skip)]
    pub suspects: Vec<String>,
    #[serde(skip)]
    answer: Option<answer::Answer>,
    /// True if what all problems together show says the diagnosis.
    #[serde(skip)]
    is_said_over_all: bool,
    /// The place of the error, or the reason why there is none.
    pub note: Option<String>,
    /// The time that grading took, s.
    #[serde(skip)]
    pub seconds: f64,
    /// The steps of the answer that is judged.
    pub steps: Option<u64>,
    /// The tolerance asked of a program that chooses its steps.
    pub asked_tolerance: Option<f64>,
    /// Errors (steps, error) from coarse to fine; empty without answers for several numbers of steps.
    pub errors: Vec<(u64, f64)>,
    /// (time / last time, error) of a curve.
    pub path: Vec<(f64, f64)>,
    /// The order between each two neighbours of `errors`.
    pub orders: Vec<Option<f64>>,
    /// The largest ||p| − 1|.
    pub length_drift: Option<f64>,
    /// The largest change of C_b (1).
    pub orbit_drift: Option<f64>,
    /// The phase lost per period, in periods; negative for a program that is ahead.
    pub phase_lost_per_period: Option<f64>,
}

impl Graded {
    /// A problem without an answer.
    pub fn without_answer(loaded: &LoadedProblem) -> Self {
        let problem = &loaded.problem;
        Self {
            name: problem.name.clone(),
            reference: loaded.origin,
            kind: problem.kind,
            verdict: Verdict::Missing,
            error: None,
            tolerance: problem.tolerance,
            because: problem.because.clone(),
            observed_order: None,
            order_found: None,
            diagnosis: None,
            suspects: Vec::new(),
            answer: None,
            is_said_over_all: false,
            note: None,
            seconds: 0.0,
            steps: None,
            asked_tolerance: None,
            errors: Vec::new(),
            path: Vec::new(),
            orders: Vec::new(),
            length_drift: None,
            orbit_drift: None,
            phase_lost_per_period: None,
        }
    }

    /// Sets the steps or the tolerance with which the answer was made.
    fn set_setting(&mut self, setting: Setting) {
        (self.steps, self.asked_tolerance) = (setting.steps().ok(), setting.tolerance().ok());
    }

    /// Sets the errors (steps, error) from coarse to fine, and their orders compared with the claimed one.
    fn set_orders(&mut self, errors: Vec<(u64, f64)>, loaded: &LoadedProblem, claimed: Option<f64>) {
        let found = order::orders(&errors, loaded.tolerances());
        self.observed_order = found.observed(claimed);
        self.order_found = claimed.filter(|_| !errors.is_empty()).map(|claimed| found.judged(claimed));
        self.orders = found.all;
        self.errors = errors;
    }

    /// Sets the error and the drifts of an answer, those that are finite.
    fn set_compared(&mut self, compared: &compare::Compared) {
        let finite = |number: &f64| number.is_finite();
        self.error = Some(compared.error).filter(finite);
        self.length_drift = compared.length_drift.filter(finite);
        self.orbit_drift = compared.orbit_drift.filter(finite);
        self.phase_lost_per_period = compared.phase_lost_per_period.filter(finite);
    }

    /// Sets an answer, its error and drifts, and the diagnosis, if it is within `most`.
    fn set_answer(&mut self, loaded: &LoadedProblem, answer: &answer::Answer, compared: &compare::Compared, most: f64) {
        self.set_compared(compared);
        self.path = figures::along(loaded, &compared.errors);
        let found = diagnosis::diagnose(loaded, answer, compared.error, self.steps).within(most);
        (self.diagnosis, self.suspects, self.answer) = (found.said, found.suspects, Some(answer.clone()));
    }

    /// A message about the order if it is refuted.
    fn order_off(&self, claimed: Option<f64>) -> Option<String> {
        let lower = self.order_found == Some(Order::Lower);
        claimed.filter(|_| lower).map(|claimed| order::other(self, claimed))
    }

    /// How many steps would bring an answer that converges within the tolerance, unless it has a mistake.
    fn steps_needed(&self) -> Option<String> {
        if self.diagnosis.is_some() {
            return None;
        }
        let (order, steps, error) = (self.observed_order?, self.steps?, self.error.filter(|x| *x > self.tolerance)?);
        let needed = steps as f64 * (error / self.tolerance).powf(1.0 / order);
        (order >= 0.5).then(|| {
            format!(
                "at this order about {needed:.0e} steps would be within the tolerance; --tolerance sets a larger one"
            )
        })
    }

    fn order_text(&self) -> String {
        self.observed_order.map_or("–".into(), |order| format!("{order:+.2}"))
    }

    fn setting_text(&self) -> String {
        match (self.steps, self.asked_tolerance) {
            (Some(steps), _) => format!("{steps} steps"),
            (None, Some(tolerance)) => format!("tolerance {tolerance:.0e}"),
            (None, None) => "–".into(),
        }
    }
}
