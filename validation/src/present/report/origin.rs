//! Where, when and from which sources a report was made.

use super::ScenePlan;
use super::formats::utc;
use crate::files::bounded;
use crate::files::build::{BUILD, SOURCES};
use crate::input::experiment::Stated;
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;
use std::time::{SystemTime, UNIX_EPOCH};

/// What is needed to repeat the run. Values that cannot be found out are "unknown".
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Origin {
    /// The command line.
    pub command: String,
    /// Version of the package.
    pub version: String,
    /// Commit of the sources, with `-dirty` if they had been changed.
    pub commit: String,
    /// A digest of the sources, of the compiler and of its settings.
    pub sources: String,
    /// Version of the compiler.
    pub rustc: String,
    /// Profile of cargo: `release`, or `debug` as by `cargo run`, in which what computes is optimised.
    pub build: String,
    /// Model of the processor.
    pub processor: String,
    /// Number of hardware threads.
    pub threads: usize,
    /// Operating system and architecture.
    pub system: String,
    /// Date and time of the report, RFC 3339.
    pub date: String,
    /// Source of the random numbers, in words.
    pub seeds: String,
    /// What the files of measured points say of them.
    pub points: Vec<Stated>,
}

impl Origin {
    /// The origin of this run, with figures drawn from the scenes of `plans` and these measured points.
    pub fn here(command: String, plans: &[ScenePlan], points: Vec<Stated>) -> Self {
        let since_1970 = SystemTime::now().duration_since(UNIX_EPOCH);
        Self {
            command,
            version: BUILD.version.into(),
            commit: BUILD.commit.into(),
            sources: SOURCES.into(),
            rustc: BUILD.rustc.into(),
            build: BUILD.build.into(),
            processor: processor().unwrap_or_else(|| "unknown".into()),
            threads: std::thread::available_parallelism().map_or(1, Into::into),
            system: format!("{} {}", std::env::consts::OS, std::env::consts::ARCH),
            date: since_1970.map_or("unknown".into(), |time| utc(time.as_secs())),
            seeds: seeds(plans),
            points,
        }
    }
}

/// The source of the cases' random numbers, and the scenes of each seed.
fn seeds(plans: &[ScenePlan]) -> String {
    let mut scenes = BTreeMap::<u64, Vec<&str>>::new();
    for plan in plans {
        scenes.entry(plan.seed).or_default().push(&plan.scene);
    }
    let of_scenes = scenes.iter().map(|(seed, names)| format!("; {seed} of the scenes {}", names.join(", ")));
    let of_scenes: String = of_scenes.collect();
    format!("fixed in the source of each case{of_scenes}. No result depends on the number of threads")
}

/// Size limit in bytes of the system's description of processors: some kB for each.
const MOST_BYTES: u64 = 64 << 20;

fn processor() -> Option<String> {
    if let Ok(text) = bounded::text(Path::new("/proc/cpuinfo"), MOST_BYTES) {
        let line = text.lines().find(|line| line.starts_with("model name"))?;
        return line.split_once(':').map(|(_, name)| name.trim().to_string());
    }
    let mac = output(Command::new("sysctl").args(["-n", "machdep.cpu.brand_string"]));
    mac.or_else(|| std::env::var("PROCESSOR_IDENTIFIER").ok())
}

/// The output of a command; `None` if it is missing or fails.
fn output(command: &mut Command) -> Option<String> {
    let output = command.output().ok().filter(|output| output.status.success())?;
    let text = String::from_utf8(output.stdout).ok()?.trim().to_string();
    (!text.is_empty()).then_some(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scenes_are_listed_by_their_seeds() {
        let plan = |scene: &str, seed| ScenePlan { scene: scene.into(), seed, ..Default::default() };
        let text = seeds(&[plan("a", 2), plan("b", 1), plan("c", 2)]);
        assert!(text.contains("; 1 of the scenes b; 2 of the scenes a, c."), "{text}");
    }

    #[test]
    fn nothing_is_empty() {
        let origin = Origin::here("shearbed validate".into(), &[], Vec::new());
        assert!(origin.threads > 0);
        assert!(!origin.commit.is_empty() && !origin.processor.is_empty());
        assert!(origin.rustc.starts_with("rustc ") && origin.date.ends_with('Z'));
    }
}
