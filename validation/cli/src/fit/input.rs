//! The input of `shearbed fit`: scenes, points and ranges, checked.

use super::Args;
use super::advice::of_scene;
use crate::owner::one_owner;
use crate::{Failure, memory, scene};
use shearbed::Plan;
use shearbed::plan::counted;
use shearbed::scene::TimeUnit;
use shearbed_validation::files::FileError;
use shearbed_validation::files::text::Shown;
use shearbed_validation::files::text::line;
use shearbed_validation::input::experiment::not_read;
use shearbed_validation::methods::least_squares::Datum;
use shearbed_validation::methods::least_squares::basis::MOST_PARAMETERS;
use shearbed_validation::serve::fit::Range;
use shearbed_validation::serve::fit::data::{self, MOST_POINTS, Reading, TimeColumn};
use shearbed_validation::serve::fit::error::SceneError;
use shearbed_validation::serve::fit::scenes::{AS_WRITTEN, Scenes, Set};
use shearbed_validation::serve::sweep;
use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};

/// Tables of a scene without properties of rods, liquid or interaction.
const NOT_FITTED: [&str; 3] = ["ensemble", "output", "time"];

/// The checked input of a fit.
pub(super) struct Input {
    pub(super) scenes: Scenes,
    pub(super) data: Vec<Datum>,
    /// The name of each data set, and its file.
    pub(super) names: Vec<String>,
    pub(super) files: Vec<PathBuf>,
    pub(super) stem: String,
    /// Columns of the files that are not read.
    pub(super) warnings: Vec<String>,
}

/// Reads scenes and points. Every fault in them is found here, before anything runs.
pub(super) fn input(args: &Args) -> Result<Input, Failure> {
    if args.over.len() > MOST_PARAMETERS {
        return Err(Failure::Input(format!(
            "--over: given {} times; up to {MOST_PARAMETERS} parameters at once are allowed",
            args.over.len()
        )));
    }
    let only_of_fits = [("--test", !args.test.is_empty()), ("--design", args.design)];
    if let Some((flag, _)) = only_of_fits.iter().find(|(_, given)| *given && args.over.is_empty()) {
        return Err(Failure::Input(format!("{flag}: nothing is fitted; --over KEY=FROM:TO names a key and its range")));
    }
    for set in 0..args.data.len() {
        check_owners(args, set)?;
    }
    for setting in &args.settings {
        let table = setting.key.split('.').next().unwrap_or_default();
        if ["ensemble", "output"].contains(&table) {
            return Err(Failure::Input(format!(
                "--set {}: a fit takes its own {table}; --replicas and --seed are allowed",
                setting.key
            )));
        }
    }
    for range in &args.over {
        if let Some(none) = range.set.filter(|set| *set > args.data.len()) {
            return Err(Failure::Input(format!(
                "--over {}: there is no set {none}; with {} of --data the first is 1 and the last {}",
                range.label(),
                counted(args.data.len() as u64, "set"),
                args.data.len()
            )));
        }
        let key = &range.key;
        if let Some(table) = NOT_FITTED.iter().find(|table| key.split('.').next() == Some(table)) {
            return Err(Failure::Input(format!(
                "--over {key}: points do not determine keys of {table}; keys of flow, particles and interaction are \
                 allowed"
            )));
        }
    }
    let (mut sets, mut data, mut names, mut files) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let (mut stem, mut warnings) = (String::new(), Vec::new());
    let reading = Reading { columns: args.columns.clone(), u: args.u, without_u: false };
    for (k, given) in args.data.iter().enumerate() {
        let (scene, path) = scene_and_file(&args.scene, given);
        let named = scene::load(scene, Vec::new())?;
        let same = |other: &PathBuf| fs::canonicalize(other).ok() == fs::canonicalize(path).ok();
        if files.iter().any(same) {
            return Err(Failure::Input(format!(
                "--data {}: given twice, and its points would count twice; each file once is allowed",
                path.shown()
            )));
        }
        let points = data::read(path, k, &reading).map_err(in_flags)?;
        if let (Some(u), Some(column)) = (args.u, &points.u_column) {
            return Err(Failure::Input(format!(
                "--u {u}: {} has uncertainties of its own, in the column {column}; either these or --u are allowed",
                path.shown()
            )));
        }
        warnings.extend(not_read(path, &points.unread));
        within_scene(&named, args, points.time, &points.points, path)?;
        if k == 0 {
            stem.clone_from(&named.stem);
        }
        names.push(line(&named.scene.title));
        files.push(path.to_owned());
        data.extend(points.points);
        sets.push(Set {
            seed: args.seed.unwrap_or(named.scene.ensemble.seed),
            source: named.source,
            text: named.text,
            starts: named.starts,
            settings: args.settings.clone(),
            time: points.time,
        });
    }
    if data.len() > MOST_POINTS {
        return Err(Failure::Input(format!(
            "--data: {} points in {} files; at most {MOST_POINTS} are allowed",
            data.len(),
            files.len()
        )));
    }
    if data.len() <= args.over.len() {
        let counted = |count: usize, what: &str| format!("{count} {what}{}", if count == 1 { "" } else { "s" });
        return Err(Failure::Input(format!(
            "--data {}: {} for {}; more points than parameters are needed",
            files.iter().map(|file| file.shown()).collect::<Vec<_>>().join(" --data "),
            counted(data.len(), "point"),
            counted(args.over.len(), "parameter")
        )));
    }
    for (k, point) in data.iter().enumerate() {
        let measured = |datum: &Datum| (datum.time.to_bits(), datum.value.to_bits());
        let same = |other: &&Datum| {
            other.set != point.set
                && sets[other.set].source == sets[point.set].source
                && (measured(other), &other.column) == (measured(point), &point.column)
        };
        if let Some(first) = data[..k].iter().find(same) {
            return Err(Failure::Input(format!(
                "{}:{}: {} = {} at {} is in {}:{} already: leave one out, or put all points of one scene into one file \
                 if two experiments gave it",
                files[point.set].shown(),
                point.line,
                point.column,
                point.value,
                point.time,
                files[first.set].shown(),
                first.line
            )));
        }
    }
    let refused = |error: SceneError| Failure::Input(of_scene(&error));
    let scenes = Scenes::new(sets, args.over.clone()).map_err(refused)?;
    scenes.one_length(&data).map_err(refused)?;
    let ends = [|range: &Range| range.from, |range: &Range| range.to];
    for values in ends.map(|end| args.over.iter().map(end).collect::<Vec<f64>>()) {
        for plan in scenes.plans(&values, &data, AS_WRITTEN).map_err(refused)? {
            memory::check(&plan, args.threads.given, &stem)?;
        }
    }
    Ok(Input { scenes, data, names, files, stem, warnings })
}

