//! The registry: every case, declared once. `cargo test`, the report and the page of equations are made from it.
//!
//! A case is a claim, its source, an implementation under test, mistakes as controls, and a check with the reason for
//! each tolerance ([`judge::case`](crate::judge::case)). Cases may use all parts above. To add one, write an entry in a
//! file of this folder; a new file is declared here and its `cases()` listed. CONTRIBUTING.md has a whole one.

mod averaged;
mod continued_run;
mod brownian;
pub mod catalogue;
mod changing_flows;
mod cheapest_split;
mod closed_forms;
mod coefficients;
mod contact_rule;
mod decay;
mod derived;
mod diffusion;
mod encounters;
mod equations;
mod experiments;
mod extreme_scenes;
mod extremes;
mod fit_covers;
pub mod fit_interpretations;
mod folgar_tucker;
mod free_suspension;
mod general_flows;
mod integrator_claims;
mod integrators;
mod interpretations;
mod jeffery_equations;
mod kicks;
mod misprints;
mod motion;
mod published;
mod reductions;
mod reference;
mod replacement;
pub mod resolution;
mod stability;
mod statements;
mod steady;
mod step_limits;
mod symmetries;
mod times;
mod two_methods;
mod volume_shapes;
mod work_precision;

// What most cases use: the files of this folder begin with `use super::*`.
use crate::judge::accept::{Design, Rule, kolmogorov_samples};
use crate::judge::case::{Case, Effort, Evidence, Judges};
use crate::judge::lab::{self, Change, Shared, per_replica};
use crate::judge::statistics::{Estimate, Sample, larger, pairs, worst};
use crate::oracle::closed_form;
use nalgebra::{Matrix3, Rotation3, UnitVector3, Vector3};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Dxsm;
use rayon::prelude::*;
use shearbed::model::flow::VelocityGradient;
use shearbed::model::jeffery::{shape_factor, strain_per_period};
use shearbed::model::orientation;
use shearbed::motion::Propagator;
use shearbed::observable::Channel;
use shearbed::run::ensemble;
use shearbed::scene::{Flow, Orientation, Scene, Time, TimeUnit, Update};
use shearbed::{Observable, Plan, Suspension};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Every case, in the order of the report.
pub fn all() -> Vec<Case> {
    [
        motion::cases(),
        times::cases(),
        brownian::cases(),
        jeffery_equations::cases(),
        contact_rule::cases(),
        misprints::cases(),
        encounters::cases(),
        replacement::cases(),
        volume_shapes::cases(),
        kicks::cases(),
        averaged::cases(),
        free_suspension::cases(),
        closed_forms::cases(),
        reductions::cases(),
        symmetries::cases(),
        continued_run::cases(),
        extremes::cases(),
        general_flows::cases(),
        changing_flows::cases(),
        extreme_scenes::cases(),
        reference::cases(),
        resolution::cases(),
        interpretations::cases(),
        steady::cases(),
        integrators::cases(),
        integrator_claims::cases(),
        stability::cases(),
        step_limits::cases(),
        work_precision::cases(),
        cheapest_split::cases(),
        decay::cases(),
        derived::cases(),
        statements::cases(),
        experiments::cases(),
        fit_covers::cases(),
        fit_interpretations::cases(),
        published::cases(),
        coefficients::cases(),
        folgar_tucker::cases(),
        diffusion::cases(),
        two_methods::cases(),
    ]
    .into_iter()
    .flatten()
    .collect()
}
