//! The acceptance gate: one named test per case of the registry.

use libtest_mimic::{Arguments, Trial};
use validation::accept::Verdict;
use validation::cases;

fn main() {
    let effort = cases::effort(false, None);
    let trials = cases::all()
        .into_iter()
        .map(|case| {
            let effort = effort.clone();
            Trial::test(case.about.name, move || {
                let outcome = case.run(&effort);
                // The level of every check is derived from these counts.
                let statistical = outcome
                    .evidence
                    .iter()
                    .filter(|judged| judged.evidence.rule.is_statistical())
                    .count();
                if outcome.verdict != Verdict::NoData && statistical != outcome.about.statistical_checks {
                    return Err(format!(
                        "{statistical} statistical checks made, {} declared",
                        outcome.about.statistical_checks
                    )
                    .into());
                }
                match outcome.verdict {
                    Verdict::Pass | Verdict::NoData => Ok(()),
                    _ => Err(format!("{outcome:#?}").into()),
                }
            })
        })
        .collect();
    libtest_mimic::run(&Arguments::from_args(), trials).exit();
}
