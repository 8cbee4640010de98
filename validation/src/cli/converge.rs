//! `shearbed converge`.

use super::{Failure, MAX_THREADS, on_threads, print, probe, progress, scene, whole};
use crate::cluster;
use crate::output::{self, Output};
use crate::report::ReportTable;
use crate::work_precision::order::{self, Found};
use crate::work_precision::{export, law, tables};
use shearbed::scene::MAX_REPLICAS;
use shearbed::{Plan, Scene};
use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// Arguments of `converge`.
#[derive(clap::Args)]
pub(super) struct Args {
    /// A scene file, or the name of a built-in scene
    scene: OsString,
    /// The folder for converge.csv and converge.json [default: out/converge-<scene>]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Independent runs of an interacting scene, in place of the scene's own number
    #[arg(long, value_name = "N", value_parser = whole(2, MAX_REPLICAS), allow_negative_numbers = true)]
    replicas: Option<u64>,
    /// Threads to run on; the results do not depend on it [default: one for each core]
    #[arg(long, value_name = "K", value_parser = whole(1, MAX_THREADS), allow_negative_numbers = true)]
    threads: Option<u64>,
    /// Print nothing but errors
    #[arg(long)]
    quiet: bool,
}

/// Studies a scene: a free one by every fixed-step subject, an interacting one by its mean.
pub(super) fn converge(args: &Args) -> Result<(), Failure> {
    let mut named = scene::load(&args.scene)?;
    named.scene.ensemble.replicas = args.replicas.unwrap_or(named.scene.ensemble.replicas);
    let at = |message: String| format!("{}: {message}", named.source);
    Plan::new(&named.scene).map_err(|error| Failure::Input(at(error.to_string())))?;
    let stem = format!("converge-{}", named.stem);
    let out = (args.out.clone()).unwrap_or_else(|| Path::new("out").join(stem));
    probe(&out)?;
    let done = match named.scene.interaction {
        Some(_) => on_threads(args.threads, || interacting(&named.scene, args.quiet))?,
        // Milliseconds: no work for many.
        None if cluster::is_root() => free(&named.scene).map(Some),
        None => Ok(None),
    }
    .map_err(|failure| match failure {
        Failure::Input(message) => Failure::Input(at(message)),
        Failure::Failed(message) => Failure::Failed(at(message)),
    })?;
    let Some(done) = done else {
        return Ok(());
    };
    output::write_all(&out, &done.files)?;
    if !args.quiet {
        let names: Vec<_> = done.files.iter().map(|(name, _)| name.as_str()).collect();
        let text: String = done.tables.iter().map(export::text).collect();
        print(&format!("{text}in {}: {}\n", out.display(), names.join(", ")))?;
    }
    match done.wrong {
        None => Ok(()),
        Some(names) => Err(Failure::Failed(at(format!("order not as theory: {names}")))),
    }
}

/// What a study leaves.
struct Done {
    tables: Vec<ReportTable>,
    files: Vec<Output>,
    /// The subjects whose order is not that of theory.
    wrong: Option<String>,
}

fn done(
    tables: Vec<ReportTable>,
    csv: Result<String, String>,
    json: Result<String, String>,
) -> Result<Done, Failure> {
    let files = vec![
        ("converge.csv".to_owned(), csv.map_err(Failure::Failed)?),
        ("converge.json".to_owned(), json.map_err(Failure::Failed)?),
    ];
    Ok(Done {
        tables,
        files,
        wrong: None,
    })
}

/// Every fixed-step subject on one rod of the scene's mean aspect ratio.
fn free(scene: &Scene) -> Result<Done, Failure> {
    if scene.flow.shear_rate_per_s.is_none() {
        return Err(Failure::Input(
            "flow: the subjects turn rods in plane Couette flow; shear_rate_per_s is needed".into(),
        ));
    }
    let studies = order::of_all(scene.particles.aspect_ratio);
    let (csv, json) = (export::orders_csv(&studies), export::json(&studies));
    let wrong: Vec<_> = (studies.iter())
        .filter(|study| study.found == Found::Not)
        .map(|study| study.subject.as_str())
        .collect();
    Ok(Done {
        wrong: (!wrong.is_empty()).then(|| wrong.join(", ")),
        ..done(vec![tables::orders(&studies)], csv, json)?
    })
}

/// The mean of an interacting scene against steps, rods and replicas; none but on the root.
fn interacting(scene: &Scene, quiet: bool) -> Result<Option<Done>, Failure> {
    let bar = progress(law::work(scene) as u64, "runs", quiet);
    let law = law::law(scene, &|| bar.inc(1)).map_err(Failure::Failed)?;
    bar.finish_and_clear();
    law.map(|law| done(tables::law(&law), export::law_csv(&law), export::json(&law)))
        .transpose()
}
