//! `shearbed sweep`.

use super::derived::{self, DERIVED, EXTREMES};
use super::duration::Long;
use super::scene::{Chosen, Ensemble, Named};
use super::{
    Failure, Threads, Writing, agree, log, memory, on_threads, progress, refuse, result_folder, scene, spares_inputs,
    tables::{self, is_bounded},
};
use shearbed::run::ensemble;
use shearbed_validation::files::output::Output;
use shearbed_validation::files::text::{self, Shown};
use shearbed_validation::files::{FileError, cluster};
use shearbed_validation::present::plot::names;
use shearbed_validation::present::table::is_narrow;
use shearbed_validation::serve::sweep::{self, Axis, Folder, GridError, Point, Points};
use std::path::{Path, PathBuf};

#[derive(clap::Args)]
#[command(after_help = "\
The same command, also with more values, runs only missing points. Every point has the same seed.
Examples:
  shearbed sweep fig4-n50 --over interaction.alpha=0.1:1:10 --replicas 100
  shearbed sweep mine.toml --over interaction.update=rotation,angles,kick")]
pub(super) struct Args {
    #[command(flatten)]
    chosen: Chosen,
    #[command(flatten)]
    ensemble: Ensemble,
    /// A key of the scene and its values: FROM:TO:COUNT evenly with both ends, or a list; given more than once, every
    /// combination is a point
    #[arg(long, value_name = "KEY=VALUES", required = true, value_parser = Axis::parse)]
    over: Vec<Axis>,
    /// The folder for sweep.csv, extremes.csv, sweep.json and points/ [default: out/sweep-<scene>]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    threads: Threads,
    #[command(flatten)]
    long: Long,
    #[command(flatten)]
    writing: Writing,
}

/// The flag that an error is about.
fn flag(error: &GridError) -> &'static str {
    match error {
        GridError::Scene(_) => "",
        GridError::TooMany => "--over: ",
        GridError::Point { .. } => "--over ",
    }
}

pub(super) fn points(named: &Named, over: &[Axis]) -> Result<Vec<Point>, Failure> {
    check(over)?;
    sweep::points(&named.text, &named.starts, &named.settings, over)
        .map_err(|error| Failure::Input(format!("{}: {}{error}", named.source, flag(&error))))
}

/// Runs the unfinished points of a sweep, which may have more values than an earlier one, and writes one row per point.
pub(super) fn sweep(args: &Args) -> Result<(), Failure> {
    let named = args.chosen.load(&args.ensemble, &args.over)?;
    let points = points(&named, &args.over)?;
    refuse(named.scene.output.rods_key(), |key| {
        format!("{}: {key}: a sweep writes no rods; remove this key", named.source)
    })?;
    let at = |point: &Point| format!("{}: --over {}", named.source, sweep::described(&args.over, &point.values));
    let first = points[0].plan.time_name();
    refuse(points.iter().find(|point| point.plan.time_name() != first), |point| {
        let (at, own) = (at(point), point.plan.time_name());
        format!("{at}: its time is {own}, that of the first point {first}; all points have the same columns")
    })?;
    memory::check_each(points.iter().map(|point| (&point.plan, at(point))), args.threads.given, false, 0)?;
    let cost: Vec<_> = points.iter().map(|point| (&point.plan, point.plan.scene().ensemble.replicas)).collect();
    args.long.check(&named.source, args.threads.given, &cost)?;
    let out = (args.out.clone()).unwrap_or_else(|| Path::new("out").join(format!("sweep-{}", named.stem)));
    let total = points.len();
    let warned = warnings(&points, &args.over);
    let inputs = sweep::inputs(&named.scene, &args.over, &points, &warned);
    agree("sweep", inputs.clone())?;

    // Only the root can access the folder.
    let mut folder = None;
    let open = || {
        let bytes = (points.iter()).map(|point| tables::most_bytes(&point.plan)).sum();
        spares_inputs(&out, &["sweep.csv", EXTREMES, "sweep.json"], named.files())?;
        let points = Points {
            pairs: (points.iter()).map(|point| sweep::pairs(&args.over, &point.values)).collect(),
            beside: vec![EXTREMES.to_owned()],
            tables: (points[0].plan.observables().iter())
                .map(|observable| format!("{}.csv", observable.name()))
                .chain([EXTREMES.to_owned(), DERIVED.to_owned()])
                .collect(),
        };
        // Force starts over.
        let kept = if args.writing.force { None } else { sweep::smaller(&out, &inputs, &points)? };
        let origin = ("sweep", inputs.clone(), args.writing.force || kept.is_some());
        let in_folder = result_folder(&out, origin, bytes, &[""; 0])?;
        let opened = folder.insert(Folder::open(in_folder, &inputs, points)?);
        kept.into_iter().flatten().try_for_each(|(k, tables)| opened.write(k, &tables))?;
        Ok::<_, Failure>(self::jobs(&opened.finished(), total))
    };
    let (checked, jobs): (Option<usize>, Vec<usize>) = cluster::from_root(open)?;
    scene::warn(&named.source, warned.iter().take(MOST_WARNINGS));
    if let Some(more @ 1..) = warned.len().checked_sub(MOST_WARNINGS) {
        scene::warn(&named.source, [&format!("and {more} more points with warnings: sweep.json has them all")]);
    }
    let finished = total - (jobs.len() - usize::from(checked.is_some()));
    if finished > 0 {
        let so_far = format!("{finished} of {total} points are finished");
        args.writing.print(&format!("goes on from {}: {so_far}\n", out.shown()))?;
    }
    let mut ended = finished;
    let bar = progress(jobs.len() as u64, "points", args.writing.quiet);
    let job = |job: usize| {
        let point = &points[jobs[job]];
        tables_of(point).map_err(|error| Failure::Input(format!("{}: {error}", at(point))))
    };
    let arrived = |job: usize, tables: &Vec<Output>| {
        bar.inc(1);
        let k = jobs[job];
        // Results arrive only on the root.
        let Some(folder) = &folder else {
            return Ok(());
        };
        if checked == Some(k) {
            let same = folder.tables(k)? == *tables;
            return if same { Ok(()) } else { Err(FileError::whole(folder.point(k), OTHER_NUMBERS).into()) };
        }
        folder.write(k, tables)?;
        ended += 1;
        log(&format!("saved in {}: {ended} of {total} points are finished", out.shown()), args.writing.quiet);
        Ok(())
    };
    let shared = on_threads(args.threads.given, || cluster::share(jobs.len(), job, arrived))??;
    bar.finish_and_clear();
    let (Some(folder), true) = (&folder, shared.is_some()) else {
        return Ok(());
    };
    let values: Vec<_> = points.iter().map(|point| point.values.clone()).collect();
    let rows = folder.gather(&args.over, &values)?;
    let swept: Vec<_> = args.over.iter().map(|axis| axis.key.as_str()).collect();
    args.writing.print(&format!(
        "{}\npoints: {total}, of which {finished} were finished before\n\n{}\nin {}: sweep.csv, {EXTREMES}, \
         sweep.json, points\n",
        text::line(&names::title_without(&named.scene.title, &swept)),
        table(&rows, args.over.len()),
        out.shown(),
    ))
}

