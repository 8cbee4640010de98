//! The study of integrators of one rod: error against run time, and observed orders.

use super::order::Found as OrderFound;
use super::{ASPECT_RATIOS, Bench, Budget, export, figures, order, tables};
use crate::files::build;
use crate::present::study::{Exhibit, Extent, Found, Study};
use crate::studies::integrators::{self, Theory};
use crate::studies::work_precision;
use serde::Serialize;

/// One for each integrator and aspect ratio.
pub const STUDY: Study = Study {
    name: "work-precision",
    title: "Integrators: error against run time",
    question: "Which integrator of one free rod reaches an error soonest, and does each converge at its order?",
    cases: &[
        "subject-orders",
        "exact-propagator-round-off",
        "subject-lengths",
        "adaptive-subjects",
        "grid-convergence-index",
        "where-errors-show",
        "flip-not-stiff",
        "coarse-steps",
        "who-loses-length",
        "right-hand-side-digits",
    ],
    command: "cargo run --release -- bench --case re2 --case re11.6 --case re100 --case re10000",
    benches: || ASPECT_RATIOS.map(work_precision::name).into(),
    shared: false,
    run,
};

/// bench.json.
#[derive(Serialize)]
struct Benches<'a> {
    benches: &'a [Bench],
}

fn run(extent: &Extent) -> Result<Option<Found>, String> {
    let chosen = (ASPECT_RATIOS.into_iter()).filter(|r| (extent.wanted)(&work_precision::name(*r)));
    let budget = extent.effort.pick(Budget::QUICK, Budget::FULL);
    let subjects = integrators::all();
    let benches: Vec<_> = chosen.map(|r| work_precision::run(r, &subjects, budget)).collect();
    if benches.is_empty() {
        return Ok(None);
    }
    let orders = order::of_rod(11.6);
    let pictures = figures::figures(&benches).into_iter();
    let mut exhibits: Vec<Exhibit> = pictures
        .zip(&benches)
        .map(|(figure, bench)| Exhibit::both(figure, tables::every_subject(bench)))
        .collect();
    exhibits.extend([
        Exhibit::both(figures::orders(&orders), tables::orders(&orders)),
        tables::cheapest(&benches).into(),
        tables::ratio(&benches).into(),
    ]);
    Ok(Some(Found {
        answer: answer(&benches, &orders),
        exhibits,
        files: vec![
            ("bench.csv".into(), export::bench_csv(&benches)?),
            ("bench.json".into(), build::json(&Benches { benches: &benches })?),
        ],
        ..Default::default()
    }))
}

fn answer(benches: &[Bench], orders: &order::Orders) -> String {
    let wins = (benches.iter()).filter(|bench| {
        let cheapest = bench.cheapest(1e-6, |_| true);
        cheapest.is_some_and(|(curve, _)| curve.theory == Theory::Exact)
    });
    let kept = (orders.studies.iter()).filter(|study| study.found == OrderFound::AsTheory);
    format!(
        "An exact propagator is the cheapest for 10⁻⁶ rad at {} of {} aspect ratios, and {} of {} methods with steps \
         converge at the order of theory.",
        wins.count(),
        benches.len(),
        kept.count(),
        orders.studies.len()
    )
}
