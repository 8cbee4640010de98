//! `shearbed run`.

mod work;

use super::derived::{DERIVED, EXTREMES};
use super::duration::Long;
use super::record::Seconds;
use super::scene::{Chosen, Ensemble, Named};
use super::until::{self, LEAST, Until};
use super::{
    Failure, Threads, Writing, agree, checkpoint, derived, memory, pictures, progress, record, result_folder, rods,
    scene, spares_inputs, tables, threads,
};
use indicatif::ProgressBar;
use serde_json::{Value, json};
use shearbed::run::resume::Halfway;
use shearbed::scene::MAX_REPLICAS;
use shearbed::{Plan, Results};
use shearbed_validation::files::checkpoint::Replicas;
use shearbed_validation::files::cluster;
use shearbed_validation::files::output::{Output, ResultFolder};
use shearbed_validation::files::text::line;
use shearbed_validation::present::plot;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};
use work::Done;

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
    #[command(flatten)]
    kept: checkpoint::Kept,
    #[command(flatten)]
    long: Long,
    #[command(flatten)]
    writing: Writing,
}

/// The plan of the run; with rules for standard errors it allows the largest number of replicas.
fn planned(args: &Args, named: &Named) -> Result<Plan, Failure> {
    let plan = named.plan()?;
    args.until.check(&plan, named)?;
    if args.vtk && plan.rods_outputs().is_empty() {
        let why = "output.rods_at is missing: the times at which rods are to be written; output.rods_every = 1 takes \
                   every output";
        return Err(Failure::Input(format!("{}: --vtk: {why}", named.source)));
    }
    Ok(if args.until.is_empty() { plan } else { plan.with_replicas(MAX_REPLICAS) })
}

/// The inputs on which the results depend. Rules for standard errors replace the number of replicas.
fn inputs(args: &Args, plan: &Plan) -> Value {
    let mut scene = json!(plan.scene().resolved());
    if !args.until.is_empty() {
        let limit = args.time_limit.map(|limit| format!(", at most {} s", limit.as_secs_f64()));
        scene["ensemble"]["replicas"] = (args.until.input() + &limit.unwrap_or_default()).into();
    }
    json!({ "scene": scene })
}

/// A run that is ready to begin.
struct Run<'a> {
    args: &'a Args,
    named: Named,
    plan: Plan,
    threads: usize,
    folder: ResultFolder,
    checkpoint: Option<Arc<Replicas>>,
    bar: ProgressBar,
}

/// Runs a scene and writes its results.
pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let start = Instant::now();
    let run = Run::prepare(args)?;
    let plan = start.elapsed().as_secs_f64();
    let start = Instant::now();
    let Some(done) = run.replicas()? else { return Ok(()) };
    run.write(done, Seconds { plan, run: start.elapsed().as_secs_f64(), ..Seconds::default() })
}

impl<'a> Run<'a> {
    /// Loads and plans the scene, and refuses whatever would stop the run or its writing.
    fn prepare(args: &'a Args) -> Result<Self, Failure> {
        let named = args.chosen.load(&args.ensemble, &[])?;
        let plan = planned(args, &named)?;
        let beside = args.kept.file.as_ref().map_or(0, |_| Halfway::bytes(&plan));
        memory::check_each([(&plan, named.source.clone())], args.threads.given, args.vtk, beside)?;
        // Rules for standard errors may end any time after these, and a time limit after two.
        let replicas = match (args.until.is_empty(), args.time_limit) {
            (true, _) => plan.scene().ensemble.replicas,
            (false, None) => LEAST,
            (false, Some(_)) => 2,
        };
        args.long.check(&named.source, args.threads.given, &[(&plan, replicas)])?;
        let out = args.out.clone().unwrap_or_else(|| Path::new("out").join(&named.stem));
        let inputs = inputs(args, &plan);
        agree("run", inputs.clone())?;
        let path = checkpoint::check(args.kept.file.as_deref(), &out)?;
        let names = names(&plan, args.vtk);
        if cluster::is_root() {
            spares_inputs(&out, &names, named.files())?;
        }
        let bytes = tables::most_bytes(&plan).saturating_add(rods::most_bytes(&plan, args.vtk));
        let folder = result_folder(&out, ("run", inputs, args.writing.force), bytes, &names)?;
        let checkpoint = path.map(|path| Replicas::open(&plan, &path, args.kept.every())).transpose()?;
        scene::warn(&named.source, &plan.warnings());
        let threads = threads::count(args.threads.given)? as usize;
        if let Some(replicas) = &checkpoint {
            work::begin(args, replicas)?;
        }
        let first = if args.until.is_empty() { plan.scene().ensemble.replicas } else { LEAST };
        let bar = progress(first, "replicas", args.writing.quiet);
        Ok(Self { args, named, plan, threads, folder, checkpoint, bar })
    }

    /// Writes the results and prints their summary.
    fn write(self, (results, until): Done, mut seconds: Seconds) -> Result<(), Failure> {
        let plan = until.as_ref().map_or(self.plan.clone(), |until| self.plan.with_replicas(until.replicas));
        let start = Instant::now();
        let mut files = files(&plan, &results).map_err(Failure::Failed)?;
        let derived = derived::of(&plan, &results);
        files.extend(derived::files(&plan, &results, &derived).map_err(Failure::Failed)?);
        files.extend(rods::files(&plan, &results, self.args.vtk));
        seconds.tables_and_pictures = start.elapsed().as_secs_f64();
        let names = files.iter().map(|(name, _)| name.as_str()).collect();
        let record = record::json(&plan, &results, self.threads, seconds, names, until.as_ref());
        files.push((RUN.to_owned(), record.map_err(Failure::Failed)?));
        let text = format!(
            "{}\nMeans ± standard errors, rods: {}, replicas: {}\n\n{}{}{}",
            line(&self.named.scene.title),
            self.named.scene.particles.count,
            plan.scene().ensemble.replicas,
            tables::summary(&results),
            derived::summary(&plan, &results, &derived),
            until.as_ref().map(|until| format!("{}\n\n", until.text())).unwrap_or_default(),
        );
        self.args.writing.write(&self.folder, files, &text)?;
        until.map_or(Ok(()), |until| until.failure())
    }
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
    let others = [Some(RUN), Some(EXTREMES), Some(DERIVED), rods, vtk].into_iter().flatten();
    of_each.chain(others.map(str::to_owned)).collect()
}

/// A table and the pictures of each observable.
fn files(plan: &Plan, results: &Results) -> Result<Vec<Output>, String> {
    let mut files = Vec::new();
    for series in &results.series {
        files.push((format!("{}.csv", series.observable.name()), tables::csv(results, series)?));
        for (stem, figure) in pictures::figures(plan, results, series) {
            files.push((format!("{stem}.svg"), plot::svg(&figure)?));
        }
    }
    Ok(files)
}
