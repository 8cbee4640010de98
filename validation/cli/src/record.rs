//! `run.json`: a record of the run, which allows to repeat it.

use super::derived::per_rod_and_period;
use super::facts::Facts;
use super::until::Ended;
use serde::Serialize;
use shearbed::model::work::Counters;
use shearbed::plan::Entry;
use shearbed::{Plan, Results, Scene};
use shearbed_validation::files::build::{BUILD, Build};
use shearbed_validation::files::text::{self, command};

/// Wall times in seconds.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub(super) struct Seconds {
    /// Reading the scene and planning.
    pub(super) plan: f64,
    /// All replicas.
    pub(super) run: f64,
    /// Tables and pictures, without writing them.
    pub(super) tables_and_pictures: f64,
}

#[derive(Serialize)]
struct Record<'a> {
    #[serde(flatten)]
    build: Build,
    /// The command line, for a shell.
    command: String,
    /// The scene, with every default written out.
    scene: Scene,
    facts: Facts,
    seed: u64,
    plan: &'a [Entry],
    plan_text: String,
    /// Reasons to doubt the results.
    warnings: Vec<String>,
    counters: Counters,
    /// How often a rod collides in a period; none without collisions or period.
    #[serde(skip_serializing_if = "Option::is_none")]
    collisions_per_rod_and_period: Option<f64>,
    /// The choice of the number of replicas by `--until-se`; none without it.
    #[serde(skip_serializing_if = "Option::is_none")]
    until_se: Option<&'a Ended>,
    /// Number of processes of an MPI job.
    ranks: usize,
    /// Number of threads of each rank.
    threads: usize,
    seconds: Seconds,
    files: Vec<&'a str>,
}

/// The text of `run.json`.
pub(super) fn json(
    plan: &Plan,
    results: &Results,
    threads: usize,
    seconds: Seconds,
    files: Vec<&str>,
    until_se: Option<&Ended>,
) -> Result<String, String> {
    let record = Record {
        build: BUILD,
        command: command(super::words::words()),
        scene: plan.scene().resolved(),
        facts: Facts::of(plan),
        seed: plan.scene().ensemble.seed,
        plan: plan.entries(),
        plan_text: plan.to_string(),
        warnings: plan.warnings(),
        counters: results.counters,
        collisions_per_rod_and_period: per_rod_and_period(plan, results)
            .map(|each| each.value)
            .filter(|each| *each > 0.0),
        until_se,
        ranks: shearbed_validation::files::cluster::size(),
        threads,
        seconds,
        files,
    };
    text::json(&record).map_err(|error| error.to_string())
}
