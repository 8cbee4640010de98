//! Savings by runs that share their random numbers, in three ways, each from its correlations.
//!
//! - *Multilevel*: the same scene at S and 2S steps per period, to correct cheap coarse runs by few fine ones.
//! - *Common random numbers*: the same scene at two values of α, for their difference.
//! - *Control variate*: the same rods without collisions, whose mean has a closed form, to correct the mean.

use super::job::Job;
use super::*;
use crate::oracle::isotropic;
use shearbed::Observable;

/// X̄₁ at each mark, for each replica.
pub type Values = Vec<Vec<f64>>;

/// The number of quarters of a period that are evaluated.
pub const QUARTERS: u64 = 8;

/// The factor on α of the second scene: 0.4 for 0.5.
const OTHER_ALPHA: f64 = 0.8;

#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Saving {
    pub turns: f64,
    /// The correlation with the same run at half the time step.
    pub finer: f64,
    /// The correlation with the other α.
    pub other_alpha: f64,
    pub free: f64,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Coupled {
    /// Steps per period of the coarse runs; the fine ones have twice as many.
    pub steps_per_period: u64,
    pub replicas: u64,
    pub rows: Vec<Saving>,
}

impl Saving {
    /// The factor by which levels in Δt reduce the cost of a mean, for coarse runs at an eighth of the cost: coupled
    /// pairs of fine and coarse runs, and more coarse runs in the best proportion (Peherstorfer, Willcox & Gunzburger
    /// 2016). Below 1 the cost exceeds the saving.
    pub fn multilevel(&self) -> f64 {
        let square = self.finer * self.finer;
        ((1.0 - square).sqrt() + (square / 8.0).sqrt()).powi(-2)
    }
}

pub fn measure(scene: &Scene, replicas: u64) -> Result<Coupled, String> {
    let steps = scene.steps_per_unit().div_ceil(4) * 4;
    let own = interacting(scene, steps, 1.0, QUARTERS, replicas)?;
    let finer = interacting(scene, 2 * steps, 1.0, QUARTERS, replicas)?;
    let other = interacting(scene, steps, OTHER_ALPHA, QUARTERS, replicas)?;
    let free = free(scene, QUARTERS, replicas)?;
    let row = |k: usize| Saving {
        turns: (k + 1) as f64 / 4.0,
        finer: correlation(&at(&own, k), &at(&finer, k)),
        other_alpha: correlation(&at(&own, k), &at(&other, k)),
        free: correlation(&at(&own, k), &at(&free, k)),
    };
    Ok(Coupled { steps_per_period: steps, replicas, rows: (0..QUARTERS as usize).map(row).collect() })
}

/// X̄₁ at every quarter of a period of a scene whose α is multiplied by `alpha`.
pub fn interacting(scene: &Scene, steps: u64, alpha: f64, quarters: u64, replicas: u64) -> Result<Values, String> {
    let mut job = Job::new(scene, steps, scene.particles.count, replicas, quarters.div_ceil(4));
    job.marks = (1..=quarters).map(|quarter| quarter * steps / 4).collect();
    lab::interaction(&mut job.scene).alpha *= alpha;
    let looks = |trace: super::job::Trace| trace.looks.iter().map(|look| look.x1).collect();
    Ok(job.run(&|| ())?.into_iter().map(looks).collect())
}

/// The same for the scene's rods without collisions: starts and aspect ratios are the same, as they have streams of
/// their own.
pub fn free(scene: &Scene, quarters: u64, replicas: u64) -> Result<Values, String> {
    let mut scene = scene.clone();
    scene.interaction = None;
    scene.time = Time { outputs_per_unit: Some(4), ..Time::periods(quarters as f64 / 4.0) };
    scene.output.observables = vec![Observable::Projections];
    let plan = Plan::new(&scene).map_err(|error| error.to_string())?;
    lab::replicas(replicas, |replica| {
        let means = run_replica(&plan, replica).map_err(|error| error.to_string())?;
        // The first output is the start.
        let x1 = (1..plan.outputs()).map(|output| means.mean(Channel::X[0], output));
        Ok(x1.map(|mean| mean.unwrap_or(f64::NAN)).collect())
    })
}

/// The mean of the free rods at t/T = `turns`, over all initial directions.
pub fn free_mean(scene: &Scene, turns: f64) -> f64 {
    let particles = &scene.particles;
    let sd = particles.aspect_ratio_sd_percent;
    isotropic::mean_projections_polydisperse(particles.aspect_ratio, sd, turns)[0]
}

/// The mean of `x1`, corrected by the deviation of the free rods from their known mean, in the best proportion.
pub fn controlled(x1: &[f64], free: &[f64], free_mean: f64) -> Estimate {
    let share = covariance(x1, free) / covariance(free, free);
    let corrected: Vec<_> = (x1.iter().zip(free)).map(|(x1, free)| x1 - share * (free - free_mean)).collect();
    Estimate::mean_of(&corrected)
}

pub fn at(values: &Values, mark: usize) -> Vec<f64> {
    values.iter().map(|replica| replica[mark]).collect()
}

pub fn table(coupled: &Coupled) -> ReportTable {
    // One over the share of the variance that is left if what is correlated costs nothing.
    let at_best = |correlation: f64| 1.0 / (1.0 - correlation * correlation);
    ReportTable::new(
        ["suspension-coupled", "Shared random numbers: the factor by which they save runs"],
        format!(
            "Levels in Δt ({} and {} steps per period, same seeds) are tied by their starts alone: the gain with \
             coarse runs at an eighth of the cost, and the largest gain if coarse runs cost nothing; below 1 it costs \
             more than it saves. The same rods without collisions, whose mean has a closed form, give more for less. \
             Common random numbers pay for a difference, here between α and 0.8 α. {} replicas \
             (`shared-random-numbers`, `paths-do-not-converge`).",
            coupled.steps_per_period,
            2 * coupled.steps_per_period,
            coupled.replicas
        ),
        &coupled.rows,
        vec![
            field("t/T", |r: &Saving| r.turns),
            number("ρ, half the step", decimals(2), |r: &Saving| r.finer),
            number("gain, levels", decimals(2), |r: &Saving| r.multilevel()),
            number("at best", decimals(2), move |r: &Saving| at_best(r.finer)),
            number("ρ, free rods", decimals(2), |r: &Saving| r.free),
            number("gain, control variate", decimals(2), move |r: &Saving| at_best(r.free)),
            number("ρ, other α", decimals(2), |r: &Saving| r.other_alpha),
            number("gain for the difference", decimals(2), |r: &Saving| 1.0 / (1.0 - r.other_alpha)),
        ],
    )
}
