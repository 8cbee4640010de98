//! The studies as tables: free suspensions, cheapest splits, coupled estimates.

use super::coupled::{Coupled, Saving};
use super::free::{Bench, StartCurve, TARGETS};
use super::split::{Constants, Scope, Split};
use super::study::{Answer, Interacting};
use crate::present::table::{Column, ReportTable, estimate, field, number, words};
use crate::studies::work_precision::tables::{NOT_REACHED, time};

/// Free suspensions: what each start reaches, and when.
pub fn free(benches: &[Bench]) -> ReportTable {
    type Of<'a> = (&'a Bench, &'a StartCurve);
    let rows = benches.iter().flat_map(|bench| bench.curves.iter().map(move |c| (bench, c)));
    let mut columns: Vec<Column<Of>> = vec![
        words("scene", |r: &Of| r.0.free.scene),
        words("start", |r: &Of| r.1.start),
        number("theory", |x| format!("{x:+.2}"), |r: &Of| r.1.theory),
        estimate("exponent", |x, se| format!("{x:+.2} ± {se:.2}"), |r: &Of| (r.1.exponent, r.1.exponent_se)),
    ];
    columns.extend(TARGETS.map(|target| {
        let reached = move |r: &Of| match r.1.cheapest(target) {
            Some(point) => format!("{} ({} rods)", time(point.seconds.least), point.rods),
            None => NOT_REACHED.into(),
        };
        words(format!("error {target:.0e}"), reached)
    }));
    ReportTable::new(
        ["suspension-starts", "Free suspensions: the time for an error of X̄₁, by how the rods are laid"],
        "Isotropic rods without collisions at t/T = 0.95, against the closed form; root mean square over trials. The \
         exponent is of the number of rods in the error, over 10³ rods and more. No time step is taken: the whole \
         error is that of the sample (`free-suspension-rates`).",
        rows,
        columns,
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

fn split_columns<'a, R>(of: impl Fn(&R) -> Split + Copy + 'a) -> Vec<Column<'a, R>> {
    let e = |x: f64| format!("{x:.1e}");
    vec![
        number("error", |x| format!("{x:.0e}"), move |r| of(r).target),
        words("from", move |r| match of(r).scope {
            Scope::OwnRods(rods) => format!("Δt → 0, {rods} rods"),
            Scope::Unbounded => "Δt → 0, N → ∞".into(),
        }),
        field("steps per period", move |r| of(r).steps_per_period),
        field("rods", move |r| of(r).rods),
        field("replicas", move |r| of(r).replicas),
        number("bias ≤", e, move |r| of(r).bias),
        number("scatter", e, move |r| of(r).scatter),
        number("rods × steps", e, move |r| of(r).rod_steps() as f64),
    ]
}

/// What to run for an error, for any scene.
pub fn splits(constants: &Constants, splits: &[Split]) -> ReportTable {
    ReportTable::new(
        ["splits", "The cheapest steps, rods and replicas for an error of X̄₁ at t/T = 1"],
        rule(constants),
        splits,
        split_columns(|split: &&Split| **split),
    )
}

/// The same with times, and what was realised.
pub fn answers(study: &Interacting) -> ReportTable {
    let realised = |answer: &&Answer| match &answer.realised {
        Some(realised) => format!(
            "{:.1e} (bias {:+.1e} ± {:.0e}, scatter {:.1e} ± {:.0e})",
            realised.error,
            realised.bias.value,
            realised.bias.se,
            realised.scatter.value,
            realised.scatter.se
        ),
        None => "– (not run)".into(),
    };
    let references: Vec<_> = (study.references.iter())
        .map(|r| {
            format!(
                "{:.5} ± {:.5} at {} steps, {} rods, {} replicas",
                r.x1, r.se, r.steps_per_period, r.rods, r.replicas
            )
        })
        .collect();
    let mut columns = split_columns(|answer: &&Answer| answer.split);
    columns.push(number("time, one core", time, |answer: &&Answer| answer.seconds));
    columns.push(words("realised error", realised));
    ReportTable::new(
        [
            "suspension-splits",
            &format!("Interacting rods ({}): the cheapest split for an error of X̄₁ at t/T = 1", study.scene),
        ],
        format!(
            "{} A rod's step takes {} on one core. The error includes the bias of the steps; the second half counts that \
             of the faces too. Realised errors are counted from {} (`cheapest-split`).",
            rule(&study.constants),
            time(study.rod_step_s),
            references.join(" and ")
        ),
        &study.answers,
        columns,
    )
}

/// What shared random numbers save.
pub fn coupled(coupled: &Coupled) -> ReportTable {
    let two = |x: f64| format!("{x:.2}");
    ReportTable::new(
        ["suspension-coupled", "Shared random numbers: by what factor fewer runs are needed"],
        format!(
            "Levels in Δt ({} and {} steps per period, same seeds) are tied by their starts alone: the gain with coarse \
             runs at an eighth of the cost, and the most that coarse runs for nothing could give; below 1 it costs more \
             than it saves. The same rods without collisions, whose mean has a closed form, give more for less. Common \
             random numbers pay for a difference, here between α and 0.8 α. {} replicas (`shared-random-numbers`, \
             `paths-do-not-converge`).",
            coupled.steps_per_period,
            2 * coupled.steps_per_period,
            coupled.replicas
        ),
        &coupled.rows,
        vec![
            number("t/T", |t| t.to_string(), |r: &&Saving| r.turns),
            number("ρ, half the step", two, |r: &&Saving| r.finer),
            number("gain, levels", two, |r: &&Saving| r.multilevel()),
            number("at best", two, |r: &&Saving| r.multilevel_at_best()),
            number("ρ, free rods", two, |r: &&Saving| r.free),
            number("gain, control variate", two, |r: &&Saving| r.control_variate()),
            number("ρ, other α", two, |r: &&Saving| r.other_alpha),
            number("gain for the difference", two, |r: &&Saving| r.common_numbers()),
        ],
    )
}
