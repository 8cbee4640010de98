//! The measurements: each is the least of several, after one for warming up.

use super::*;
use crate::methods::least_work::{plain_sum, sum_of_inverse_roots};
use crate::oracle::reference::motion::{Motion, Unit};
use crate::oracle::reference::table::{self, Start};
use crate::studies::work_precision::seconds;
use shearbed::run::memory;
use std::hint::black_box;

#[derive(Clone, Copy)]
pub(super) struct Amount {
    /// Number of measurements; the least of them counts.
    repeats: usize,
    /// Number of rods for the memory rate.
    free_rods: usize,
    /// Number of rods of one run over all cores.
    large_run: usize,
    /// Approximate duration of the steps of one measurement, s.
    seconds: f64,
}

impl Amount {
    pub const FULL: Self = Self { repeats: 7, free_rods: 10_000_000, large_run: 1_000_000, seconds: 0.2 };
    pub const QUICK: Self = Self { repeats: 3, free_rods: 2_000_000, large_run: 300_000, seconds: 0.02 };
}

#[derive(Serialize)]
pub(super) struct Speed {
    pub threads: usize,
    pub checks: Vec<Check>,
    /// Time of a step of the paper's suspension against the number of rods, on one core.
    pub by_rods: Vec<Step>,
    /// Time of a step against the concentration, from dilute to dense, on one core.
    pub by_concentration: Vec<Step>,
}

#[derive(Serialize)]
pub(super) struct Check {
    pub what: &'static str,
    pub measured: f64,
    pub target: Target,
    pub unit: &'static str,
    /// The numbers from which it is computed.
    pub behind: String,
}

#[derive(Clone, Copy, Serialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Target {
    AtMost(f64),
    AtLeast(f64),
}

impl Check {
    pub fn over_target(&self) -> f64 {
        let (Target::AtMost(target) | Target::AtLeast(target)) = self.target;
        self.measured / target
    }

    pub fn met(&self) -> bool {
        match self.target {
            Target::AtMost(most) => self.measured <= most,
            Target::AtLeast(least) => self.measured >= least,
        }
    }
}

#[derive(Clone, Copy, Serialize)]
pub(super) struct Step {
    pub rods: usize,
    pub concentration_per_cm3: f64,
    /// The core's time per rod and step in ns.
    pub core_ns: f64,
    /// The naive reference's time per rod and step in ns, if it was measured.
    pub naive_ns: Option<f64>,
}

const RODS: [usize; 6] = [30, 100, 1_000, 10_000, 100_000, 1_000_000];
const CONCENTRATIONS_PER_CM3: [f64; 6] = [0.5, 5.0, 50.0, 500.0, 5_000.0, 50_000.0];
/// The largest number of rods for the naive reference, which is slow.
const NAIVE_RODS: usize = 10_000;

/// Runs all measurements; ignores the number of threads of the caller.
pub(super) fn measure(amount: Amount) -> Result<Speed, String> {
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let one = pool(1)?;
    let by_rods: Vec<_> =
        (RODS.iter()).map(|rods| one.install(|| step(*rods, 50.0, amount))).collect::<Result<_, _>>()?;
    let by_concentration =
        (CONCENTRATIONS_PER_CM3.iter()).map(|n| one.install(|| step(1000, *n, amount))).collect::<Result<_, _>>()?;
    let all = pool(threads)?;
    let mut checks = vec![
        free("free rods of one r_e, per rod and output", 0.0, Target::AtMost(1.2), &one, amount),
        free("free rods of unequal r_e, per rod and output", 3.6, Target::AtMost(4.0), &one, amount),
        memory_rate(&all, amount),
    ];
    checks.extend(against_naive(&by_rods));
    checks.extend(efficiencies([&one, &all], amount)?);
    checks.extend([memory_of_a_rod(), plan_of_a_scene(amount), certified(&all, amount)]);
    Ok(Speed { threads, checks, by_rods, by_concentration })
}

fn pool(threads: usize) -> Result<rayon::ThreadPool, String> {
    let built = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    built.map_err(|error| format!("cannot start {threads} threads: {error}"))
}

/// The least of several measurements in seconds, after one for warming up.
fn least(amount: Amount, mut measure: impl FnMut() -> f64) -> f64 {
    measure();
    (0..amount.repeats).map(|_| measure()).fold(f64::INFINITY, f64::min)
}

