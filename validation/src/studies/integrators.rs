//! The integrators that studies compare. Register your own here: it appears in every table of `bench`, `converge` and
//! the report with the project's own, and no case judges it, so that it cannot fail the gate.

use super::*;
use crate::methods::integrators::own;

/// Integrators registered by users.
fn guests() -> Vec<Integrator> {
    vec![
        // Integrator::in_p("mine", 2, my_step),
        #[cfg(test)]
        tests::heun(),
    ]
}

/// Every integrator in the tables: the project's own, then guests.
pub fn all() -> Vec<Integrator> {
    own().into_iter().chain(guests()).collect()
}

/// Tests that run with a guest registered.
#[cfg(test)]
mod tests {
    use super::{Integrator, all, own};
    use crate::judge::accept::Verdict;
    use crate::judge::case::{Effort, Judges};
    use crate::studies::work_precision::order;

    const NAME: &str = "Heun, a guest";

    pub(super) fn heun() -> Integrator {
        Integrator::in_p(NAME, 2, |problem, p, h| {
            let k1 = problem.rate(&p);
            p + 0.5 * h * (k1 + problem.rate(&(p + h * k1)))
        })
    }

    #[test]
    fn a_guest_is_graded_and_breaks_no_case() {
        assert_eq!(all().len(), own().len() + 1);
        let studies = order::of_rod(2.0).studies;
        let heun = studies.iter().find(|study| study.integrator == NAME);
        assert_eq!(heun.unwrap().found, order::OrderVerdict::AsTheory);
        for case in crate::cases::all() {
            // The cases that ask for every integrator.
            if case.about.judges == Judges::Integrator && ASK_FOR_ALL.contains(&case.about.name) {
                let outcome = case.run(&Effort::gate());
                assert_eq!(outcome.verdict, Verdict::Pass, "{outcome:?}");
                let text = format!("{:?}", outcome.evidence);
                assert!(!text.contains(NAME), "{text}");
            }
        }
    }

    const ASK_FOR_ALL: [&str; 6] = [
        "stability-map",
        "integrator-orders",
        "integrator-lengths",
        "who-loses-length",
        "coarse-steps",
        "grid-convergence-index",
    ];
}
