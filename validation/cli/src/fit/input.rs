//! The input of `shearbed fit`: scenes, points and ranges, checked.

use super::Args;
use super::advice::of_scene;
use crate::scene::{Named, one_owner};
use crate::{Failure, memory, refuse, scene};
use shearbed::Plan;
use shearbed::plan::counted;
use shearbed::scene::TimeUnit;
use shearbed_validation::files::FileError;
use shearbed_validation::files::text::{Shown, line};
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

impl Input {
    /// The name of the column of times of each data set.
    pub(super) fn times(&self) -> Vec<&'static str> {
        self.scenes.sets.iter().map(|set| set.time.name()).collect()
    }

    /// The plans of the scenes with these values of the parameters.
    pub(super) fn plans(&self, values: &[f64]) -> Result<Vec<Plan>, Failure> {
        self.scenes.plans(values, &self.data, AS_WRITTEN).map_err(refused)
    }

    /// The plans at the lower ends of all ranges, and at the upper ones.
    pub(super) fn plans_at_ends(&self, over: &[Range]) -> Result<Vec<Plan>, Failure> {
        let ends = [|range: &Range| range.from, |range: &Range| range.to];
        let [from, to] = ends.map(|end| self.plans(&over.iter().map(end).collect::<Vec<f64>>()));
        Ok([from?, to?].concat())
    }
}

fn refused(error: SceneError) -> Failure {
    Failure::Input(of_scene(&error))
}

