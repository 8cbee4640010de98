//! The maps of outcomes as pictures.

use super::map::{self, ASPECT_RATIOS, Cell, Fate, PERIODS, TOLERANCES};
use super::orbit::Place;
use super::theory::THEORIES;
use super::*;
use crate::methods::integrators::limits::Property;
use crate::present::plot::{Grid, Map, decade, power_of_ten};

/// The largest number of steps in a run of the maps over steps and over starts; ten times as many over durations.
pub const MOST_STEPS: u64 = 20_000;

/// Exponents of the picture's steps GΔt: quarter decades.
const STRAINS: std::ops::RangeInclusive<i32> = -6..=10;

/// The aspect ratios of the picture, for which theory has limits.
const RODS: [f64; 10] = [1.01, 1.5, 2.0, 3.0, 5.0, 11.6, 30.0, 100.0, 1e3, 1e4];

fn strain(quarter: i32) -> f64 {
    10f64.powf(0.25 * f64::from(quarter))
}

/// The theoretical limit of the property `Order`, in columns and rows of the picture by steps.
fn limit(integrator: &str) -> Vec<(f64, f64)> {
    let theory = (THEORIES.iter()).find(|theory| theory.0 == integrator && theory.1 == Property::Order);
    let Some((_, _, theory)) = theory else {
        return Vec::new();
    };
    let column = |strain: f64| 4.0 * strain.log10() - f64::from(*STRAINS.start());
    let at = |(row, r): (usize, &f64)| (column(theory(*r)), row as f64);
    let points = RODS.iter().enumerate().map(at);
    points.filter(|(column, _)| column.is_finite()).collect()
}

/// A sentence on the worst and the best method with steps: the longest step of the grid up to which it is right at
/// every aspect ratio of the picture.
pub fn answer(figures: &[ReportFigure]) -> String {
    let grid = figures.first().and_then(|figure| figure.figure.grid.as_ref());
    let maps = grid.iter().flat_map(|grid| &grid.maps);
    let right = |map: &Map| {
        let wrong = |column: &usize| map.cells.iter().any(|row| row[*column] != 0);
        (0..STRAINS.count()).find(wrong).unwrap_or(STRAINS.count())
    };
    let mut reached: Vec<_> = maps.map(|map| (right(map), map.title.as_str())).collect();
    reached.sort_unstable();
    let words = |(columns, name): &(usize, &str)| match columns {
        0 => format!("{name} at none of the steps tried"),
        columns => format!("{name} up to GΔt = {:.2}", strain(STRAINS.start() + *columns as i32 - 1)),
    };
    match (reached.first(), reached.last()) {
        (Some(worst), Some(best)) => format!(
            "Over one period and at every aspect ratio {} is right to 10⁻² rad, and {}; the others lie between.",
            words(worst),
            words(best)
        ),
        _ => "No method with steps was tried.".into(),
    }
}

pub fn figures(integrators: &[Integrator]) -> Vec<ReportFigure> {
    vec![steps(integrators), tolerances(integrators), starts(integrators), durations(integrators)]
}

pub(super) fn with_theory(integrators: &[Integrator], which: impl Fn(Theory) -> bool) -> Vec<&Integrator> {
    integrators.iter().filter(|integrator: &&Integrator| which(integrator.theory)).collect()
}

fn steps(integrators: &[Integrator]) -> ReportFigure {
    let row = |integrator: &Integrator, r: f64| {
        let run = |quarter| {
            let step = strain(quarter) / strain_per_period(r);
            map::by_step(integrator.theory, r, step, MOST_STEPS).of(integrator)
        };
        classes(STRAINS.map(run))
    };
    let map = |integrator: &Integrator| {
        let cells = RODS.map(|r| row(integrator, r)).into();
        Map { title: integrator.name.clone(), cells, limit: limit(&integrator.name) }
    };
    let stepped = with_theory(integrators, |theory| matches!(theory, Theory::Order(_)));
    figure(
        ["stability-steps", "Stability by step and aspect ratio"],
        format!(
            "Runs end during a flip, at φ = 1 rad, after one period or twenty steps, whichever is more; at short steps \
             after {MOST_STEPS} of them. Right: within 10⁻² rad of the closed form. The line is theory's longest \
             step without overtaking, where there is one: a step is inaccurate long before. The exact propagator takes \
             no steps and is right everywhere."
        ),
        ["step GΔt", "aspect ratio r_e"],
        Grid {
            columns: STRAINS
                .map(|quarter| match quarter % 4 {
                    0 => decade(quarter / 4),
                    _ => String::new(),
                })
                .collect(),
            values: STRAINS.map(|quarter| strain(quarter).to_string()).collect(),
            rows: RODS.map(ratio).into(),
            maps: stepped.into_iter().map(map).collect(),
            ..Default::default()
        },
    )
}

/// The tolerances from fine to coarse, as steps are from short to long.
pub(super) fn tolerances_from_fine() -> impl Iterator<Item = f64> {
    TOLERANCES.into_iter().rev()
}

pub(super) fn with_tolerance(integrator: &Integrator, r: f64, tolerance: f64) -> Cell {
    let run = map::by_duration(integrator.theory, r, 1.0, Place::mid_flip(r), MOST_STEPS);
    let setting = Setting::Tolerance(tolerance);
    run.map_or_else(Cell::not_run, |run| map::Run { setting, ..run }.of(integrator))
}

