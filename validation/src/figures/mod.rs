//! Figures 4 to 12 of the paper, drawn from the built-in scenes in the paper's own axes.

mod amplitude;
mod measured;
mod paper;
mod run;

use crate::case::Effort;
use crate::report::{ReportFigure, ScenePlan};
use run::Runs;

/// How many replicas of a scene are run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Replicas {
    /// Of a scene with interaction, usually of 100 rods each.
    pub interacting: u64,
    /// Of a scene of free rods, usually of 10 000 rods each.
    pub free: u64,
}

impl Replicas {
    /// The number for a quick or a full run. The quick run of an interacting scene is the scene as its file says.
    pub fn of(effort: &Effort) -> Self {
        Self {
            interacting: effort.pick(100, 1000),
            free: effort.pick(20, 200),
        }
    }
}

/// The figures, and the plans of the scenes behind them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Drawn {
    /// The figures, in the paper's order.
    pub figures: Vec<ReportFigure>,
    /// The scenes, in the same order.
    pub plans: Vec<ScenePlan>,
}

/// How often [`draw`] calls `finished`.
pub fn work(replicas: Replicas) -> Result<u64, String> {
    let plans = run::plans(replicas)?;
    Ok(plans.iter().map(|(_, plan)| plan.scene().ensemble.replicas).sum())
}

/// Runs the scenes over all ranks and draws the figures on the root, none elsewhere; `finished` is called on
/// the root for each replica, after its scene.
pub fn draw(effort: &Effort, replicas: Replicas, finished: &dyn Fn()) -> Result<Option<Drawn>, String> {
    let plans = run::plans(replicas)?;
    let shown = plans.iter().map(run::shown).collect();
    let Some(runs) = Runs::new(plans, finished)? else {
        return Ok(None);
    };
    Ok(Some(Drawn {
        figures: paper::figures(&runs, effort)?,
        plans: shown,
    }))
}
