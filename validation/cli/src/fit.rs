//! `shearbed fit`.

mod advice;
mod input;
mod shifts;
mod terminal;

use super::derived::{self, DERIVED, EXTREMES};
use super::duration::{Long, nodes, usual_runs};
use super::{
    Failure, Threads, Writing, checkpoint, log_progress, number, on_threads, progress_of_some, result_folder, scene,
    spares_inputs, whole,
};
use advice::{of_fit, of_scene, of_warning};
pub(super) use input::check_ranges;
use input::{Input, input};
use serde_json::{Value, json};
use shearbed::Plan;
use shearbed::plan::counted;
use shearbed::run::ensemble;
use shearbed::scene::{MAX_REPLICAS, MAX_SEED};
use shearbed_validation::files::build::BUILD;
use shearbed_validation::files::output::{Output, ResultFolder};
use shearbed_validation::files::text::{self, Shown, command};
use shearbed_validation::files::{FileError, bounded};
use shearbed_validation::input::experiment::MOST_BYTES;
use shearbed_validation::methods::least_squares::Datum;
use shearbed_validation::methods::least_squares::direct::Direct;
use shearbed_validation::present::plot;
use shearbed_validation::serve::fit::contents::{self, Contents};
use shearbed_validation::serve::fit::design::{Candidate, design};
use shearbed_validation::serve::fit::elsewhere::best_fit;
use shearbed_validation::serve::fit::error::{FitError, SceneError};
use shearbed_validation::serve::fit::report::{self, Report};
use shearbed_validation::serve::fit::runs::Runs;
use shearbed_validation::serve::fit::samples::samples_csv;
use shearbed_validation::serve::fit::scenes::{AS_WRITTEN, Scenes};
use shearbed_validation::serve::fit::search::{Fit, FitProblem, Watch};
use shearbed_validation::serve::fit::{Hypothesis, Range, pictures};
use shearbed_validation::serve::sweep::KeyValue;
use shifts::{shifts, taken_as_known};
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

/// The default of the largest number of replicas at each value of the parameters.
pub(super) const MOST_REPLICAS: u64 = 1000;

/// The least that may be given for it.
pub(super) const FEWEST_REPLICAS: u64 = 20;

#[derive(clap::Args)]
#[command(override_usage = "shearbed fit <SCENE> --data <FILE.csv> [--over <KEY=FROM:TO>] [OPTIONS]")]
#[command(after_help = "\
FILE.csv has the columns t_over_T (or t_s, strain), x1, x1_u, and as you like x2, x2_u, … (docs/src/user/fitting.md).
Examples:
  shearbed fit fig4-n50 --data points.csv --over interaction.alpha=0.05:5
  shearbed fit a.toml --data a.csv --data b.toml=b.csv --over interaction.m=1:6")]
