//! The acceptance gate: one named test per case of the registry.

use libtest_mimic::{Arguments, Trial};
use validation::case::Verdict;
use validation::cases;

fn main() {
    let effort = cases::effort(false, None);
    let trials = cases::all()
        .into_iter()
        .map(|case| {
            let effort = effort.clone();
            Trial::test(case.about.name, move || {
                let outcome = case.run(&effort);
                match outcome.verdict {
                    Verdict::Pass | Verdict::NoData => Ok(()),
                    _ => Err(format!("{outcome:#?}").into()),
                }
            })
        })
        .collect();
    libtest_mimic::run(&Arguments::from_args(), trials).exit();
}
