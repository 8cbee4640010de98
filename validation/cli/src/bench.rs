//! `shearbed bench`: runs the studies that have named parts, alone and with longer measurements.

use super::finished::{Finished, measured};
use super::{Failure, Writing, checkpoint, on_threads, progress, refuse, result_folder};
use serde_json::json;
use shearbed_validation::judge::case::Effort;
use shearbed_validation::present::plot;
use shearbed_validation::present::report::figure_csv;
use shearbed_validation::present::study::Request;
use shearbed_validation::studies;
use std::path::PathBuf;

#[derive(clap::Args)]
#[command(after_help = "Example:\n  shearbed bench --case re11.6")]
pub(super) struct Args {
    /// Run this bench only, as re11.6, fig7-n50 or speed; repeatable
    #[arg(long = "case", value_name = "NAME")]
    cases: Vec<String>,
    /// Keep finished studies in this file, and skip those that it has
    #[arg(long, value_name = "FILE")]
    checkpoint: Option<PathBuf>,
    /// The folder for the tables, their data and the pictures
    #[arg(long, value_name = "DIR", default_value = "out/bench")]
    out: PathBuf,
    #[command(flatten)]
    writing: Writing,
}

/// Measures errors against run times, one bench after the other: for a rod on one core, and for suspensions by runs on
/// all cores with the time of one. Measures the speed of the core, too.
pub(super) fn bench(args: &Args) -> Result<(), Failure> {
    check(&args.cases)?;
    let wanted = |name: &str| args.cases.is_empty() || args.cases.iter().any(|case| case == name);
    let input = json!({ "cases": args.cases });
    let path = checkpoint::check(args.checkpoint.as_deref(), &args.out)?;
    let folder = result_folder(&args.out, ("bench", input.clone(), args.writing.force), 0, &[""; 0])?;
    let finished = Finished::open(path.as_deref(), "bench", input, &args.writing)?;
    let effort = Effort { full: true, ..Effort::gate() };
    let (mut files, mut tables) = (Vec::new(), String::new());
    let bar = progress(1, "", args.writing.quiet);
    for study in studies::ALL {
        if !study.parts.iter().any(|name| wanted(name)) {
            continue;
        }
        bar.set_message(study.title);
        let found = || study.found(&Request { effort: &effort, wanted: &wanted, finished: &|| () });
        let run = || on_threads(None, found)?.map_err(Failure::Failed);
        let Some((found, _)) = measured(finished.as_ref(), study.name, run)? else { continue };
        // A study without records of its own has the curves of its figures.
        let bare = found.files.is_empty();
        files.extend(found.files);
        for exhibit in found.exhibits {
            if let Some(figure) = exhibit.figure {
                let svg = plot::svg(&figure.figure).map_err(Failure::Failed)?;
                files.push((format!("{}.svg", figure.name), svg));
                if bare {
                    let curves = figure_csv(&figure.figure).map_err(Failure::Failed)?;
                    files.push((format!("{}.csv", figure.name), curves));
                }
            }
            tables.extend(exhibit.table.map(|table| table.for_terminal()));
        }
    }
    bar.finish_and_clear();
    args.writing.write(&folder, files, &tables)
}

/// Refuses names that no bench has; `names` are the arguments of `--case`.
fn check(names: &[String]) -> Result<(), Failure> {
    let known: Vec<_> = studies::ALL.iter().flat_map(|study| study.parts).copied().collect();
    refuse(names.iter().find(|name| !known.contains(&name.as_str())), |unknown| {
        format!("--case {unknown}: no bench has this name; there are {}", known.join(", "))
    })
}
