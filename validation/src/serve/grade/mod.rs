//! Grading any program: its answers to reference problems, from files or over a pipe, with a verdict for each and the
//! known mistake whose curve a wrong answer is. `docs/src/user/grading.md` is the user's page.

mod answer;
mod axes;
mod compare;
mod contact;
mod diagnosis;
pub mod figures;
mod files;
mod html;
mod lammps;
mod layout;
mod lines;
pub mod live;
mod means;
mod mistakes;
mod read;
mod report;

pub use axes::Axes;
pub use files::{Claim, Options, grade};
pub use html::html;
pub use lammps::Told as Dump;
pub use layout::{Foreign, Told};
pub use lines::LineEnds;
pub use report::{Report, json, junit, markdown, terminal};

use crate::serve::problems::{Kind, LoadedProblem, Origin};
use serde::Serialize;

/// How a problem ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "UPPERCASE")]
pub enum Verdict {
    /// The error is at most the tolerance, and the order, where one is claimed, is as claimed.
    Pass,
    /// Not.
    Fail,
    /// There is no answer.
    Missing,
    /// Time ran out before the answers came within the tolerance, or showed that they would not: no pass, and no failure.
    #[serde(rename = "NOT REACHED")]
    NotReached,
}

impl Verdict {
    /// In capitals.
    pub fn word(self) -> &'static str {
        match self {
            Self::Pass => "PASS",
            Self::Fail => "FAIL",
            Self::Missing => "MISSING",
            Self::NotReached => "NOT REACHED",
        }
    }
}

/// What is said of a program on one problem.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Graded {
    /// The problem.
    pub name: String,
    /// Whose problem it is.
    pub reference: Origin,
    /// What it asks for.
    pub kind: Kind,
    /// The verdict.
    pub verdict: Verdict,
    /// The error in the problem's metric; none where there is no answer, or where it is not finite.
    pub error: Option<f64>,
    /// The largest that passes.
    pub tolerance: f64,
    /// Why that much.
    pub because: String,
    /// The exponent with which the error falls with the step, with its sign, on the last pair above the tolerance.
    pub observed_order: Option<f64>,
    /// The known mistake whose curve the answer is.
    pub diagnosis: Option<String>,
    /// Where the error is, or why there is none.
    pub note: Option<String>,
    /// The steps of the answer that is judged.
    pub steps: Option<u64>,
    /// The tolerance asked of the program, where it chooses its steps.
    pub asked_tolerance: Option<f64>,
    /// Errors (steps, error) from coarse to fine, where several numbers of steps were answered.
    pub errors: Vec<(u64, f64)>,
    /// The order between each two neighbours of these.
    pub orders: Vec<Option<f64>>,
    /// The largest ||p| − 1|.
    pub length_drift: Option<f64>,
    /// The largest change of C_b (1).
    pub orbit_drift: Option<f64>,
    /// In periods a period, negative where the program is ahead.
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
            diagnosis: None,
            note: None,
            steps: None,
            asked_tolerance: None,
            errors: Vec::new(),
            orders: Vec::new(),
            length_drift: None,
            orbit_drift: None,
            phase_lost_per_period: None,
        }
    }

    /// The observed order with its sign.
    fn order_text(&self) -> String {
        self.observed_order.map_or("–".into(), |order| format!("{order:+.2}"))
    }

    /// What the program was set to.
    fn setting_text(&self) -> String {
        match (self.steps, self.asked_tolerance) {
            (Some(steps), _) => format!("{steps} steps"),
            (None, Some(tolerance)) => format!("tolerance {tolerance:.0e}"),
            (None, None) => "–".into(),
        }
    }
}

/// The order between each two neighbours of errors (steps, error) from coarse to fine, with its sign, and the last one of
/// which both errors are above `floor`: below it they are round-off.
pub fn orders(errors: &[(u64, f64)], floor: f64) -> (Vec<Option<f64>>, Option<f64>) {
    let order = |pair: &[(u64, f64)]| {
        let order = (pair[0].1 / pair[1].1).ln() / (pair[1].0 as f64 / pair[0].0 as f64).ln();
        order.is_finite().then_some(order)
    };
    let orders: Vec<_> = errors.windows(2).map(order).collect();
    let above = errors.iter().take_while(|(_, error)| *error > floor).count();
    let last = above.checked_sub(2).and_then(|at| orders[at]);
    (orders, last)
}

/// How far an observed order may be from the one claimed.
pub use crate::studies::work_precision::order::ORDER_TOLERANCE;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_order_has_its_sign_and_needs_two_errors_above_round_off() {
        let of = |errors: &[f64]| {
            let errors: Vec<_> = (0..).map(|k| 10u64 << k).zip(errors.iter().copied()).collect();
            orders(&errors, 1e-10).1.map(|order| (order * 1e6).round() / 1e6)
        };
        assert_eq!(of(&[1e-2, 1e-2 / 16.0, 1e-12]), Some(4.0));
        assert_eq!(of(&[1e-3, 2e-3, 4e-3]), Some(-1.0), "it diverges");
        assert_eq!(of(&[1e-3, 1e-12, 1e-3]), None);
        assert_eq!(of(&[1e-12, 1e-13]), None);
        assert_eq!(of(&[f64::NAN, 1e-3]), None);
        assert_eq!(of(&[1e-3]), None);
        let (every, last) = orders(&[(100, 1e-2), (300, 1e-2 / 9.0)], 1e-9);
        assert!((last.unwrap() - 2.0).abs() < 1e-12 && every.len() == 1);
    }
}
