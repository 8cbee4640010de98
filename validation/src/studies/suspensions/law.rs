//! Convergence in law: how an interacting scene's X̄₁ at t/T = 1, and the distribution of its directions, depend on the
//! steps per period, the rods and the replicas. The study is a list of independent jobs, and an evaluation of their
//! results.

use super::blocks::{Block, blocks, replicas_exponent};
use super::fit::{Line, Means, Order};
use super::job::{Job, PLACES, Trace, x1};
use super::*;
use shearbed::scene::TimeUnit;
use std::collections::BTreeSet;

/// The numbers of steps per period that are tried.
pub const STEPS_PER_PERIOD: [u64; 10] = [20, 50, 100, 200, 400, 800, 1600, 3200, 6400, 12800];

/// The numbers of rods that are tried.
pub const RODS: [usize; 6] = [25, 50, 100, 200, 400, 1000];

/// The exponent of N in the bias: rods near a face of the volume lack neighbours, and the share of the volume within
/// a rod length of a face is ∝ 1/H ∝ N^(−1/3).
pub const FACES: f64 = -1.0 / 3.0;

/// The times t/T at which X̄₁ is compared between steps.
pub const QUARTERS: [f64; 4] = [0.25, 0.5, 0.75, 1.0];

/// Number of replicas whose rods are compared one by one between two steps.
const FOLLOWED: u64 = 16;

/// The number of replicas of each job.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Replicas {
    /// The same number for all jobs.
    Each(u64),
    /// The largest number that keeps a job below `rod_steps`, at least 8 and at most `most`.
    Within {
        /// Rods times steps of a job, over all replicas.
        rod_steps: u64,
        /// The largest number of replicas.
        most: u64,
    },
}

impl Replicas {
    /// The choice for `shearbed converge`: about three minutes of one core.
    pub const CONVERGE: Self = Self::Within { rod_steps: 400_000_000, most: 20_000 };

    fn of_job(self, steps_per_period: u64, rods: usize) -> u64 {
        match self {
            Self::Each(replicas) => replicas,
            Self::Within { rod_steps, most } => (rod_steps / (steps_per_period * rods as u64)).clamp(8, most),
        }
    }
}

/// The result of one job for X̄₁ at t/T = 1.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct JobMean {
    pub(crate) steps_per_period: u64,
    pub(crate) rods: usize,
    pub(crate) replicas: u64,
    /// The mean of |p_1| over rods and replicas.
    pub x1: f64,
    pub(crate) se: f64,
}

/// The results at one number of steps per period less those at the next finer one, at the same seeds.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Change {
    pub(crate) x1: Estimate,
    /// The correlation of X̄₁ between the two; its standard error is that for normal variables.
    pub correlation: Estimate,
    /// The change of the share of rods with |p_1| below 0.1, 0.2, … 0.9, for the bound where it is largest in standard
    /// errors.
    pub p1_distribution: Estimate,
    /// The same change for C_b.
    pub orbit_distribution: Estimate,
    /// The root mean square angle between the same rod in both, up to sign.
    pub apart_rad: f64,
    /// The same angle between different rods, for comparison: unrelated directions.
    pub unrelated_rad: f64,
}

/// X̄₁ at [`QUARTERS`] of the period at one number of steps, which they divide.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Quarters {
    pub(crate) steps_per_period: u64,
    pub(crate) x1: [Estimate; 4],
    /// X̄₁ less that at the finest step, at the same seeds; `None` for the finest itself.
    pub less_finest: Option<[Estimate; 4]>,
}

/// The results of the study.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Law {
    pub(crate) steps: Vec<JobMean>,
    pub(crate) changes: Vec<Change>,
    /// Results within the period against the steps per period, coarse to fine.
    pub quarters: Vec<Quarters>,
    /// The first of the levels with GΔt ≤ 1, which resolve a flip: from it on an order may be determined.
    pub resolved_from: usize,
    /// The weak order over those levels, if the noise allows it and two differences are distinct from 0.
    pub order: Option<Order>,
    /// X̄₁ against 1/(steps per period) over those levels, or from a finer level if no straight line fits: first order.
    pub steps_line: Option<Line>,
    /// The first level of that line.
    pub line_from: usize,
    pub(crate) rods: Vec<JobMean>,
    /// Lines of X̄₁ against N^(−1/3), and against 1/N.
    pub rods_lines: [Option<Line>; 2],
    /// Blocks of replicas of the scene as it is.
    pub blocks: Vec<Block>,
    /// The exponent of the number of replicas in the standard deviation of their mean; `None` for fewer than 1024.
    pub replicas_exponent: Option<Estimate>,
    /// N times the variance of X̄₁ over replicas.
    pub variance_per_rod: f64,
    /// Rods times steps of all jobs.
    pub rod_steps: u64,
}

