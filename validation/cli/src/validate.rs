//! `shearbed validate`.

use super::finished::{CaseResult, Finished, measured};
use super::{
    Failure, Threads, Writing, agree, checkpoint, choice, on_threads, print, progress, result_folder, scene, whole,
    write,
};
use serde_json::json;
use shearbed::scene::MAX_SEED;
use shearbed_validation::cases::catalogue;
use shearbed_validation::files::cluster;
use shearbed_validation::files::text::{Shown, command, complain};
use shearbed_validation::input::experiment;
use shearbed_validation::judge::accept::Verdict;
use shearbed_validation::judge::case::{Case, Effort, GATE_SEED, Outcome};
use shearbed_validation::present::report::{self, CaseRow, ReportStudy, Sections};
use shearbed_validation::present::study::Request;
use shearbed_validation::studies;
use shearbed_validation::studies::figures;
use std::path::PathBuf;

#[derive(clap::Args)]
#[command(after_help = "Example:\n  shearbed validate --case jeffery-period --out out/period")]
pub(super) struct Args {
    /// Run this case only; repeatable
    #[arg(long = "case", value_name = "NAME")]
    cases: Vec<String>,
    /// Run the cases with this tag: what they judge, or an equation as eq-15; repeatable
    #[arg(long = "tag", value_name = "TAG")]
    tags: Vec<String>,
    /// List the cases, with their tags and claims, and run none
    #[arg(long)]
    list: bool,
    /// More replicas and samples: the same cases, judged more sharply
    #[arg(long)]
    full: bool,
    /// The seed from which every case takes its random numbers
    #[arg(long, value_name = "S", value_parser = whole(0, MAX_SEED), default_value_t = GATE_SEED,
        allow_negative_numbers = true)]
    seed: u64,
    /// Keep finished cases and studies in this file, and skip those that it has
    #[arg(long, value_name = "FILE")]
    checkpoint: Option<PathBuf>,
    /// A folder with measured points, for the cases that compare with experiments
    #[arg(long, value_name = "DIR", value_parser = folder)]
    data: Option<PathBuf>,
    /// The folder for report.html, report.json, report.md and curves/
    #[arg(long, value_name = "DIR", default_value = "out/report")]
    out: PathBuf,
    #[command(flatten)]
    threads: Threads,
    #[command(flatten)]
    writing: Writing,
}

fn folder(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    match path.metadata() {
        Ok(metadata) if metadata.is_dir() => Ok(path),
        Ok(_) => Err("it is no folder; an existing folder is allowed".to_owned()),
        Err(error) => Err(format!("{error}; an existing folder is allowed")),
    }
}

/// Files of a report other than its curves and tables.
const PAGES: [&str; 4] = ["report.html", "report.json", "report.md", "junit.xml"];

/// Runs the cases and writes the report. If cases are chosen, the report contains only them.
pub(super) fn validate(args: Args) -> Result<(), Failure> {
    let chosen = choice::chosen(&args.cases, &args.tags)?;
    if args.list {
        return print(&choice::list(&chosen));
    }
    if let Some(data) = &args.data {
        // Invalid points are bad input, not a failed case.
        scene::warn("measured points", &experiment::check(data)?);
    }
    let names: Vec<_> = chosen.iter().map(|case| case.about.name).collect();
    let data = args.data.as_deref().map(experiment::digest).transpose()?;
    let input = json!({ "full": args.full, "seed": args.seed, "data": data });
    let mut agreed = input.clone();
    // A later version with other cases replaces a whole report of an earlier one.
    let runs_all = args.cases.is_empty() && args.tags.is_empty();
    agreed["cases"] = if runs_all { json!("all") } else { json!(names) };
    agree("validate", agreed.clone())?;
    let path = checkpoint::check(args.checkpoint.as_deref(), &args.out)?;
    let folder = result_folder(&args.out, ("validate", agreed, args.writing.force), 0, &PAGES)?;
    let finished = Finished::open(path.as_deref(), "validate", input, &args.writing)?;
    let effort = Effort { full: args.full, seed: args.seed, data: args.data };
    let (outcomes, sections) = on_threads(args.threads.given, || {
        let outcomes = outcomes(&chosen, &effort, finished.as_ref(), args.writing.quiet)?;
        let sections =
            if runs_all { gather(&effort, finished.as_ref(), args.writing.quiet)? } else { Some(Sections::default()) };
        Ok::<_, Failure>((outcomes, sections))
    })??;
    let (Some(outcomes), Some(sections)) = (outcomes, sections) else {
        return Ok(());
    };
    let report = report::build(outcomes, sections, &effort, command(super::words::words()));
    let mut files = report.data().map_err(Failure::Failed)?;
    let pages = [report.html().map_err(Failure::Failed)?, report.json(), report.markdown(), report.junit()];
    files.extend(PAGES.map(str::to_owned).into_iter().zip(pages));
    let replaced = write(&folder, &files)?;
    let red: String = report.cases.iter().map(CaseRow::reasons).collect();
    if !red.is_empty() && cluster::is_root() {
        // Printed even with --quiet: a failed case is an error.
        complain(&format!("\n{red}"));
    }
    let page = args.out.join("report.html");
    args.writing.print(&format!("\n{}\nreport: {}\n{replaced}", report.headline(), page.shown()))?;
    match report.exit_code() {
        0 => Ok(()),
        _ => Err(Failure::Failed(format!("not every case passed: {}", report.headline()))),
    }
}

