//! The studies of suspensions.

use super::free::{self, Bench};
use super::{export, figures, law_tables, starts, study, tables};
use crate::files::build;
use crate::present::study::{Exhibit, Extent, Found, Study};
use crate::studies::work_precision::Budget;
use crate::studies::work_precision::tables::time;
use serde::Serialize;

/// Free rods: how to lay them.
pub const FREE: Study = Study {
    name: "free-suspensions",
    title: "Free suspensions: error against run time",
    question: "How must free rods be laid for X̄₁ to reach an error soonest?",
    cases: &["free-suspension-rates", "free-isotropic", "free-polydisperse", "replicas-are-independent"],
    command: "cargo run --release -- bench --case fig6-uniform --case fig6-polydisperse",
    benches: || free::SCENES.map(|free| free.scene.to_owned()).into(),
    shared: false,
    run: run_free,
};

/// Interacting rods: steps, rods and replicas.
pub const INTERACTING: Study = Study {
    name: "interacting-suspensions",
    title: "Interacting suspensions: steps, rods and replicas",
    question: "How many steps, rods and replicas does an error of X̄₁ take?",
    cases: &[
        "cheapest-split",
        "faces-cost-collisions",
        "paths-do-not-converge",
        "shared-random-numbers",
        "default-step-resolves",
        "hundred-rods-suffice",
    ],
    command: "cargo run --release -- bench --case fig7-n50",
    benches: || vec![study::SCENE.to_owned()],
    shared: false,
    run: run_interacting,
};

/// suspensions.json.
#[derive(Serialize)]
struct Benches<'a> {
    benches: &'a [Bench],
}

fn run_free(extent: &Extent) -> Result<Option<Found>, String> {
    let amount = extent.effort.pick(free::Extent::QUICK, free::Extent::FULL);
    let budget = extent.effort.pick(Budget::QUICK, Budget::FULL);
    let chosen = free::SCENES.into_iter().filter(|free| (extent.wanted)(free.scene));
    let benches: Vec<_> = chosen.map(|free| free.bench(&starts::ALL, amount, budget)).collect();
    let Some(first) = benches.first() else {
        return Ok(None);
    };
    let steepest = (first.curves.iter()).min_by(|a, b| a.exponent.total_cmp(&b.exponent));
    let answer = steepest.map_or(String::new(), |curve| {
        format!(
            "Of {} ways the error falls fastest with {}: as N^({:+.2} ± {:.2}).",
            first.curves.len(),
            curve.start,
            curve.exponent,
            curve.exponent_se
        )
    });
    let mut exhibits: Vec<Exhibit> = benches.iter().map(|bench| figures::free(bench).into()).collect();
    exhibits[0].table = Some(tables::free(&benches));
    Ok(Some(Found {
        answer,
        exhibits,
        files: vec![
            ("suspensions.csv".into(), export::free_csv(&benches)?),
            ("suspensions.json".into(), build::json(&Benches { benches: &benches })?),
        ],
        ..Default::default()
    }))
}

fn run_interacting(extent: &Extent) -> Result<Option<Found>, String> {
    if !(extent.wanted)(study::SCENE) {
        return Ok(None);
    }
    let amount = extent.effort.pick(study::Extent::QUICK, study::Extent::FULL);
    let budget = extent.effort.pick(Budget::QUICK, Budget::FULL);
    let study = study::run(amount, budget)?;
    let mut law = law_tables::law(&study.law, study.strain_per_period).into_iter();
    let mut exhibits = vec![Exhibit::both(figures::interacting(&study), tables::answers(&study))];
    exhibits.extend((law.next()).map(|steps| Exhibit::both(figures::steps(&study.law), steps)));
    exhibits.extend(law.map(Exhibit::from));
    exhibits.push(tables::coupled(&study.coupled).into());
    let answer = study.answers.first().map_or(String::new(), |answer| {
        let split = &answer.split;
        format!(
            "For an error of {:.0e} at t/T = 1: {} steps a period, {} rods and {} replicas, {} on one core.",
            split.target,
            split.steps_per_period,
            split.rods,
            split.replicas,
            time(answer.seconds)
        )
    });
    Ok(Some(Found {
        answer,
        exhibits,
        files: vec![
            ("splits.csv".into(), export::splits_csv(&study)?),
            ("splits.json".into(), build::json(&study)?),
        ],
        ..Default::default()
    }))
}
