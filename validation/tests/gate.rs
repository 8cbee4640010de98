//! The acceptance gate: one named test per case of the registry.

use libtest_mimic::{Arguments, Trial};
use shearbed_validation::cases;
use shearbed_validation::judge::accept::Verdict;
use shearbed_validation::judge::case::Effort;

fn main() {
    let trials = cases::all()
        .into_iter()
        .map(|case| {
            Trial::test(case.about.name, move || {
                let outcome = case.run(&Effort::gate());
                match outcome.verdict {
                    Verdict::Pass | Verdict::NoData => Ok(()),
                    _ => Err(format!("{outcome:#?}").into()),
                }
            })
        })
        .collect();
    libtest_mimic::run(&Arguments::from_args(), trials).exit();
}
