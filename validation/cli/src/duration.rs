//! A rough estimate of the run time of suspensions before they start.

use super::{Failure, memory, threads};
use shearbed::Plan;
use shearbed::plan::{Stage, counted};
use shearbed::run::ensemble;
use shearbed_validation::files::cluster;
use shearbed_validation::methods::least_squares::basis::Basis;
use shearbed_validation::serve::fit::pictures::MOST_REPLICAS as MOST_DRAWN;
use shearbed_validation::serve::fit::search::{FIRST_REPLICAS, MOST_ROUNDS};
use shearbed_validation::studies::speed::{SECONDS_PER_DRAW, SECONDS_PER_OUTPUT, SECONDS_PER_ROD_AND_STEP};
use shearbed_validation::studies::suspensions::job::Job;
use shearbed_validation::studies::suspensions::law::{self, Replicas};

/// The longest pilot, in s.
const PILOT_S: f64 = 3.0;

/// The exponent of the rods, from 100 on, in the time of one of them: some 3 times as much at a million.
const BY_RODS: f64 = 0.11;

/// The longest work that begins unasked, in hours: longer work is more often a slip in a count than meant.
pub(super) const UNASKED_H: f64 = 24.0;

/// The option of commands that may work for days.
#[derive(clap::Args)]
pub(super) struct Long {
    /// Begin work of over a day
    #[arg(long)]
    pub(super) yes: bool,
}

impl Long {
    /// The hours that work may take from here on: a day unasked. Ranks of an MPI job, whose clocks differ, work on.
    pub(super) fn most_h(&self) -> f64 {
        if self.yes || cluster::size() > 1 { f64::INFINITY } else { UNASKED_H }
    }

    /// Refuses plans, each with its number of replicas, that would take more than [`UNASKED_H`] hours. A replica runs
    /// on one thread.
    pub(super) fn check(&self, source: &str, given: Option<u64>, plans: &[(&Plan, u64)]) -> Result<(), Failure> {
        let threads = threads::count(given)? * cluster::size() as u64;
        let guess = |(plan, replicas): &(&Plan, u64)| {
            let rounds = (*replicas as f64 / threads as f64).max(1.0);
            of_replica(plan, false) * rounds
        };
        let guessed_s: f64 = plans.iter().map(guess).sum();
        if self.yes || plans.is_empty() || guessed_s < 360.0 * UNASKED_H {
            return Ok(());
        }
        // A tenth of the limit is worth a pilot.
        let first = plans[0].0;
        let seconds = guessed_s * of_replica(first, true) / of_replica(first, false);
        self.refuse(&format!("{source}: "), seconds, threads)
    }

    /// Refuses a study of convergence that would take more than [`UNASKED_H`] hours.
    pub(super) fn check_jobs(&self, given: Option<u64>, jobs: &[Job]) -> Result<(), Failure> {
        let threads = threads::count(given)? * cluster::size() as u64;
        self.refuse("", rod_steps(jobs) * SECONDS_PER_ROD_AND_STEP / threads as f64, threads)
    }

    /// Refuses work of so many seconds if that is more than [`UNASKED_H`] hours.
    pub(super) fn refuse(&self, of: &str, seconds: f64, threads: u64) -> Result<(), Failure> {
        if self.yes || seconds < 3600.0 * UNASKED_H {
            return Ok(());
        }
        let threads = counted(threads, "thread");
        Err(Failure::Input(format!(
            "{of}takes {} on {threads}, by a rough estimate; more than {UNASKED_H} h begin with --yes alone; \
             fewer rods, steps, periods or replicas are allowed",
            about(seconds)
        )))
    }
}

/// Checks that a plan fits into memory with a replica on each thread, and that it takes less than a day unless `yes`;
/// the error says why it may not run.
pub fn may_run(plan: &Plan, threads: Option<u64>, source: &str, yes: bool) -> Result<(), String> {
    let replicas = plan.scene().ensemble.replicas;
    memory::check(plan, threads, source)
        .and_then(|()| Long { yes }.check(source, threads, &[(plan, replicas)]))
        .map_err(|failure| failure.message_and_code().0)
}

/// Seconds of a replica on one core: the time of the first replica, with its collisions; a guess by rods and steps
/// where that takes long, where `may_run` is false, or where the replica fails.
pub(super) fn of_replica(plan: &Plan, may_run: bool) -> f64 {
    let rods = plan.scene().particles.count as f64;
    let guess = if plan.steps() > 0 {
        rods * plan.steps() as f64 * SECONDS_PER_ROD_AND_STEP * (0.01 * rods).max(1.0).powf(BY_RODS)
    } else {
        rods * (SECONDS_PER_DRAW + plan.outputs() as f64 * SECONDS_PER_OUTPUT)
    };
    let start = cpu_s();
    let has_run = may_run && guess < 0.1 * PILOT_S && ensemble::replicas_of(plan, 0..1, &|| ()).is_ok();
    if has_run { cpu_s() - start } else { guess }
}

/// The CPU time of this process in s, which other processes on the machine hardly change.
#[cfg(unix)]
fn cpu_s() -> f64 {
    let now = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
    now.tv_sec as f64 + 1e-9 * now.tv_nsec as f64
}

