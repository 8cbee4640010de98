//! The maps and the limits as tables.

use super::core;
use super::map::{self, ASPECT_RATIOS, Cell, Found, PERIODS, STEPS, TOLERANCES};
use super::orbit::Place;
use crate::plot::power_of_ten;
use crate::report::ReportTable;
use crate::subject::{Setting, Subject, Theory};

/// Steps that a run of the maps over steps and over starts may take; ten times as many over durations.
pub const MOST_STEPS: u64 = 20_000;

/// Every map of these subjects.
pub fn tables(subjects: &[Box<dyn Subject>]) -> Vec<ReportTable> {
    [
        vec![core_table()],
        steps(subjects),
        tolerances(subjects),
        vec![starts(subjects), durations(subjects)],
    ]
    .concat()
}

pub(super) fn table(
    name: &str,
    title: &str,
    caption: String,
    columns: Vec<String>,
    rows: Vec<Vec<String>>,
) -> ReportTable {
    ReportTable {
        name: name.into(),
        title: title.into(),
        caption,
        columns,
        rows,
    }
}

fn words(columns: &[&str]) -> Vec<String> {
    columns.iter().map(|column| (*column).into()).collect()
}

const LEGEND: &str = "= at round-off, + within 10⁻² rad, w stable but wrong, L length lost, N not finite, R refused with \
                      an error, · not run: too many steps.";

fn core_table() -> ReportTable {
    let row = |aspect_ratio: f64| {
        let found = core::worst(aspect_ratio, &core::exact);
        vec![
            ratio(aspect_ratio),
            format!("{:.1}", found.length / f64::EPSILON),
            format!("{:.1}", found.orbit / f64::EPSILON),
            format!("{:.2}", found.angle),
        ]
    };
    table(
        "stability-core",
        "The core in the corners of plane Couette flow",
        format!(
            "The worst over G = 10⁻³⁰, ½ and 10³⁰ 1/s, {} durations from 10⁻⁹ to 10⁸ periods, and {} starts: both poles, \
             the flip, C = 0, 10⁻³⁰⁰, 10³⁰⁰, ∞. ε = 2.2·10⁻¹⁶. Bounds: 4 ε, 8 ε, and 1.",
            core::TURNS.len(),
            map::places(2.0).len()
        ),
        words(&[
            "r_e",
            "||p| − 1| / ε",
            "change of C_b / ε",
            "angle to the closed form over its bound",
        ]),
        ASPECT_RATIOS.into_iter().map(row).collect(),
    )
}

/// The signs of cells from left to right.
fn strip(cells: &[Cell]) -> String {
    let signs: String = cells.iter().map(|cell| cell.found.sign()).collect();
    format!("`{signs}`")
}

/// The last setting before the first whose end is not right, and what comes then.
fn leaves(cells: &[Cell], setting: impl Fn(usize) -> String) -> String {
    match cells.iter().position(|cell| !cell.found.is_right()) {
        Some(0) => format!("never: {}", cells[0].found.words()),
        Some(bad) => format!("to {}, then {}", setting(bad - 1), cells[bad].found.words()),
        None => "all".into(),
    }
}

/// Two tables of a row for each r_e and a column for each subject: the signs, and where each leaves.
fn maps(
    [name, title, caption]: [&str; 3],
    subjects: &[&dyn Subject],
    settings: &[f64],
    setting: impl Fn(usize) -> String,
    run: impl Fn(&dyn Subject, f64, f64) -> Cell,
) -> Vec<ReportTable> {
    let mut signs = Vec::new();
    let mut ends = Vec::new();
    for r in ASPECT_RATIOS {
        let cells = |subject: &&dyn Subject| -> Vec<Cell> {
            settings
                .iter()
                .map(|setting| run(*subject, r, *setting))
                .collect()
        };
        let cells: Vec<_> = subjects.iter().map(cells).collect();
        let row = |text: &dyn Fn(&[Cell]) -> String| {
            let texts = cells.iter().map(|cells| text(cells));
            std::iter::once(ratio(r)).chain(texts).collect::<Vec<_>>()
        };
        signs.push(row(&strip));
        ends.push(row(&|cells| leaves(cells, &setting)));
    }
    let names = subjects.iter().map(|subject| subject.name().to_owned());
    let columns: Vec<_> = std::iter::once("r_e".to_owned()).chain(names).collect();
    vec![
        table(name, title, format!("{caption} {LEGEND}"), columns.clone(), signs),
        table(
            &format!("{name}-end"),
            &format!("{title}: where each leaves"),
            format!("The last that is right in `{name}`, and what comes after it."),
            columns,
            ends,
        ),
    ]
}

fn steps(subjects: &[Box<dyn Subject>]) -> Vec<ReportTable> {
    let stepped: Vec<_> = (subjects.iter())
        .map(AsRef::as_ref)
        .filter(|subject| subject.theory() != Theory::Adaptive)
        .collect();
    maps(
        [
            "stability-steps",
            "Stability map by step",
            &format!(
                "A sign for each of the steps 10⁻⁹, 10⁻⁸, … 10³ T, from left to right. Runs end in the middle of a flip, after one \
                 period or twenty steps, whichever is more; at short steps after {MOST_STEPS} of them. Subjects without steps \
                 go the length of a step at once."
            ),
        ],
        &stepped,
        &STEPS,
        |k| format!("{:.0e} T", STEPS[k]),
        |subject, r, step| map::by_step(subject.theory(), r, step, MOST_STEPS).of(subject),
    )
}

