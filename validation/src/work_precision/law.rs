//! How the mean of an interacting scene depends on steps, rods and replicas. It says what was found with its standard
//! errors; it reads no weak order from it.

use crate::cluster;
use serde::{Deserialize, Serialize};
use shearbed::{Observable, Plan, Scene, ensemble};

/// Steps per period that are tried, each twice the last.
pub const STEPS_PER_PERIOD: [u64; 7] = [25, 50, 100, 200, 400, 800, 1600];

/// Rods that are tried.
pub const RODS: [usize; 5] = [25, 50, 100, 200, 400];

/// X̄₁ at t/T = 1.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sample {
    /// Steps per period.
    pub steps_per_period: u64,
    /// Rods in the control volume.
    pub rods: usize,
    /// Independent runs.
    pub replicas: u64,
    /// The mean of |p_1| over rods and replicas.
    pub x1: f64,
    /// Its standard error over replicas.
    pub se: f64,
}

/// An interacting scene's X̄₁ at t/T = 1 against one number each; all else is the scene's own.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Law {
    /// Against the steps per period.
    pub steps: Vec<Sample>,
    /// Against the rods.
    pub rods: Vec<Sample>,
    /// Against the replicas.
    pub replicas: Vec<Sample>,
}

/// Runs the scene for one period again and again over all ranks, at its own seed; none but on the root. `finished` is
/// called on the root after each run.
pub fn law(scene: &Scene, finished: &dyn Fn()) -> Result<Option<Law>, String> {
    let (steps, rods) = (scene.steps_per_period(), scene.particles.count);
    let replicas = scene.ensemble.replicas.max(8);
    let against_steps = STEPS_PER_PERIOD.map(|steps| (steps, rods, replicas));
    let against_rods = RODS.map(|rods| (steps, rods, replicas));
    let against_replicas = halves(replicas)
        .into_iter()
        .map(|replicas| (steps, rods, replicas));
    let jobs: Vec<_> = (against_steps.into_iter().chain(against_rods))
        .chain(against_replicas)
        .collect();
    let run = |job: usize| {
        let (steps, rods, replicas) = jobs[job];
        sample(scene, steps, rods, replicas)
    };
    let arrived = |_, _: &_| {
        finished();
        Ok(())
    };
    let Some(mut steps) = cluster::share(jobs.len(), run, arrived)? else {
        return Ok(None);
    };
    let mut rods = steps.split_off(STEPS_PER_PERIOD.len());
    let replicas = rods.split_off(RODS.len());
    Ok(Some(Law {
        steps,
        rods,
        replicas,
    }))
}

/// How often [`law`] calls `finished`.
pub fn work(scene: &Scene) -> usize {
    STEPS_PER_PERIOD.len() + RODS.len() + halves(scene.ensemble.replicas.max(8)).len()
}

/// An eighth, a quarter, half and all of the replicas.
fn halves(replicas: u64) -> Vec<u64> {
    [8, 4, 2, 1].map(|part| (replicas / part).max(2)).into()
}

fn sample(scene: &Scene, steps_per_period: u64, rods: usize, replicas: u64) -> Result<Sample, String> {
    let mut scene = scene.clone();
    scene.time.periods = Some(1.0);
    scene.time.strain = None;
    scene.time.outputs_per_strain = None;
    scene.time.steps_per_period = Some(steps_per_period);
    scene.time.outputs_per_period = Some(1);
    scene.particles.count = rods;
    scene.ensemble.replicas = replicas;
    scene.output.observables = vec![Observable::Projections];
    let plan = Plan::new(&scene).map_err(|error| error.to_string())?;
    let results = ensemble::run(&plan, || ()).map_err(|error| error.to_string())?;
    let x1 = results.channel("x1").ok_or("no projections")?;
    match (x1.mean.last(), x1.se.last()) {
        (Some(mean), Some(se)) => Ok(Sample {
            steps_per_period,
            rods,
            replicas,
            x1: *mean,
            se: *se,
        }),
        _ => Err("no output at t/T = 1".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenes;

    #[test]
    fn a_scene_is_run_for_one_period_with_everything_asked_for() {
        let mut scene = scenes::find("fig4-n50").unwrap().scene().unwrap();
        scene.ensemble.replicas = 8;
        scene.particles.count = 10;
        let runs = std::cell::Cell::new(0);
        let law = law(&scene, &|| runs.set(runs.get() + 1)).unwrap().unwrap();
        assert_eq!(runs.get(), work(&scene));
        assert!(
            law.steps
                .iter()
                .all(|s| s.rods == 10 && s.replicas == 8 && s.se > 0.0)
        );
        assert_eq!(
            law.replicas.iter().map(|s| s.replicas).collect::<Vec<_>>(),
            [2, 2, 4, 8]
        );
        // The same run, whichever table asks for it.
        let own = law.steps.iter().find(|s| s.steps_per_period == 200);
        assert_eq!(own, law.replicas.last());
    }
}