/// Checks that each key of a set's scene is set by one flag.
fn check_owners(args: &Args, set: usize) -> Result<(), Failure> {
    let over = args.over.iter().filter(|range| range.is_of(set));
    let over = over.map(|range| ("--over", range.key.as_str()));
    let given = args.settings.iter().map(|setting| ("--set", setting.key.as_str()));
    let seed = args.seed.map(|_| ("--seed", "ensemble.seed"));
    let owners: Vec<_> = over.chain(given).chain(seed).collect();
    one_owner(&owners)
}

/// `FILE` belongs to the scene of the command, `SCENE2=FILE` to another. A name with `=` that exists as a file is that
/// file.
fn scene_and_file<'a>(scene: &'a OsStr, given: &'a OsStr) -> (&'a OsStr, &'a Path) {
    match given.to_str().and_then(|text| text.split_once('=')) {
        Some((other, file)) if !Path::new(given).exists() => (OsStr::new(other), Path::new(file)),
        _ => (scene, Path::new(given)),
    }
}

/// The message in the words of the command line.
fn in_flags(error: FileError) -> FileError {
    let mut message = error.message.replace(", or u = ", ", or --u=");
    if message.starts_with("no column of measured values") {
        message += "; --columns=t_s,x1,x1_u or the like names columns that have other names, in their order";
    }
    FileError { message, ..error }
}

/// Refuses points later than the scene's end: they would make it run for long, and usually have another unit.
fn within_scene(
    named: &scene::Named,
    args: &Args,
    time: TimeColumn,
    points: &[Datum],
    path: &Path,
) -> Result<(), Failure> {
    let refused = |error: String| Failure::Input(format!("{}: {error}", named.source));
    let mut scene = sweep::scene_with(&named.text, &args.settings).map_err(refused)?;
    named.starts.clone().fill(&mut scene).map_err(refused)?;
    let plan = Plan::new(&scene).map_err(|error| refused(error.to_string()))?;
    let end = time.end_of(&plan).ok_or_else(|| {
        Failure::Input(format!(
            "{}: {} has no periods; t_s or strain are allowed in place of t_over_T",
            path.shown(),
            named.source
        ))
    })?;
    let unit = scene.time.unit;
    let key = unit.duration_key();
    let (most, what) = match (unit, time.per_unit(&plan)) {
        (TimeUnit::Period, Some(period)) => (0.25 * period, "a quarter of a period"),
        _ => (end, "the scene's length"),
    };
    if let Some(point) = points.iter().find(|point| point.u_time > most * (1.0 + 1e-12)) {
        return Err(Failure::Input(format!(
            "{}:{}: column {}_u: `{}` is not allowed: expected one standard deviation of at most {what}, {most}",
            path.shown(),
            point.line,
            time.name(),
            point.u_time
        )));
    }
    // A point at the very end may be rounded to a later time.
    match points.iter().find(|point| point.time > end * (1.0 + 1e-12)) {
        None => Ok(()),
        Some(point) => Err(Failure::Input(format!(
            "{}:{}: column {}: `{}` is not allowed: {} ends at {} there; --set {key}=… moves that",
            path.shown(),
            point.line,
            time.name(),
            point.time,
            named.source,
            end
        ))),
    }
}
