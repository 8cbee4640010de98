//! `shearbed run`.

mod work;

use super::record::Seconds;
use super::scene::{Chosen, Ensemble, Named};
use super::until::{self, LEAST, Until};
use super::{
    Failure, Threads, Writing, agree, checkpoint, facts, memory, number, on_threads, pictures, print, probe, progress,
    record, rods, scene, spares_inputs, tables, threads,
};
use serde_json::{Value, json};
use shearbed::Error;
use shearbed::run::resume::Halfway;
use shearbed::scene::MAX_REPLICAS;
use shearbed::{Plan, Results};
use shearbed_validation::files::checkpoint::{Progress, Replicas};
use shearbed_validation::files::cluster;
use shearbed_validation::files::output::{Output, ResultFolder};
use shearbed_validation::files::text::Shown;
use shearbed_validation::files::text::line;
use shearbed_validation::present::plot;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};
use work::Work;

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
    /// Write the rods of output.rods_at and rods_every for ParaView too: rods.pvd, and a .vtp file for each time and
    /// replica
    #[arg(long)]
    vtk: bool,
    #[command(flatten)]
    until: Until,
    /// With --until-se: begin no replica after this time, as 90s, 10min or 1.5h; the results of those that have begun
    /// are written
    #[arg(long, value_name = "TIME", value_parser = until::time_limit, requires = "rules",
        allow_negative_numbers = true)]
    time_limit: Option<Duration>,
    /// Keep the run in this file while it runs, and go on from there where the file exists, with more --replicas too
    #[arg(long, value_name = "FILE")]
    checkpoint: Option<PathBuf>,
    /// Seconds between two checkpoints [default: 60]
    #[arg(long, value_name = "S", value_parser = seconds, requires = "checkpoint", allow_negative_numbers = true)]
    every: Option<Duration>,
    #[command(flatten)]
    writing: Writing,
}

/// Parses the time between checkpoints, in s.
fn seconds(text: &str) -> Result<Duration, String> {
    let seconds = number(text, |s| (0.01..=86_400.0).contains(&s), "a number of seconds from 0.01 to 86400")?;
    Ok(Duration::from_secs_f64(seconds))
}

/// The plan of the run; with `--until-se` it allows the largest number of replicas.
fn planned(args: &Args, named: &Named) -> Result<Plan, Failure> {
    let plan = named.plan()?;
    args.until.check(&plan, &named.source)?;
    if args.until.is_empty() {
        return Ok(plan);
    }
    if named.settings.iter().any(|setting| setting.key == "ensemble.replicas") {
        return Err(Failure::Input(format!(
            "{}: --until-se and a number of replicas (--replicas, or --set ensemble.replicas): --until-se finds the \
             number; one of the two is allowed",
            named.source
        )));
    }
    Ok(plan.with_replicas(MAX_REPLICAS))
}

/// The inputs on which the results depend. With `--until-se` the rules replace the number of replicas.
fn inputs(args: &Args, plan: &Plan) -> Value {
    if args.until.is_empty() {
        return json!({ "scene": plan.scene().resolved() });
    }
    let limit = args.time_limit.map(|limit| format!(", at most {} s", limit.as_secs_f64()));
    let mut scene = json!(plan.scene().resolved());
    scene["ensemble"]["replicas"] = (args.until.input() + &limit.unwrap_or_default()).into();
    json!({ "scene": scene })
}

/// The run's checkpoint, if one is requested.
fn open_checkpoint(args: &Args, plan: &Plan, path: Option<&Path>) -> Result<Option<Arc<Replicas>>, Failure> {
    let every = args.every.unwrap_or(Duration::from_secs(60));
    Ok(path.map(|path| Replicas::open(plan, path, every)).transpose()?)
}

/// Writes the checkpoint for the first time, and prints how much of the run it contains.
fn begin(args: &Args, replicas: &Replicas) -> Result<(), Failure> {
    replicas.write()?;
    let progress = replicas.progress();
    if args.writing.quiet || progress.done == 0 && progress.halfway == 0 {
        return Ok(());
    }
    let Progress { done, halfway, .. } = progress;
    let progress = if args.until.is_empty() {
        progress.to_string()
    } else {
        format!("{done} replicas are done, {halfway} halfway")
    };
    print(&format!("goes on from {}: {progress}\n", replicas.path().shown()))
}