pub(super) struct Args {
    /// A scene file, or the name of a built-in scene
    scene: OsString,
    /// Measured points of SCENE; SCENE2=FILE.csv: points of another scene, fitted with the same parameters, but for
    /// those of one set
    #[arg(long, value_name = "FILE.csv", required = true)]
    data: Vec<OsString>,
    /// One standard uncertainty for all points, in the unit of their column, for files without columns x1_u, …
    #[arg(long, value_name = "X", value_parser = positive, allow_negative_numbers = true)]
    u: Option<f64>,
    /// The files' columns in their order, - for one to leave out: t_s,-,x1,x1_u
    #[arg(long, value_name = "NAMES", value_delimiter = ',', allow_hyphen_values = true)]
    columns: Option<Vec<String>>,
    /// A key of the scene to fit, and the range to look in; up to three times. SET:KEY=FROM:TO: a value of its own for
    /// the scene of the first, second, … --data. Without it: how well the scene as it is describes the points
    #[arg(long, value_name = "[SET:]KEY=FROM:TO", value_parser = advice::range)]
    over: Vec<Range>,
    /// The folder for fit.json, tables and pictures [default: out/fit-<scene>; out/check-<scene> without --over]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// The most replicas at each value, 20 or more, four times the points; fewer run where the model's error is small
    #[arg(long, value_name = "N", default_value_t = MOST_REPLICAS, value_parser = whole(FEWEST_REPLICAS, MAX_REPLICAS),
        allow_negative_numbers = true)]
    replicas: u64,
    /// The seed of all random numbers, in place of the scene's own
    #[arg(long, value_name = "S", value_parser = whole(0, MAX_SEED), allow_negative_numbers = true)]
    seed: Option<u64>,
    /// Rods that each measured point is a mean over
    #[arg(long, value_name = "N", value_parser = whole(1, u64::MAX), allow_negative_numbers = true)]
    rods: Option<u64>,
    /// What u contains [default: reading]
    #[arg(long, value_name = "WHAT", value_parser = advice::contents(), requires_if("rods", "rods"))]
    u_contains: Option<Contents>,
    /// Test a value of a fitted key, or whether it has the same value in two sets
    /// (1:interaction.alpha=2:interaction.alpha); repeatable
    #[arg(long, value_name = "[SET:]KEY=VALUE", value_parser = Hypothesis::parse)]
    test: Vec<Hypothesis>,
    /// A key of every scene and the value to give it; repeatable
    #[arg(long = "set", value_name = "KEY=VALUE", value_parser = KeyValue::parse)]
    settings: Vec<KeyValue>,
    #[command(flatten)]
    threads: Threads,
    #[command(flatten)]
    kept: checkpoint::Kept,
    /// List further points, at all times and at half and twice the concentration, with the uncertainties that each
    /// would leave
    #[arg(long)]
    design: bool,
    /// Without a terminal: seconds between two lines about progress; for Python's `progress`
    #[arg(long, value_parser = checkpoint::seconds, default_value = "60", hide = true)]
    log_every: Duration,
    #[command(flatten)]
    long: Long,
    #[command(flatten)]
    writing: Writing,
}

/// The record of a fit.
const FIT: &str = "fit.json";

/// The results of a fit; of a scene as it is without a fit.
struct Done {
    fit: Option<Fit>,
    report: Report,
    warnings: Vec<String>,
    figures: Vec<(String, plot::Figure)>,
    /// Tables of what is derived from each set's curves.
    derived: Vec<Output>,
    candidates: Vec<Candidate>,
}

/// Fits keys of a scene to measured points.
pub(super) fn fit(args: &Args) -> Result<(), Failure> {
    let check =
        |test: &Hypothesis| test.check(&args.over).map_err(|error| Failure::Input(advice::of_test(test, &error)));
    args.test.iter().try_for_each(check)?;
    let mut input = input(args)?;
    check_duration(args, &input)?;
    let asked = asked(args, &input)?;
    let folder = folder(args, &input, &asked)?;
    let path = checkpoint::check(args.kept.file.as_deref(), folder.dir())?;
    let scenes = input.scenes.sets.iter().map(|set| json!({ "seed": set.seed, "text": set.text }));
    let scenes = json!({ "scenes": scenes.collect::<Vec<_>>() });
    let open = |path: PathBuf| Runs::open(&path, args.kept.every(), scenes);
    let runs = path.map(open).transpose()?;
    if let Some(runs) = runs.as_ref().filter(|runs| runs.count() > 0) {
        args.writing.print(&format!("goes on from {}\n", counted(runs.count() as u64, "finished run")))?;
    }
    input.scenes = input.scenes.with_runs(runs.clone());
    let usual = usual_runs(args.over.len(), args.replicas);
    let bar = progress_of_some(usual, "runs", args.writing.quiet);
    log_progress(&bar, "runs", args.log_every, args.writing.quiet);
    let planned = AtomicU64::new(0);
    let watch = Watch {
        stage: &|name| bar.set_message(name.to_owned()),
        planned: &|runs| bar.set_length(usual.max(runs + planned.fetch_add(runs, Ordering::Relaxed))),
        done: &|| bar.inc(1),
    };
    let done = on_threads(args.threads.given, || work(args, &input, &watch))?;
    // Before it is finished, which moves it to its end.
    let all = bar.position();
    bar.finish_and_clear();
    runs.as_ref().map_or(Ok(()), |runs| runs.write())?;
    write(args, &input, &folder, &asked, &done?, all)
}

