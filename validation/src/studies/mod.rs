//! The studies, from which the report and `shearbed bench` are made, and the integrators that they compare.
//!
//! A study answers one question with tables and figures; it judges nothing, but names the cases that judge what it
//! shows.
//!
//! They may use `present` and all wings above. To add a study, write a module with a `STUDY`, declare it here, and give
//! it a place in [`ALL`]; `tests/program/example_study.rs` is a whole one. To add an integrator, add it to
//! [`integrators`].

mod bisect;
pub mod coefficients;
mod cost;
pub mod figures;
pub mod integrators;
pub mod kicks;
pub mod interpretations;
pub mod speed;
pub mod stability;
pub mod suspensions;
mod tensors;
pub mod work_precision;

use crate::present::study::Study;

/// Every study, in the order of the report.
pub const ALL: [Study; 11] = [
    figures::STUDY,
    interpretations::STUDY,
    kicks::study::STUDY,
    work_precision::study::STUDY,
    stability::study::STUDY,
    suspensions::free_study::STUDY,
    suspensions::interacting::STUDY,
    coefficients::study::STUDY,
    tensors::study::STUDY,
    cost::STUDY,
    speed::STUDY,
];

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
