//! What the report of a whole run shows beside its cases.

use super::{Failure, print, progress};
use crate::case::Effort;
use crate::catalogue;
use crate::dependencies;
use crate::figures::{self, Replicas};
use crate::kicks;
use crate::readings;
use crate::report::Sections;
use crate::speed;
use crate::stability;
use crate::subject;
use crate::suspensions::{self, free, law_tables, starts, study};
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
        print("the limit Δt → 0: kicks, and the averaged motion\n")?;
    }
    let limit = kicks::study::measure(effort).map_err(Failure::Failed)?;
    if !quiet {
        print("integrators: error against run time\n")?;
    }
    let budget = effort.pick(Budget::QUICK, Budget::FULL);
    let benches = work_precision::run_all(budget);
    if !quiet {
        print("speed: the core beside the naive reference\n")?;
    }
    let amount = effort.pick(speed::Amount::QUICK, speed::Amount::FULL);
    let speed = speed::measure(amount).map_err(Failure::Failed)?;
    let mut tables = vec![readings::table(&readings)];
    tables.extend(kicks::tables::tables(&limit));
    tables.extend(work_precision::tables::tables(&benches));
    tables.push(work_precision::tables::orders(&work_precision::order::of_rod(
        11.6,
    )));
    tables.push(speed::tables::table(&speed));
    tables.push(dependencies::table());
    if !quiet {
        print("integrators: stability\n")?;
    }
    let subjects = subject::all();
    tables.extend(stability::tables::tables(&subjects));
    tables.extend(stability::limit_tables::limits(&subjects));
    let mut figures = drawn.figures;
    figures.push(kicks::tables::figure(&limit));
    figures.extend(stability::figures::figures(&subjects));
    figures.extend(work_precision::figures::figures(&benches));
    if !quiet {
        print("suspensions: error against run time, steps, rods and replicas\n")?;
    }
    let free_extent = effort.pick(free::Extent::QUICK, free::Extent::FULL);
    let free = free::SCENES.map(|scene| scene.bench(&starts::ALL, free_extent, budget));
    let study = study::run(effort.pick(study::Extent::QUICK, study::Extent::FULL), budget);
    let study = study.map_err(Failure::Failed)?;
    tables.push(suspensions::tables::free(&free));
    tables.push(suspensions::tables::answers(&study));
    tables.extend(law_tables::law(&study.law, study.strain_per_period));
    tables.push(suspensions::tables::coupled(&study.coupled));
    figures.extend(free.iter().map(suspensions::figures::free));
    figures.push(suspensions::figures::interacting(&study));
    figures.extend(speed::figures::figures(&speed));
    Ok(Some(Sections {
        figures,
        tables,
        equations: catalogue::equations(),
        plans: drawn.plans,
    }))
}
