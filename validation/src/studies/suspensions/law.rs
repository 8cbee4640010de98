//! Convergence in law: how an interacting scene's X̄₁ and the distribution of its directions depend on the steps per
//! period, the rods and the replicas, at the scene's end and within its first and last period. The study is a list of
//! independent jobs, and an evaluation of their results.

#[cfg(test)]
mod tests;

use super::blocks::{Block, blocks, replicas_exponent};
use super::fit::{FEWEST, Line, Means, Order};
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

/// How many times finer steps are those that the scene's own are compared with.
pub const FINER: u64 = 8;

/// The largest t/T of a run.
const LONGEST: f64 = 10.0;

/// Number of replicas whose rods are compared one by one between two steps.
const FOLLOWED: u64 = 16;

/// The number of replicas of each job.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Replicas {
    /// The same number for all jobs.
    Each(u64),
    /// The largest number that keeps a job below `rod_steps`, at most `most`; steps and rods that allow fewer than 8
    /// are left out, except the scene's own, which have 8.
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

    /// The number of replicas of so many steps in all; `None` if too few are allowed.
    fn of_job(self, steps: f64, rods: usize) -> Option<u64> {
        match self {
            Self::Each(replicas) => Some(replicas),
            Self::Within { rod_steps, most } => {
                let allowed = (rod_steps as f64 / (steps * rods as f64)) as u64;
                (allowed >= FEWEST as u64).then_some(allowed.min(most))
            }
        }
    }
}

/// The result of one job for X̄₁ at its end.
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
    /// The correlation of X̄₁ between the two; its standard error is that for normal variables. `None` for fewer than
    /// 8 replicas, of which two have ±1.
    pub correlation: Option<Estimate>,
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

/// X̄₁ at one time, and what the scene's own steps, rods and replicas leave of an error there.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct AtTime {
    #[serde(rename = "t_over_T")]
    pub(crate) time: f64,
    /// At the scene's own steps and rods, with the replicas of the study.
    pub(crate) x1: Estimate,
    /// X̄₁ at the scene's own steps less that at [`FINER`] times as many and more; `None` if none so fine are tried.
    pub steps_bias: Option<Estimate>,
    /// X̄₁ less that at the largest number of rods, at other seeds; `None` if that is the scene's own.
    pub rods_bias: Option<Estimate>,
    /// The standard error of the scene's own replicas.
    pub scatter: f64,
}

/// The scene's own steps per period, rods and replicas.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Own {
    /// Steps per period.
    pub steps_per_period: u64,
    pub(crate) rods: usize,
    pub(crate) replicas: u64,
}

/// The results of the study.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Law {
    /// The end t/T of the runs, at which X̄₁ is compared where no other time is said.
    #[serde(rename = "t_over_T")]
    pub end: f64,
    /// The scene as it is.
    pub own: Own,
    /// The times that a step of the scene's ends at, of the quarters of the first period and of the last; empty if
    /// replicas are too few.
    pub times: Vec<AtTime>,
    pub(crate) steps: Vec<JobMean>,
    pub(crate) changes: Vec<Change>,
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
        let steps = (scene.steps_per_unit() as f64 / per_period).round().max(1.0) as u64;
        scene.time = Time { steps_per_unit: Some(steps), ..Time::periods(scene.time.duration * per_period) };
    }
    scene
}

/// The end t/T of the study's runs: that of the scene, to the nearest quarter of a period, and at most 10.
pub fn end(scene: &Scene) -> f64 {
    ((4.0 * scene.time.duration).round() / 4.0).clamp(0.25, LONGEST)
}

/// The times t/T at which X̄₁ is looked at: the quarters of the first period and of the last.
fn times(end: f64) -> Vec<f64> {
    let quarters = (4.0 * end) as u64;
    let chosen = (1..=quarters).filter(|k| *k <= 4 || k + 4 > quarters);
    chosen.map(|k| k as f64 / 4.0).collect()
}

/// The scene as it is; if its end is between two periods, its steps are rounded so that one ends there.
pub fn own(scene: &Scene) -> Own {
    let steps = scene.steps_per_unit();
    Own {
        steps_per_period: if end(scene).fract() == 0.0 { steps } else { steps.saturating_add(2).max(4) / 4 * 4 },
        rods: scene.particles.count,
        replicas: scene.ensemble.replicas,
    }
}

