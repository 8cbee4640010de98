//! `shearbed bench`.

use super::{Failure, on_threads, print, probe};
use crate::output::{self, Output};
use crate::report::{ReportFigure, ReportTable};
use crate::suspensions::{self, free, law_tables, starts, study};
use crate::work_precision::export::Benches;
use crate::work_precision::{self, ASPECT_RATIOS, Budget, export, figures, tables};
use crate::{plot, speed, subject};
use std::path::PathBuf;

/// Arguments of `bench`.
#[derive(clap::Args)]
pub(super) struct Args {
    /// Run this bench only, as re11.6, fig7-n50 or speed; can be given more than once
    #[arg(long = "case", value_name = "NAME")]
    cases: Vec<String>,
    /// The folder for the tables, their data and the pictures
    #[arg(long, value_name = "DIR", default_value = "out/bench")]
    out: PathBuf,
    /// Print nothing but errors
    #[arg(long)]
    quiet: bool,
}

/// What the benches leave.
#[derive(Default)]
struct Found {
    tables: Vec<ReportTable>,
    figures: Vec<ReportFigure>,
    files: Vec<Output>,
}

impl Found {
    fn file(&mut self, name: &str, text: Result<String, String>) -> Result<(), Failure> {
        self.files.push((name.to_owned(), text.map_err(Failure::Failed)?));
        Ok(())
    }
}

/// Measures errors against run times, one bench after the other: of a rod on one core, of suspensions by runs on all
/// cores and the time of one, and of the core its speed.
pub(super) fn bench(args: &Args) -> Result<(), Failure> {
    check(&args.cases)?;
    let wanted = |name: &str| args.cases.is_empty() || args.cases.iter().any(|case| case == name);
    probe(&args.out, 0)?;
    let mut found = Found::default();
    rods(&wanted, &mut found)?;
    free_suspensions(&wanted, &mut found)?;
    if wanted(study::SCENE) {
        on_threads(None, || interacting(&mut found))??;
    }
    if wanted(SPEED) {
        core_speed(&mut found)?;
    }
    let mut files = std::mem::take(&mut found.files);
    for figure in &found.figures {
        let svg = plot::svg(&figure.figure).map_err(Failure::Failed)?;
        files.push((format!("{}.svg", figure.name), svg));
    }
    output::write_all(&args.out, &files)?;
    if args.quiet {
        return Ok(());
    }
    let names: Vec<_> = files.iter().map(|(name, _)| name.as_str()).collect();
    let tables: String = found.tables.iter().map(export::text).collect();
    print(&format!(
        "{tables}in {}: {}\n",
        args.out.display(),
        names.join(", ")
    ))
}

/// The core's speed.
fn core_speed(found: &mut Found) -> Result<(), Failure> {
    let speed = speed::measure(speed::Amount::FULL).map_err(Failure::Failed)?;
    found.file("speed.json", export::json(&speed))?;
    found.tables.push(speed::tables::table(&speed));
    found.figures.extend(speed::figures::figures(&speed));
    Ok(())
}

/// Every subject on one rod.
fn rods(wanted: &dyn Fn(&str) -> bool, found: &mut Found) -> Result<(), Failure> {
    let chosen = ASPECT_RATIOS.into_iter();
    let chosen: Vec<_> = chosen.filter(|r| wanted(&work_precision::name(*r))).collect();
    if chosen.is_empty() {
        return Ok(());
    }
    let subjects = subject::all();
    let benches: Vec<_> = (chosen.into_iter())
        .map(|aspect_ratio| work_precision::run(aspect_ratio, &subjects, Budget::FULL))
        .collect();
    found.file("bench.csv", export::bench_csv(&benches))?;
    found.file("bench.json", export::json(&Benches { benches: &benches }))?;
    found.tables.extend(tables::tables(&benches));
    found.figures.extend(figures::figures(&benches));
    Ok(())
}

/// Every start of the free suspensions.
fn free_suspensions(wanted: &dyn Fn(&str) -> bool, found: &mut Found) -> Result<(), Failure> {
    let chosen = free::SCENES.into_iter().filter(|free| wanted(free.scene));
    let benches: Vec<_> = chosen
        .map(|free| free.bench(&starts::ALL, free::Extent::FULL, Budget::FULL))
        .collect();
    if benches.is_empty() {
        return Ok(());
    }
    found.file("suspensions.csv", suspensions::export::free_csv(&benches))?;
    found.file("suspensions.json", export::json(&Benches { benches: &benches }))?;
    found.tables.push(suspensions::tables::free(&benches));
    found
        .figures
        .extend(benches.iter().map(suspensions::figures::free));
    Ok(())
}

/// Steps, rods and replicas of the interacting suspension.
fn interacting(found: &mut Found) -> Result<(), Failure> {
    let study = study::run(study::Extent::FULL, Budget::FULL).map_err(Failure::Failed)?;
    found.file("splits.csv", suspensions::export::splits_csv(&study))?;
    found.file("splits.json", export::json(&study))?;
    found.tables.push(suspensions::tables::answers(&study));
    found
        .tables
        .extend(law_tables::law(&study.law, study.strain_per_period));
    found.tables.push(suspensions::tables::coupled(&study.coupled));
    found.figures.push(suspensions::figures::interacting(&study));
    Ok(())
}

/// Refuses names that no bench has.
/// The bench of the core itself.
const SPEED: &str = "speed";

fn check(names: &[String]) -> Result<(), Failure> {
    let mut known: Vec<_> = ASPECT_RATIOS.map(work_precision::name).into();
    known.extend(free::SCENES.map(|free| free.scene.to_owned()));
    known.extend([study::SCENE, SPEED].map(String::from));
    match names.iter().find(|name| !known.contains(name)) {
        Some(unknown) => Err(Failure::Input(format!(
            "--case {unknown}: no bench has this name; there are {}",
            known.join(", ")
        ))),
        None => Ok(()),
    }
}
