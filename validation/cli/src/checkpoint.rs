//! Validation of a checkpoint's path.

use super::{Failure, number};
use shearbed_validation::files::checkpoint::{on_stop, stays};
use shearbed_validation::files::text::Shown;
use shearbed_validation::files::{cluster, output};
use std::path::{Component, Path, PathBuf};
use std::time::Duration;

/// Where a command keeps its state, and how often.
#[derive(clap::Args)]
pub(super) struct Kept {
    /// Keep the run in this file while it runs, and go on from there where the file exists, with more --replicas too
    #[arg(long = "checkpoint", id = "checkpoint", value_name = "FILE")]
    pub(super) file: Option<PathBuf>,
    /// Seconds between two checkpoints [default: 60]
    #[arg(long, value_name = "S", value_parser = seconds, requires = "checkpoint", allow_negative_numbers = true)]
    every: Option<Duration>,
}

impl Kept {
    pub(super) fn every(&self) -> Duration {
        self.every.unwrap_or(Duration::from_secs(60))
    }
}

/// Parses the time between two checkpoints or two lines of a log, in s.
pub(super) fn seconds(text: &str) -> Result<Duration, String> {
    let seconds = number(text, |s| (0.01..=86_400.0).contains(&s), "a number of seconds from 0.01 to 86400")?;
    Ok(Duration::from_secs_f64(seconds))
}

/// The extensions of result files.
const ENDINGS: [&str; 9] = ["csv", "svg", "json", "pvd", "vtp", "html", "md", "xml", "png"];

/// Checks a checkpoint's path, if there is one, and resolves its links; from then on the message after a signal says
/// that the file is kept. Refuses several ranks, and a name that results in `out` may have, whether they exist or not.
pub(super) fn check(checkpoint: Option<&Path>, out: &Path) -> Result<Option<PathBuf>, Failure> {
    let Some(checkpoint) = checkpoint else { return Ok(None) };
    let refused = |what: &str| Failure::Input(format!("--checkpoint {}: {what}", checkpoint.shown()));
    if let ranks @ 2.. = cluster::size() {
        return Err(refused(&format!("{ranks} ranks; one process alone is allowed")));
    }
    let path = output::followed(checkpoint);
    let (file, folder) = (resolved(&path), resolved(out));
    if folder.starts_with(&file) {
        return Err(refused(&format!("is --out {}, or a folder above it; another name is allowed", out.shown())));
    }
    let of_results = ENDINGS.iter().any(|end| file.extension().is_some_and(|own| own == *end));
    if of_results && file.starts_with(&folder) {
        return Err(refused(
            "a result may have that name; choose a checkpoint outside the output folder, or a name without .csv, .svg, \
             .json or the like at its end",
        ));
    }
    let kept = path.clone();
    on_stop(move || stays(&kept));
    Ok(Some(path))
}

/// The path with links resolved; the file or folder need not exist.
fn resolved(path: &Path) -> PathBuf {
    let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let mut resolved = PathBuf::new();
    for part in path.components() {
        match part {
            Component::ParentDir => _ = resolved.pop(),
            part => resolved.push(part),
        }
        if let Ok(real) = resolved.canonicalize() {
            resolved = real;
        }
    }
    resolved
}
