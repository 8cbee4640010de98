//! The maps of outcomes as pictures.

use super::map::{self, ASPECT_RATIOS, Cell, Fate, PERIODS, TOLERANCES};
use super::orbit::Place;
use super::theory::THEORIES;
use crate::methods::integrators::limits::Property;
use crate::methods::integrators::{Integrator, Setting, Theory};
use crate::present::plot::{Grid, Map, decade, power_of_ten};
use crate::present::study::ReportFigure;
use shearbed::model::jeffery::strain_per_period;

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
fn limit(subject: &str) -> Vec<(f64, f64)> {
    let theory = (THEORIES.iter()).find(|theory| theory.0 == subject && theory.1 == Property::Order);
    let Some((_, _, theory)) = theory else {
        return Vec::new();
    };
    let column = |strain: f64| 4.0 * strain.log10() - f64::from(*STRAINS.start());
    let at = |(row, r): (usize, &f64)| (column(theory(*r)), row as f64);
    let points = RODS.iter().enumerate().map(at);
    points.filter(|(column, _)| column.is_finite()).collect()
}

/// A sentence on the worst and the best method with steps: the longest step of the grid up to which it is right at every aspect
/// ratio of the picture.
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

/// The maps as pictures.
pub fn figures(subjects: &[Integrator]) -> Vec<ReportFigure> {
    [steps(subjects), tolerances(subjects), starts(subjects), durations(subjects)].map(Panels::figure).into()
}

pub(super) fn of(subjects: &[Integrator], which: impl Fn(Theory) -> bool) -> Vec<&Integrator> {
    subjects.iter().filter(|subject: &&Integrator| which(subject.theory)).collect()
}

fn steps(subjects: &[Integrator]) -> Panels<'static> {
    let panel = |subject: &Integrator| Panel {
        title: subject.name.clone(),
        cells: RODS
            .map(|r| {
                let run = |quarter| {
                    let step = strain(quarter) / strain_per_period(r);
                    map::by_step(subject.theory, r, step, MOST_STEPS).of(subject)
                };
                STRAINS.map(run).collect()
            })
            .into(),
        limit: limit(&subject.name),
    };
    let stepped = of(subjects, |theory| matches!(theory, Theory::Order(_)));
    Panels {
        words: ["stability-steps", "Stability by step and aspect ratio"],
        caption: format!(
            "Runs end during a flip, at φ = 1 rad, after one period or twenty steps, whichever is more; at short steps after \
             {MOST_STEPS} of them. Right: within 10⁻² rad of the closed form. The black line is theory's longest step \
             without overtaking, where there is one: a step is inaccurate long before. The exact propagator takes no steps \
             and is right everywhere."
        ),
        axes: ["step GΔt", "aspect ratio r_e"],
        columns: STRAINS
            .map(|quarter| match quarter % 4 {
                0 => decade(quarter / 4),
                _ => String::new(),
            })
            .collect(),
        values: STRAINS.map(|quarter| strain(quarter).to_string()).collect(),
        rows: RODS.map(ratio).into(),
        panels: stepped.into_iter().map(panel).collect(),
    }
}

/// The tolerances from fine to coarse, as steps are from short to long.
pub(super) fn tolerances_from_fine() -> impl Iterator<Item = f64> {
    TOLERANCES.into_iter().rev()
}

pub(super) fn with_tolerance(subject: &Integrator, r: f64, tolerance: f64) -> Cell {
    let run = map::by_duration(subject.theory, r, 1.0, Place::mid_flip(r), MOST_STEPS);
    let setting = Setting::Tolerance(tolerance);
    run.map_or_else(Cell::not_run, |run| map::Run { setting, ..run }.of(subject))
}

fn tolerances(subjects: &[Integrator]) -> Panels<'static> {
    let panel = |subject: &Integrator| Panel {
        title: subject.name.clone(),
        cells: ASPECT_RATIOS
            .map(|r| tolerances_from_fine().map(|t| with_tolerance(subject, r, t)).collect())
            .into(),
        limit: Vec::new(),
    };
    Panels {
        words: ["stability-tolerances", "Stability by tolerance and aspect ratio"],
        caption: "Integrators that choose their step: one period, into a flip.".into(),
        axes: ["tolerance", "aspect ratio r_e"],
        columns: tolerances_from_fine().map(power).collect(),
        values: tolerances_from_fine().map(|t| format!("{t:e}")).collect(),
        rows: ASPECT_RATIOS.map(ratio).into(),
        panels: of(subjects, |theory| theory == Theory::Adaptive).into_iter().map(panel).collect(),
    }
}

