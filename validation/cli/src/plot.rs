//! `shearbed plot`: one picture of a channel from several runs or the points of a sweep, or a picture of a fit or a
//! report.

mod against;
mod folders;
mod look;
mod measured;
mod table;

use super::{Failure, ending_in, number, print, scene, spares};
use against::against;
pub(super) use folders::FIGURES;
use folders::{Run, kept, runs_in};
use look::Look;
use shearbed_validation::files::output;
use shearbed_validation::files::text::Shown;
use shearbed_validation::present::plot::{self, Figure, names};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use table::MOST_ROWS;

/// Arguments of `plot`.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  shearbed plot first second --y x1 --out both.svg")]
pub(super) struct Args {
    /// Folders of `shearbed run`, or of `shearbed sweep`, whose points are all drawn; or one of `shearbed fit` or
    /// `validate`
    #[arg(required = true, value_name = "DIR")]
    dirs: Vec<PathBuf>,
    /// The column to draw, as x1, phi or a12 [default: the first of the first table]; of a fit or a report, the
    /// picture's name
    #[arg(long = "y", value_name = "CHANNEL")]
    channel: Option<String>,
    /// A key of a sweep to draw its channel against, at the last output
    #[arg(long = "x", value_name = "KEY", conflicts_with = "data")]
    key: Option<String>,
    /// With --x: the time of another output
    #[arg(long, value_name = "TIME", requires = "key", value_parser = time, allow_negative_numbers = true)]
    at: Option<f64>,
    /// Measured points to draw over the curves, in the columns that `shearbed fit` takes
    #[arg(long, value_name = "FILE.csv")]
    data: Option<PathBuf>,
    #[command(flatten)]
    look: Look,
    /// The picture, whose name ends in .svg, .png or .pdf
    #[arg(long, value_name = "FILE", default_value = "out/plot.svg", value_parser = picture)]
    out: PathBuf,
    /// Overwrite an existing picture
    #[arg(long)]
    force: bool,
}

fn time(text: &str) -> Result<f64, String> {
    number(text, |_| true, "a finite number")
}

fn picture(text: &str) -> Result<PathBuf, String> {
    ending_in(&["svg", "png", "pdf"], ".svg, .png or .pdf", text)
}

/// Draws a channel of every folder, or a picture stored in a folder.
pub(super) fn plot(args: &Args) -> Result<(), Failure> {
    spares(&args.out, [args.out.clone()], args.data.clone())?;
    let (mut figure, said) = match &args.dirs[..] {
        [dir] => match kept(dir)? {
            Some(kept) => named(args, dir, kept)?,
            None => of_runs(args)?,
        },
        _ => of_runs(args)?,
    };
    args.look.apply(&mut figure)?;
    scene::warn(&args.out.shown(), &args.look.warnings(&figure));
    write(&args.out, &figure, args.force)?;
    print(&format!("{said} in {}\n", args.out.shown()))
}

fn of_runs(args: &Args) -> Result<(Figure, String), Failure> {
    let drawn = figure(&args.dirs, args.channel.as_deref())?;
    if let Some(key) = &args.key {
        if args.dirs.len() > 1 {
            let message = format!("--x {key}: {} folders are given; one sweep is allowed", args.dirs.len());
            return Err(Failure::Input(message));
        }
        let said = format!("{} of {} points", drawn.channel, drawn.runs.len());
        return Ok((against(drawn, key, args.at)?, said));
    }
    let mut figure = drawn.figure;
    if let Some(path) = &args.data {
        figure.points.push(measured::points(path, &drawn.runs, &drawn.channel)?);
    }
    Ok((figure, format!("{} of {} runs", drawn.channel, drawn.runs.len())))
}

/// The requested picture of a fit or a report, by default the first.
fn named(args: &Args, dir: &Path, kept: Vec<(String, Figure)>) -> Result<(Figure, String), Failure> {
    if let Some(key) = &args.key {
        return Err(Failure::Input(format!(
            "--x {key}: {} is no sweep; a folder of `shearbed sweep` is allowed",
            dir.shown()
        )));
    }
    if args.data.is_some() {
        return Err(Failure::Input(format!(
            "--data: {} is no run; a folder of `shearbed run` is allowed",
            dir.shown()
        )));
    }
    if kept.is_empty() {
        return Err(Failure::Input(format!(
            "{}: has no picture: `validate` draws them where it runs all cases",
            dir.shown()
        )));
    }
    let names = kept.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>().join(", ");
    let is_it = |(name, _): &(String, Figure)| args.channel.as_ref().is_none_or(|asked| asked == name);
    let found = kept.into_iter().find(is_it).ok_or_else(|| {
        let asked = args.channel.as_deref().unwrap_or("its first");
        Failure::Input(format!("--y {asked}: {} has no such picture; there are {names}", dir.shown()))
    })?;
    Ok((found.1, format!("{} of {}", found.0, dir.shown())))
}

/// A picture of a channel for several runs.
pub(super) struct Drawn {
    pub(super) figure: Figure,
    channel: String,
    /// The runs, at least one.
    runs: Vec<Run>,
}

/// A channel of every folder; by default the first channel of the first folder.
pub(super) fn figure(dirs: &[PathBuf], channel: Option<&str>) -> Result<Drawn, Failure> {
    let mut runs = Vec::new();
    for dir in dirs {
        runs.extend(runs_in(dir)?);
    }
    let mut wanted = channel.map(str::to_owned);
    let mut found = Vec::new();
    let mut rows = MOST_ROWS;
    for run in &runs {
        let of_run = table::channel(run, wanted.as_deref(), &mut rows)?;
        // The first run's channel is required of the others.
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
    let channel = first.channel.clone();
    let titles: BTreeSet<&str> = runs.iter().map(|run| run.scene.title.as_str()).collect();
    let mut figure = Figure {
        title: match titles.len() {
            1 => scene.title.clone(),
            _ => format!("{} of {} scenes", names::channel(&channel), titles.len()),
        },
        x_name: names::time(&first.time),
        y_name: names::channel(&channel),
        curves: found.into_iter().map(|found| found.curve).collect(),
        ..Figure::default()
    };
    // Scenes of different titles are labelled by them.
    if runs.len() > 1 && titles.len() == runs.len() {
        for (curve, run) in figure.curves.iter_mut().zip(&runs) {
            curve.label.clone_from(&run.scene.title);
        }
    }
    Ok(Drawn { figure, channel, runs })
}

fn write(out: &Path, figure: &Figure, force: bool) -> Result<(), Failure> {
    let target = output::followed(out);
    if picture(&target.to_string_lossy()).is_err() {
        let why = format!("{}: is a link to {}, which is no picture", out.shown(), target.shown());
        return Err(Failure::Input(why));
    }
    Ok(output::write_one(out, &drawn(out, figure)?, force)?)
}

/// The bytes of a picture in the format of its file's ending.
pub(super) fn drawn(out: &Path, figure: &Figure) -> Result<Vec<u8>, Failure> {
    let drawn = match out.extension().and_then(|extension| extension.to_str()) {
        Some("png") => plot::png(figure),
        Some("pdf") => plot::pdf(figure),
        _ => plot::svg(figure).map(|text| plot::Drawing { bytes: text.into_bytes(), missing: BTreeSet::new() }),
    };
    let plot::Drawing { bytes, missing } = drawn.map_err(Failure::Failed)?;
    if !missing.is_empty() {
        let missing = String::from_iter(missing);
        let lacking =
            format!("PNG and PDF pictures have no letters for {missing:?}; boxes stand for them, SVG has them");
        scene::warn(&out.shown(), &[lacking]);
    }
    Ok(bytes)
}