/// Refuses a fit that may take days: as many replicas as are asked for at each value, at the ends of the ranges. The
/// default is a limit that few fits reach: with it the runs of usual fits count.
fn check_duration(args: &Args, input: &Input) -> Result<(), Failure> {
    let nodes = nodes(args.over.len());
    let usual = usual_runs(args.over.len(), args.replicas);
    let runs = if args.replicas == MOST_REPLICAS { usual } else { nodes * args.replicas };
    // Half of them at each end.
    let runs = runs / 2;
    let plans = input.plans_at_ends(&args.over)?;
    let cost: Vec<_> = plans.iter().map(|plan| (plan, runs)).collect();
    args.long.check(&input.stem, args.threads.given, &cost)
}

/// The folder for the results, which may replace none of the files that are read.
fn folder(args: &Args, input: &Input, asked: &Value) -> Result<ResultFolder, Failure> {
    // The points are often compared with a scene as it is after a fit, whose results stay.
    let what = if args.over.is_empty() { "check" } else { "fit" };
    let out = (args.out.clone()).unwrap_or_else(|| Path::new("out").join(format!("{what}-{}", input.stem)));
    let names =
        [FIT, "residuals.csv", "profiles.csv", "samples.csv", "design.csv", EXTREMES, DERIVED, super::plot::FIGURES];
    let scenes = input.scenes.sets.iter();
    let scenes = scenes.flat_map(|set| set.starts.files().chain([PathBuf::from(&set.source)]));
    spares_inputs(&out, &names, input.files.iter().cloned().chain(scenes))?;
    result_folder(&out, ("fit", asked.clone(), args.writing.force), 0, &names)
}

/// Writes the results and prints them; `runs` is the number of all runs.
fn write(
    args: &Args,
    input: &Input,
    folder: &ResultFolder,
    asked: &Value,
    done: &Done,
    runs: u64,
) -> Result<(), Failure> {
    let times = input.times();
    let files = files(args, done, &times).map_err(Failure::Failed)?;
    let names: Vec<&str> = std::iter::once(FIT).chain(files.iter().map(|(name, _)| name.as_str())).collect();
    let record = record(asked, input, done, &names)?;
    let names = names.join(", ");
    let replaced = crate::write(folder, &files.into_iter().chain([(FIT.into(), record)]).collect::<Vec<_>>())?;
    scene::warn(&input.stem, input.warnings.iter().chain(&done.warnings));
    let design = done.report.design.as_ref();
    let design =
        done.fit.as_ref().zip(design).map_or(String::new(), |(fit, steps)| terminal::design(fit, steps, &times) + "\n");
    let table = done.fit.as_ref().map_or(String::new(), |fit| terminal::table(fit, &done.report, runs) + "\n");
    let (sentence, tests) = (terminal::sentence(done.fit.as_ref(), &done.report), terminal::tests(&done.report));
    let place = folder.dir().shown();
    args.writing.print(&format!("{sentence}\n{tests}\n{table}{design}in {place}: {names}\n{replaced}"))
}

/// Tables and pictures.
fn files(args: &Args, done: &Done, times: &[&str]) -> Result<Vec<Output>, String> {
    let mut files: Vec<Output> = vec![("residuals.csv".into(), report::residuals_csv(&done.report, times)?)];
    if let Some(fit) = &done.fit {
        files.push(("profiles.csv".into(), report::profiles_csv(fit)?));
        files.push(("samples.csv".into(), samples_csv(fit)?));
        if args.design {
            files.push(("design.csv".into(), report::design_csv(fit, &done.candidates, times)?));
        }
    }
    files.extend(done.derived.iter().cloned());
    let figures = text::json(&done.figures).map_err(|error| error.to_string())?;
    files.push((super::plot::FIGURES.into(), figures));
    for (stem, figure) in &done.figures {
        files.push((format!("{stem}.svg"), plot::svg(figure)?));
    }
    Ok(files)
}

