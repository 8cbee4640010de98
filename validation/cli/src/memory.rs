//! Refusal of scenes that need too much memory, before they start.

mod available;

use super::{Failure, refuse, rods, tables, threads};
use available::available;
use shearbed::Plan;
use shearbed::run::memory;
use shearbed_validation::studies::suspensions::job::{Job, Look};

/// Bytes that the program needs in addition to its work, including memory that the allocator does not return.
const PROGRAM: u64 = 32 << 20;

/// Bytes that a thread needs in addition to its replica: its stack.
const THREAD: u64 = 2 << 20;

/// Refuses a command where a limit of the shell leaves less than it needs for itself: later the system would end it
/// without a message. Of the address space most is only reserved, by the C library for each thread.
pub(super) fn check_start(on_threads: bool) -> Result<(), Failure> {
    const LEAST: u64 = 16 << 20;
    const WITH_THREADS: u64 = 208 << 20;
    const EACH_THREAD: u64 = 16 << 20;
    let threads = if on_threads { WITH_THREADS + threads::count(None)?.min(16) * EACH_THREAD } else { 0 };
    let needed = LEAST + threads;
    refuse(available::within_limits().filter(|free| *free < needed), |free| {
        let (needed, free) = (size(needed), size(free));
        let allowed = "a higher limit (ulimit -v, ulimit -d)";
        format!("this command needs {needed} of address space, and {free} are free; allowed: {allowed}")
    })
}

/// Refuses a plan that needs more memory than is available, with `threads` replicas at a time.
pub(super) fn check(plan: &Plan, threads: Option<u64>, source: &str) -> Result<(), Failure> {
    check_each([(plan, source.to_owned())], threads, false, 0)
}

/// The same of several plans with the sources of their messages, with `vtk` files for ParaView and `beside` further
/// bytes for each replica. The system is asked once. If the available memory is unknown, nothing is refused.
pub(super) fn check_each<'a>(
    plans: impl IntoIterator<Item = (&'a Plan, String)>,
    threads: Option<u64>,
    vtk: bool,
    beside: u64,
) -> Result<(), Failure> {
    let threads = threads::count(threads)?;
    let Some(free) = available() else { return Ok(()) };
    plans.into_iter().try_for_each(|(plan, source)| {
        fits(plan, threads, vtk, free, beside).map_err(|message| Failure::Input(format!("{source}: {message}")))
    })
}

/// Refuses jobs if one of them needs more memory than is available next to the results of all.
pub(super) fn check_jobs(jobs: &[Job], threads: Option<u64>) -> Result<(), Failure> {
    let threads = threads::count(threads)?;
    let free = available().unwrap_or(u64::MAX);
    let left: u64 = jobs.iter().map(left_by).sum();
    for job in jobs {
        let mut scene = job.scene.clone();
        scene.ensemble.replicas = job.replicas;
        let plan = Plan::new(&scene)?;
        let at_once = threads.min(job.replicas);
        // Directions are copied for evaluation.
        let copies = at_once * 24 * scene.particles.count as u64;
        let needed = memory::bytes(&plan, at_once) + copies + threads * THREAD + PROGRAM + left;
        refuse((needed > free).then_some(scene.particles.count), |rods| {
            let (count, needed, free) = (jobs[0].scene.particles.count, size(needed), size(free));
            let need = format!("{at_once} replicas at a time need {needed} of memory, and {free} are free");
            let allowed = "fewer --threads, --replicas or particles";
            format!("particles.count = {count}: with {rods} rods, {need}; allowed: {allowed}")
        })?;
    }
    Ok(())
}

/// The bytes of a job's results, which are kept until all jobs are done.
fn left_by(job: &Job) -> u64 {
    let looks = job.replicas * (job.marks.len() * size_of::<Look>()) as u64;
    looks + job.followed.min(job.replicas) * 24 * job.scene.particles.count as u64
}

/// The bytes that a run of a plan needs, with its results and their tables and pictures at its end, and `beside` bytes
/// for each replica.
fn needed(plan: &Plan, threads: u64, vtk: bool, beside: u64) -> u64 {
    // A growing text may reserve twice its length.
    let rods = rods::most_bytes(plan, vtk).saturating_mul(2);
    let replicas = threads.min(plan.scene().ensemble.replicas);
    let rest = replicas * beside + threads * THREAD + PROGRAM + tables::most_memory(plan);
    memory::bytes(plan, threads).saturating_add(rest).saturating_add(rods)
}

/// Refuses the output of every rod at the requested times, if the plan would fit in memory without it.
fn rods_fit(plan: &Plan, threads: u64, vtk: bool, free: u64) -> Result<(), String> {
    let mut scene = plan.scene().clone();
    scene.output.drop_rods();
    let without = Plan::new(&scene).map_err(|error| error.to_string())?;
    if plan.rods_out() == 0 || needed(&without, threads, false, 0) > free {
        return Ok(());
    }
    let output = &plan.scene().output;
    let at = (!output.rods_at.is_empty()).then(|| format!("output.rods_at = {:?}", output.rods_at));
    let every = output.rods_every.map(|every| format!("output.rods_every = {every}"));
    let keys: Vec<_> = [at, every].into_iter().flatten().collect();
    Err(format!(
        "{}: {} times of {} rods in each of {} replicas make files of up to {} and need {} of memory, and {} are free; \
         allowed: fewer times, rods or replicas",
        keys.join(", "),
        plan.rods_outputs().len(),
        plan.scene().particles.count,
        plan.scene().ensemble.replicas,
        size(rods::most_bytes(plan, vtk)),
        size(needed(plan, threads, vtk, 0)),
        size(free),
    ))
}

fn fits(plan: &Plan, threads: u64, vtk: bool, free: u64, beside: u64) -> Result<(), String> {
    let most = needed(plan, threads, vtk, beside);
    if most <= free {
        return Ok(());
    }
    rods_fit(plan, threads, vtk, free)?;
    let replicas = threads.min(plan.scene().ensemble.replicas);
    let least = needed(plan, 1, vtk, beside);
    let allowed = if least <= free {
        format!("fewer --threads: {} with one", size(least))
    } else {
        format!("fewer: one replica needs {}", size(least))
    };
    Err(format!(
        "particles.count = {}: {replicas} at a time of {} replicas, with {} outputs each, need {} of memory, and {} \
         are free; allowed: {allowed}",
        plan.scene().particles.count,
        plan.scene().ensemble.replicas,
        plan.outputs(),
        size(most),
        size(free),
    ))
}

fn size(bytes: u64) -> String {
    format!("{:.2} GB", 1e-9 * bytes as f64)
}