/// The time of a step, from a number of steps that takes about the time in `amount`.
fn step(rods: usize, concentration_per_cm3: f64, amount: Amount) -> Result<Step, String> {
    let scene = lab::crowded_scene(&Effort::gate(), rods, concentration_per_cm3);
    let mut suspension = lab::suspension(&scene, 0);
    let steps = |suspension: &mut Suspension, count: u64| (0..count).try_for_each(|_| suspension.step().map(|_| ()));
    // The first steps set up the buffers.
    let mut failed = steps(&mut suspension, 2).err();
    let once = seconds(|| suspension.step().map(<[_]>::len)).max(1e-7);
    let count = (amount.seconds / once).clamp(1.0, 1e6) as u64;
    let core = least(amount, || seconds(|| failed = steps(&mut suspension, count).err().or(failed.take())));
    if let Some(error) = failed {
        return Err(error.to_string());
    }
    let per_rod = |seconds: f64, steps: u64| 1e9 * seconds / (steps as f64 * rods as f64);
    let naive_ns = (rods <= NAIVE_RODS && concentration_per_cm3 == 50.0).then(|| {
        let mut naive = Naive::new(NaiveProblem { count: rods, ..NaiveProblem::paper(1, 0) });
        let once = seconds(|| naive.step());
        let count = (amount.seconds / once).clamp(1.0, 1e6) as u64;
        let repeats = Amount { repeats: if once > 0.1 { 1 } else { amount.repeats }, ..amount };
        per_rod(least(repeats, || seconds(|| (0..count).for_each(|_| naive.step()))), count)
    });
    Ok(Step { rods, concentration_per_cm3, core_ns: per_rod(core, count), naive_ns })
}

/// The core's time compared with the naive reference's, and its growth with the number of rods.
fn against_naive(by_rods: &[Step]) -> Vec<Check> {
    let at = |rods: usize| by_rods.iter().find(|step| step.rods == rods);
    let ratio = |what, rods, target| {
        let step = at(rods)?;
        let naive = step.naive_ns?;
        Some(Check {
            what,
            measured: naive / step.core_ns,
            target: Target::AtLeast(target),
            unit: "×",
            behind: format!("{:.1} ns and {naive:.0} ns per rod and step, one core", step.core_ns),
        })
    };
    let growth = at(100).zip(at(1_000_000)).map(|(few, many)| Check {
        what: "the cost per rod and step at 10⁶ rods over that at 10²",
        measured: many.core_ns / few.core_ns,
        target: Target::AtMost(2.0),
        unit: "×",
        behind: format!("{:.1} ns and {:.1} ns, one core", few.core_ns, many.core_ns),
    });
    [
        ratio("a step of 100 rods: the naive reference's time over the core's", 100, 12.0),
        ratio("a step of 10⁴ rods: the naive reference's time over the core's", 10_000, 300.0),
        growth,
    ]
    .into_iter()
    .flatten()
    .collect()
}

fn free_plan(rods: usize, outputs: u64, sd_percent: f64) -> Plan {
    let mut scene = lab::free_scene(&Effort::gate());
    scene.particles.count = rods;
    scene.particles.aspect_ratio_sd_percent = sd_percent;
    scene.time = Time { outputs_per_unit: Some(outputs), ..Time::periods(1.0) };
    scene.ensemble.replicas = 1;
    lab::plan(&scene)
}

/// The time of an output of free rods, beside the roots and quotients in it: bringing a direction to length 1 takes one
/// of each.
fn free(what: &'static str, sd_percent: f64, target: Target, one: &rayon::ThreadPool, amount: Amount) -> Check {
    const RODS: usize = 10_000;
    let run = |outputs| {
        let plan = free_plan(RODS, outputs, sd_percent);
        least(amount, || one.install(|| seconds(|| run_replica(&plan, 0))))
    };
    let (few, many) = (run(50), run(500));
    let squares: Vec<_> = (1..=RODS).map(|k| k as f64).collect();
    let roots = least(amount, || {
        one.install(|| seconds(|| (0..100).map(|_| sum_of_inverse_roots(black_box(&squares))).sum::<f64>()))
    });
    let per_rod = |seconds: f64, times: f64| 1e9 * seconds / (times * RODS as f64);
    Check {
        what,
        measured: per_rod(many - few, 450.0),
        target,
        unit: "ns",
        behind: format!(
            "10⁴ rods, projections with standard errors, one core; {:.2} ns with the draws and 51 outputs; a root and \
             a quotient alone take {:.2} ns",
            per_rod(few, 51.0),
            per_rod(roots, 100.0)
        ),
    }
}

/// The rate at which outputs process the bytes of directions, over the rate of summing the same arrays.
fn memory_rate(all: &rayon::ThreadPool, amount: Amount) -> Check {
    let bytes = 24.0 * amount.free_rods as f64;
    let (few, many) = (free_plan(amount.free_rods, 1, 0.0), free_plan(amount.free_rods, 33, 0.0));
    let run = |plan: &Plan| least(amount, || all.install(|| seconds(|| run_replica(plan, 0))));
    // The difference removes the time for drawing the rods.
    let per_output = (run(&many) - run(&few)) / (many.outputs() - few.outputs()) as f64;
    let arrays = [0.25f64, 0.5, 0.75].map(|value| vec![value; amount.free_rods]);
    let sum = least(amount, || {
        let total = |axis: &Vec<f64>| -> f64 { axis.par_chunks(1 << 16).map(plain_sum).sum() };
        all.install(|| seconds(|| arrays.iter().map(total).sum::<f64>()))
    });
    Check {
        what: "free rods on all cores: rate over that of a plain sum of the same arrays",
        measured: sum / per_output,
        target: Target::AtLeast(0.6),
        unit: "×",
        behind: format!(
            "{:.0e} rods: {:.1} GB/s for an output, {:.1} GB/s for the sum",
            amount.free_rods as f64,
            1e-9 * bytes / per_output,
            1e-9 * bytes / sum
        ),
    }
}

