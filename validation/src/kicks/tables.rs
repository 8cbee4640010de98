//! The studies of the limit Δt → 0 as tables and a picture.

use super::study::{PERIODS_AT, SCENE, Study};
use super::tail::Exponent;
use super::{Row, averaged, updates};
use crate::plot;
use crate::report::{ReportFigure, ReportTable};
use crate::statistics::Sample;

fn value(sample: Sample) -> String {
    // Two digits of the error.
    let digits = (1.0 - sample.se.log10().floor()).clamp(0.0, 9.0) as usize;
    if sample.se > 0.0 && sample.se.is_finite() {
        format!("{:.digits$} ± {:.digits$}", sample.mean, sample.se)
    } else {
        format!("{}", sample.mean)
    }
}

fn table(name: &str, title: &str, caption: String, columns: &[&str], rows: Vec<Vec<String>>) -> ReportTable {
    ReportTable {
        name: name.into(),
        title: title.into(),
        caption,
        columns: columns.iter().map(|column| (*column).into()).collect(),
        rows,
    }
}

/// The study in words.
pub fn tables(study: &Study) -> Vec<ReportTable> {
    vec![
        steps(study),
        dense(study),
        periods(study),
        exponents(study),
        averages(study),
        update(study),
    ]
}

fn steps(study: &Study) -> ReportTable {
    let row = |row: &Row| {
        let mut cells = vec![row.steps_per_period.to_string()];
        cells.extend((0..4).map(|k| value(row.mean(|c| c.all(k)))));
        cells.push(value(row.mean(|c| c.fresh(1))));
        cells.extend(sides(row));
        cells
    };
    table(
        "kick-rates",
        "Kicks per rod and period against the step",
        format!(
            "Scene {SCENE} (σ = 3.6 %), t/T from 0 to 2, {} replicas. A kick is |ṗ′ − ṗ|Δt. Kicks above 0.1 rad are also told \
             apart by what the liquid does to the gap between the contact points, and stand beside the formula for \
             fresh arms with the directions of the run. `kick-formula`, `kick-memory`",
            study.replicas[0]
        ),
        &[
            &[
                "steps per period",
                "> 0.01 rad",
                "> 0.1 rad",
                "> 1 rad",
                "> 10 rad",
                "> 0.1, formula",
            ],
            &SIDES[..],
        ]
        .concat(),
        study.steps.iter().map(row).collect(),
    )
}

fn dense(study: &Study) -> ReportTable {
    let row = |row: &Row| {
        let mut cells = vec![row.steps_per_period.to_string()];
        cells.extend(sides(row));
        cells
    };
    table(
        "kick-rates-dense",
        "Kicks where rods collide often",
        format!(
            "100 rods at 400 per cm³ with α = 2, r_e = 11.6, t/T from 0 to 1, {} replicas: what frequent collisions do \
             to the arm shows at coarser steps. `kick-memory`, `arm-pushed`",
            study.replicas[1]
        ),
        &[&["steps per period"], &SIDES[..]].concat(),
        study.dense.iter().map(row).collect(),
    )
}

const SIDES: [&str; 5] = [
    "> 0.1, closing",
    "formula",
    "> 0.1, opening",
    "formula",
    "turns by a collision",
];

fn sides(row: &Row) -> [String; 5] {
    [
        value(row.mean(|c| c.closing[1])),
        value(row.mean(|c| c.fresh_closing[1])),
        value(row.mean(|c| c.opening[1])),
        value(row.mean(|c| c.fresh_opening[1])),
        value(row.mean(|c| c.turns)),
    ]
}

fn periods(study: &Study) -> ReportTable {
    let row = |row: &Row| {
        let mut cells = vec![format!("{} to {}", row.periods.start, row.periods.end)];
        cells.extend([1, 2].map(|k| value(row.mean(|c| c.all(k)))));
        cells.extend(sides(row));
        cells
    };
    table(
        "kicks-by-period",
        "Kicks per rod and period as the rods align",
        format!(
            "Scene {SCENE} (σ = 3.6 %) at {PERIODS_AT} steps a period, {} replicas. The rate follows the directions: the formula \
             is evaluated with those of the run.",
            study.replicas[0]
        ),
        &[&["t/T", "> 0.1 rad", "> 1 rad"], &SIDES[..]].concat(),
        study.periods.iter().map(row).collect(),
    )
}

fn exponents(study: &Study) -> ReportTable {
    let row = |(what, tail): &(String, Exponent)| {
        vec![
            what.clone(),
            tail.threshold.to_string(),
            tail.count.to_string(),
            format!("{:.3} ± {:.3}", tail.alpha, tail.se),
        ]
    };
    table(
        "kick-tail",
        "The exponent of the kicks' tail, by Hill's estimate",
        "Rods of Fig. 4 (σ = 3.6 %). From all kicks above a threshold chosen beforehand; the standard error is α over the root of their number. \
         An arm of any size gives 1; a shortest arm cuts the tail off. `kick-tail`"
            .into(),
        &["kicks", "threshold", "above it", "exponent"],
        study.tails.iter().map(row).collect(),
    )
}

fn averages(study: &Study) -> ReportTable {
    let row = |row: &averaged::Row| {
        vec![
            format!("{:.4}", row.min_contact_arm),
            row.steps_per_period.to_string(),
            value(row.averaged_x1),
            value(row.x1),
            value(row.square),
        ]
    };
    table(
        "averaged-motion",
        "The model against the averaged motion",
        format!(
            "50 rods at 400 per cm³, r_e = 11.6, t/T = 1, {} replicas, same places. With a shortest arm the model \
             tends to the averaged motion path by path; with arms of every size it does not (⅔ in the last column: no \
             memory of the path). `averaged-motion`",
            study.replicas[1]
        ),
        &[
            "min_contact_arm",
            "steps per period",
            "averaged X̄₁",
            "model − averaged",
            "mean sin² between paths",
        ],
        study.averaged.iter().map(row).collect(),
    )
}

fn update(study: &Study) -> ReportTable {
    let row = |row: &updates::Row| {
        vec![
            format!("{:.4}", row.min_contact_arm),
            row.steps_per_period.to_string(),
            value(row.rotation_x1),
            value(row.change),
        ]
    };
    table(
        "updates",
        "The update `angles` against `rotation`",
        format!(
            "50 rods at 400 per cm³, r_e = 11.6, t/T = 1, {} replicas with the same draws. A kick of finite angle ends \
             elsewhere by either update, however short the step: with arms of every size the two have different limits. \
             `updates-in-the-limit`",
            2 * study.replicas[1]
        ),
        &[
            "min_contact_arm",
            "steps per period",
            "X̄₁ by rotation",
            "angles − rotation",
        ],
        study.updates.iter().map(row).collect(),
    )
}

/// The rates against the step.
pub fn figure(study: &Study) -> ReportFigure {
    let points = |label: &str, value: &dyn Fn(&Row) -> Sample| {
        let samples: Vec<_> = study.steps.iter().map(value).collect();
        plot::Points {
            label: label.into(),
            x: (study.steps.iter())
                .map(|row| row.steps_per_period as f64)
                .collect(),
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
        let sample = |mean, se| value(Sample { mean, se, samples: 9 });
        assert_eq!(sample(0.26154, 0.00842), "0.2615 ± 0.0084");
        assert_eq!(sample(83.878, 0.53), "83.88 ± 0.53");
        assert_eq!(sample(0.0, 0.0), "0");
    }
}