/// True if the study applies to a plan's scene: plane Couette flow, and rods that are drawn.
pub fn judges(plan: &Plan) -> bool {
    // A study has other numbers of rods than a file.
    plan.flow().shear_rate_per_s().is_some() && plan.scene().particles.rods.is_none()
}

/// The scene of a plan that the study judges, with its time in periods and about as many steps in each.
pub fn by_periods(plan: &Plan) -> Scene {
    let mut scene = plan.scene().clone();
    let per_period = plan.elapsed(1.0).strain / strain_per_period(scene.particles.mean_aspect_ratio());
    if scene.time.unit != TimeUnit::Period {
        let steps = scene.time.steps_per_unit.map(|steps| (steps as f64 / per_period).round().max(1.0) as u64);
        scene.time = Time { steps_per_unit: steps, ..Time::periods(scene.time.duration * per_period) };
    }
    scene
}

/// The jobs of a scene: every number of steps, then every number of rods, each once.
pub fn jobs(scene: &Scene, replicas: Replicas) -> Vec<Job> {
    let (own_steps, own_rods) = (scene.steps_per_unit(), scene.particles.count);
    let job = |steps, rods| Job::new(scene, steps, rods, replicas.of_job(steps, rods), 1);
    let every_steps: BTreeSet<_> = STEPS_PER_PERIOD.into_iter().chain([own_steps]).collect();
    let mut jobs: Vec<_> = (every_steps.into_iter())
        .map(|steps| {
            let followed = FOLLOWED.min(replicas.of_job(steps, own_rods));
            let job = job(steps, own_rods);
            let marks = if steps % 4 == 0 { [1, 2, 3, 4].map(|k| k * steps / 4).to_vec() } else { job.marks };
            Job { followed, marks, ..job }
        })
        .collect();
    let rods = RODS.iter().filter(|rods| **rods != own_rods);
    jobs.extend(rods.map(|rods| job(own_steps, *rods)));
    jobs
}

/// Runs every job, one after the other, on the threads of the current pool. `finished` is called after each replica.
pub fn run(jobs: &[Job], finished: &(dyn Fn() + Sync)) -> Result<Vec<Vec<Trace>>, String> {
    jobs.iter().map(|job| job.run(finished)).collect()
}

/// Evaluates the traces of the jobs of [`jobs`].
pub fn read(scene: &Scene, jobs: &[Job], traces: &[Vec<Trace>]) -> Law {
    let (own_steps, own_rods) = (scene.steps_per_unit(), scene.particles.count);
    let x1: Vec<_> = traces.iter().map(|of_job| x1(of_job)).collect();
    let chosen = |which: &dyn Fn(&Job) -> bool| -> Vec<usize> {
        let mut chosen: Vec<_> = (0..jobs.len()).filter(|k| which(&jobs[*k])).collect();
        chosen.sort_by_key(|k| (jobs[*k].scene.particles.count, jobs[*k].scene.steps_per_unit()));
        chosen
    };
    let steps = chosen(&|job| job.scene.particles.count == own_rods);
    let rods = chosen(&|job| job.scene.steps_per_unit() == own_steps);
    let samples = |which: &[usize]| which.iter().map(|k| sample(&jobs[*k], &x1[*k])).collect();
    let of = |which: &[usize]| Means::of(&which.iter().map(|k| x1[*k].clone()).collect::<Vec<_>>());

    let (means, h) = (of(&steps), steps.iter().map(|k| 1.0 / jobs[*k].scene.steps_per_unit() as f64));
    let h: Vec<f64> = h.collect();
    let changes: Vec<_> =
        (steps.windows(2).enumerate()).map(|(k, pair)| change(&means, k, &traces[pair[0]], &traces[pair[1]])).collect();
    let by_steps: Vec<_> = steps.iter().map(|k| (jobs[*k].scene.steps_per_unit(), &traces[*k][..])).collect();
    let strain = strain_per_period(scene.particles.aspect_ratio);
    let resolved_from = h.iter().position(|h| strain * h <= 1.0).unwrap_or(h.len().saturating_sub(1));
    let known = changes[resolved_from.min(changes.len())..].iter().filter(|change| change.x1.readable());
    let order = match known.count() {
        0 | 1 => None,
        _ => means.from(resolved_from).order(&h[resolved_from..]),
    };
    let (line_from, steps_line) = first_order(&means, &h, resolved_from);

    let of_rods = of(&rods);
    let counts: Vec<f64> = (rods.iter()).map(|k| jobs[*k].scene.particles.count as f64).collect();
    let against = |exponent: f64| {
        let x: Vec<_> = counts.iter().map(|count| count.powf(exponent)).collect();
        of_rods.line(&x)
    };
    let own = (steps.iter()).find(|k| jobs[**k].scene.steps_per_unit() == own_steps);
    let own = own.map_or(&[][..], |k| &x1[*k]);
    Law {
        steps: samples(&steps),
        changes,
        quarters: quarters(&by_steps),
        resolved_from,
        order,
        steps_line,
        line_from,
        rods: samples(&rods),
        rods_lines: [against(FACES), against(-1.0)],
        blocks: blocks(own),
        replicas_exponent: replicas_exponent(own),
        variance_per_rod: super::covariance(own, own) * own_rods as f64,
        rod_steps: jobs.iter().map(Job::rod_steps).sum(),
    }
}