/// Runs every study and collects the report's sections on the root; `None` elsewhere.
fn gather(effort: &Effort, finished: Option<&Finished>, quiet: bool) -> Result<Option<Sections>, Failure> {
    let mut sections = Sections { equations: catalogue::equations(), ..Default::default() };
    for study in studies::ALL {
        let run = || {
            if !quiet {
                print(&format!("study: {}\n", study.title))?;
            }
            // Only this study reports its pieces of work.
            let work = if study.name == figures::STUDY.name {
                figures::work(figures::Replicas::of(effort)).map_err(Failure::Failed)?
            } else {
                0
            };
            let bar = progress(work, "replicas", quiet || work == 0);
            let found = study.found(&Request { effort, wanted: &|_| true, finished: &|| bar.inc(1) });
            bar.finish_and_clear();
            found.map_err(Failure::Failed)
        };
        if let Some((found, seconds)) = measured(finished, study.name, run)? {
            sections.add(ReportStudy::new(&study, found, seconds));
        }
    }
    catalogue::name_judges(&mut sections);
    Ok(cluster::is_root().then_some(sections))
}

/// Runs the cases, each rank its part one after the other, and prints how each ended. All outcomes on the root, and
/// `None` elsewhere.
fn outcomes(
    chosen: &[Case],
    effort: &Effort,
    finished: Option<&Finished>,
    quiet: bool,
) -> Result<Option<Vec<Outcome>>, Failure> {
    let bar = progress(chosen.len() as u64, "cases", quiet);
    // Every rank has the cases' own descriptions.
    let run = |k: usize| {
        let case: &Case = &chosen[k];
        if let Some(found) = finished.and_then(|finished| finished.case(case.about.name)) {
            return Ok(found);
        }
        bar.set_message(case.about.name);
        let outcome = case.run(effort);
        Ok((outcome.verdict, outcome.evidence, outcome.controls, outcome.seconds))
    };
    let arrived = |k: usize, found: &CaseResult| {
        if !quiet {
            bar.suspend(|| print(&line(chosen[k].about.name, found.0, found.3)))?;
        }
        bar.inc(1);
        finished.map_or(Ok(()), |finished| finished.add_case(chosen[k].about.name, found))
    };
    let found = cluster::share(chosen.len(), run, arrived)?;
    bar.finish_and_clear();
    let outcome = |(case, found): (&Case, CaseResult)| {
        let (verdict, evidence, controls, seconds) = found;
        Outcome { about: case.about.clone(), verdict, evidence, controls, seconds }
    };
    Ok(found.map(|found| chosen.iter().zip(found).map(outcome).collect()))
}

fn line(name: &str, verdict: Verdict, seconds: f64) -> String {
    let verdict = match verdict {
        Verdict::Pass => "pass",
        Verdict::Fail => "FAIL",
        Verdict::Underpowered => "UNDER-POWERED",
        Verdict::NoData => "no data",
    };
    format!("{verdict:<14}  {name:<40}  {seconds:>7.2} s\n")
}
