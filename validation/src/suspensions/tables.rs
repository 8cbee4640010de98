//! The studies as tables: free suspensions, cheapest splits, coupled estimates.

use super::coupled::{Coupled, Row};
use super::free::{Bench, Curve, TARGETS};
use super::split::{Constants, Scope, Split};
use super::study::{Answer, Study};
use crate::report::ReportTable;
use crate::work_precision::tables::{NOT_REACHED, table, time};

/// Free suspensions: what each start reaches, and when.
pub fn free(benches: &[Bench]) -> ReportTable {
    let row = |bench: &Bench, curve: &Curve| {
        let mut row = vec![
            bench.free.scene.to_owned(),
            curve.start.to_owned(),
            format!("{:+.2}", curve.theory),
            format!("{:+.2} ± {:.2}", curve.exponent, curve.exponent_se),
        ];
        row.extend(TARGETS.map(|target| match curve.cheapest(target) {
            Some(point) => format!("{} ({} rods)", time(point.seconds.least), point.rods),
            None => NOT_REACHED.into(),
        }));
        row
    };
    let rows = benches
        .iter()
        .flat_map(|bench| bench.curves.iter().map(move |curve| row(bench, curve)));
    table(
        "suspension-starts",
        "Free suspensions: the time for an error of X̄₁, by how the rods are laid",
        "Isotropic rods without collisions at t/T = 0.95, against the closed form; root mean square over trials. The \
         exponent is of the number of rods in the error, over 10³ rods and more. No time step is taken: the whole \
         error is that of the sample (`free-suspension-rates`).",
        &[
            "scene",
            "start",
            "theory",
            "exponent",
            "error 1e-2",
            "1e-3",
            "1e-4",
            "1e-6",
        ],
        rows.collect(),
    )
}

/// The rule as the measured constants give it, in words.
fn rule(constants: &Constants) -> String {
    format!(
        "Mean-square error = (b/S + c N^(−1/3))² + v/(N M) for S steps per period, N rods and M replicas, with b = {:.2} \
         for S ≥ {}, c = {:.3} (each the largest that its standard error allows: estimate + 2 se) and v = {:.3}; cost = \
         N M S. With the scene's own rods S = √3 b/ε and N M = 3v/(2ε²), or the fewest steps and N M = \
         v/(ε² − (b/S)²) where that is more; without faces as many rods in as few replicas as there may be.",
        constants.steps_bias, constants.fewest_steps, constants.rods_bias, constants.variance_per_rod
    )
}

fn split_cells(split: &Split) -> Vec<String> {
    let counted_from = match split.scope {
        Scope::OwnRods(rods) => format!("Δt → 0, {rods} rods"),
        Scope::Unbounded => "Δt → 0, N → ∞".into(),
    };
    vec![
        format!("{:.0e}", split.target),
        counted_from,
        split.steps_per_period.to_string(),
        split.rods.to_string(),
        split.replicas.to_string(),
        format!("{:.1e}", split.bias),
        format!("{:.1e}", split.scatter),
        format!("{:.1e}", split.rod_steps() as f64),
    ]
}

const SPLIT_COLUMNS: [&str; 8] = [
    "error",
    "from",
    "steps per period",
    "rods",
    "replicas",
    "bias ≤",
    "scatter",
    "rods × steps",
];

/// What to run for an error, for any scene.
pub fn splits(constants: &Constants, splits: &[Split]) -> ReportTable {
    table(
        "splits",
        "The cheapest steps, rods and replicas for an error of X̄₁ at t/T = 1",
        &rule(constants),
        &SPLIT_COLUMNS,
        splits.iter().map(split_cells).collect(),
    )
}

/// The same with times, and what was realised.
pub fn answers(study: &Study) -> ReportTable {
    let row = |answer: &Answer| {
        let mut row = split_cells(&answer.split);
        row.push(time(answer.seconds));
        row.push(match &answer.realised {
            Some(realised) => format!(
                "{:.1e} (bias {:+.1e} ± {:.0e}, scatter {:.1e} ± {:.0e})",
                realised.error,
                realised.bias.value,
                realised.bias.se,
                realised.scatter.value,
                realised.scatter.se
            ),
            None => "– (not run)".into(),
        });
        row
    };
    let references: Vec<_> = (study.references.iter())
        .map(|r| {
            format!(
                "{:.5} ± {:.5} at {} steps, {} rods, {} replicas",
                r.x1, r.se, r.steps_per_period, r.rods, r.replicas
            )
        })
        .collect();
    let mut columns = SPLIT_COLUMNS.to_vec();
    columns.extend(["time, one core", "realised error"]);
    table(
        "suspension-splits",
        &format!(
            "Interacting rods ({}): the cheapest split for an error of X̄₁ at t/T = 1",
            study.scene
        ),
        &format!(
            "{} A rod's step takes {} on one core. The error includes the bias of the steps; the second half counts that \
             of the faces too. Realised errors are counted from {} (`cheapest-split`).",
            rule(&study.constants),
            time(study.rod_step_s),
            references.join(" and ")
        ),
        &columns,
        study.answers.iter().map(row).collect(),
    )
}

/// What shared random numbers save.
pub fn coupled(coupled: &Coupled) -> ReportTable {
    let row = |row: &Row| {
        vec![
            row.turns.to_string(),
            format!("{:.2}", row.finer),
            format!("{:.2}", row.multilevel()),
            format!("{:.2}", row.multilevel_at_best()),
            format!("{:.2}", row.free),
            format!("{:.2}", row.control_variate()),
            format!("{:.2}", row.other_alpha),
            format!("{:.2}", row.common_numbers()),
        ]
    };
    table(
        "suspension-coupled",
        "Shared random numbers: by what factor fewer runs are needed",
        &format!(
            "Levels in Δt ({} and {} steps per period, same seeds) are tied by their starts alone: the gain with coarse \
             runs at an eighth of the cost, and the most that coarse runs for nothing could give; below 1 it costs more \
             than it saves. The same rods without collisions, whose mean has a closed form, give more for less. Common \
             random numbers pay for a difference, here between α and 0.8 α. {} replicas (`shared-random-numbers`, \
             `paths-do-not-converge`).",
            coupled.steps_per_period,
            2 * coupled.steps_per_period,
            coupled.replicas
        ),
        &[
            "t/T",
            "ρ, half the step",
            "gain, levels",
            "at best",
            "ρ, free rods",
            "gain, control variate",
            "ρ, other α",
            "gain for the difference",
        ],
        coupled.rows.iter().map(row).collect(),
    )
}