/// The jobs of a scene: every number of steps, then every number of rods, each once.
pub fn jobs(scene: &Scene, replicas: Replicas) -> Vec<Job> {
    let (own, end) = (own(scene), end(scene));
    let job = |steps: u64, rods: usize| {
        let mark = |time: f64| Some(time * steps as f64).filter(|mark| mark.fract() == 0.0).map(|mark| mark as u64);
        let marks = times(end).into_iter().filter_map(mark).collect();
        let least = (steps == own.steps_per_period && rods == own.rods).then_some(FEWEST as u64);
        let replicas = replicas.of_job(end * steps as f64, rods).or(least).filter(|_| mark(end).is_some())?;
        Some(Job { marks, ..Job::new(scene, steps, rods, replicas, end.ceil() as u64) })
    };
    let every_steps: BTreeSet<_> = STEPS_PER_PERIOD.into_iter().chain([own.steps_per_period]).collect();
    let followed = |job: Job| Job { followed: FOLLOWED.min(job.replicas), ..job };
    let of_steps = every_steps.into_iter().filter_map(|steps| job(steps, own.rods).map(followed));
    let rods = RODS.into_iter().filter(|rods| *rods != own.rods);
    of_steps.chain(rods.filter_map(|rods| job(own.steps_per_period, rods))).collect()
}

/// Runs every job, one after the other, on the threads of the current pool. `finished` is called after each replica.
pub fn run(jobs: &[Job], finished: &(dyn Fn() + Sync)) -> Result<Vec<Vec<Trace>>, String> {
    jobs.iter().map(|job| job.run(finished)).collect()
}

/// X̄₁ of each replica of a job at the mark after `time` periods; `None` if there is none.
fn x1_at(job: &Job, traces: &[Trace], time: f64) -> Option<Vec<f64>> {
    let mark = time * job.scene.steps_per_unit() as f64;
    let look = job.marks.iter().position(|own| *own as f64 == mark)?;
    Some(traces.iter().map(|trace| trace.looks[look].x1).collect())
}

/// Jobs of one kind at one time, ascending in their steps or rods.
struct Levels<'a> {
    jobs: Vec<&'a Job>,
    x1: Vec<Vec<f64>>,
}

impl Levels<'_> {
    fn means(&self) -> Means {
        Means::of(&self.x1)
    }

    /// The steps of a job in periods.
    fn h(&self) -> Vec<f64> {
        self.jobs.iter().map(|job| 1.0 / job.scene.steps_per_unit() as f64).collect()
    }

    fn samples(&self) -> Vec<JobMean> {
        self.jobs.iter().zip(&self.x1).map(|(job, x1)| sample(job, x1)).collect()
    }

    fn find(&self, which: impl Fn(&Job) -> bool) -> Option<usize> {
        self.jobs.iter().position(|job| which(job))
    }
}

