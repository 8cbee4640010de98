//! `shearbed converge`.

use super::duration::Long;
use super::scene::{Chosen, Ensemble};
use super::{
    Failure, Threads, Writing, agree, duration, memory, on_threads, progress, refuse, result_folder, scene,
    spares_inputs, whole,
};
use serde::Serialize;
use serde_json::json;
use shearbed::Scene;
use shearbed::model::jeffery::strain_per_period;
use shearbed::plan::Stage;
use shearbed::scene::{MAX_REPLICAS, Time};
use shearbed_validation::files::output::Output;
use shearbed_validation::files::text::complain;
use shearbed_validation::files::{build, cluster};
use shearbed_validation::present::plot;
use shearbed_validation::present::table::{ReportTable, rows_csv};
use shearbed_validation::studies::speed::SECONDS_PER_INTEGRATOR_STEP;
use shearbed_validation::studies::suspensions::interacting::splits_table;
use shearbed_validation::studies::suspensions::law::{self, Law, Replicas};
use shearbed_validation::studies::suspensions::law_tables;
use shearbed_validation::studies::suspensions::split::{Constants, Scope, Split, TARGETS};
use shearbed_validation::studies::work_precision::order::{self, OrderVerdict};
use shearbed_validation::studies::work_precision::rows::orders_csv;
use shearbed_validation::studies::work_precision::study::{orders_figure, orders_table};
use std::path::{Path, PathBuf};

#[derive(clap::Args)]
#[command(after_help = "Example:\n  shearbed converge fig4-n50 --replicas 20")]
pub(super) struct Args {
    #[command(flatten)]
    chosen: Chosen,
    /// The folder for the tables and converge.json [default: out/converge-<scene>]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Replicas, 2 or more, at every step and number of rods [default: as many as some three minutes
    /// of one core allow, fewer at fine steps]
    #[arg(long, value_name = "N", value_parser = whole(2, MAX_REPLICAS), allow_negative_numbers = true)]
    replicas: Option<u64>,
    #[command(flatten)]
    threads: Threads,
    #[command(flatten)]
    long: Long,
    #[command(flatten)]
    writing: Writing,
}

/// Studies a scene: an interacting one by the law of its mean and directions, a free one by every fixed-step
/// integrator.
pub(super) fn converge(args: &Args) -> Result<(), Failure> {
    let named = args.chosen.load(&Ensemble::default(), &[])?;
    let at = |message: String| format!("{}: {message}", named.source);
    let plan = named.plan()?;
    if plan.runs(Stage::Contacts) && !law::judges(&plan) {
        let (key, steps) = (named.scene.time.unit.steps_key(), named.scene.steps_per_unit());
        let (half, quarter) = (2 * steps, 4 * steps);
        return Err(Failure::Input(at(format!(
            "converge of interacting rods needs plane Couette flow, only ∂u_2/∂x_1 other than 0, and no \
             particles.rods; else halve the time step and compare: sweep --over {key}={steps},{half},{quarter}"
        ))));
    }
    let out = (args.out.clone()).unwrap_or_else(|| Path::new("out").join(format!("converge-{}", named.stem)));
    let input = json!({ "scene": named.scene.resolved(), "replicas": args.replicas });
    agree("converge", input.clone())?;
    let names = ["converge.csv", "converge.svg", "converge.json", "times.csv", "replicas.csv"];
    spares_inputs(&out, &names, named.files())?;
    let folder = result_folder(&out, ("converge", input, args.writing.force), 0, &names)?;
    let replicas = args.replicas.map_or(Replicas::CONVERGE, Replicas::Each);
    let couette = plan.flow().shear_rate_per_s().is_some();
    let scene = if couette { law::by_periods(&plan) } else { named.scene.clone() };
    let done = match plan.runs(Stage::Contacts) {
        true => {
            let warnings = [plan.warnings(), other_end(&named.scene, &scene)].concat();
            scene::warn(&named.source, &warnings);
            on_threads(args.threads.given, || interacting(&scene, replicas, warnings, args))?
        }
        // Of most rods this takes a second, so that the root does it alone.
        false if cluster::is_root() => {
            let why = "rods that do not interact have no replicas to compare; the flag is for interacting ones";
            refuse(args.replicas, |replicas| format!("--replicas {replicas}: {why}"))
                .and_then(|()| free(&scene, &named.source, args))
                .map(Some)
        }
        false => Ok(None),
    }
    .map_err(|failure| match failure {
        Failure::Input(message) => Failure::Input(at(message)),
        Failure::Failed(message) => Failure::Failed(at(message)),
    })?;
    let Some(done) = done else {
        return Ok(());
    };
    let text: String = done.tables.iter().map(ReportTable::for_terminal).collect();
    args.writing.write(&folder, done.files, &text)?;
    match done.wrong {
        None => Ok(()),
        Some(names) => Err(Failure::Failed(at(format!("the observed order is not that of theory: {names}")))),
    }
}

struct Done {
    tables: Vec<ReportTable>,
    files: Vec<Output>,
    /// The integrators whose order differs from theory.
    wrong: Option<String>,
}

fn done(tables: Vec<ReportTable>, files: Vec<(&str, Result<String, String>)>) -> Result<Done, Failure> {
    let written = |(name, text): (&str, Result<String, String>)| Ok((name.to_owned(), text?));
    let files: Result<_, _> = files.into_iter().map(written).collect();
    Ok(Done { tables, files: files.map_err(Failure::Failed)?, wrong: None })
}

