//! The studies of the limit Δt → 0 as tables and a picture.

use super::study::{Limit, PERIODS_AT, SCENE};
use super::tail::Exponent;
use super::{Counts, StepCounts, averaged, updates};
use crate::judge::statistics::Sample;
use crate::present::plot;
use crate::present::study::ReportFigure;
use crate::present::table::{Column, ReportTable, estimate, field, number, words};

/// A value with two digits of its error.
fn value(mean: f64, se: f64) -> String {
    let digits = (1.0 - se.log10().floor()).clamp(0.0, 9.0) as usize;
    if se > 0.0 && se.is_finite() { format!("{mean:.digits$} ± {se:.digits$}") } else { format!("{mean}") }
}

fn pair(sample: Sample) -> (f64, f64) {
    (sample.mean, sample.se)
}

fn mean<'a>(name: &str, of: fn(&Counts) -> f64) -> Column<'a, &'a StepCounts> {
    estimate(name, value, move |row: &&StepCounts| pair(row.mean(of)))
}

/// What the liquid does to the gap.
fn sides<'a>() -> [Column<'a, &'a StepCounts>; 5] {
    [
        mean("> 0.1, closing", |c| c.closing[1]),
        mean("formula", |c| c.fresh_closing[1]),
        mean("> 0.1, opening", |c| c.opening[1]),
        mean("formula", |c| c.fresh_opening[1]),
        mean("turns by a collision", |c| c.turns),
    ]
}

/// The study in words.
pub fn tables(study: &Limit) -> Vec<ReportTable> {
    vec![steps(study), dense(study), periods(study), exponents(study), averages(study), update(study)]
}

fn steps(study: &Limit) -> ReportTable {
    let mut columns = vec![
        field("steps per period", |row: &&StepCounts| row.steps_per_period),
        mean("> 0.01 rad", |c| c.all(0)),
        mean("> 0.1 rad", |c| c.all(1)),
        mean("> 1 rad", |c| c.all(2)),
        mean("> 10 rad", |c| c.all(3)),
        mean("> 0.1, formula", |c| c.fresh(1)),
    ];
    columns.extend(sides());
    ReportTable::new(
        ["kick-rates", "Kicks per rod and period against the step"],
        format!(
            "Scene {SCENE} (σ = 3.6 %), t/T from 0 to 2, {} replicas. A kick is |ṗ′ − ṗ|Δt. Kicks above 0.1 rad are also told \
             apart by what the liquid does to the gap between the contact points, and stand beside the formula for \
             fresh arms with the directions of the run. `kick-formula`, `kick-memory`",
            study.replicas[0]
        ),
        &study.steps,
        columns,
    )
}

fn dense(study: &Limit) -> ReportTable {
    let mut columns = vec![field("steps per period", |row: &&StepCounts| row.steps_per_period)];
    columns.extend(sides());
    ReportTable::new(
        ["kick-rates-dense", "Kicks where rods collide often"],
        format!(
            "100 rods at 400 per cm³ with α = 2, r_e = 11.6, t/T from 0 to 1, {} replicas: what frequent collisions do \
             to the arm shows at coarser steps. `kick-memory`, `arm-pushed`",
            study.replicas[1]
        ),
        &study.dense,
        columns,
    )
}

fn periods(study: &Limit) -> ReportTable {
    let mut columns = vec![
        words("t/T", |row: &&StepCounts| format!("{} to {}", row.periods.start, row.periods.end)),
        mean("> 0.1 rad", |c| c.all(1)),
        mean("> 1 rad", |c| c.all(2)),
    ];
    columns.extend(sides());
    ReportTable::new(
        ["kicks-by-period", "Kicks per rod and period as the rods align"],
        format!(
            "Scene {SCENE} (σ = 3.6 %) at {PERIODS_AT} steps a period, {} replicas. The rate follows the directions: the formula \
             is evaluated with those of the run.",
            study.replicas[0]
        ),
        &study.periods,
        columns,
    )
}