fn work(args: &Args, input: &Input, watch: &Watch<'_>) -> Result<Done, Failure> {
    let Input { scenes, data, .. } = input;
    let stopped = |error: FitError| Failure::Input(of_fit(&error));
    let refused = |error: SceneError| Failure::Input(of_scene(&error));
    let model_of = |scenes: &Scenes, data: &[Datum], values: &[f64]| advice::model(scenes, data, AS_WRITTEN, values);
    let model = |values: &[f64]| model_of(scenes, data, values);
    let from: Vec<f64> = args.over.iter().map(|range| range.from).collect();
    let count = |set| scenes.scene(set, &from).map(|scene| scene.particles.count as f64);
    let counts: Vec<f64> = (0..scenes.sets.len()).map(count).collect::<Result<_, _>>().map_err(refused)?;
    let rods = contents::rods(args.rods, args.u_contains, &counts);
    let problem = FitProblem {
        data,
        ranges: &args.over,
        rods: &rods,
        model: &model,
        most_replicas: if scenes.draw(data).map_err(refused)? { args.replicas } else { 1 },
    };
    if args.over.is_empty() {
        return as_written(input, &problem, watch);
    }
    let (fit, unsearched) = best_fit(&problem, watch).map_err(stopped)?;
    let shifts = shifts(input, &fit, &model, watch).map_err(Failure::Input)?;
    let mut report = report::report(&fit, data, shifts);
    report.warnings.extend(unsearched);
    report.warnings.extend(contents::warning(&fit, data, args.rods, args.u_contains, &counts));
    report.warnings.extend(scenes.moving_points());
    let test = |test: &Hypothesis| test.test(&fit).map_err(|error| Failure::Input(advice::of_test(test, &error)));
    report.tests = args.test.iter().map(test).collect::<Result<_, _>>()?;
    let mut warnings: Vec<String> = report.warnings.iter().map(of_warning).collect();
    warnings.extend(taken_as_known(&report));
    let mut candidates = Vec::new();
    if args.design {
        let found = design(&fit, scenes, data, &rods, &model_of, watch).map_err(stopped)?;
        warnings.extend(found.warnings.iter().map(of_warning));
        report.design = Some(found.steps);
        candidates = found.candidates;
    }
    warnings.extend(of_plans(input, &fit.values(&fit.best.place))?);
    let places = pictures::places(data);
    let drawn = |values: &[f64]| model_of(scenes, &places, values);
    let curves = pictures::best_curves(&fit, &places, &drawn, watch).map_err(Failure::Input)?;
    let drawn = (&places[..], &curves[..], plot::FITTED);
    let figures =
        pictures::of_points(&report, (data, &pictures::u_of_points(&fit)), drawn, &input.names, &input.times());
    let figures = figures.into_iter().chain(pictures::of_parameters(&fit)).collect();
    let derived = derived(input, &fit.values(&fit.best.place), fit.emulator.behind_covariance() as u64, watch)?;
    Ok(Done { fit: Some(fit), report, warnings, figures, derived, candidates })
}

/// The points beside the scene as it is.
fn as_written(input: &Input, problem: &FitProblem<'_>, watch: &Watch<'_>) -> Result<Done, Failure> {
    let FitProblem { data, rods, model, most_replicas, .. } = *problem;
    (watch.stage)("the scene as it is");
    let replica = model(&[]).map_err(Failure::Input)?;
    let rows = watch.replicas(most_replicas, |k| replica.run(k)).map_err(Failure::Input)?;
    let found = Direct::of(data, &rows, rods).ok_or("the covariance of the points is not positive");
    let found = found.map_err(|error| Failure::Input(error.into()))?;
    let report = report::as_written(data, &found, rods, rows.len()).map_err(Failure::Input)?;
    let mut warnings: Vec<String> = report.warnings.iter().map(of_warning).collect();
    warnings.extend(of_plans(input, &[])?);
    let places = pictures::places(data);
    let model = |values: &[f64]| advice::model(&input.scenes, &places, AS_WRITTEN, values);
    let curves = pictures::own_curves(&model, most_replicas, watch).map_err(Failure::Input)?;
    let drawn = (&places[..], &curves[..], "");
    let figures = pictures::of_points(&report, (data, &found.u_of_points()), drawn, &input.names, &input.times());
    let derived = derived(input, &[], most_replicas, watch)?;
    Ok(Done { fit: None, report, warnings, figures, derived, candidates: Vec::new() })
}