fn tolerances(integrators: &[Integrator]) -> ReportFigure {
    let row = |integrator: &Integrator, r| classes(tolerances_from_fine().map(|t| with_tolerance(integrator, r, t)));
    let map = |integrator: &Integrator| {
        let cells = ASPECT_RATIOS.map(|r| row(integrator, r)).into();
        Map { title: integrator.name.clone(), cells, ..Default::default() }
    };
    figure(
        ["stability-tolerances", "Stability by tolerance and aspect ratio"],
        "Integrators that choose their step: one period, into a flip.",
        ["tolerance", "aspect ratio r_e"],
        Grid {
            columns: tolerances_from_fine().map(power).collect(),
            values: tolerances_from_fine().map(|t| format!("{t:e}")).collect(),
            rows: ASPECT_RATIOS.map(ratio).into(),
            maps: with_theory(integrators, |theory| theory == Theory::Adaptive).into_iter().map(map).collect(),
            ..Default::default()
        },
    )
}

fn power(value: f64) -> String {
    decade(value.log10().round() as i32)
}

fn cell(integrator: &Integrator, r: f64, periods: f64, end: Place, most_steps: u64) -> Cell {
    map::by_duration(integrator.theory, r, periods, end, most_steps)
        .map_or_else(Cell::not_run, |run| run.of(integrator))
}

fn names(integrators: &[Integrator]) -> Vec<String> {
    integrators.iter().map(|integrator| integrator.name.clone()).collect()
}

fn starts(integrators: &[Integrator]) -> ReportFigure {
    let row = |integrator: &Integrator, r| {
        let run = |(_, place)| cell(integrator, r, 1.0, place, MOST_STEPS);
        classes(map::places(r).into_iter().map(run))
    };
    let map = |r: f64| {
        let cells = integrators.iter().map(|integrator| row(integrator, r)).collect();
        Map { title: format!("r_e = {}", ratio(r)), cells, ..Default::default() }
    };
    let places = map::places(2.0).into_iter().map(|(name, _)| name);
    figure(
        ["stability-starts", "Stability at the poles, in the flip, and on orbits from C = 0 to ∞"],
        format!(
            "The end of one period and a flip. Places: {}. GΔt = {}, tolerance {:.0e}.",
            places.clone().enumerate().map(|(k, name)| format!("{} {name}", k + 1)).collect::<Vec<_>>().join("; "),
            map::STRAIN_PER_STEP,
            map::TOLERANCE
        ),
        ["place", ""],
        Grid {
            columns: places.clone().enumerate().map(|(k, _)| (k + 1).to_string()).collect(),
            values: places.map(String::from).collect(),
            rows: names(integrators),
            maps: [1e-8, 1.0 + 1e-12, 11.6, 1e8].map(map).into(),
            ..Default::default()
        },
    )
}

fn durations(integrators: &[Integrator]) -> ReportFigure {
    let r = 11.6;
    let row = |integrator: &Integrator| {
        let run = |periods| cell(integrator, r, periods, Place::mid_flip(r), 10 * MOST_STEPS);
        classes(PERIODS.map(run))
    };
    let map = Map { cells: integrators.iter().map(row).collect(), ..Default::default() };
    figure(
        ["stability-durations", "Stability over up to 10⁸ periods at r_e = 11.6"],
        format!(
            "GΔt = {}, tolerance {:.0e}; at most {} steps, so longer runs of methods with steps are not run.",
            map::STRAIN_PER_STEP,
            map::TOLERANCE,
            10 * MOST_STEPS
        ),
        ["duration (periods)", ""],
        Grid {
            columns: PERIODS.map(power).into(),
            values: PERIODS.map(|periods| format!("{periods:e}")).into(),
            rows: names(integrators),
            maps: vec![map],
            ..Default::default()
        },
    )
}

fn figure(words: [&str; 2], caption: impl Into<String>, axes: [&str; 2], grid: Grid) -> ReportFigure {
    let mut figure = ReportFigure::new(words, caption, axes);
    figure.figure.grid = Some(Grid {
        classes: Fate::CLASSES.map(String::from).into(),
        limit_name: "theory: no overtaking up to here".into(),
        ..grid
    });
    figure.judged("A.1 to A.5", &["stability-map"])
}

fn classes(cells: impl IntoIterator<Item = Cell>) -> Vec<usize> {
    cells.into_iter().map(|cell| cell.found.class()).collect()
}

impl Fate {
    const CLASSES: [&'static str; 6] = ["right", "stable but wrong", "length lost", "not finite", "refused", "not run"];

    /// The index of the outcome's class in [`Self::CLASSES`]: the first two outcomes are right.
    fn class(self) -> usize {
        (self as usize).saturating_sub(1)
    }
}

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

    #[test]
    fn theory_s_limit_lies_where_its_step_is() {
        // 1/Λ is 1 for long rods, the column of 10⁰; at r_e = 1.01 it is far to the right.
        let limit = limit("explicit Euler in angles");
        assert_eq!(limit.len(), RODS.len());
        let (column, row) = limit[9];
        assert!((column - 6.0).abs() < 1e-6 && row == 9.0, "{limit:?}");
        assert!(limit[0].0 > limit[1].0, "{limit:?}");
        assert!(super::limit("RK4 in p").is_empty());
    }
}
