//! What the report of a whole run shows beside its cases.

use super::{Failure, print, progress};
use crate::case::Effort;
use crate::figures::{self, Replicas};
use crate::report::{ReportEquation, Sections};
use crate::{cases, equations};

/// Runs the scenes of the figures, and gathers everything.
pub(super) fn gather(effort: &Effort, quiet: bool) -> Result<Sections, Failure> {
    let replicas = Replicas::of(effort);
    let work = figures::work(replicas).map_err(Failure::Failed)?;
    if !quiet {
        print(&format!("figures: {work} replicas of their scenes\n"))?;
    }
    let bar = progress(work, "replicas", quiet);
    let drawn = figures::draw(effort, replicas, &|| bar.inc(1)).map_err(Failure::Failed)?;
    bar.finish_and_clear();
    Ok(Sections {
        figures: drawn.figures,
        tables: Vec::new(),
        equations: equations(),
        plans: drawn.plans,
    })
}

/// Every equation with the cases of the registry that test it.
fn equations() -> Vec<ReportEquation> {
    let about: Vec<_> = cases::all().into_iter().map(|case| case.about).collect();
    let equation = |equation: &equations::Equation| ReportEquation {
        number: equation.number.into(),
        says: equation.says.into(),
        code: equation.code.iter().map(|item| (*item).into()).collect(),
        cases: (about.iter())
            .filter(|about| about.equations.contains(&equation.number))
            .map(|about| about.name.into())
            .collect(),
    };
    equations::ALL.iter().map(equation).collect()
}
