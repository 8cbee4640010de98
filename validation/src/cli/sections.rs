//! What the report of a whole run shows beside its cases.

use super::{Failure, print, progress};
use crate::case::Effort;
use crate::catalogue;
use crate::dependencies;
use crate::figures::{self, Replicas};
use crate::readings;
use crate::report::Sections;
use crate::speed;
use crate::stability;
use crate::subject;
use crate::work_precision::{self, Budget};

/// Runs the scenes of the figures and the open readings over all ranks, the rest on the root, and gathers everything
/// there; nothing elsewhere.
pub(super) fn gather(effort: &Effort, quiet: bool) -> Result<Option<Sections>, Failure> {
    let replicas = Replicas::of(effort);
    let work = figures::work(replicas).map_err(Failure::Failed)?;
    if !quiet {
        print(&format!("figures: {work} replicas of their scenes\n"))?;
    }
    let bar = progress(work, "replicas", quiet);
    let drawn = figures::draw(effort, replicas, &|| bar.inc(1)).map_err(Failure::Failed)?;
    bar.finish_and_clear();
    if !quiet {
        print("open readings: the default and every alternative\n")?;
    }
    let readings = readings::measure(effort);
    let (Some(drawn), Some(readings)) = (drawn, readings) else {
        return Ok(None);
    };
    if !quiet {
        print("integrators: error against run time\n")?;
    }
    let benches = work_precision::run_all(effort.pick(Budget::QUICK, Budget::FULL));
    if !quiet {
        print("speed: the core beside the naive reference\n")?;
    }
    let amount = effort.pick(speed::Amount::QUICK, speed::Amount::FULL);
    let speed = speed::measure(amount).map_err(Failure::Failed)?;
    let mut tables = vec![readings::table(&readings)];
    tables.extend(work_precision::tables::tables(&benches));
    tables.push(work_precision::tables::orders(&work_precision::order::of_all(
        11.6,
    )));
    tables.push(speed::tables::table(&speed));
    tables.push(dependencies::table());
    if !quiet {
        print("integrators: stability\n")?;
    }
    let subjects = subject::all();
    tables.extend(stability::tables::tables(&subjects));
    let mut figures = drawn.figures;
    figures.extend(stability::figures::figures(&subjects));
    figures.extend(work_precision::figures::figures(&benches));
    figures.extend(speed::figures::figures(&speed));
    Ok(Some(Sections {
        figures,
        tables,
        equations: catalogue::equations(),
        plans: drawn.plans,
    }))
}
