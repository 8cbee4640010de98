//! `shearbed run`.

use super::record::Seconds;
use super::scene::{Chosen, Ensemble};
use super::{
    Failure, MAX_THREADS, agree, alone, facts, kept, memory, on_threads, pictures, print, probe, progress,
    record, rods, scene, tables, threads, whole,
};
use crate::checkpoint::Replicas;
use crate::output::{self, Output};
use crate::text::line;
use crate::{cluster, plot};
use serde_json::json;
use shearbed::resume::Halfway;
use shearbed::work::RunError;
use shearbed::{Plan, Results};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Arguments of `run`.
#[derive(clap::Args)]
pub(super) struct Args {
    #[command(flatten)]
    chosen: Chosen,
    #[command(flatten)]
    ensemble: Ensemble,
    /// The folder for tables, pictures and run.json [default: out/<scene>]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Threads to run on; the results do not depend on it [default: one for each core]
    #[arg(long, value_name = "K", value_parser = whole(1, MAX_THREADS), allow_negative_numbers = true)]
    threads: Option<u64>,
    /// Write the rods of output.rods_at for ParaView too: rods.pvd, and a .vtp file for each time
    #[arg(long)]
    vtk: bool,
    /// Keep the run in this file while it runs, and go on from there where the file exists
    #[arg(long, value_name = "FILE")]
    checkpoint: Option<PathBuf>,
    /// Seconds between two checkpoints [default: 60]
    #[arg(long, value_name = "S", value_parser = seconds, requires = "checkpoint", allow_negative_numbers = true)]
    every: Option<Duration>,
    /// Overwrite a folder that holds another run, or what another command wrote
    #[arg(long)]
    force: bool,
    /// Print nothing but errors and warnings
    #[arg(long)]
    quiet: bool,
}

/// A time between checkpoints.
fn seconds(text: &str) -> Result<Duration, String> {
    let seconds = text.parse().ok().filter(|s| (0.01..=86_400.0).contains(s));
    let seconds = seconds.ok_or("seconds from 0.01 to 86400 are allowed")?;
    Ok(Duration::from_secs_f64(seconds))
}

/// The run's checkpoint, and how far it has come, where one is asked for.
fn checkpoint(args: &Args, plan: &Plan, out: &Path) -> Result<Option<Arc<Replicas>>, Failure> {
    let Some(path) = &args.checkpoint else {
        return Ok(None);
    };
    let path = &output::followed(path);
    alone(path)?;
    let folder = |path: &Path| path.canonicalize().ok();
    let beside = path.parent().filter(|parent| !parent.as_os_str().is_empty());
    let inside = folder(beside.unwrap_or(Path::new("."))).is_some_and(|parent| Some(parent) == folder(out));
    let of_results = ["csv", "svg", "json", "pvd", "vtp"]
        .iter()
        .any(|end| path.extension().is_some_and(|own| own == *end));
    if inside && of_results {
        return Err(Failure::Input(format!(
            "--checkpoint {}: the results may take that name; another folder than theirs, or another ending than .csv, .svg and .json, is allowed",
            path.display()
        )));
    }
    let every = args.every.unwrap_or(Duration::from_secs(60));
    let replicas = Replicas::open(plan, path, every)?;
    if replicas.done() > 0 || replicas.halfway() > 0 {
        let (done, all) = (replicas.done(), plan.scene().ensemble.replicas);
        let told = format!(
            "goes on from {}: {done} of {all} replicas are done, {} halfway\n",
            path.display(),
            replicas.halfway()
        );
        print(if args.quiet { "" } else { &told })?;
    }
    Ok(Some(replicas))
}