fn exponents(study: &Limit) -> ReportTable {
    type Tail = (String, Exponent);
    ReportTable::new(
        ["kick-tail", "The exponent of the kicks' tail, by Hill's estimate"],
        "Rods of Fig. 4 (σ = 3.6 %). From all kicks above a threshold chosen beforehand; the standard error is α over the root of their number. \
         An arm of any size gives 1; a shortest arm cuts the tail off. `kick-tail`",
        &study.tails,
        vec![
            words("kicks", |t: &&Tail| t.0.as_str()),
            field("threshold", |t: &&Tail| t.1.threshold),
            field("above it", |t: &&Tail| t.1.count),
            estimate("exponent", |a, se| format!("{a:.3} ± {se:.3}"), |t: &&Tail| (t.1.alpha, t.1.se)),
        ],
    )
}

fn four(number: f64) -> String {
    format!("{number:.4}")
}

fn averages(study: &Limit) -> ReportTable {
    type Of<'a> = &'a averaged::AveragedStep;
    ReportTable::new(
        ["averaged-motion", "The model against the averaged motion"],
        format!(
            "50 rods at 400 per cm³, r_e = 11.6, t/T = 1, {} replicas, same places. With a shortest arm the model \
             tends to the averaged motion path by path; with arms of every size it does not (⅔ in the last column: no \
             memory of the path). `averaged-motion`",
            study.replicas[1]
        ),
        &study.averaged,
        vec![
            number("min_contact_arm", four, |r: &Of| r.min_contact_arm),
            field("steps per period", |r: &Of| r.steps_per_period),
            estimate("averaged X̄₁", value, |r: &Of| pair(r.averaged_x1)),
            estimate("model − averaged", value, |r: &Of| pair(r.x1)),
            estimate("mean sin² between paths", value, |r: &Of| pair(r.square)),
        ],
    )
}

fn update(study: &Limit) -> ReportTable {
    type Of<'a> = &'a updates::BothUpdates;
    ReportTable::new(
        ["updates", "The update `angles` against `rotation`"],
        format!(
            "50 rods at 400 per cm³, r_e = 11.6, t/T = 1, {} replicas with the same draws. A kick of finite angle ends \
             elsewhere by either update, however short the step: with arms of every size the two have different limits. \
             `updates-in-the-limit`",
            2 * study.replicas[1]
        ),
        &study.updates,
        vec![
            number("min_contact_arm", four, |r: &Of| r.min_contact_arm),
            field("steps per period", |r: &Of| r.steps_per_period),
            estimate("X̄₁ by rotation", value, |r: &Of| pair(r.rotation_x1)),
            estimate("angles − rotation", value, |r: &Of| pair(r.change)),
        ],
    )
}

/// The rates against the step.
pub fn figure(study: &Limit) -> ReportFigure {
    let points = |label: &str, value: &dyn Fn(&StepCounts) -> Sample| {
        let samples: Vec<_> = study.steps.iter().map(value).collect();
        plot::Points {
            label: label.into(),
            x: (study.steps.iter()).map(|row| row.steps_per_period as f64).collect(),
            y: samples.iter().map(|sample| sample.mean).collect(),
            y_error: Some(samples.iter().map(|sample| 1.96 * sample.se).collect()),
            ..Default::default()
        }
    };
    ReportFigure {
        name: "kick-rates".into(),
        figure: plot::Figure {
            title: "Kicks above 0.1 rad per rod and period against the step".into(),
            x_name: "steps per period".into(),
            y_name: "kicks per rod and period".into(),
            points: vec![
                points("all", &|row| row.mean(|c| c.all(1))),
                points("closing", &|row| row.mean(|c| c.closing[1])),
                points("opening", &|row| row.mean(|c| c.opening[1])),
                points("formula, closing", &|row| row.mean(|c| c.fresh_closing[1])),
                points("formula, opening", &|row| row.mean(|c| c.fresh_opening[1])),
            ],
            x_log: true,
            y_span: Some((0.0, 0.35)),
            ..Default::default()
        },
        caption: format!(
            "Scene {SCENE}, t/T from 0 to 2, with 95 % bars. Kicks of closing pairs come at the formula's rate at any \
             step; those of opening pairs die out as Δt → 0, because a pair's earlier collisions push the arm away from \
             0."
        ),
        source: "A.7 to A.14".into(),
        cases: vec!["kick-formula".into(), "kick-memory".into()],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_has_two_digits_of_its_error() {
        assert_eq!(value(0.26154, 0.00842), "0.2615 ± 0.0084");
        assert_eq!(value(83.878, 0.53), "83.88 ± 0.53");
        assert_eq!(value(0.0, 0.0), "0");
    }
}
