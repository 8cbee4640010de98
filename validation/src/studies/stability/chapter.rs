//! The study of stability.

use super::{corners_table, ends, figures, limit_tables, maps};
use crate::present::study::{Exhibit, Extent, Found, Study};
use crate::studies::integrators;

/// Maps of what becomes of a rod, and the longest steps beside their theory.
pub const STUDY: Study = Study {
    name: "stability",
    title: "Integrators: stability",
    question: "How long may a step be, and what becomes of a rod beyond it?",
    cases: &[
        "stability-map",
        "euler-step-limit",
        "step-limit-turning",
        "step-limit-side",
        "step-limit-at-least",
        "rods-come-to-rest",
        "implicit-midpoint-order",
        "implicit-midpoint-side",
        "rk4-near-a-sphere",
        "frozen-limit",
        "extreme-motion",
    ],
    command: "cargo run --release -- validate",
    benches: Study::no_parts,
    shared: false,
    run,
};

fn run(_: &Extent) -> Result<Option<Found>, String> {
    let subjects = integrators::all();
    let mut limits = limit_tables::limits(&subjects);
    let maps = maps::figures(&subjects);
    let answer = maps::answer(&maps);
    let mut exhibits: Vec<Exhibit> = maps.into_iter().map(Exhibit::from).collect();
    for (exhibit, table) in exhibits.iter_mut().zip(ends::ends(&subjects)) {
        exhibit.table = Some(table);
    }
    for figure in figures::figures(&subjects) {
        let beside = limits.iter().position(|table| table.name == figure.name);
        let table = beside.map(|beside| limits.remove(beside));
        exhibits.push(Exhibit { figure: Some(figure), table });
    }
    exhibits.extend(limits.into_iter().map(Exhibit::from));
    exhibits.push(corners_table::table().into());
    Ok(Some(Found { answer, exhibits, ..Default::default() }))
}