/// Evaluates the traces of the jobs of [`jobs`].
pub fn read(scene: &Scene, jobs: &[Job], traces: &[Vec<Trace>]) -> Law {
    let (own, end) = (own(scene), end(scene));
    let chosen = |which: &dyn Fn(&Job) -> bool| -> Vec<usize> {
        let mut chosen: Vec<_> = (0..jobs.len()).filter(|k| which(&jobs[*k])).collect();
        chosen.sort_by_key(|k| (jobs[*k].scene.particles.count, jobs[*k].scene.steps_per_unit()));
        chosen
    };
    let of_steps = chosen(&|job| job.scene.particles.count == own.rods);
    let of_rods = chosen(&|job| job.scene.steps_per_unit() == own.steps_per_period);
    let levels = |which: &[usize], time: f64| {
        let found = which.iter().filter_map(|k| Some((&jobs[*k], x1_at(&jobs[*k], &traces[*k], time)?)));
        let (jobs, x1) = found.unzip();
        Levels { jobs, x1 }
    };
    let (steps, rods) = (levels(&of_steps, end), levels(&of_rods, end));
    let strain = strain_per_period(scene.particles.aspect_ratio);

    let (means, h) = (steps.means(), steps.h());
    let change = |(k, pair): (usize, &[usize])| change(&means, k, &traces[pair[0]], &traces[pair[1]]);
    let changes: Vec<_> = of_steps.windows(2).enumerate().map(change).collect();
    let resolved_from = h.iter().position(|h| strain * h <= 1.0).unwrap_or(h.len().saturating_sub(1));
    let known = changes[resolved_from.min(changes.len())..].iter().filter(|change| change.x1.readable());
    let order = match known.count() {
        0 | 1 => None,
        _ => means.from(resolved_from).order(&h[resolved_from..]),
    };
    let (line_from, steps_line) = first_order(&means, &h, resolved_from);

    let means_of_rods = rods.means();
    let against = |exponent: f64| {
        let x: Vec<_> = rods.jobs.iter().map(|job| (job.scene.particles.count as f64).powf(exponent)).collect();
        means_of_rods.line(&x)
    };
    let own_x1 = steps.find(|job| job.scene.steps_per_unit() == own.steps_per_period).map_or(&[][..], |k| &steps.x1[k]);
    let at = |time: f64| at_time(own, time, &levels(&of_steps, time), &levels(&of_rods, time));
    Law {
        end,
        own,
        times: times(end).into_iter().filter_map(at).collect(),
        steps: steps.samples(),
        changes,
        resolved_from,
        order,
        steps_line,
        line_from,
        rods: rods.samples(),
        rods_lines: [against(FACES), against(-1.0)],
        blocks: blocks(own_x1),
        replicas_exponent: replicas_exponent(own_x1),
        variance_per_rod: super::covariance(own_x1, own_x1) * own.rods as f64,
        rod_steps: jobs.iter().map(Job::rod_steps).sum(),
    }
}

/// What the scene's own settings leave of an error at `time`; `None` if no step of its own ends there, or replicas are
/// too few to tell their scatter.
fn at_time(own: Own, time: f64, steps: &Levels<'_>, rods: &Levels<'_>) -> Option<AtTime> {
    let level = steps.find(|job| job.scene.steps_per_unit() == own.steps_per_period)?;
    if steps.x1.iter().chain(&rods.x1).any(|x1| x1.len() < FEWEST) {
        return None;
    }
    let (means, x1) = (steps.means(), &steps.x1[level]);
    let finer = steps.find(|job| job.scene.steps_per_unit() >= FINER * own.steps_per_period);
    let most = rods.jobs.len().saturating_sub(1);
    let own_rods = rods.find(|job| job.scene.particles.count == own.rods).filter(|own| *own != most);
    Some(AtTime {
        time,
        x1: Estimate::mean_of(x1),
        steps_bias: finer.and_then(|finer| means.less_finer(level, finer)),
        rods_bias: own_rods.map(|own| rods.means().difference(own, most)),
        scatter: (super::covariance(x1, x1) / own.replicas as f64).sqrt(),
    })
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

/// The line a + b/S over the resolved levels, or from a finer level if the line is refuted (p < 0.05), with its first
/// level.
fn first_order(means: &Means, h: &[f64], resolved_from: usize) -> (usize, Option<Line>) {
    let mut lines = (resolved_from..h.len().saturating_sub(2))
        .filter_map(|first| Some((first, means.from(first).line(&h[first..])?)));
    let fitting = lines.find(|(_, line)| line.p.is_none_or(|p| p >= 0.05));
    fitting.map_or((resolved_from, None), |(first, line)| (first, Some(line)))
}

fn change(means: &Means, level: usize, coarse: &[Trace], fine: &[Trace]) -> Change {
    let count = coarse.len().min(fine.len());
    let correlation = correlation(&x1(&coarse[..count]), &x1(&fine[..count]));
    let [apart_rad, unrelated_rad] = [0, 1].map(|shift| apart(coarse, fine, shift));
    Change {
        x1: means.difference(level, level + 1),
        correlation: (count >= FEWEST)
            .then(|| Estimate { value: correlation, se: (1.0 - correlation * correlation) / (count as f64).sqrt() }),
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
