//! What the report of a whole run shows beside its cases.

use super::{Failure, print, progress};
use crate::case::Effort;
use crate::catalogue;
use crate::figures::{self, Replicas};
use crate::readings;
use crate::report::Sections;

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
    if !quiet {
        print("open readings: the default and every alternative\n")?;
    }
    let readings = readings::measure(effort);
    Ok(Sections {
        figures: drawn.figures,
        tables: vec![readings::table(&readings)],
        equations: catalogue::equations(),
        plans: drawn.plans,
    })
}