fn tolerances(subjects: &[Box<dyn Subject>]) -> Vec<ReportTable> {
    let adaptive: Vec<_> = (subjects.iter())
        .map(AsRef::as_ref)
        .filter(|subject| subject.theory() == Theory::Adaptive)
        .collect();
    // From fine to coarse, as steps are from short to long.
    let settings: Vec<f64> = TOLERANCES.into_iter().rev().collect();
    maps(
        [
            "stability-tolerances",
            "Stability map by tolerance",
            "A sign for each of the tolerances 10⁻¹², 10⁻¹⁰, 10⁻⁸, 10⁻⁶, 10⁻⁴, 10⁻², 10⁻¹, from left to right. One period, into the \
             middle of a flip.",
        ],
        &adaptive,
        &settings,
        |k| format!("{:.0e}", settings[k]),
        |subject, r, tolerance| {
            let run = map::by_duration(subject.theory(), r, 1.0, Place::mid_flip(r), MOST_STEPS);
            let setting = Setting::Tolerance(tolerance);
            run.map_or_else(Cell::not_run, |run| map::Run { setting, ..run }.of(subject))
        },
    )
}

fn cell(subject: &dyn Subject, r: f64, periods: f64, end: Place, most_steps: u64) -> Cell {
    map::by_duration(subject.theory(), r, periods, end, most_steps)
        .map_or_else(Cell::not_run, |run| run.of(subject))
}

fn starts(subjects: &[Box<dyn Subject>]) -> ReportTable {
    let ratios = [1e-8, 1.0 + 1e-12, 11.6, 1e8];
    let row = |subject: &dyn Subject| {
        let cells = ratios.map(|r| {
            let places = map::places(r).into_iter();
            let cells: Vec<_> = places
                .map(|(_, place)| cell(subject, r, 1.0, place, MOST_STEPS))
                .collect();
            strip(&cells)
        });
        [vec![subject.name().into()], cells.into()].concat()
    };
    let names: Vec<_> = map::places(2.0).into_iter().map(|(name, _)| name).collect();
    table(
        "stability-starts",
        "Stability map: poles, flip, and orbits from C = 0 to ∞",
        format!(
            "A sign for each of the places {}, from left to right: the end of one period and a flip. GΔt = {}, tolerance \
             {:.0e}. {LEGEND}",
            names.join("; "),
            map::STRAIN_PER_STEP,
            map::TOLERANCE
        ),
        std::iter::once("subject".to_owned())
            .chain(ratios.map(|r| format!("r_e = {}", ratio(r))))
            .collect(),
        subjects.iter().map(|subject| row(subject.as_ref())).collect(),
    )
}

fn durations(subjects: &[Box<dyn Subject>]) -> ReportTable {
    let r = 11.6;
    let row = |subject: &dyn Subject| {
        let mut row = vec![subject.name().into()];
        row.extend(PERIODS.map(|periods| {
            let found = cell(subject, r, periods, Place::mid_flip(r), 10 * MOST_STEPS);
            match (found.error_rad, found.found) {
                (Some(error), _) => format!("`{}` {error:.0e}", found.found.sign()),
                (None, Found::NotRun) => format!("`·` {}", found.reason.unwrap_or_default()),
                (None, _) => format!("`{}`", found.found.sign()),
            }
        }));
        row
    };
    let columns = PERIODS.map(|periods| format!("{periods:.0e} T"));
    table(
        "stability-durations",
        "Stability map: up to 10⁸ periods at r_e = 11.6",
        format!(
            "The angle to the closed form in rad. GΔt = {}, tolerance {:.0e}; at most {} steps. {LEGEND}",
            map::STRAIN_PER_STEP,
            map::TOLERANCE,
            10 * MOST_STEPS
        ),
        [vec!["subject".into()], columns.into()].concat(),
        subjects.iter().map(|subject| row(subject.as_ref())).collect(),
    )
}

/// An aspect ratio in few letters.
pub(super) fn ratio(r: f64) -> String {
    match r {
        r if r > 1.0 && r < 1.0 + 1e-9 => format!("1 + {}", power_of_ten((r - 1.0).log10().round() as i32)),
        r if (0.01..1e4).contains(&r) => r.to_string(),
        r => power_of_ten(r.log10().round() as i32),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::subject;

    #[test]
    fn a_strip_says_where_it_leaves() {
        let (problem, end) = (map::by_step(Theory::Exact, 2.0, 1.0, 1), Place::mid_flip(2.0));
        let right = problem.of(&subject::ExactPropagator);
        let wrong = map::Run {
            end: end.before(0.1),
            ..problem
        };
        let late = map::Run {
            turns: 1.1,
            end,
            ..problem
        }
        .of(&subject::ExactPropagator);
        assert_eq!((right.found, late.found), (Found::RoundOff, Found::RoundOff));
        assert!(wrong.of(&subject::ExactPropagator).found.is_right());
        let bad = Cell::not_run("many".into());
        let cells = [right.clone(), right.clone(), bad.clone(), right.clone()];
        assert_eq!(strip(&cells), "`==·=`");
        assert_eq!(leaves(&cells, |k| k.to_string()), "to 1, then not run");
        assert_eq!(leaves(&[bad], |k| k.to_string()), "never: not run");
        assert_eq!(leaves(&[right], |k| k.to_string()), "all");
    }
}