/// Runs a scene and writes its results.
pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let start = Instant::now();
    let named = args.chosen.load(&args.ensemble, &[])?;
    let scene = named.scene;
    let plan = Plan::new(&scene).map_err(|error| Failure::Input(format!("{}: {error}", named.source)))?;
    if args.vtk && plan.rods_outputs().is_empty() {
        return Err(Failure::Input(format!(
            "{}: --vtk: output.rods_at is missing: the times at which rods are to be written",
            named.source
        )));
    }
    let beside = args.checkpoint.as_ref().map_or(0, |_| Halfway::bytes(&plan));
    memory::check_beside(&plan, args.threads, args.vtk, &named.source, beside)?;
    let out = args
        .out
        .clone()
        .unwrap_or_else(|| Path::new("out").join(&named.stem));
    agree("run", json!({ "scene": plan.scene().resolved() }))?;
    let bytes = tables::most_bytes(&plan).saturating_add(rods::most_bytes(&plan, args.vtk));
    probe(&out, bytes)?;
    if !args.force && cluster::is_root() {
        kept::check_run(&out, &plan)?;
    }
    scene::warn(&named.source, &facts::warnings(&plan));
    let mut seconds = Seconds {
        plan: start.elapsed().as_secs_f64(),
        ..Seconds::default()
    };

    let checkpoint = checkpoint(args, &plan, &out)?;
    let bar = progress(scene.ensemble.replicas, "replicas", args.quiet);
    bar.inc(checkpoint.as_ref().map_or(0, |kept| kept.done()));
    let start = Instant::now();
    let threads = threads::count(args.threads)? as usize;
    let results = match &checkpoint {
        Some(kept) => kept
            .run(
                threads,
                || bar.inc(1),
                |error| {
                    let lost = format!("{error}; the run goes on, and what comes is not kept");
                    scene::warn("--checkpoint", [&lost]);
                },
            )
            .map(Some),
        None => on_threads(args.threads, || cluster::ensemble(&plan, || bar.inc(1)))?,
    };
    bar.finish_and_clear();
    let Some(results) = ended(&named.source, results)? else {
        return Ok(());
    };
    seconds.run = start.elapsed().as_secs_f64();

    let start = Instant::now();
    let mut files = files(&plan, &results).map_err(Failure::Failed)?;
    files.extend(rods::files(&plan, &results, args.vtk));
    seconds.tables_and_pictures = start.elapsed().as_secs_f64();
    let names = files.iter().map(|(name, _)| name.as_str()).collect();
    let record = record::json(&plan, &results, threads, seconds, names).map_err(Failure::Failed)?;
    files.push((kept::RUN.to_owned(), record));
    let names: Vec<_> = files.iter().map(|(name, _)| name.as_str()).collect();
    let left_over = kept::left_over(&out, &names);
    output::write_all_where(&out, &files, || match args.force {
        true => Ok(()),
        false => kept::check_run(&out, &plan),
    })?;
    output::remove(&out, &left_over)?;
    if args.quiet {
        return Ok(());
    }
    print(&format!(
        "{}\nMeans ± standard errors, rods: {}, replicas: {}\n\n{}in {}: {}\n",
        line(&scene.title),
        scene.particles.count,
        scene.ensemble.replicas,
        tables::summary(&results),
        out.display(),
        names.join(", ")
    ))
}

/// The results of a run that did not stop: where it did, the scene asks for what cannot be computed. Nothing is written
/// then, and what an earlier run left stays.
fn ended<T>(source: &str, results: Result<T, RunError>) -> Result<T, Failure> {
    results.map_err(|error| Failure::Input(format!("{source}: {error}")))
}

/// A table and the pictures of each observable.
fn files(plan: &Plan, results: &Results) -> Result<Vec<Output>, String> {
    let mut files = Vec::new();
    for series in &results.series {
        files.push((
            format!("{}.csv", series.observable.name()),
            tables::csv(results, series)?,
        ));
        for (stem, figure) in pictures::figures(plan.scene(), results, series) {
            files.push((format!("{stem}.svg"), plot::svg(&figure)?));
        }
    }
    Ok(files)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_run_that_stops_is_a_failure_that_names_the_rod() {
        let stopped = RunError::NonFinite {
            rod: 7,
            step: 41,
            seed: 3,
            replica: 2,
            cause: "a contact arm of 1e-320 rod lengths turned it by inf rad".into(),
        };
        let failure = ended::<()>("my.toml", Err(stopped)).expect_err("it stopped");
        let (message, code) = failure.message_and_code();
        assert_eq!(code, 2);
        assert_eq!(
            message,
            "my.toml: rod 7 would become non-finite in step 41 of replica 2, seed 3: a contact arm of 1e-320 rod lengths \
             turned it by inf rad"
        );
    }
}
