//! `shearbed plot`: one picture of channels from several runs or the points of a sweep, or a picture of a fit or a
//! report.

mod against;
mod exact;
mod folders;
mod look;
mod measured;
mod shades;
mod table;

use super::{Failure, derived, ending_in, number, pictures, print, refuse, scene, spares};
use against::against;
pub(super) use folders::FIGURES;
use folders::{Run, kept, runs_in};
use look::Look;
use shearbed::Plan;
use shearbed::plan::counted;
use shearbed_validation::files::text::Shown;
use shearbed_validation::files::{FileError, output};
use shearbed_validation::present::plot::{self, Figure, names};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use table::MOST_ROWS;

#[derive(clap::Args)]
#[command(after_help = "Example:\n  shearbed plot first second --y x1 --out both.svg")]
pub(super) struct Args {
    /// Folders of `shearbed run`, or of `shearbed sweep`, whose points are all drawn; or one of `shearbed fit` or
    /// `validate`
    #[arg(required = true, value_name = "DIR")]
    dirs: Vec<PathBuf>,
    /// The columns to draw, as x1 or phi,a12 [default: the first of the first table]; of a fit or a report, the
    /// picture's name
    #[arg(long = "y", value_name = "CHANNELS", value_delimiter = ',')]
    channels: Vec<String>,
    /// The horizontal axis: t_over_T, time_s or strain; of a sweep also a key, or a product of powers, KEY*KEY^(1/3)
    #[arg(long = "x", value_name = "KEY")]
    key: Option<String>,
    /// With a key: the time [default: the last output's]; of extremes, to a quarter period [default: the first of most
    /// points]
    #[arg(long, value_name = "TIME", requires = "key", value_parser = time, allow_negative_numbers = true)]
    at: Option<f64>,
    /// Measured points to draw over the curves, in the columns that `shearbed fit` takes, or without uncertainties
    #[arg(long, value_name = "FILE.csv")]
    data: Option<PathBuf>,
    /// The columns of --data in their order, - for one to leave out: t_s,-,x1
    #[arg(long, value_name = "NAMES", value_delimiter = ',', allow_hyphen_values = true, requires = "data")]
    columns: Option<Vec<String>>,
    /// Exact curves of `shearbed reference` to draw over the runs
    #[arg(long, value_name = "FILE.csv")]
    reference: Option<PathBuf>,
    #[command(flatten)]
    look: Look,
    /// The picture, whose name ends in .svg, .png or .pdf
    #[arg(long, value_name = "FILE", default_value = "out/plot.svg", value_parser = picture)]
    out: PathBuf,
    /// Overwrite a file that is no unedited picture of `plot`
    #[arg(long)]
    force: bool,
}

impl Args {
    /// The flag of a file that is drawn over the curves of runs, if one is given.
    fn over_runs(&self) -> Option<&'static str> {
        let files = [("--data", &self.data), ("--reference", &self.reference)];
        files.into_iter().find(|(_, file)| file.is_some()).map(|(flag, _)| flag)
    }
}

/// Columns of time that every table of a run has.
const TIMES: [&str; 3] = ["t_over_T", "time_s", "strain"];

fn time(text: &str) -> Result<f64, String> {
    number(text, |_| true, "a finite number")
}

fn picture(text: &str) -> Result<PathBuf, String> {
    ending_in(&["svg", "png", "pdf"], ".svg, .png or .pdf", text)
}

/// Draws a channel of every folder, or a picture stored in a folder.
pub(super) fn plot(args: &Args) -> Result<(), Failure> {
    spares(&args.out, [args.out.clone()], args.data.iter().chain(&args.reference).cloned())?;
    let kept = if let [dir] = &args.dirs[..] { kept(dir)?.map(|kept| (dir, kept)) } else { None };
    let (mut figure, said, order) = match kept {
        Some((dir, kept)) => {
            let (figure, said) = named(args, dir, kept)?;
            (figure, said, Vec::new())
        }
        None => of_runs(args)?,
    };
    args.look.name(&mut figure, &order)?;
    args.look.apply(&mut figure)?;
    scene::warn(&args.out.shown(), &args.look.warnings(&figure));
    let replaced = if write(&args.out, &figure, args.force)? { " (replaced an earlier picture)" } else { "" };
    print(&format!("{said} in {}{replaced}\n", args.out.shown()))
}