fn power(value: f64) -> String {
    decade(value.log10().round() as i32)
}

fn cell(subject: &Integrator, r: f64, periods: f64, end: Place, most_steps: u64) -> Cell {
    map::by_duration(subject.theory, r, periods, end, most_steps)
        .map_or_else(Cell::not_run, |run| run.of(subject))
}

fn names(subjects: &[Integrator]) -> Vec<String> {
    subjects.iter().map(|subject| subject.name.clone()).collect()
}

fn starts(subjects: &[Integrator]) -> Panels<'static> {
    let panel = |r: f64| Panel {
        title: format!("r_e = {}", ratio(r)),
        cells: (subjects.iter())
            .map(|subject| {
                let places = map::places(r).into_iter();
                let found = |(_, place)| cell(subject, r, 1.0, place, MOST_STEPS);
                places.map(found).collect()
            })
            .collect(),
        limit: Vec::new(),
    };
    let places = map::places(2.0).into_iter().map(|(name, _)| name);
    Panels {
        words: ["stability-starts", "Stability at the poles, in the flip, and on orbits from C = 0 to ∞"],
        caption: format!(
            "The end of one period and a flip. Places: {}. GΔt = {}, tolerance {:.0e}.",
            places
                .clone()
                .enumerate()
                .map(|(k, name)| format!("{} {name}", k + 1))
                .collect::<Vec<_>>()
                .join("; "),
            map::STRAIN_PER_STEP,
            map::TOLERANCE
        ),
        axes: ["place", ""],
        columns: places.clone().enumerate().map(|(k, _)| (k + 1).to_string()).collect(),
        values: places.map(String::from).collect(),
        rows: names(subjects),
        panels: [1e-8, 1.0 + 1e-12, 11.6, 1e8].map(panel).into(),
    }
}

fn durations(subjects: &[Integrator]) -> Panels<'static> {
    let r = 11.6;
    let row = |subject: &Integrator| {
        let found = |periods| cell(subject, r, periods, Place::mid_flip(r), 10 * MOST_STEPS);
        PERIODS.map(found).into()
    };
    Panels {
        words: ["stability-durations", "Stability over up to 10⁸ periods at r_e = 11.6"],
        caption: format!(
            "GΔt = {}, tolerance {:.0e}; at most {} steps, so longer runs of methods with steps are not run.",
            map::STRAIN_PER_STEP,
            map::TOLERANCE,
            10 * MOST_STEPS
        ),
        axes: ["duration (periods)", ""],
        columns: PERIODS.map(power).into(),
        values: PERIODS.map(|periods| format!("{periods:e}")).into(),
        rows: names(subjects),
        panels: vec![Panel {
            title: String::new(),
            cells: subjects.iter().map(row).collect(),
            limit: Vec::new(),
        }],
    }
}

/// The outcomes of one integrator, or at one aspect ratio: a row and a column for each cell.
struct Panel {
    title: String,
    cells: Vec<Vec<Cell>>,
    limit: Vec<(f64, f64)>,
}

/// A picture of panels with the same rows and columns.
struct Panels<'a> {
    words: [&'a str; 2],
    caption: String,
    axes: [&'a str; 2],
    columns: Vec<String>,
    values: Vec<String>,
    rows: Vec<String>,
    panels: Vec<Panel>,
}

impl Panels<'_> {
    fn figure(self) -> ReportFigure {
        let row = |row: &Vec<Cell>| row.iter().map(|cell| cell.found.class()).collect();
        let map = |panel: Panel| Map {
            title: panel.title,
            cells: panel.cells.iter().map(row).collect(),
            limit: panel.limit,
        };
        let mut figure = ReportFigure::new(self.words, self.caption, self.axes);
        figure.figure.grid = Some(Grid {
            classes: Fate::CLASSES.map(String::from).into(),
            columns: self.columns,
            values: self.values,
            rows: self.rows,
            maps: self.panels.into_iter().map(map).collect(),
            limit_name: "theory: the longest step without overtaking".into(),
        });
        figure.judged("A.1 to A.5", &["stability-map"])
    }
}

impl Fate {
    /// The classes that a map distinguishes.
    const CLASSES: [&'static str; 6] =
        ["right", "stable but wrong", "length lost", "not finite", "refused", "not run"];

    /// The index of the outcome's class in [`Self::CLASSES`].
    fn class(self) -> usize {
        match self {
            Self::RoundOff | Self::Accurate => 0,
            Self::Wrong => 1,
            Self::LengthLost => 2,
            Self::NotFinite => 3,
            Self::Refused => 4,
            Self::NotRun => 5,
        }
    }
}

/// An aspect ratio as a short text.
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
