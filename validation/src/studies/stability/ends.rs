//! Where each integrator leaves, in words: tables beside the maps.

use super::map::{self, ASPECT_RATIOS, Cell, STEPS};
use super::maps::{MOST_STEPS, of, ratio, tolerances_from_fine, with_tolerance};
use crate::present::table::{ReportTable, of_words};
use crate::studies::integrators::{Integrator, Theory};

/// The last setting before the first whose end is not right, and what comes then.
fn leaves(cells: &[Cell], setting: impl Fn(usize) -> String) -> String {
    match cells.iter().position(|cell| !cell.found.is_right()) {
        Some(0) => format!("never: {}", cells[0].found.words()),
        Some(bad) => format!("to {}, then {}", setting(bad - 1), cells[bad].found.words()),
        None => "all".into(),
    }
}

/// Where each subject leaves, by the step as a part of the period and by the tolerance: a row for each r_e.
pub fn ends(subjects: &[Box<dyn Integrator>]) -> [ReportTable; 2] {
    let by_step = |subject: &dyn Integrator, r: f64| {
        let run = |step| map::by_step(subject.theory(), r, step, MOST_STEPS).of(subject);
        leaves(&STEPS.map(run), |k| format!("{:.0e} T", STEPS[k]))
    };
    let by_tolerance = |subject: &dyn Integrator, r: f64| {
        let settings: Vec<f64> = tolerances_from_fine().collect();
        let cells: Vec<_> = settings.iter().map(|t| with_tolerance(subject, r, *t)).collect();
        leaves(&cells, |k| format!("{:.0e}", settings[k]))
    };
    let table = |words: [&str; 2],
                 caption: &str,
                 which: Vec<&dyn Integrator>,
                 end: &dyn Fn(&dyn Integrator, f64) -> String| {
        let names = which.iter().map(|subject| subject.name().to_owned());
        let row = |r: f64| {
            let ends = which.iter().map(|subject| end(*subject, r));
            std::iter::once(ratio(r)).chain(ends).collect()
        };
        let columns: Vec<_> = std::iter::once("r_e".to_owned()).chain(names).collect();
        of_words(words[0], words[1], caption, &columns, ASPECT_RATIOS.map(row).into())
    };
    [
        table(
            ["stability-steps-end", "The longest step that is right, and what comes after it"],
            "Of the steps 10⁻⁹, 10⁻⁸, … 10³ T; subjects without steps go the length of a step at once.",
            of(subjects, |theory| theory != Theory::Adaptive),
            &by_step,
        ),
        table(
            ["stability-tolerances-end", "The loosest tolerance that is right, and what comes after it"],
            "Of the tolerances 10⁻¹², 10⁻¹⁰, 10⁻⁸, 10⁻⁶, 10⁻⁴, 10⁻², 10⁻¹.",
            of(subjects, |theory| theory == Theory::Adaptive),
            &by_tolerance,
        ),
    ]
}

#[cfg(test)]
mod tests {
    use super::super::map::Found;
    use super::super::orbit::Place;
    use super::*;
    use crate::studies::integrators;

    #[test]
    fn a_row_of_cells_says_where_it_leaves() {
        let (problem, end) = (map::by_step(Theory::Exact, 2.0, 1.0, 1), Place::mid_flip(2.0));
        let right = problem.of(&integrators::ExactPropagator);
        let wrong = map::Run { end: end.before(0.1), ..problem };
        let late = map::Run { turns: 1.1, end, ..problem }.of(&integrators::ExactPropagator);
        assert_eq!((right.found, late.found), (Found::RoundOff, Found::RoundOff));
        assert!(wrong.of(&integrators::ExactPropagator).found.is_right());
        let bad = Cell::not_run("many".into());
        let cells = [right.clone(), right.clone(), bad.clone(), right.clone()];
        assert_eq!(leaves(&cells, |k| k.to_string()), "to 1, then not run");
        assert_eq!(leaves(&[bad], |k| k.to_string()), "never: not run");
        assert_eq!(leaves(&[right], |k| k.to_string()), "all");
    }
}