/// The picture, what it shows, and the place among the names of --legend of each curve and then of all points.
fn of_runs(args: &Args) -> Result<(Figure, String, Vec<usize>), Failure> {
    let across = args.key.as_deref().filter(|key| TIMES.contains(key));
    refuse(across.zip(args.at), |(time, at)| {
        format!("--at {at}: --x {time} draws all times; --at is for a key of a sweep")
    })?;
    let mut drawn = drawn_of(&args.dirs, &args.channels, across)?;
    let (channels, runs) = (drawn.channels.join(", "), drawn.runs.len());
    if let (Some(key), None) = (&args.key, across) {
        refuse(args.over_runs(), |flag| {
            format!("--x {key}: {flag} has times; {} are allowed beside it", TIMES.join(", "))
        })?;
        refuse((args.dirs.len() > 1).then_some(args.dirs.len()), |count| {
            format!("--x {key}: {count} folders are given; one sweep is allowed")
        })?;
        let (figure, left_out) = against(drawn, key, args.at)?;
        scene::warn(&args.out.shown(), &left_out);
        return Ok((figure, format!("{channels} of {}", counted(runs as u64, "point")), Vec::new()));
    }
    drawn.is_defined()?;
    let apart = drawn.part();
    let (apart, joined): (Vec<usize>, Vec<usize>) = (0..apart.len()).partition(|k| apart[*k]);
    if apart.is_empty() {
        shades::colour(&mut drawn);
    }
    if let Some(path) = &args.data {
        let measured = measured::points(path, args.columns.as_ref(), &drawn)?;
        drawn.figure.points.extend(measured);
    }
    if let Some(path) = &args.reference {
        drawn.figure.curves.extend(exact::curves(path, &drawn.time, &drawn.channels, &drawn.runs[0])?);
    }
    // Names are given for the curves of runs, also of those drawn as points, then for exact curves and measured points.
    let (own, curves) = (joined.len() + apart.len(), drawn.figure.curves.len());
    let others = own + curves - joined.len();
    let order = joined.into_iter().chain(own..others).chain(apart).chain(others..curves + drawn.figure.points.len());
    Ok((drawn.figure, format!("{channels} of {}", counted(runs as u64, "run")), order.collect()))
}

/// The requested picture of a fit or a report, by default the first.
fn named(args: &Args, dir: &Path, kept: Vec<(String, Figure)>) -> Result<(Figure, String), Failure> {
    let shown = dir.shown();
    refuse(args.key.as_ref(), |key| {
        format!("--x {key}: {shown} is no sweep; a folder of `shearbed sweep` is allowed")
    })?;
    refuse(args.over_runs(), |flag| format!("{flag}: {shown} is no run; a folder of `shearbed run` is allowed"))?;
    if kept.is_empty() {
        let why = "has no picture: `validate` draws them where it runs all cases";
        return Err(FileError::whole(dir, why).into());
    }
    let names = kept.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>().join(", ");
    let is_it = |(name, _): &(String, Figure)| args.channels.is_empty() || args.channels == [name.as_str()];
    let (name, figure) = kept.into_iter().find(is_it).ok_or_else(|| {
        let asked = args.channels.join(",");
        Failure::Input(format!("--y {asked}: {shown} has no such picture; there are {names}, of which one is allowed"))
    })?;
    Ok((figure, format!("{name} of {shown}")))
}

/// A picture of channels for several runs.
struct Drawn {
    /// Its curves are those of the first run, channel by channel, then of the next.
    figure: Figure,
    channels: Vec<String>,
    /// The column of times.
    time: String,
    /// The runs, at least one.
    runs: Vec<Run>,
}

impl Drawn {
    /// Refuses a channel that is undefined in a run.
    fn is_defined(&self) -> Result<(), Failure> {
        let Some(k) = self.figure.curves.iter().position(|curve| curve.x.is_empty()) else { return Ok(()) };
        let (run, channel) = (&self.runs[k / self.channels.len()], &self.channels[k % self.channels.len()]);
        Err(FileError::whole(&run.dir, format!("has no {channel}: {}", derived::lacks(channel))).into())
    }