/// Tables of what is derived from the means of each set's scene with these values, up to its last point.
fn derived(input: &Input, values: &[f64], replicas: u64, watch: &Watch<'_>) -> Result<Vec<Output>, Failure> {
    let plans = input.plans(values)?;
    let mut files = Vec::new();
    for (set, plan) in plans.iter().enumerate() {
        let plan = plan.with_replicas(replicas.min(pictures::MOST_REPLICAS));
        let run = |replicas| ensemble::replicas_of(&plan, replicas, &watch.done);
        (watch.planned)(plan.scene().ensemble.replicas);
        let results = ensemble::fold(&plan, run).map_err(|error| Failure::Input(error.to_string()))?;
        for (name, text) in derived::files(&plan, &results, &derived::of(&plan, &results)).map_err(Failure::Failed)? {
            let of_set = name.replace(".csv", &format!("_{}.csv", set + 1));
            files.push((if plans.len() == 1 { name } else { of_set }, text));
        }
    }
    Ok(files)
}

/// The warnings of the scenes' plans with these values, each once.
fn of_plans(input: &Input, values: &[f64]) -> Result<Vec<String>, Failure> {
    let mut all: Vec<String> = input.plans(values)?.iter().flat_map(Plan::warnings).collect();
    all.dedup();
    Ok(all)
}

/// The inputs of a fit, on which all its results depend.
fn asked(args: &Args, input: &Input) -> Result<Value, Failure> {
    let mut data = Vec::new();
    for (set, path) in input.scenes.sets.iter().zip(&input.files) {
        let sum = bounded::length_and_crc32(path, MOST_BYTES);
        let (_, crc32) = sum.map_err(|error| FileError::unreadable(path, &error))?;
        data.push(json!({
            "scene": set.source, "file": path.display().to_string(), "crc32": crc32, "time": set.time,
            "seed": set.seed, "scene_text": set.text, "starts": set.starts.checksums()
        }));
    }
    let set = |setting: &KeyValue| format!("{}={}", setting.key, setting.value);
    let mut asked = json!({
        "data": data,
        "over": args.over,
        "set": args.settings.iter().map(set).collect::<Vec<_>>(),
        "rods": args.rods,
        "u_contains": args.u_contains,
        "most_replicas": args.replicas,
    });
    // Without these flags the record is the same as before they existed.
    if !args.test.is_empty() {
        asked["test"] = json!(args.test.iter().map(Hypothesis::text).collect::<Vec<_>>());
    }
    if let Some(u) = args.u {
        asked["u"] = json!(u);
    }
    if let Some(columns) = &args.columns {
        asked["columns"] = json!(columns);
    }
    Ok(asked)
}

fn positive(text: &str) -> Result<f64, String> {
    number(text, |number| number > 0.0 && number.is_finite(), "a finite number > 0")
}

/// The text of `fit.json`.
fn record(asked: &Value, input: &Input, done: &Done, files: &[&str]) -> Result<String, Failure> {
    let failed = |error: serde_json::Error| Failure::Failed(error.to_string());
    let mut record = serde_json::to_value(&done.report).map_err(failed)?;
    record["warnings"] = json!(input.warnings.iter().chain(&done.warnings).collect::<Vec<_>>());
    record["build"] = json!(BUILD);
    record["command"] = json!(command(super::words::words()));
    for (key, value) in asked.as_object().into_iter().flatten() {
        record[key] = value.clone();
    }
    record["files"] = json!(files);
    text::json(&record).map_err(failed)
}
