//! `shearbed bench`.

use super::{Failure, print};
use crate::work_precision::{self, ASPECT_RATIOS, Budget, export, figures, tables};
use crate::{output, plot, speed, subject};
use std::path::PathBuf;

/// Arguments of `bench`.
#[derive(clap::Args)]
pub(super) struct Args {
    /// Run this bench only, as re11.6; can be given more than once
    #[arg(long = "case", value_name = "NAME")]
    cases: Vec<String>,
    /// The folder for bench.csv, bench.json and the pictures
    #[arg(long, value_name = "DIR", default_value = "out/bench")]
    out: PathBuf,
    /// Print nothing but errors
    #[arg(long)]
    quiet: bool,
}

/// Measures every subject's error against its run time, one after the other on one core, and the core's speed.
pub(super) fn bench(args: &Args) -> Result<(), Failure> {
    let chosen = chosen(&args.cases)?;
    output::probe(&args.out)?;
    let subjects = subject::all();
    let benches: Vec<_> = (chosen.into_iter())
        .map(|aspect_ratio| work_precision::run(aspect_ratio, &subjects, Budget::FULL))
        .collect();
    let mut files = vec![
        (
            "bench.csv".to_owned(),
            export::bench_csv(&benches).map_err(Failure::Failed)?,
        ),
        (
            "bench.json".to_owned(),
            export::json(&benches).map_err(Failure::Failed)?,
        ),
    ];
    // A single bench is asked for to see that one alone.
    let speed = match args.cases.is_empty() {
        true => Some(speed::measure(speed::Amount::FULL).map_err(Failure::Failed)?),
        false => None,
    };
    if let Some(speed) = &speed {
        let text = export::json(speed).map_err(Failure::Failed)?;
        files.push(("speed.json".to_owned(), text));
    }
    let drawn = figures::figures(&benches);
    let scaling = speed.as_ref().map(speed::figures::figures).unwrap_or_default();
    for figure in drawn.into_iter().chain(scaling) {
        let svg = plot::svg(&figure.figure).map_err(Failure::Failed)?;
        files.push((format!("{}.svg", figure.name), svg));
    }
    output::write_all(&args.out, &files)?;
    if args.quiet {
        return Ok(());
    }
    let names: Vec<_> = files.iter().map(|(name, _)| name.as_str()).collect();
    let mut tables = tables::tables(&benches);
    tables.extend(speed.as_ref().map(speed::tables::table));
    let tables: String = tables.iter().map(export::text).collect();
    print(&format!(
        "{tables}in {}: {}\n",
        args.out.display(),
        names.join(", ")
    ))
}

/// The aspect ratios of these benches in their own order, or all.
fn chosen(names: &[String]) -> Result<Vec<f64>, Failure> {
    let known = ASPECT_RATIOS.map(work_precision::name);
    if let Some(unknown) = names.iter().find(|name| !known.contains(name)) {
        return Err(Failure::Input(format!(
            "--case {unknown}: no bench has this name; there are {}",
            known.join(", ")
        )));
    }
    let wanted = |r: &f64| names.is_empty() || names.contains(&work_precision::name(*r));
    Ok(ASPECT_RATIOS.into_iter().filter(wanted).collect())
}
