//! The error along the path of a rod, with equal steps or at one tolerance: it peaks where the rod flips.

use super::bench::{ASPECT_RATIO, START};
use super::program::Program;
use crate::methods::integrators::{RodProblem, Setting, Theory, grade};
use crate::present::plot::{Curve, Figure};
use crate::serve::grade::figures::{LEAST, PROGRAM};
use nalgebra::{UnitVector3, Vector3};
use serde::Serialize;

/// Number of requests, each for a sixteenth of a period more, and the steps of each sixteenth.
const REQUESTS: u64 = 32;
const STEPS: u64 = 64;

const TOLERANCE: f64 = 1e-6;

/// The error at a time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Along {
    /// t/T.
    pub turns: f64,
    /// The error in rad.
    pub error_rad: f64,
}

/// The errors of a program over two periods; those that are finite.
pub(super) fn path(program: &Program) -> Vec<Along> {
    let (integrator, start) = (program.integrator(), UnitVector3::new_normalize(Vector3::from(START)));
    let at = |request: u64| {
        let turns = request as f64 / 16.0;
        let setting = match program.theory {
            Theory::Adaptive => Setting::Tolerance(TOLERANCE),
            _ => Setting::Steps(STEPS * request),
        };
        let errors = grade(&integrator, &RodProblem::new(ASPECT_RATIO, turns), &start, setting).ok()?;
        Some(Along { turns, error_rad: errors.orientation_rad })
    };
    (1..=REQUESTS).filter_map(at).collect()
}

/// The errors as a picture; `None` if there are none.
pub fn figure(path: &[Along], theory: Theory) -> Option<Figure> {
    let setting = match theory {
        Theory::Adaptive => format!("tolerance {TOLERANCE:e}"),
        _ => format!("{} steps a period", 16 * STEPS),
    };
    let place = |along: &Along| (along.turns, along.error_rad.max(LEAST));
    (!path.is_empty()).then(|| Figure {
        title: format!("Error along the path, r_e = {ASPECT_RATIO}, {setting}"),
        x_name: "t/T".into(),
        y_name: "error (rad)".into(),
        curves: vec![Curve::of(PROGRAM, path, place)],
        y_log: true,
        ..Figure::default()
    })
}
