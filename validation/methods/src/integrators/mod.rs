//! Integrators of a free rod's motion, all of one type; your own integrator is graded by the same code
//! (`examples/bring_your_own.rs`).

mod adaptive;
mod errors;
mod exact;
mod fixed;
mod integrator;
pub mod limits;
mod problem;
mod sphere;

use nalgebra::UnitVector3;
use serde::Serialize;
use std::fmt;

pub use adaptive::{dormand_prince, radau};
pub use errors::{Errors, apart_rad};
pub use exact::{closed_form, exact_propagator};
pub use fixed::{explicit_euler, rk4};
pub use integrator::Integrator;
pub use problem::RodProblem;

/// How the error should fall, which also says what settings an integrator takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Theory {
    /// The integrator takes no steps: [`Setting::Once`].
    Exact,
    /// Error ∝ Δtᵖ in [`Setting::Steps`], with this order p.
    Order(u32),
    /// The integrator chooses its steps by [`Setting::Tolerance`].
    Adaptive,
}

/// The accuracy asked of an integrator.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Setting {
    /// No setting, for integrators without steps.
    Once,
    /// The number of equal steps over the whole problem.
    Steps(u64),
    /// The relative and absolute tolerance of an adaptive method.
    Tolerance(f64),
}

impl Setting {
    /// The number of steps; an error unless the setting is a number of equal steps > 0.
    pub fn steps(self) -> Result<u64, Failure> {
        match self {
            Self::Steps(steps) if steps > 0 => Ok(steps),
            _ => Err(Failure::Setting),
        }
    }

    /// The tolerance; an error unless the setting is a tolerance > 0.
    pub fn tolerance(self) -> Result<f64, Failure> {
        match self {
            Self::Tolerance(tolerance) if tolerance > 0.0 => Ok(tolerance),
            _ => Err(Failure::Setting),
        }
    }
}

impl fmt::Display for Setting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Once => write!(f, "–"),
            Self::Steps(steps) => write!(f, "{steps} steps"),
            Self::Tolerance(tolerance) => write!(f, "tolerance {tolerance:.0e}"),
        }
    }
}

/// The reason why there is no direction at the end.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Failure {
    /// A component is infinite or NaN.
    NotFinite,
    /// The integrator does not take this setting.
    Setting,
    /// The integrator failed for this reason.
    Gave(String),
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFinite => write!(f, "not finite"),
            Self::Setting => write!(f, "takes no such setting"),
            Self::Gave(reason) => write!(f, "{reason}"),
        }
    }
}

/// The errors of an integrator on a problem; fails if the direction is not finite.
pub fn grade(
    integrator: &Integrator,
    problem: &RodProblem,
    start: &UnitVector3<f64>,
    setting: Setting,
) -> Result<Errors, Failure> {
    let end = integrator.advance(problem, start, setting)?;
    if end.iter().all(|component| component.is_finite()) {
        Ok(Errors::of(&end, problem, start))
    } else {
        Err(Failure::NotFinite)
    }
}

/// All integrators of this project, in the order of the tables; the cases judge these.
pub fn own() -> Vec<Integrator> {
    let mut own = vec![exact_propagator(), closed_form()];
    own.extend(fixed::all());
    own.extend(sphere::all());
    own.extend([dormand_prince(), radau()]);
    own
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_setting_says_what_it_is_and_none_is_zero() {
        let said = [Setting::Once, Setting::Steps(20), Setting::Tolerance(1e-8)].map(|setting| setting.to_string());
        assert_eq!(said, ["–", "20 steps", "tolerance 1e-8"]);
        assert_eq!(Setting::Steps(1).steps(), Ok(1));
        assert_eq!(Setting::Tolerance(1e-300).tolerance(), Ok(1e-300));
        for setting in [Setting::Once, Setting::Steps(0), Setting::Tolerance(0.0), Setting::Tolerance(f64::NAN)] {
            assert_eq!(setting.steps(), Err(Failure::Setting));
            assert_eq!(setting.tolerance(), Err(Failure::Setting));
        }
    }

    /// Tables and pictures identify the integrators by these names.
    #[test]
    fn integrators_have_their_names_and_some_keep_the_length() {
        let said: Vec<_> = own()
            .iter()
            .map(|integrator| format!("{}{}", integrator.name, if integrator.keeps_length { " |p| = 1" } else { "" }))
            .collect();
        let expected = [
            "exact propagator |p| = 1",
            "A.4 and A.5 in angles |p| = 1",
            "explicit Euler in angles |p| = 1",
            "RK4 in angles |p| = 1",
            "RK4 in p",
            "projected RK4 in p |p| = 1",
            "implicit midpoint in p |p| = 1",
            "Lie-group midpoint |p| = 1",
            "Lie-group RKMK4 |p| = 1",
            "Dormand–Prince 8(5,3)",
            "Radau IIA 5",
        ];
        assert_eq!(said, expected);
    }

    #[test]
    fn every_integrator_comes_close_and_refuses_the_settings_of_others() {
        let (problem, start) = RodProblem::mid_flip(3.0);
        for integrator in own() {
            let (own, other) = match integrator.theory {
                Theory::Exact => (Setting::Once, Setting::Steps(10)),
                Theory::Order(_) => (Setting::Steps(20_000), Setting::Tolerance(1e-6)),
                Theory::Adaptive => (Setting::Tolerance(1e-8), Setting::Once),
            };
            let errors = grade(&integrator, &problem, &start, own).unwrap();
            assert!(errors.orientation_rad < 5e-3, "{}: {errors:?}", integrator.name);
            let refused = grade(&integrator, &problem, &start, other);
            assert_eq!(refused.is_err(), integrator.theory != Theory::Exact, "{}", integrator.name);
        }
    }
}
