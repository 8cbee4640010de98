//! The registry: every case, declared once. `cargo test`, the report and the catalogue are made from it.

mod averaged;
mod closed_forms;
mod contact_rule;
mod decay;
mod encounters;
mod experiments;
mod extreme_scenes;
mod extremes;
mod free_suspension;
mod general_flows;
mod integrator_claims;
mod jeffery_equations;
mod kicks;
pub mod lab;
mod misprints;
mod motion;
mod readings;
mod reductions;
mod reference;
mod stability;
mod steady;
mod step_limits;
mod subjects;
mod words;
mod work_precision;
mod work_precision_coupled;

use crate::accept::FAMILY_FALSE_ALARM_RATE;
use crate::case::{Case, Effort};
use std::path::PathBuf;

/// Every case, in the order of the report.
pub fn all() -> Vec<Case> {
    [
        motion::cases(),
        jeffery_equations::cases(),
        contact_rule::cases(),
        misprints::cases(),
        encounters::cases(),
        kicks::cases(),
        averaged::cases(),
        free_suspension::cases(),
        closed_forms::cases(),
        reductions::cases(),
        extremes::cases(),
        general_flows::cases(),
        extreme_scenes::cases(),
        reference::cases(),
        readings::cases(),
        steady::cases(),
        subjects::cases(),
        integrator_claims::cases(),
        stability::cases(),
        step_limits::cases(),
        work_precision::cases(),
        work_precision_coupled::cases(),
        decay::cases(),
        words::cases(),
        experiments::cases(),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// The effort of a quick or a full run, with the level each statistical check of the registry gets.
pub fn effort(full: bool, data: Option<PathBuf>) -> Effort {
    let checks: usize = all().iter().map(|case| case.about.statistical_checks).sum();
    Effort {
        full,
        level: FAMILY_FALSE_ALARM_RATE / checks.max(1) as f64,
        data,
    }
}
