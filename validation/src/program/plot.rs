//! `shearbed plot`: one picture of a channel from several runs, or from the points of a sweep.

mod folders;
mod table;

use super::{Failure, print, scene};
use crate::files::output;
use crate::files::text::Shown;
use crate::present::plot::{self, Figure};
use folders::runs_in;
use std::path::{Path, PathBuf};
use table::MOST_ROWS;

/// Arguments of `plot`.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  shearbed plot first second --y x1 --out both.svg")]
pub(super) struct Args {
    /// Folders of `shearbed run`, or of `shearbed sweep`, whose points are all drawn
    #[arg(required = true, value_name = "DIR")]
    dirs: Vec<PathBuf>,
    /// The column to draw, as x1, phi or a12 [default: the first of the first table]
    #[arg(long = "y", value_name = "CHANNEL")]
    channel: Option<String>,
    /// The picture, whose name ends in .svg or .png
    #[arg(long, value_name = "FILE", default_value = "out/plot.svg", value_parser = picture)]
    out: PathBuf,
    /// Overwrite an existing picture
    #[arg(long)]
    force: bool,
}

fn picture(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    match path.extension().and_then(|extension| extension.to_str()) {
        Some("svg" | "png") => Ok(path),
        _ => Err("a name that ends in .svg or .png is allowed; no other format is written".to_owned()),
    }
}

/// Draws a channel of every folder.
pub(super) fn plot(args: &Args) -> Result<(), Failure> {
    let (figure, runs) = figure(&args.dirs, args.channel.as_deref())?;
    write(&args.out, &figure, args.force)?;
    print(&format!("{} of {runs} runs in {}\n", figure.y_name, args.out.shown()))
}

/// A channel of every folder, the first that there is where none is asked for, and how many runs that is of.
pub(super) fn figure(dirs: &[PathBuf], channel: Option<&str>) -> Result<(Figure, usize), Failure> {
    let mut runs = Vec::new();
    for dir in dirs {
        runs.extend(runs_in(dir)?);
    }
    let mut wanted = channel.map(str::to_owned);
    let mut found = Vec::new();
    let mut rows = MOST_ROWS;
    for run in &runs {
        let of_run = table::channel(run, wanted.as_deref(), &mut rows)?;
        // What the first has is asked of the others.
        wanted.get_or_insert_with(|| of_run.channel.clone());
        found.push(of_run);
    }
    let (Some(first), Some(scene)) = (found.first(), runs.first().map(|run| &run.scene)) else {
        return Err(Failure::Input("plot: no run was found in these folders".into()));
    };
    if let Some(k) = found.iter().position(|other| other.time != first.time) {
        return Err(Failure::Input(format!(
            "{}: its time is {}, that of {} is {}: one of the two can be drawn",
            runs[k].dir.shown(),
            found[k].time,
            runs[0].dir.shown(),
            first.time
        )));
    }
    let figure = Figure {
        title: match runs.len() {
            1 => scene.title.clone(),
            count => format!("{}: {count} runs", first.channel),
        },
        x_name: first.time.replace("t_over_T", "t/T"),
        y_name: first.channel.clone(),
        curves: found.into_iter().map(|found| found.curve).collect(),
        ..Figure::default()
    };
    Ok((figure, runs.len()))
}

fn write(out: &Path, figure: &Figure, force: bool) -> Result<(), Failure> {
    let name = out.to_string_lossy();
    let contents = match name.ends_with(".png") {
        false => plot::svg(figure).map_err(Failure::Failed)?.into_bytes(),
        true => {
            let plot::Png { bytes, missing } = plot::png(figure).map_err(Failure::Failed)?;
            if !missing.is_empty() {
                let missing = String::from_iter(missing);
                let lacking = format!(
                    "PNG pictures have no letters for {missing:?}; boxes stand for them, SVG has them"
                );
                scene::warn(&out.shown(), &[lacking]);
            }
            bytes
        }
    };
    Ok(output::write_one(out, &contents, force)?)
}