/// The parallel efficiency of replicas, and of one run of many rods.
fn efficiencies(pools: [&rayon::ThreadPool; 2], amount: Amount) -> Result<[Check; 2], String> {
    let replicas = 64 * pools[1].current_num_threads() as u64;
    let mut small = lab::interacting_scene(&Effort::gate());
    small.time.duration = 1.0;
    let mut large = small.clone();
    small.ensemble.replicas = replicas;
    large.particles.count = amount.large_run;
    large.time = Time { outputs_per_unit: Some(25), ..Time::periods(0.04) };
    let what = "replicas over all cores: the time on one core over that on all, and over their number";
    let of_replicas = efficiency(what, &small, (0.9, &format!(", {replicas} replicas")), pools, amount)?;
    let what = "one large run over all cores: the time on one core over that on all, and over their number";
    let work = format!("; {:.0e} rods, 8 steps and the draws", amount.large_run as f64);
    Ok([of_replicas, efficiency(what, &large, (0.85, &work), pools, amount)?])
}

/// The time of a scene on one thread over that on all, and over their number.
fn efficiency(
    what: &'static str,
    scene: &Scene,
    (least_efficiency, work): (f64, &str),
    pools: [&rayon::ThreadPool; 2],
    amount: Amount,
) -> Result<Check, String> {
    let plan = lab::plan(scene);
    ensemble::run(&plan).map_err(|error| error.to_string())?;
    let [alone, shared] = pools.map(|pool| least(amount, || pool.install(|| seconds(|| ensemble::run(&plan)))));
    let threads = pools[1].current_num_threads();
    Ok(Check {
        what,
        measured: alone / shared / threads as f64,
        target: Target::AtLeast(least_efficiency),
        unit: "×",
        behind: format!("{alone:.3} s on one, {shared:.3} s on {threads}{work}"),
    })
}

/// The memory of a run of 10⁶ rods, which `tests/memory.rs` confirms to within 5 %.
fn memory_of_a_rod() -> Check {
    let bytes = |sd_percent: f64| {
        let mut scene = lab::interacting_scene(&Effort::gate());
        scene.particles.count = 1_000_000;
        scene.particles.aspect_ratio_sd_percent = sd_percent;
        scene.ensemble.replicas = 1;
        memory::bytes(&lab::plan(&scene), 1) as f64 / 1e6
    };
    Check {
        what: "memory of an interacting rod",
        measured: bytes(0.0),
        target: Target::AtMost(80.0),
        unit: "bytes",
        behind: format!(
            "10⁶ rods; place, direction and its step are 52, the rest is the search and collisions; {:.1} with an r_e \
             of its own",
            bytes(3.6)
        ),
    }
}

/// The time of checking and planning the paper's suspension, before it runs.
fn plan_of_a_scene(amount: Amount) -> Check {
    let scene = lab::interacting_scene(&Effort::gate());
    Check {
        what: "a plan of 100 interacting rods",
        measured: 1e3 * least(amount, || seconds(|| Plan::new(&scene))),
        target: Target::AtMost(5.0),
        unit: "ms",
        behind: "all checks, stages and warnings".into(),
    }
}

/// The time of certified means: 10⁵ of them in 10 s are 0.1 ms each.
fn certified(all: &rayon::ThreadPool, amount: Amount) -> Check {
    const TIMES: usize = 400;
    let motion = Motion { gradient_per_s: [[0.0; 3], [1.0, 0.0, 0.0], [0.0; 3]], aspect_ratio: 11.6 };
    let times: Vec<_> = (0..TIMES).map(|k| 0.01 * k as f64).collect();
    let start = Start::Isotropic { aspect_ratio_sd_percent: 0.0, fourth: false };
    let whole = || table::table(&motion, start, &times, Unit::Period, || ());
    Check {
        what: "certified means over isotropic rods, per time, over all cores",
        measured: 1e3 * least(amount, || all.install(|| seconds(whole))) / TIMES as f64,
        target: Target::AtMost(0.1),
        unit: "ms",
        behind: "nine means of r_e = 11.6, each the nearest double".into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TINY: Amount = Amount { repeats: 1, free_rods: 1000, large_run: 1000, seconds: 1e-5 };

    #[test]
    fn a_step_is_measured_of_both() {
        let step = step(50, 50.0, TINY).unwrap();
        assert!(step.core_ns > 0.0 && step.naive_ns.unwrap() > 0.0);
        assert_eq!(super::step(50, 5.0, TINY).unwrap().naive_ns, None);
    }

    #[test]
    fn ratios_are_of_the_same_number_of_rods() {
        let step = |rods, core_ns, naive_ns| Step { rods, concentration_per_cm3: 50.0, core_ns, naive_ns };
        let steps = [step(100, 20.0, Some(300.0)), step(10_000, 40.0, Some(30_000.0)), step(1_000_000, 50.0, None)];
        let measured: Vec<_> = against_naive(&steps).iter().map(|check| check.measured).collect();
        assert_eq!(measured, [15.0, 750.0, 2.5]);
    }
}
