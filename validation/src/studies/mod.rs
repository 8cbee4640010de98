//! The studies, from which the report and `shearbed bench` are made, and the integrators that they compare.
//!
//! A study answers one question with tables and figures; it judges nothing, but names the cases that judge what it
//! shows.
//!
//! They may use `present` and all parts above. To add a study, write a module with a `STUDY`, declare it here, and give
//! it a place in [`ALL`]; `tests/program/example_study.rs` is a whole one. To add an integrator, add it to
//! [`integrators`].

mod brownian;
pub(crate) mod coefficients;
mod cost;
pub mod figures;
pub mod integrators;
pub mod kicks;
pub mod interpretations;
pub mod speed;
pub(crate) mod stability;
pub mod suspensions;
mod tensors;
pub mod work_precision;

// What most studies use: the files of this folder begin with `use super::*`.
use crate::files::build;
use crate::judge::case::Effort;
use crate::judge::lab;
use crate::judge::statistics::{Estimate, Sample, correlation, covariance, slope};
use crate::methods::integrators::{Errors, Integrator, RodProblem, Setting, Theory, apart_rad, grade};
use crate::oracle::naive::{Naive, NaiveProblem, mean_projections};
use crate::present::plot::{Curve, Figure, Points};
use crate::present::study::{Exhibit, Findings, ReportFigure, Request, Study};
use crate::present::table::{
    Column, ReportTable, columns_csv, decimals, difference, estimate, field, number, of_words, powers, rows_csv, words,
};
use nalgebra::{Matrix3, UnitVector3, Vector3};
use rand::SeedableRng;
use rand_pcg::Pcg64Dxsm;
use rayon::prelude::*;
use serde::Serialize;
use shearbed::model::jeffery::{shape_factor, strain_per_period};
use shearbed::observable::Channel;
use shearbed::run::{ensemble, run_replica};
use shearbed::scene::{Scene, Time, Update};
use shearbed::{Plan, Suspension};
use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::time::Instant;

/// Every study, in the order of the report.
pub const ALL: [Study; 12] = [
    figures::STUDY,
    interpretations::STUDY,
    kicks::study::STUDY,
    work_precision::study::STUDY,
    stability::study::STUDY,
    suspensions::free_study::STUDY,
    suspensions::interacting::STUDY,
    coefficients::study::STUDY,
    tensors::STUDY,
    brownian::STUDY,
    cost::STUDY,
    speed::STUDY,
];

/// Halves the interval from `holds` to `fails` so many times: the last place where the property was seen to hold, and
/// the last where it was not.
pub(crate) fn bisect(mut holds: f64, mut fails: f64, halvings: u32, is_true: impl Fn(f64) -> bool) -> [f64; 2] {
    for _ in 0..halvings {
        let middle = 0.5 * (holds + fails);
        if is_true(middle) { holds = middle } else { fails = middle }
    }
    [holds, fails]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cases;
    use std::collections::BTreeSet;

    #[test]
    fn studies_name_cases_that_there_are_and_themselves_once() {
        let known: BTreeSet<_> = cases::all().iter().map(|case| case.about.name).collect();
        let mut names = BTreeSet::new();
        for study in ALL {
            assert!(names.insert(study.name), "{} twice", study.name);
            assert!(study.question.ends_with('?') && !study.cases.is_empty(), "{}", study.name);
            for case in study.cases {
                assert!(known.contains(case), "{}: {case}", study.name);
            }
        }
    }
}