/// The largest number of warnings of points on the terminal.
const MOST_WARNINGS: usize = 10;

/// Reasons to doubt results, each once, with the first of its points and the number of the others.
pub(super) fn warnings(points: &[Point], over: &[Axis]) -> Vec<String> {
    let mut found: Vec<(String, &Point, usize)> = Vec::new();
    for point in points {
        for warning in point.plan.warnings() {
            match found.iter_mut().find(|(known, ..)| *known == warning) {
                Some((.., others)) => *others += 1,
                None => found.push((warning, point, 0)),
            }
        }
    }
    let line = |(warning, point, others): (String, &Point, usize)| {
        let at = sweep::described(over, &point.values);
        match others {
            0 => format!("--over {at}: {warning}"),
            1 => format!("--over {at} and another point: {warning}"),
            _ => format!("--over {at} and {others} other points: {warning}"),
        }
    };
    found.into_iter().map(line).collect()
}

/// Refuses a key that changes the columns of the results.
fn check(axes: &[Axis]) -> Result<(), Failure> {
    refuse(axes.iter().find(|axis| axis.key.starts_with("output")), |Axis { key, .. }| {
        format!("--over {key}: all points have the same columns; keys of other tables are allowed")
    })
}

/// The points to run: the missing ones; if others are finished, the first of these comes before them, and its result is
/// compared with the stored one, to detect a program whose numbers have changed.
fn jobs(finished: &[usize], points: usize) -> (Option<usize>, Vec<usize>) {
    let missing: Vec<_> = (0..points).filter(|k| finished.binary_search(k).is_err()).collect();
    let checked = finished.first().copied().filter(|_| !missing.is_empty());
    (checked, checked.into_iter().chain(missing).collect())
}

/// Runs a point and returns a table for each observable.
fn tables_of(point: &Point) -> Result<Vec<Output>, String> {
    let results = ensemble::run(&point.plan).map_err(|error| error.to_string())?;
    let table =
        |series: &ensemble::Series| Ok((format!("{}.csv", series.observable.name()), tables::csv(&results, series)?));
    let mut tables: Vec<Output> = results.series.iter().map(table).collect::<Result<_, String>>()?;
    tables.extend(derived::files(&point.plan, &results, &derived::of(&point.plan, &results))?);
    Ok(tables)
}

/// Why a sweep does not go on with a point that is run again.
const OTHER_NUMBERS: &str = "run again, this point gives other numbers, so another build of the program wrote the \
    folder; give another --out, or remove the folder; nothing of it was changed";

/// The largest numbers of rows and columns of a table for the terminal.
const MOST: (usize, usize) = (32, 9);

/// A table with shortened numbers, without columns that are empty at all points; empty if there are too many rows to
/// read.
fn table(rows: &[Vec<String>], swept: usize) -> String {
    if rows.len() > MOST.0 + 1 {
        return String::new();
    }
    let columns = (0..rows[0].len()).filter(|c| rows[1..].iter().any(|row| !row[*c].is_empty()));
    let columns: Vec<_> = columns.take(if is_narrow() { swept + MOST.1 } else { usize::MAX }).collect();
    let short = |column: usize, text: &String| match text.parse::<f64>() {
        Ok(number) if column >= swept && is_bounded(&rows[0][column]) && (number == 0.0 || number.abs() >= 1e-3) => {
            text::four_decimals(number)
        }
        Ok(number) if column >= swept => format!("{number:.3e}"),
        _ => text.clone(),
    };
    let cells: Vec<Vec<_>> = (rows.iter()).map(|row| columns.iter().map(|c| short(*c, &row[*c])).collect()).collect();
    let more = match rows[0].len() {
        all if all > columns.len() => format!("({} of the {all} columns of sweep.csv)\n", columns.len()),
        _ => String::new(),
    };
    text::right_aligned(&cells) + &more
}