/// Reads scenes and points. Every fault in them is found here, before anything runs.
pub(super) fn input(args: &Args) -> Result<Input, Failure> {
    refuse((args.over.len() > MOST_PARAMETERS).then_some(args.over.len()), |count| {
        format!("--over: given {count} times; up to {MOST_PARAMETERS} parameters at once are allowed")
    })?;
    let only_of_fits = [("--test", !args.test.is_empty()), ("--design", args.design)];
    refuse(only_of_fits.iter().find(|(_, given)| *given && args.over.is_empty()), |(flag, _)| {
        format!("{flag}: nothing is fitted; --over KEY=FROM:TO names a key and its range")
    })?;
    for set in 0..args.data.len() {
        check_owners(args, set)?;
    }
    for setting in &args.settings {
        refuse(["ensemble", "output"].iter().find(|table| is_in(&setting.key, table)), |table| {
            format!("--set {}: a fit takes its own {table}; --replicas and --seed are allowed", setting.key)
        })?;
    }
    for range in &args.over {
        let last = args.data.len();
        refuse(range.set.filter(|set| *set > last), |none| {
            let (label, sets) = (range.label(), counted(last as u64, "set"));
            format!("--over {label}: there is no set {none}; with {sets} of --data the first is 1 and the last {last}")
        })?;
        check_key(range)?;
    }
    let (mut sets, mut data, mut names, mut files) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let (mut stem, mut warnings) = (String::new(), Vec::new());
    let reading = Reading { columns: args.columns.clone(), u: args.u, without_u: false };
    for (k, given) in args.data.iter().enumerate() {
        let (scene, path) = scene_and_file(&args.scene, given);
        let named = scene::load(scene, Vec::new())?;
        let same = |other: &&PathBuf| fs::canonicalize(other).ok() == fs::canonicalize(path).ok();
        refuse(files.iter().find(same), |_| {
            let why = "given twice, and its points would count twice; each file once is allowed";
            format!("--data {}: {why}", path.shown())
        })?;
        let points = data::read(path, k, &reading).map_err(in_flags)?;
        refuse(args.u.zip(points.u_column.as_ref()), |(u, column)| {
            let own = format!("{} has uncertainties of its own, in the column {column}", path.shown());
            format!("--u {u}: {own}; either these or --u are allowed")
        })?;
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
    let count = data.len();
    refuse((count > MOST_POINTS).then_some(count), |count| {
        format!("--data: {count} points in {} files; at most {MOST_POINTS} are allowed", files.len())
    })?;
    refuse((count <= args.over.len()).then_some(args.over.len()), |parameters| {
        let files = files.iter().map(|file| file.shown()).collect::<Vec<_>>().join(" --data ");
        let (points, parameters) = (counted(count as u64, "point"), counted(parameters as u64, "parameter"));
        format!("--data {files}: {points} for {parameters}; more points than parameters are needed")
    })?;
    for (k, point) in data.iter().enumerate() {
        let measured = |datum: &Datum| (datum.time.to_bits(), datum.value.to_bits());
        let same = |other: &&Datum| {
            other.set != point.set
                && sets[other.set].source == sets[point.set].source
                && (measured(other), &other.column) == (measured(point), &point.column)
        };
        let place = |datum: &Datum| format!("{}:{}", files[datum.set].shown(), datum.line);
        refuse(data[..k].iter().find(same), |first| {
            let Datum { column, value, time, .. } = point;
            let advice = "leave one out, or put all points of one scene into one file if two experiments gave it";
            format!("{}: {column} = {value} at {time} is in {} already: {advice}", place(point), place(first))
        })?;
    }
    let scenes = Scenes::new(sets, args.over.clone()).map_err(refused)?;
    scenes.one_length(&data).map_err(refused)?;
    let input = Input { scenes, data, names, files, stem, warnings };
    let plans = input.plans_at_ends(&args.over)?;
    memory::check_each(plans.iter().map(|plan| (plan, input.stem.clone())), args.threads.given, false, 0)?;
    Ok(input)
}

fn check_key(range: &Range) -> Result<(), Failure> {
    refuse(NOT_FITTED.iter().find(|table| is_in(&range.key, table)), |table| {
        let allowed = "keys of flow, particles and interaction are allowed";
        format!("--over {}: points do not determine keys of {table}; {allowed}", range.key)
    })
}

/// Refuses keys of a scene that a fit of its mean projections would refuse together.
pub(crate) fn check_ranges(named: &Named, ranges: Vec<Range>) -> Result<(), Failure> {
    ranges.iter().try_for_each(check_key)?;
    let set = Set {
        seed: named.scene.ensemble.seed,
        source: named.source.clone(),
        text: named.text.clone(),
        starts: named.starts.clone(),
        settings: named.settings.clone(),
        time: TimeColumn::Seconds,
    };
    let scenes = Scenes::new(vec![set], ranges).map_err(refused)?;
    scenes.one_length(&[Datum::place(0, "x1", 0.0)]).map_err(refused)
}

fn is_in(key: &str, table: &str) -> bool {
    key.split('.').next() == Some(table)
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
    if ["no column of measured values", "no column of times"].iter().any(|start| message.starts_with(start)) {
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
        let why = "has no periods; t_s or strain are allowed in place of t_over_T";
        FileError::whole(path, format!("{} {why}", named.source))
    })?;
    let unit = scene.time.unit;
    let key = unit.duration_key();
    let (most, what) = match (unit, time.per_unit(&plan)) {
        (TimeUnit::Period, Some(period)) => (0.25 * period, "a quarter of a period"),
        _ => (end, "the scene's length"),
    };
    // A point at the very end may be rounded to a later time.
    let late = |time: f64, most: f64| time > most * (1.0 + 1e-12);
    let refused = |point: &Datum, column: String, value: f64, why: String| {
        format!("{}:{}: column {column}: `{value}` is not allowed: {why}", path.shown(), point.line)
    };
    refuse(points.iter().find(|point| late(point.u_time, most)), |point| {
        let why = format!("expected one standard deviation of at most {what}, {most}");
        refused(point, format!("{}_u", time.name()), point.u_time, why)
    })?;
    refuse(points.iter().find(|point| late(point.time, end)), |point| {
        let why = format!("{} ends at {end} there; --set {key}=… moves that", named.source);
        refused(point, time.name().to_owned(), point.time, why)
    })
}
