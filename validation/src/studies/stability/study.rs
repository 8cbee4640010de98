//! The study of stability: maps of outcomes, and the longest steps compared with theory.

use super::extremes::{self, Worst};
use super::map::{self, ASPECT_RATIOS, Cell, STEPS};
use super::maps::{self, MOST_STEPS, ratio, tolerances_from_fine, with_theory, with_tolerance};
use super::*;
use crate::studies::integrators;

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
    command: "cargo run --release -- bench --case stability",
    parts: &["stability"],
    shared: false,
    run,
};

fn run(_: &Request) -> Result<Option<Findings>, String> {
    let integrators = integrators::all();
    let maps = maps::figures(&integrators);
    let answer = maps::answer(&maps);
    let mut exhibits: Vec<Exhibit> = maps.into_iter().map(Exhibit::from).collect();
    for (exhibit, table) in exhibits.iter_mut().zip(ends(&integrators)) {
        exhibit.table = Some(table);
    }
    exhibits.extend(limit_study::exhibits(&integrators));
    exhibits.push(core_table().into());
    Ok(Some(Findings::new(answer, exhibits, [])))
}

/// A text on the last setting before the first whose end is not right, and on the outcome of the latter.
fn leaves(cells: &[Cell], setting: impl Fn(usize) -> String) -> String {
    match cells.iter().position(|cell| !cell.found.is_right()) {
        Some(0) => format!("never: {}", cells[0].found.names()[1]),
        Some(bad) => format!("to {}, then {}", setting(bad - 1), cells[bad].found.names()[1]),
        None => "all".into(),
    }
}

/// The limits of each integrator, by the step in periods and by the tolerance: a row for each r_e.
fn ends(integrators: &[Integrator]) -> [ReportTable; 2] {
    let by_step = |integrator: &Integrator, r: f64| {
        let run = |step| map::by_step(integrator.theory, r, step, MOST_STEPS).of(integrator);
        leaves(&STEPS.map(run), |k| format!("{:.0e} T", STEPS[k]))
    };
    let by_tolerance = |integrator: &Integrator, r: f64| {
        let settings: Vec<f64> = tolerances_from_fine().collect();
        let cells: Vec<_> = settings.iter().map(|t| with_tolerance(integrator, r, *t)).collect();
        leaves(&cells, |k| format!("{:.0e}", settings[k]))
    };
    let table = |words: [&str; 2], caption: &str, which: Vec<&Integrator>, end: &dyn Fn(&Integrator, f64) -> String| {
        let names = which.iter().map(|integrator| integrator.name.clone());
        let row = |r: f64| {
            let ends = which.iter().map(|integrator| end(integrator, r));
            std::iter::once(ratio(r)).chain(ends).collect()
        };
        let columns: Vec<_> = std::iter::once("r_e".to_owned()).chain(names).collect();
        of_words(words[0], words[1], caption, &columns, ASPECT_RATIOS.map(row).into())
    };
    [
        table(
            ["stability-steps-end", "The longest step that is right, and what comes after it"],
            "Of the steps 10⁻⁹, 10⁻⁸, … 10³ T; integrators without steps go the length of a step at once.",
            with_theory(integrators, |theory| theory != Theory::Adaptive),
            &by_step,
        ),
        table(
            ["stability-tolerances-end", "The loosest tolerance that is right, and what comes after it"],
            "Of the tolerances 10⁻¹², 10⁻¹⁰, 10⁻⁸, 10⁻⁶, 10⁻⁴, 10⁻², 10⁻¹.",
            with_theory(integrators, |theory| theory == Theory::Adaptive),
            &by_tolerance,
        ),
    ]
}

fn core_table() -> ReportTable {
    type Row = (f64, Worst);
    ReportTable::new(
        ["stability-core", "The core at the extremes of plane Couette flow"],
        format!(
            "The worst over G = 10⁻³⁰, ½ and 10³⁰ 1/s, {} durations from 10⁻⁹ to 10⁸ periods, and {} starts: both \
             poles, the flip, C = 0, 10⁻³⁰⁰, 10³⁰⁰, ∞. ε = 2.2·10⁻¹⁶. Bounds: 4 ε, 8 ε, and 1.",
            extremes::TURNS.len(),
            map::places(2.0).len()
        ),
        ASPECT_RATIOS.map(|r| (r, extremes::worst(r, &extremes::exact))),
        vec![
            number("r_e", ratio, |row: &Row| row.0),
            number("||p| − 1| / ε", decimals(1), |row: &Row| row.1.length / f64::EPSILON),
            number("change of C_b / ε", decimals(1), |row: &Row| row.1.orbit / f64::EPSILON),
            number("angle to the closed form over its bound", decimals(2), |row: &Row| row.1.angle),
        ],
    )
}

#[cfg(test)]
mod tests {
    use super::super::map::Fate;
    use super::super::orbit::Place;
    use super::*;

    #[test]
    fn a_row_of_cells_says_where_it_leaves() {
        let (problem, end) = (map::by_step(Theory::Exact, 2.0, 1.0, 1), Place::mid_flip(2.0));
        let exact = crate::methods::integrators::exact_propagator();
        let right = problem.of(&exact);
        let wrong = map::Run { end: end.before(0.1), ..problem };
        let late = map::Run { turns: 1.1, end, ..problem }.of(&exact);
        assert_eq!((right.found, late.found), (Fate::RoundOff, Fate::RoundOff));
        assert!(wrong.of(&exact).found.is_right());
        let bad = Cell::not_run("many".into());
        let cells = [right.clone(), right.clone(), bad.clone(), right.clone()];
        assert_eq!(leaves(&cells, |k| k.to_string()), "to 1, then not run");
        assert_eq!(leaves(&[bad], |k| k.to_string()), "never: not run");
        assert_eq!(leaves(&[right], |k| k.to_string()), "all");
    }
}
