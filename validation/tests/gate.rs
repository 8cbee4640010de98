//! The acceptance gate: one named test per case of the registry.
//!
//! A case that passed in `out/report`, by `validate` of these very sources, is not run again: it would get the same
//! bits. Named cases are always run: `cargo test --test gate jeffery-period`; all of them with `SHEARBED_GATE=run`.

use libtest_mimic::{Arguments, Trial};
use shearbed_validation::cases;
use shearbed_validation::judge::accept::Verdict;
use shearbed_validation::judge::case::{Case, Effort};
use shearbed_validation::present::report::passed;
use std::path::Path;

fn main() {
    let arguments = Arguments::from_args();
    let report = Path::new(env!("CARGO_MANIFEST_DIR")).join("../out/report/report.json");
    let runs_all = arguments.filter.is_some() || std::env::var_os("SHEARBED_GATE").is_some();
    let text = if runs_all { String::new() } else { std::fs::read_to_string(report).unwrap_or_default() };
    let passed = passed(&text);
    if !passed.is_empty() {
        println!("\n{} cases passed in out/report, made by validate from the same sources", passed.len());
    }
    let trial = |case: Case| {
        let passed = passed.contains(case.about.name);
        Trial::test(case.about.name, move || {
            if passed {
                return Ok(());
            }
            let outcome = case.run(&Effort::gate());
            match outcome.verdict {
                Verdict::Pass | Verdict::NoData => Ok(()),
                _ => Err(format!("{outcome:#?}").into()),
            }
        })
    };
    let trials = cases::all().into_iter().map(trial).collect();
    libtest_mimic::run(&arguments, trials).exit();
}