/// Runs a scene and writes its results.
pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let start = Instant::now();
    let named = args.chosen.load(&args.ensemble, &[])?;
    let plan = planned(args, &named)?;
    let read: Vec<_> = named.files().collect();
    let scene = named.scene;
    if args.vtk && plan.rods_outputs().is_empty() {
        return Err(Failure::Input(format!(
            "{}: --vtk: output.rods_at is missing: the times at which rods are to be written; output.rods_every = 1 \
             takes every output",
            named.source
        )));
    }
    let beside = args.checkpoint.as_ref().map_or(0, |_| Halfway::bytes(&plan));
    memory::check_beside(&plan, args.threads.given, args.vtk, &named.source, beside)?;
    let out = args.out.clone().unwrap_or_else(|| Path::new("out").join(&named.stem));
    let inputs = inputs(args, &plan);
    agree("run", inputs.clone())?;
    let path = args.checkpoint.as_deref();
    let path = path.map(|path| checkpoint::check(path, &out)).transpose()?;
    let bytes = tables::most_bytes(&plan).saturating_add(rods::most_bytes(&plan, args.vtk));
    let names = names(&plan, args.vtk);
    if cluster::is_root() {
        spares_inputs(&out, &names, read)?;
    }
    probe(&out, bytes)?;
    let checkpoint = open_checkpoint(args, &plan, path.as_deref())?;
    let folder = ResultFolder::new(&out, "run", inputs, args.writing.force).from_any_input();
    if cluster::is_root() {
        folder.check(&names)?;
    }
    let replaced = folder.difference();
    scene::warn(&named.source, &facts::warnings(&plan));
    let mut seconds = Seconds { plan: start.elapsed().as_secs_f64(), ..Seconds::default() };

    if let Some(replicas) = &checkpoint {
        begin(args, replicas)?;
    }
    let first = if args.until.is_empty() { plan.scene().ensemble.replicas } else { LEAST };
    let bar = progress(first, "replicas", args.writing.quiet);
    bar.inc(checkpoint.as_ref().map_or(0, |replicas| replicas.progress().done));
    let start = Instant::now();
    let threads = threads::count(args.threads.given)? as usize;
    let work = Work { args, plan: &plan, bar: &bar, threads };
    let results = match &checkpoint {
        Some(replicas) => work.kept(replicas).map(Some),
        None => on_threads(args.threads.given, || work.alone())?,
    };
    bar.finish_and_clear();
    let Some((results, until)) = ended(&named.source, results)? else {
        return Ok(());
    };
    let plan = until.as_ref().map_or(plan.clone(), |until| plan.with_replicas(until.replicas));
    seconds.run = start.elapsed().as_secs_f64();

    let start = Instant::now();
    let mut files = files(&plan, &results).map_err(Failure::Failed)?;
    files.extend(rods::files(&plan, &results, args.vtk));
    seconds.tables_and_pictures = start.elapsed().as_secs_f64();
    let names = files.iter().map(|(name, _)| name.as_str()).collect();
    let record = record::json(&plan, &results, threads, seconds, names, until.as_ref()).map_err(Failure::Failed)?;
    files.push((RUN.to_owned(), record));
    let names: Vec<_> = files.iter().map(|(name, _)| name.clone()).collect();
    folder.write(files)?;
    if !args.writing.quiet {
        let until = until.as_ref().map(|until| format!("{}\n\n", until.text())).unwrap_or_default();
        let replaced = replaced.map(|difference| format!("(replaced an earlier run: {difference})\n"));
        print(&format!(
            "{}\nMeans ± standard errors, rods: {}, replicas: {}\n\n{}{until}in {}: {}\n{}",
            line(&scene.title),
            scene.particles.count,
            plan.scene().ensemble.replicas,
            tables::summary(&results),
            out.shown(),
            names.join(", "),
            replaced.unwrap_or_default()
        ))?;
    }
    until.map_or(Ok(()), |until| until.failure())
}

/// Adds the scene's name to the error of a stopped run, which writes nothing, so that earlier results stay.
fn ended<T>(source: &str, results: Result<T, Error>) -> Result<T, Failure> {
    results.map_err(|error| Failure::Input(format!("{source}: {error}")))
}

/// The file with the scene, plan, counters and times of a run.
const RUN: &str = "run.json";

/// The names of the files of a run, except those of single times of its rods.
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
            "my.toml: rod 7 would become non-finite in step 41 of replica 2, seed 3: a contact arm of 1e-320 rod \
             lengths turned it by inf rad"
        );
    }
}
