//! `shearbed plot`: one picture of a channel from several runs, or from the points of a sweep.

use super::{Failure, pictures, print, scene};
use crate::output;
use crate::plot::{self, Curve, Figure};
use serde_json::Value;
use shearbed::Scene;
use std::fs;
use std::path::{Path, PathBuf};

/// Arguments of `plot`.
#[derive(clap::Args)]
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
}

fn picture(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    match path.extension().and_then(|extension| extension.to_str()) {
        Some("svg" | "png") => Ok(path),
        _ => Err("a name that ends in .svg or .png is allowed; no other format is written".to_owned()),
    }
}

/// A folder of tables, what it is called, and its scene.
struct Run {
    dir: PathBuf,
    label: String,
    scene: Scene,
}

/// A channel of a run against time.
struct Found {
    time: String,
    channel: String,
    curve: Curve,
}

/// Draws a channel of every folder.
pub(super) fn plot(args: &Args) -> Result<(), Failure> {
    let mut runs = Vec::new();
    for dir in &args.dirs {
        runs.extend(runs_in(dir)?);
    }
    let mut wanted = args.channel.clone();
    let mut found = Vec::new();
    for run in &runs {
        let of_run = channel(run, wanted.as_deref())?;
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
            runs[k].dir.display(),
            found[k].time,
            runs[0].dir.display(),
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
    write(&args.out, &figure)?;
    print(&format!(
        "{} of {} runs in {}\n",
        figure.y_name,
        runs.len(),
        args.out.display()
    ))
}

fn write(out: &Path, figure: &Figure) -> Result<(), Failure> {
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
                scene::warn(&out.display().to_string(), &[lacking]);
            }
            bytes
        }
    };
    Ok(output::write_one(out, &contents)?)
}

/// The runs that a folder holds: itself, or the points of a sweep.
fn runs_in(dir: &Path) -> Result<Vec<Run>, Failure> {
    let name = |dir: &Path| {
        let own = dir.canonicalize().unwrap_or(dir.to_owned());
        own.file_name().unwrap_or_default().to_string_lossy().into_owned()
    };
    if dir.join("run.json").exists() {
        return Ok(vec![Run {
            label: name(dir),
            scene: scene(&dir.join("run.json"))?,
            dir: dir.to_owned(),
        }]);
    }
    let sweep = dir.join("sweep.json");
    if !sweep.exists() {
        return Err(Failure::Input(format!(
            "{}: neither run.json nor sweep.json is in it; a folder that `shearbed run` or `shearbed sweep` wrote is allowed",
            dir.display()
        )));
    }
    let scene = scene(&sweep)?;
    let points = dir.join("points");
    let unreadable = |error| Failure::Input(format!("{}: cannot be read: {error}", points.display()));
    let entries = fs::read_dir(&points).map_err(unreadable)?;
    let mut folders: Vec<PathBuf> = (entries.flatten().map(|entry| entry.path()))
        .filter(|path| path.join("point.json").exists())
        .collect();
    folders.sort();
    let point = |dir: PathBuf| {
        let record = json(&dir.join("point.json"))?;
        Ok(Run {
            label: record["point"].as_str().map_or_else(|| name(&dir), String::from),
            scene: scene.clone(),
            dir,
        })
    };
    folders.into_iter().map(point).collect()
}

fn json(path: &Path) -> Result<Value, Failure> {
    let at = |what: String| Failure::Input(format!("{}: {what}", path.display()));
    let text = fs::read_to_string(path).map_err(|error| at(format!("cannot be read: {error}")))?;
    serde_json::from_str(&text).map_err(|error| at(format!("is no record: {error}")))
}

fn scene(record: &Path) -> Result<Scene, Failure> {
    serde_json::from_value(json(record)?["scene"].take()).map_err(|error| {
        Failure::Input(format!(
            "{}: scene: is no scene of this version: {error}",
            record.display()
        ))
    })
}

/// The column `wanted` of the run's tables, or the first of the first.
fn channel(run: &Run, wanted: Option<&str>) -> Result<Found, Failure> {
    let mut known = Vec::new();
    for observable in &run.scene.output.observables {
        let path = run.dir.join(format!("{}.csv", observable.name()));
        let at = |what: String| Failure::Input(format!("{}: {what}", path.display()));
        let mut reader = csv::Reader::from_path(&path).map_err(|error| at(error.to_string()))?;
        let heads: Vec<String> = (reader.headers().map_err(|error| at(error.to_string()))?)
            .iter()
            .map(String::from)
            .collect();
        let channels = heads.iter().filter(|head| heads.contains(&format!("{head}_se")));
        let channels: Vec<_> = channels.cloned().collect();
        let chosen = match wanted {
            Some(wanted) => channels.iter().find(|channel| *channel == wanted),
            None => channels.first(),
        };
        let Some(chosen) = chosen else {
            known.extend(channels);
            continue;
        };
        let place = |name: &str| heads.iter().position(|head| head == name).unwrap_or(0);
        let (y, se) = (place(chosen), place(&format!("{chosen}_se")));
        let rows: Vec<Vec<f64>> = (reader.deserialize().collect::<Result<_, _>>())
            .map_err(|error: csv::Error| at(error.to_string()))?;
        let column = |k: usize| rows.iter().map(|row| row[k]).collect::<Vec<f64>>();
        let half = pictures::half_widths(&run.scene);
        return Ok(Found {
            time: heads[0].clone(),
            channel: chosen.clone(),
            curve: Curve {
                label: run.label.clone(),
                x: column(0),
                y: column(y),
                half_band: half.map(|factor| column(se).iter().map(|se| factor * se).collect()),
            },
        });
    }
    Err(Failure::Input(format!(
        "--y {}: {} has no such channel; there are {}",
        wanted.unwrap_or_default(),
        run.dir.display(),
        known.join(", ")
    )))
}