/// Studies every fixed-step integrator on one rod of the scene's mean aspect ratio, from its start, for its number of
/// periods.
fn free(scene: &Scene, source: &str, args: &Args) -> Result<Done, Failure> {
    let shear_rate_per_s = scene.flow.shear_rate_per_s().ok_or_else(|| {
        Failure::Input(
            "flow: converge compares integrators of free rods in plane Couette flow; give shear_rate_per_s".into(),
        )
    })?;
    refuse(Some(scene.particles.rotary_diffusion_per_s).filter(|d_r| *d_r > 0.0), |d_r| {
        format!("particles.rotary_diffusion_per_s = {d_r}: converge compares integrators of free rods; 0 is allowed")
    })?;
    let seconds = order::steps_of_scene(scene, shear_rate_per_s) * SECONDS_PER_INTEGRATOR_STEP;
    args.long.refuse("", seconds, 1)?;
    if !args.writing.quiet && seconds > 5.0 {
        let about = duration::about(seconds);
        complain(&format!("a step has to resolve the flip: {about} of one core; nothing is saved before it ends\n"));
    }
    let orders = order::of_scene(scene, shear_rate_per_s);
    let (csv, json) = (orders_csv(&orders.studies), build::json(&orders));
    let picture = plot::svg(&orders_figure(&orders).figure);
    let which = |verdict: OrderVerdict| -> Vec<&str> {
        let found = orders.studies.iter().filter(|study| study.found == verdict);
        found.map(|study| study.integrator.as_str()).collect()
    };
    let (coarse, wrong) = (which(OrderVerdict::TooCoarse), which(OrderVerdict::Not));
    let too_coarse = (!coarse.is_empty())
        .then(|| format!("too far off at every step to show an order: {}; fewer periods show one", coarse.join(", ")));
    scene::warn(source, &too_coarse);
    let files = vec![("converge.csv", csv), ("converge.svg", picture), ("converge.json", json)];
    Ok(Done { wrong: (!wrong.is_empty()).then(|| wrong.join(", ")), ..done(vec![orders_table(&orders)], files)? })
}

/// Sentences where the scene has another end or other steps than the study's runs; `by_periods` is it in periods.
fn other_end(scene: &Scene, by_periods: &Scene) -> Vec<String> {
    let end = law::end(by_periods);
    let time = Some(&scene.time).filter(|_| (end / by_periods.time.duration - 1.0).abs() > 1e-5);
    let said = |time: &Time| {
        let why = format!("the runs of this study end after {end} periods: whole quarters, and 10 at most");
        format!("{} = {} is not used: {why}", time.unit.duration_key(), time.duration)
    };
    let (exact, own) = (by_periods.steps_per_unit(), law::own(by_periods).steps_per_period);
    let steps = (exact != own)
        .then(|| format!("this study takes {own} steps a period, not {exact}: a step ends where its runs end"));
    time.map(said).into_iter().chain(steps).collect()
}

/// The content of converge.json for an interacting scene.
#[derive(Serialize)]
struct Written {
    warnings: Vec<String>,
    law: Law,
    constants: Option<Constants>,
    splits: Vec<Split>,
}

/// Studies X̄₁ and the directions of an interacting scene against steps, rods and replicas, and derives the cost of
/// accuracy; `None` except on the root.
fn interacting(scene: &Scene, replicas: Replicas, warnings: Vec<String>, args: &Args) -> Result<Option<Done>, Failure> {
    let jobs = law::jobs(scene, replicas);
    memory::check_jobs(&jobs, args.threads.given)?;
    args.long.check_jobs(args.threads.given, &jobs)?;
    if !args.writing.quiet && cluster::is_root() {
        complain(&format!("{}; nothing is saved before it ends\n", duration::of_jobs(&jobs)));
    }
    let bar = progress(jobs.iter().map(|job| job.replicas).sum(), "replicas", args.writing.quiet);
    let found = cluster::share(jobs.len(), |k| jobs[k].run(&|| bar.inc(1)), |_, _| Ok(()));
    bar.finish_and_clear();
    let Some(found) = found.map_err(Failure::Failed)? else {
        return Ok(None);
    };
    let law = law::read(scene, &jobs, &found);
    let mut tables = law_tables::law(&law, strain_per_period(scene.particles.aspect_ratio)).to_vec();
    // Without the tables that too few replicas leave empty.
    tables.retain(|table| !table.rows.is_empty());
    let constants = Constants::of(&law);
    let scopes = [Scope::OwnRods(scene.particles.count), Scope::Unbounded];
    let splits: Vec<_> = (constants.iter())
        .flat_map(|constants| scopes.map(|scope| TARGETS.map(|target| constants.cheapest(scope, target))))
        .flatten()
        .collect();
    tables.extend((constants.iter()).map(|constants| splits_table(constants, &splits, law.end)));
    let picture = plot::svg(&law_tables::steps_figure(&law).figure);
    let (csv, blocks) = (law_tables::law_csv(&law), rows_csv(law.blocks.iter().copied()));
    let times = law_tables::times_csv(&law);
    let json = build::json(&Written { warnings, law, constants, splits });
    let files = [
        ("converge.csv", csv),
        ("converge.svg", picture),
        ("times.csv", times),
        ("replicas.csv", blocks),
        ("converge.json", json),
    ];
    done(tables, files.into()).map(Some)
}
