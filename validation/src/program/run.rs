//! `shearbed run`.

use super::record::Seconds;
use super::scene::{Chosen, Ensemble};
use super::{
    Failure, Threads, Writing, agree, checkpoint, facts, log, memory, on_threads, pictures, print, progress,
    record, result_folder, rods, scene, tables, threads,
};
use crate::files::checkpoint::Replicas;
use crate::files::cluster;
use crate::files::output::Output;
use crate::files::text::Shown;
use crate::files::text::line;
use crate::input::start::Starts;
use crate::present::plot;
use serde_json::json;
use shearbed::Error;
use shearbed::run::resume::Halfway;
use shearbed::{Plan, Results};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Arguments of `run`.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  shearbed run fig4-n50 --replicas 10 --out first")]
pub(super) struct Args {
    #[command(flatten)]
    chosen: Chosen,
    #[command(flatten)]
    ensemble: Ensemble,
    /// The folder for tables, pictures and run.json [default: out/<scene>]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    threads: Threads,
    /// Write the rods of output.rods_at and rods_every for ParaView too: rods.pvd, and a .vtp file for each time and replica
    #[arg(long)]
    vtk: bool,
    /// Keep the run in this file while it runs, and go on from there where the file exists
    #[arg(long, value_name = "FILE")]
    checkpoint: Option<PathBuf>,
    /// Seconds between two checkpoints [default: 60]
    #[arg(long, value_name = "S", value_parser = seconds, requires = "checkpoint", allow_negative_numbers = true)]
    every: Option<Duration>,
    #[command(flatten)]
    writing: Writing,
}

/// Refuses a folder in which a result would replace a file that the scene's rods are read from, with --force too.
fn reads_no_result(starts: &Starts, out: &Path, names: &[impl AsRef<Path>]) -> Result<(), Failure> {
    let there = |path: PathBuf| path.canonicalize().ok();
    let results: Vec<_> = names.iter().filter_map(|name| there(out.join(name))).collect();
    match starts.files().find(|file| there(file.clone()).is_some_and(|file| results.contains(&file))) {
        Some(file) => Err(Failure::Input(format!(
            "--out {}: a result would replace {}, which particles.rods reads: choose another folder",
            out.display(),
            file.display()
        ))),
        None => Ok(()),
    }
}

/// A time between checkpoints.
fn seconds(text: &str) -> Result<Duration, String> {
    let seconds = text.parse().ok().filter(|s| (0.01..=86_400.0).contains(s));
    let seconds = seconds.ok_or("seconds from 0.01 to 86400 are allowed")?;
    Ok(Duration::from_secs_f64(seconds))
}

/// The run's checkpoint, if one is asked for. Prints its progress.
fn open_checkpoint(args: &Args, plan: &Plan, path: Option<&Path>) -> Result<Option<Arc<Replicas>>, Failure> {
    let Some(path) = path else {
        return Ok(None);
    };
    let every = args.every.unwrap_or(Duration::from_secs(60));
    let replicas = Replicas::open(plan, path, every)?;
    let progress = replicas.progress();
    if progress.done > 0 || progress.halfway > 0 {
        let text = format!("goes on from {}: {progress}\n", path.shown());
        print(if args.writing.quiet { "" } else { &text })?;
    }
    Ok(Some(replicas))
}

/// Runs a scene and writes its results.
pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let start = Instant::now();
    let named = args.chosen.load(&args.ensemble, &[])?;
    let plan = named.plan()?;
    let scene = named.scene;
    if args.vtk && plan.rods_outputs().is_empty() {
        return Err(Failure::Input(format!(
            "{}: --vtk: output.rods_at is missing: the times at which rods are to be written; output.rods_every = 1 takes \
             every output",
            named.source
        )));
    }
    let beside = args.checkpoint.as_ref().map_or(0, |_| Halfway::bytes(&plan));
    memory::check_beside(&plan, args.threads.given, args.vtk, &named.source, beside)?;
    let out = args.out.clone().unwrap_or_else(|| Path::new("out").join(&named.stem));
    let inputs = json!({ "scene": plan.scene().resolved() });
    agree("run", inputs.clone())?;
    let path = args.checkpoint.as_deref();
    let path = path.map(|path| checkpoint::check(path, &out)).transpose()?;
    let bytes = tables::most_bytes(&plan).saturating_add(rods::most_bytes(&plan, args.vtk));
    let names = names(&plan, args.vtk);
    if cluster::is_root() {
        reads_no_result(&named.starts, &out, &names)?;
    }
    let folder = result_folder(&out, ("run", inputs, args.writing.force), bytes, &names)?;
    scene::warn(&named.source, &facts::warnings(&plan));
    let mut seconds = Seconds { plan: start.elapsed().as_secs_f64(), ..Seconds::default() };

    let checkpoint = open_checkpoint(args, &plan, path.as_deref())?;
    let bar = progress(scene.ensemble.replicas, "replicas", args.writing.quiet);
    bar.inc(checkpoint.as_ref().map_or(0, |replicas| replicas.progress().done));
    let start = Instant::now();
    let threads = threads::count(args.threads.given)? as usize;
    let results = match &checkpoint {
        Some(replicas) => replicas
            .run(
                threads,
                || bar.inc(1),
                |saved| match saved {
                    Ok(progress) => {
                        log(&format!("kept in {}: {progress}", replicas.path().display()), args.writing.quiet)
                    }
                    Err(error) => {
                        let lost = format!("{error}; the run goes on, and what comes is not kept");
                        scene::warn("--checkpoint", [&lost]);
                    }
                },
            )
            .map(Some),
        None => on_threads(args.threads.given, || cluster::ensemble(&plan, || bar.inc(1)))?,
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
    files.push((RUN.to_owned(), record));
    let names: Vec<_> = files.iter().map(|(name, _)| name.clone()).collect();
    folder.write(files)?;
    if args.writing.quiet {
        return Ok(());
    }
    print(&format!(
        "{}\nMeans ± standard errors, rods: {}, replicas: {}\n\n{}in {}: {}\n",
        line(&scene.title),
        scene.particles.count,
        scene.ensemble.replicas,
        tables::summary(&results),
        out.shown(),
        names.join(", ")
    ))
}

/// The results of a run. The error of a stopped run names the scene; nothing is written then, and earlier results stay.
fn ended<T>(source: &str, results: Result<T, Error>) -> Result<T, Failure> {
    results.map_err(|error| Failure::Input(format!("{source}: {error}")))
}

/// The scene, plan, counters and times of a run.
const RUN: &str = "run.json";

/// The names of the files of a run, but for those of single times of its rods.
fn names(plan: &Plan, vtk: bool) -> Vec<String> {
    let of_each = plan.observables().into_iter().flat_map(|observable| {
        let stems = pictures::stems(observable).into_iter();
        let pictures = stems.map(|stem| format!("{stem}.svg"));
        pictures.chain([format!("{}.csv", observable.name())])
    });
    let rods = (!plan.rods_outputs().is_empty()).then_some("rods.csv");
    let vtk = vtk.then_some("rods.pvd");
    let others = [Some(RUN), rods, vtk].into_iter().flatten();
    of_each.chain(others.map(str::to_owned)).collect()
}

/// A table and the pictures of each observable.
fn files(plan: &Plan, results: &Results) -> Result<Vec<Output>, String> {
    let mut files = Vec::new();
    for series in &results.series {
        files.push((format!("{}.csv", series.observable.name()), tables::csv(results, series)?));
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
        let stopped = Error::NonFinite {
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