/// The time since the first call in s.
#[cfg(not(unix))]
fn cpu_s() -> f64 {
    static FIRST: std::sync::LazyLock<std::time::Instant> = std::sync::LazyLock::new(std::time::Instant::now);
    FIRST.elapsed().as_secs_f64()
}

/// True if `replicas` that take so long each are a pilot.
pub(super) fn is_pilot(replicas: u64, each_s: f64) -> bool {
    replicas as f64 * each_s <= PILOT_S
}

pub(super) fn about(seconds: f64) -> String {
    match seconds {
        // A measured time is no better known.
        s if s < 5.0 => "below 5 s".to_owned(),
        s if s < 120.0 => format!("some {s:.0} s"),
        s if s < 7200.0 => format!("some {:.0} min", s / 60.0),
        s => format!("some {:.0} h", s / 3600.0),
    }
}

/// What a replica has to do, in rods × steps, or rods × outputs of free rods.
fn work(plan: &Plan) -> f64 {
    plan.scene().particles.count as f64 * plan.steps().max(plan.outputs() as u64) as f64
}

/// The most points of a sweep of which a replica is timed.
const PILOTS: usize = 8;

/// The cost of a sweep's points, as text; `may_run` as of [`of_replica`].
pub(super) fn of_sweep(points: &[&Plan], may_run: bool) -> String {
    let all: f64 = points.iter().map(|point| work(point) * point.scene().ensemble.replicas as f64).sum();
    // Rods that collide more take longer, so points spread evenly among them are timed.
    let timed = points.iter().step_by(points.len().div_ceil(PILOTS));
    let [seconds, of] = timed.fold([0.0, 0.0], |[s, of], point| [s + of_replica(point, may_run), of + work(point)]);
    let took = about(seconds / of * all);
    format!("sweep: {}, {took} of one core\n", counted(points.len() as u64, "point"))
}

/// The runs of usual fits of one to three parameters over those of their first box. Measured, with those beside the
/// search: 3,000 to 7,000; 15,000 (α and the spread of r_e) to 50,000 (α and m); 40,000 to 230,000, 91,000 on average.
const USUAL: [u64; 3] = [12, 10, 15];

/// The runs that a fit usually takes, all its parts together.
pub(super) fn usual_runs(parameters: usize, most_replicas: u64) -> u64 {
    match parameters.checked_sub(1) {
        // The curves and what is derived from them come after the scene as it is.
        None => most_replicas + 2 * most_replicas.min(MOST_DRAWN),
        Some(k) => USUAL[k.min(2)] * nodes(parameters) * FIRST_REPLICAS.min(most_replicas),
    }
}

/// The number of values at which a fit of so many parameters runs replicas, in each range.
pub(super) fn nodes(parameters: usize) -> u64 {
    if parameters == 0 { 1 } else { Basis::new(parameters).nodes.len() as u64 }
}

/// The cost of a fit of so many parameters, as text: of usual points, and of a long search, with `most` replicas at
/// each value;
/// `corners` are the ends of the ranges, and `may_run` as of [`of_replica`].
pub(super) fn of_fit((parameters, most): (usize, u64), corners: &[&Plan], may_run: bool) -> String {
    let each_s = corners.iter().map(|plan| of_replica(plan, may_run)).sum::<f64>() / corners.len() as f64;
    let took = |runs: u64| about(each_s * runs as f64);
    let (usual, most) = (usual_runs(parameters, most), nodes(parameters) * most);
    format!(
        "fit: usually some {usual} runs, {} of one core; a long search, {MOST_ROUNDS} boxes of {most} runs each, {}\n",
        took(usual),
        took(MOST_ROUNDS * most)
    )
}

/// The cost of a study's jobs, as text: `4.0e9 rods × steps, some 3 min of one core`.
pub(super) fn of_jobs(jobs: &[Job]) -> String {
    let rod_steps = rod_steps(jobs);
    format!("{rod_steps:.1e} rods × steps, {} of one core", about(rod_steps * SECONDS_PER_ROD_AND_STEP))
}

fn rod_steps(jobs: &[Job]) -> f64 {
    jobs.iter().map(|job| job.rod_steps() as f64).sum()
}

/// The cost of a run whose replicas take `each_s`, and of a study of an interacting scene, as text; of a run of free
/// rods where it takes five seconds or more.
pub(super) fn of_scene(plan: &Plan, each_s: f64, threads: Option<u64>) -> String {
    let scene = plan.scene();
    let rods = scene.particles.count as f64 * scene.ensemble.replicas as f64;
    let all_s = each_s * scene.ensemble.replicas as f64;
    let took = match threads {
        None | Some(1) => format!("{} of one core", about(all_s)),
        Some(threads) => format!("{} on {threads} threads", about(all_s / threads as f64)),
    };
    if !plan.runs(Stage::Contacts) {
        let rods_outputs = rods * plan.outputs() as f64;
        return if all_s < 5.0 { String::new() } else { format!("run: {rods_outputs:.1e} rods × outputs, {took}\n") };
    }
    let own = rods * plan.steps() as f64;
    let study = if law::judges(plan) {
        of_jobs(&law::jobs(&law::by_periods(plan), Replicas::CONVERGE))
    } else {
        "only plane Couette flow, and no particles.rods".to_owned()
    };
    format!("run: {own:.1e} rods × steps, {took}\nconverge: {study}\n")
}