fn sample(job: &Job, x1: &[f64]) -> JobMean {
    let mean = Estimate::mean_of(x1);
    JobMean {
        steps_per_period: job.scene.steps_per_unit(),
        rods: job.scene.particles.count,
        replicas: job.replicas,
        x1: mean.value,
        se: mean.se,
    }
}

/// X̄₁ within the period at the levels that were looked at there.
fn quarters(levels: &[(u64, &[Trace])]) -> Vec<Quarters> {
    let seen: Vec<_> = levels.iter().filter(|(_, traces)| traces[0].looks.len() == QUARTERS.len()).collect();
    let of = |traces: &[Trace], k: usize| traces.iter().map(|trace| trace.looks[k].x1).collect::<Vec<_>>();
    let means = [0, 1, 2, 3].map(|k| Means::of(&seen.iter().map(|(_, traces)| of(traces, k)).collect::<Vec<_>>()));
    let finest = seen.len().saturating_sub(1);
    let row = |(level, (steps_per_period, traces)): (usize, &&(u64, &[Trace]))| Quarters {
        steps_per_period: *steps_per_period,
        x1: [0, 1, 2, 3].map(|k| Estimate::mean_of(&of(traces, k))),
        less_finest: (level != finest).then(|| means.each_ref().map(|means| means.difference(level, finest))),
    };
    seen.iter().enumerate().map(row).collect()
}

/// The line a + b/S over the resolved levels, or from a finer level if the line is refuted (p < 0.001), with its first
/// level.
fn first_order(means: &Means, h: &[f64], resolved_from: usize) -> (usize, Option<Line>) {
    let mut lines = (resolved_from..h.len().saturating_sub(2))
        .filter_map(|first| Some((first, means.from(first).line(&h[first..])?)));
    let fitting = lines.find(|(_, line)| line.p.is_none_or(|p| p >= 1e-3));
    fitting.map_or((resolved_from, None), |(first, line)| (first, Some(line)))
}

fn change(means: &Means, level: usize, coarse: &[Trace], fine: &[Trace]) -> Change {
    let count = coarse.len().min(fine.len());
    let correlation = correlation(&x1(&coarse[..count]), &x1(&fine[..count]));
    let [apart_rad, unrelated_rad] = [0, 1].map(|shift| apart(coarse, fine, shift));
    Change {
        x1: means.difference(level, level + 1),
        correlation: Estimate { value: correlation, se: (1.0 - correlation * correlation) / (count as f64).sqrt() },
        p1_distribution: furthest(coarse, fine, |trace, k| trace.last().p1_below[k]),
        orbit_distribution: furthest(coarse, fine, |trace, k| trace.last().orbit_below[k]),
        apart_rad,
        unrelated_rad,
    }
}

/// The largest difference of two distribution functions, in units of its standard error.
fn furthest(coarse: &[Trace], fine: &[Trace], share: impl Fn(&Trace, usize) -> f64) -> Estimate {
    let at = |k: usize| {
        let shares = [coarse, fine].map(|traces| traces.iter().map(|trace| share(trace, k)).collect());
        Means::of(&shares).difference(0, 1)
    };
    let apart = |e: &Estimate| {
        if e.se > 0.0 { e.value.abs() / e.se } else { 0.0 }
    };
    let places = (0..PLACES).map(at);
    let none = Estimate { value: 0.0, se: 0.0 };
    places.max_by(|a, b| apart(a).total_cmp(&apart(b))).unwrap_or(none)
}

/// The root mean square angle between rod i of one and rod i + `shift` of the other, over all replicas.
pub fn apart(one: &[Trace], other: &[Trace], shift: usize) -> f64 {
    let mut squares = Vec::new();
    for (a, b) in one.iter().zip(other) {
        let count = a.directions.len().min(b.directions.len());
        squares.extend((0..count).map(|rod| {
            let [p, q] = [a.directions[rod], b.directions[(rod + shift) % count]].map(Vector3::from);
            apart_rad(&p, &q).powi(2)
        }));
    }
    (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
}
