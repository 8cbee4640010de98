//! Figures 4 to 12 of the paper, drawn from the built-in scenes in the paper's own axes.

mod beside;
mod measured;
mod paper;
mod run;

use super::*;
pub use run::Replicas;
use run::Runs;

/// The figures of the paper.
pub const STUDY: Study = Study {
    name: "figures",
    title: "Figures 4 to 12 of the paper",
    question: "Are the model's results as the paper describes them, with n (Fig. 7), length (8), σ (9) and r_e (11), \
               which its captions omit, chosen by us?",
    cases: &[
        "okagawa-mason-1973",
        "anczurowski-1967",
        "alpha-same-for-both",
        "free-amplitude",
        "faster-with-concentration",
        "faster-with-length",
        "faster-with-spread",
        "faster-with-collisions",
        "dies-out",
        "other-axes-decay",
        "period-unaffected",
        "hundred-rods-suffice",
        "steady-stays-put",
        "steady-mean-angle",
        "in-plane-rods",
    ],
    command: "cargo run --release -- bench --case figures",
    parts: &["figures"],
    shared: true,
    run,
};

fn run(request: &Request) -> Result<Option<Findings>, String> {
    draw(request.effort, Replicas::of(request.effort), request.finished)
}

/// The number of calls of `finished` by [`draw`].
pub fn work(replicas: Replicas) -> Result<u64, String> {
    let plans = run::plans(replicas)?;
    Ok(plans.iter().map(|(_, plan)| plan.scene().ensemble.replicas).sum())
}

/// Runs the scenes over all ranks and returns the figures, each with its table of numbers; `None` except on the root.
/// `finished` is called on the root for each replica, after its scene.
pub fn draw(effort: &Effort, replicas: Replicas, finished: &dyn Fn()) -> Result<Option<Findings>, String> {
    let plans = run::plans(replicas)?;
    let shown = plans.iter().map(run::shown).collect();
    let Some(runs) = Runs::new(plans, finished)? else {
        return Ok(None);
    };
    // Bands are 95 %, and ± in tables are standard errors, as everywhere.
    let tables = paper::figures(&runs.with_standard_errors(), effort)?;
    let tables = tables.iter().map(|figure| Some(beside::table(figure)));
    let figures = paper::figures(&runs, effort)?.into_iter().map(Some);
    Ok(Some(Findings {
        answer: paper::answer(&runs)?,
        exhibits: figures.zip(tables).map(|(figure, table)| Exhibit { figure, table }).collect(),
        plans: shown,
        ..Default::default()
    }))
}
