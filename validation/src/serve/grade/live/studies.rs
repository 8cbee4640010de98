//! Studies of a program beyond a verdict, as for the project's integrators: work–precision, longest steps, a stability
//! map.

use super::bench::{self, Bench};
use super::path::{Along, path};
use super::program::Program;
use crate::methods::integrators::limits::{Ladder, Limit, Property, longest_on};
use crate::methods::integrators::{Setting, Theory};
use crate::present::table::{ReportTable, of_words};
use crate::studies::stability::map;
use serde::Serialize;

/// All measurements; `None` for a study that had not enough time (`--timeout`).
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Studies {
    /// Error against run time.
    pub work_precision: Option<Bench>,
    /// The error along the path.
    pub path: Option<Vec<Along>>,
    /// The longest steps.
    pub limits: Option<Vec<Longest>>,
    /// The fate of a rod by aspect ratio and step.
    pub map: Option<Vec<MapRow>>,
}

/// The longest step at which a program keeps a property.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Longest {
    /// The property that is kept.
    pub property: Property,
    /// r_e.
    pub aspect_ratio: f64,
    /// The longest step, GΔt.
    pub strain: Limit,
}

/// A row of the map.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MapRow {
    /// r_e.
    pub aspect_ratio: f64,
    /// The fate at each of [`STEPS`] or [`TOLERANCES`].
    pub found: Vec<map::Fate>,
}

const LIMIT_RATIOS: [f64; 2] = [2.0, 11.6];

const MAP_RATIOS: [f64; 6] = [0.1, 1.01, 2.0, 11.6, 100.0, 1e4];

/// Steps of the map, in periods.
const STEPS: [f64; 5] = [1e-4, 1e-3, 1e-2, 0.1, 1.0];

const TOLERANCES: [f64; 5] = [1e-2, 1e-4, 1e-6, 1e-8, 1e-10];

/// The largest number of steps in a run of the map.
const MOST_STEPS: u64 = 20_000;

/// Rungs from a step at which every consistent method works up to a hundred times 1/G.
const LADDER: Ladder = Ladder { least: 0.01, most: 100.0, factor: 1.25 };

/// Runs all studies, each for no longer than one answer may take.
pub fn studies(program: &Program, echo: &str) -> Studies {
    Studies {
        work_precision: program.within_time("work against precision", || bench::bench(program, echo)),
        path: program.within_time("the error along the path", || path(program)),
        limits: match program.theory {
            Theory::Order(_) => program.within_time("longest steps", || limits(program)),
            _ => Some(Vec::new()),
        },
        map: program.within_time("the stability map", || rows(program)),
    }
}

fn limits(program: &Program) -> Vec<Longest> {
    let integrator = program.integrator();
    let of = |property: Property, aspect_ratio: f64| Longest {
        property,
        aspect_ratio,
        strain: longest_on(LADDER, &integrator, property, aspect_ratio),
    };
    [Property::Turning, Property::Length, Property::Orbit]
        .into_iter()
        .flat_map(|property| LIMIT_RATIOS.map(|aspect_ratio| of(property, aspect_ratio)))
        .collect()
}

fn rows(program: &Program) -> Vec<MapRow> {
    let integrator = program.integrator();
    let cell = |aspect_ratio: f64, k: usize| {
        let mut run = map::by_step(program.theory, aspect_ratio, STEPS[k], MOST_STEPS);
        if program.theory == Theory::Adaptive {
            run = map::by_step(Theory::Order(1), aspect_ratio, 0.1, MOST_STEPS);
            run.setting = Setting::Tolerance(TOLERANCES[k]);
        }
        run.of(&integrator).found
    };
    let found = |aspect_ratio: f64| (0..STEPS.len()).map(|k| cell(aspect_ratio, k)).collect();
    MAP_RATIOS.map(|aspect_ratio| MapRow { aspect_ratio, found: found(aspect_ratio) }).into()
}

impl Studies {
    /// The measurements as tables.
    pub fn tables(&self) -> Vec<ReportTable> {
        let mut tables: Vec<_> = self.work_precision.iter().map(Bench::table).collect();
        tables.extend(self.limits.iter().filter(|limits| !limits.is_empty()).map(|limits| limit_table(limits)));
        tables.extend(self.map.iter().map(|rows| self.map_table(rows)));
        tables
    }

    /// The measurements that are missing.
    pub fn left_out(&self) -> impl Iterator<Item = &'static str> {
        let parts = [
            ("work against precision", self.work_precision.is_none()),
            ("the error along the path", self.path.is_none()),
            ("longest steps", self.limits.is_none()),
            ("the stability map", self.map.is_none()),
        ];
        parts.into_iter().filter_map(|(what, is_missing)| is_missing.then_some(what))
    }

    fn map_table(&self, rows: &[MapRow]) -> ReportTable {
        let adaptive = (self.work_precision.as_ref()).is_some_and(|bench| bench.program.theory == Theory::Adaptive);
        let (what, heads): (_, Vec<_>) = if adaptive {
            ("tolerance", TOLERANCES.iter().map(|tolerance| format!("{tolerance:.0e}")).collect())
        } else {
            ("Δt", STEPS.iter().map(|step| format!("{step} T")).collect())
        };
        let row = |row: &MapRow| {
            let signs = row.found.iter().map(|found| found.sign().to_owned());
            std::iter::once(row.aspect_ratio.to_string()).chain(signs).collect()
        };
        let mut map = of_words(
            "grade-stability",
            "What becomes of a rod",
            "= at round-off, + within 10⁻² rad, w stable but wrong, L length lost, N not finite, R refused with an \
             error.",
            &[&format!("r_e, by {what}")],
            rows.iter().map(row).collect(),
        );
        map.columns.extend(heads);
        map
    }
}

fn limit_table(limits: &[Longest]) -> ReportTable {
    let row = |longest: &Longest| {
        let property = match longest.property {
            Property::Turning => "every rod turns, by less than half a turn a step",
            Property::Length => "|p| < 1.5 after ten periods",
            Property::Orbit => "C_b within 0.1 after ten periods",
            _ => "–",
        };
        let limit = match longest.strain {
            Limit::At(strain) => format!("{strain:.4}"),
            Limit::Beyond(strain) => format!("> {strain:.0}"),
            Limit::Below(strain) => format!("< {strain}"),
        };
        vec![property.to_owned(), longest.aspect_ratio.to_string(), limit]
    };
    of_words(
        "grade-limits",
        "The longest step GΔt with which",
        "By a ladder with the factor 1.25 and bisection.",
        &["property", "r_e", "longest GΔt"],
        limits.iter().map(row).collect(),
    )
}