    /// Leaves out lines through outputs that are far apart; of each curve whether it has none.
    fn part(&mut self) -> Vec<bool> {
        let Self { figure, channels, runs, .. } = self;
        // A plan of many outputs may take long.
        let is_apart = |k: usize| {
            let (few, channel) = (figure.curves[k].x.len() <= pictures::MANY, &channels[k % channels.len()]);
            few && !derived::is_extreme(channel)
                && Plan::new(&runs[k / channels.len()].scene).is_ok_and(|plan| pictures::are_apart(&plan))
        };
        let apart: Vec<bool> = (0..figure.curves.len()).map(is_apart).collect();
        pictures::part(figure, |k| apart[k]);
        apart
    }
}

/// Channels of every folder against time; by default the first channel of the first folder.
pub(super) fn figure(dirs: &[PathBuf], channels: &[String]) -> Result<Figure, Failure> {
    let mut drawn = drawn_of(dirs, channels, None)?;
    drawn.is_defined()?;
    drawn.part();
    Ok(drawn.figure)
}

/// The same, also where a channel is undefined in some runs, against the column `across`.
fn drawn_of(dirs: &[PathBuf], channels: &[String], across: Option<&str>) -> Result<Drawn, Failure> {
    let mut runs = Vec::new();
    for dir in dirs {
        runs.extend(runs_in(dir)?);
    }
    let Some(first) = runs.first() else {
        return Err(Failure::Input("plot: no run was found in these folders".into()));
    };
    let mut rows = MOST_ROWS;
    let channels = match channels {
        [] => vec![table::channel(first, None, across, &mut rows.clone())?.channel],
        asked => asked.to_vec(),
    };
    let symbols = channels.iter().map(|channel| names::channel(channel)).collect::<Vec<_>>();
    let titles: BTreeSet<&str> = runs.iter().map(|run| run.scene.title.as_str()).collect();
    let mut curves = Vec::new();
    let mut time: Option<String> = None;
    for run in &runs {
        // Scenes of different titles are labelled by them.
        let differ = runs.len() > 1 && titles.len() == runs.len();
        let label = if differ { &run.scene.title } else { &run.label };
        for (channel, symbol) in channels.iter().zip(&symbols) {
            let mut found = table::channel(run, Some(channel), across, &mut rows)?;
            let time = time.get_or_insert_with(|| found.time.clone());
            if *time != found.time {
                let (own, first) = (&found.time, first.dir.shown());
                let why = format!(
                    "its time is {own}, that of {first} is {time}: one of the two can be drawn, or --x time_s of both"
                );
                return Err(FileError::whole(&run.dir, why).into());
            }
            found.curve.label = match (channels.len(), runs.len()) {
                (1, _) => label.clone(),
                (_, 1) => symbol.clone(),
                _ => format!("{symbol}, {label}"),
            };
            curves.push(found.curve);
        }
    }
    let swept = first.point.iter().flatten().map(|(key, _)| key.as_str()).collect::<Vec<_>>();
    let time = time.unwrap_or_default();
    let with_unit = |(channel, symbol): (&String, &String)| {
        if derived::is_rate(channel) { format!("{symbol} ({})", derived::per(&time)) } else { symbol.clone() }
    };
    let y_name = channels.iter().zip(&symbols).map(with_unit).collect::<Vec<_>>().join(", ");
    let figure = Figure {
        title: match titles.len() {
            1 => names::title_without(&first.scene.title, &swept),
            count => format!("{y_name} of {count} scenes"),
        },
        x_name: names::time(&time),
        y_name,
        channels: if channels.len() > 1 && runs.len() > 1 { symbols.clone() } else { Vec::new() },
        curves,
        ..Figure::default()
    };
    Ok(Drawn { figure, channels, time, runs })
}

/// True if the picture replaced an unedited one.
fn write(out: &Path, figure: &Figure, force: bool) -> Result<bool, Failure> {
    let target = output::followed(out);
    if picture(&target.to_string_lossy()).is_err() {
        let why = format!("is a link to {}, which is no picture", target.shown());
        return Err(FileError::whole(out, why).into());
    }
    Ok(output::write_one(out, &drawn(out, figure)?, force)?)
}

/// The bytes of a picture in the format of its file's ending, with the mark of an unedited one.
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
    Ok(output::sealed(bytes))
}
