//! The study of the limit Δt → 0.

use super::study::{self, Limit};
use super::tables;
use crate::present::study::{Exhibit, Extent, Found, Study};

/// Kicks against the step, their tail, the averaged motion, the two updates.
pub const STUDY: Study = Study {
    name: "limit",
    title: "The limit Δt → 0",
    question: "What is left of the collision model as the time step goes to 0?",
    cases: &[
        "kick-formula",
        "kick-memory",
        "kick-tail",
        "kick-bound",
        "averaged-motion",
        "arm-pushed",
        "updates-in-the-limit",
        "paths-do-not-converge",
    ],
    command: "cargo run --release -p shearbed-suite --example time_step",
    benches: Study::no_parts,
    shared: false,
    run,
};

fn run(extent: &Extent) -> Result<Option<Found>, String> {
    let limit = study::measure(extent.effort)?;
    let mut tables = tables::tables(&limit).into_iter();
    let first = tables.next().map(|table| Exhibit::both(tables::figure(&limit), table));
    Ok(Some(Found {
        answer: answer(&limit),
        exhibits: first.into_iter().chain(tables.map(Exhibit::from)).collect(),
        ..Default::default()
    }))
}

fn answer(limit: &Limit) -> String {
    let (Some(coarse), Some(fine)) = (limit.steps.first(), limit.steps.last()) else {
        return "Nothing was measured.".into();
    };
    let rate = |row: &super::StepCounts| row.mean(|c| c.closing[1]);
    let stay = rate(fine).mean > 2.0 * rate(fine).se;
    let words = |row: &super::StepCounts| format!("{:.3} ± {:.3}", rate(row).mean, rate(row).se);
    format!(
        "{}: closing pairs kick a rod by more than 0.1 rad {} times a period at {} steps, {} times at {} steps.",
        if stay { "Jumps are left" } else { "No jumps are seen" },
        words(coarse),
        coarse.steps_per_period,
        words(fine),
        fine.steps_per_period
    )
}
