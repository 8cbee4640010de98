//! The study of the limit Δt → 0: kicks against the step, their tail, the averaged motion, the two updates.

use super::averaged::AtStep;
use super::tail::{self, Exponent};
use super::*;
use crate::input::scenes;

/// Kicks, averaged motion and updates as Δt → 0.
pub const STUDY: Study = Study {
    name: "limit",
    title: "The limit Δt → 0",
    question: "What is left of the collision model as the time step goes to 0?",
    cases: &[
        "kick-formula",
        "kick-memory",
        "kick-tail",
        "kick-bound",
        "averaged-motion",
        "arm-pushed",
        "updates-in-the-limit",
        "paths-do-not-converge",
    ],
    command: "cargo run --release -p shearbed-validation --example time_step",
    parts: &[],
    shared: false,
    run,
};

fn run(request: &Request) -> Result<Option<Findings>, String> {
    let limit = measure(request.effort)?;
    let exhibits = [
        Exhibit::both(figure(&limit), steps(&limit)),
        dense(&limit).into(),
        periods(&limit).into(),
        exponents(&limit).into(),
        averages(&limit).into(),
        update(&limit).into(),
    ];
    Ok(Some(Findings::new(answer(&limit), exhibits.into(), [])))
}

fn answer(limit: &Limit) -> String {
    let (Some(coarse), Some(fine)) = (limit.steps.first(), limit.steps.last()) else {
        return "Nothing was measured.".into();
    };
    let rate = |row: &StepCounts| row.mean(|c| c.kicks[(CLOSING, 1)]);
    let stay = rate(fine).mean > 2.0 * rate(fine).se;
    let words = |row: &StepCounts| format!("{:.3} ± {:.3}", rate(row).mean, rate(row).se);
    format!(
        "{}: closing pairs kick a rod by more than 0.1 rad {} times a period at {} steps, {} times at {} steps.",
        if stay { "Jumps are left" } else { "No jumps are seen" },
        words(coarse),
        coarse.steps_per_period,
        words(fine),
        fine.steps_per_period
    )
}

struct Limit {
    /// Kicks in the first two periods of Fig. 4's suspension against the step.
    steps: Vec<StepCounts>,
    /// Kicks in the first period of a suspension where rods collide often, against the step.
    dense: Vec<StepCounts>,
    /// Kicks in each period at one step.
    periods: Vec<StepCounts>,
    /// Exponents of the tail, each with a description of its kicks.
    tails: Vec<(String, Exponent)>,
    averaged: Vec<AtStep<3>>,
    updates: Vec<AtStep<2>>,
    /// Replicas behind the counts, and behind the averaged motion.
    replicas: [u64; 2],
}

const SCENE: &str = "fig4-n50";

/// The steps per period for the counts in single periods.
const PERIODS_AT: u64 = 400;

fn measure(effort: &Effort) -> Result<Limit, String> {
    let built_in = scenes::find(SCENE).ok_or("no such scene")?;
    let scene = built_in.scene().map_err(|error| error.to_string())?;
    let replicas = effort.pick([10, 8], [200, 100]);
    let finest = effort.pick(1600, 12_800);
    let doubled =
        |coarsest: u64, finest: u64| (0u32..).map(move |k| coarsest << k).take_while(move |steps| *steps <= finest);
    let averaged_steps = doubled(100, effort.pick(400, 6400));
    let mut dense = lab::crowded_scene(effort, 100, 400.0);
    lab::interaction(&mut dense).alpha = 2.0;
    // The second arm is the rods' radius.
    let arms = [0.25, 0.5 / 11.6, 0.0];
    let each = |arm| averaged_steps.clone().map(move |steps| (steps, arm));
    Ok(Limit {
        steps: doubled(50, finest).map(|steps| rates(&scene, steps, 0..2, replicas[0], KICKS)).collect(),
        dense: doubled(100, 2 * finest)
            .step_by(2)
            .map(|steps| rates(&dense, steps, 0..1, replicas[1], KICKS))
            .collect(),
        periods: (0..6).map(|period| rates(&scene, PERIODS_AT, period..period + 1, replicas[0], KICKS)).collect(),
        tails: tails(&scene, replicas[0]),
        averaged: (arms.into_iter().flat_map(each))
            .map(|(steps, arm)| averaged::row(effort, steps, arm, replicas[1]))
            .collect(),
        updates: ([0.25, 0.0].into_iter().flat_map(each))
            .map(|(steps, arm)| averaged::both_updates(effort, steps, arm, 2 * replicas[1]))
            .collect(),
        replicas,
    })
}

fn tails(scene: &Scene, replicas: u64) -> Vec<(String, Exponent)> {
    let with = |steps, arm| {
        let mut scene = scene.clone();
        scene.time = Time { steps_per_unit: Some(steps), outputs_per_unit: Some(1), ..Time::periods(2.0) };
        lab::interaction(&mut scene).min_contact_arm = arm;
        scene
    };
    let run = |steps, arm| tail::hill(tail::in_runs(&with(steps, arm), replicas, kicks_rad), 0.3);
    // One step in place of two periods of 200 steps: as many collisions from as many starts.
    let fresh = tail::hill(tail::fresh(&with(200, 0.0), 400 * replicas, kicks_rad), 2.0);
    let mut tails = vec![("fresh arms, kicks over GΔt".to_owned(), fresh)];
    for steps in [100, 400, 1600] {
        tails.push((format!("two periods, {steps} steps a period, rad"), run(steps, 0.0)));
    }
    tails.push(("400 steps, min_contact_arm = 0.05, rad".to_owned(), run(400, 0.05)));
    tails
}

fn mean<'a>(name: &str, of: fn(&Counts) -> f64) -> Column<'a, StepCounts> {
    estimate(name, move |row: &StepCounts| row.mean(of))
}

/// Columns by the side of the kick, for closing and opening gaps.
fn sides<'a>() -> [Column<'a, StepCounts>; 5] {
    [
        mean("> 0.1, closing", |c| c.kicks[(CLOSING, 1)]),
        mean("formula", |c| c.fresh[(CLOSING, 1)]),
        mean("> 0.1, opening", |c| c.kicks[(OPENING, 1)]),
        mean("formula", |c| c.fresh[(OPENING, 1)]),
        mean("turns by a collision", |c| c.collided),
    ]
}

fn steps(study: &Limit) -> ReportTable {
    let mut columns = vec![
        field("steps per period", |row: &StepCounts| row.steps_per_period),
        mean("> 0.01 rad", |c| c.kicks.column(0).sum()),
        mean("> 0.1 rad", |c| c.kicks.column(1).sum()),
        mean("> 1 rad", |c| c.kicks.column(2).sum()),
        mean("> 10 rad", |c| c.kicks.column(3).sum()),
        mean("> 0.1, formula", |c| c.fresh.column(1).sum()),
    ];
    columns.extend(sides());
    ReportTable::new(
        ["kick-rates", "Kicks per rod and period against the step"],
        format!(
            "Scene {SCENE} (σ = 3.6 %), t/T from 0 to 2, {} replicas. A kick is |ṗ′ − ṗ|Δt. Kicks above 0.1 rad are \
             also distinguished by what the liquid does to the gap between the contact points, and stand beside the \
             formula for fresh arms with the directions of the run. `kick-formula`, `kick-memory`",
            study.replicas[0]
        ),
        &study.steps,
        columns,
    )
}

fn dense(study: &Limit) -> ReportTable {
    let mut columns = vec![field("steps per period", |row: &StepCounts| row.steps_per_period)];
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
        words("t/T", |row: &StepCounts| format!("{} to {}", row.periods.start, row.periods.end)),
        mean("> 0.1 rad", |c| c.kicks.column(1).sum()),
        mean("> 1 rad", |c| c.kicks.column(2).sum()),
    ];
    columns.extend(sides());
    ReportTable::new(
        ["kicks-by-period", "Kicks per rod and period as the rods align"],
        format!(
            "Scene {SCENE} (σ = 3.6 %) at {PERIODS_AT} steps a period, {} replicas. The rate follows the directions: \
             the formula is evaluated with those of the run.",
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
        "Rods of Fig. 4 (σ = 3.6 %). From all kicks above a threshold chosen beforehand; the standard error is α over \
         the root of their number. An arm of any size gives 1; a shortest arm cuts the tail off. `kick-tail`",
        &study.tails,
        vec![
            words("kicks", |t: &Tail| t.0.clone()),
            field("threshold", |t: &Tail| t.1.threshold),
            field("above it", |t: &Tail| t.1.count),
            estimate("exponent", |t: &Tail| (t.1.alpha, t.1.se)),
        ],
    )
}

fn samples<'a, const N: usize>(names: [&str; N]) -> Vec<Column<'a, AtStep<N>>> {
    let mut columns = vec![
        number("min_contact_arm", decimals(4), |row: &AtStep<N>| row.min_contact_arm),
        field("steps per period", |row: &AtStep<N>| row.steps_per_period),
    ];
    columns.extend((0..N).map(|k| estimate(names[k], move |row: &AtStep<N>| row.samples[k])));
    columns
}

fn averages(study: &Limit) -> ReportTable {
    ReportTable::new(
        ["averaged-motion", "The model against the averaged motion"],
        format!(
            "50 rods at 400 per cm³, r_e = 11.6, t/T = 1, {} replicas, same places. With a shortest arm the model \
             tends to the averaged motion path by path; with arms of every size it does not (⅔ in the last column: no \
             memory of the path). `averaged-motion`",
            study.replicas[1]
        ),
        &study.averaged,
        samples(["averaged X̄₁", "model − averaged", "mean sin² between paths"]),
    )
}

fn update(study: &Limit) -> ReportTable {
    ReportTable::new(
        ["updates", "The update `angles` against `rotation`"],
        format!(
            "50 rods at 400 per cm³, r_e = 11.6, t/T = 1, {} replicas with the same draws. A kick of finite angle ends \
             elsewhere by either update, however short the step: with arms of every size the two have different \
             limits. `updates-in-the-limit`",
            2 * study.replicas[1]
        ),
        &study.updates,
        samples(["X̄₁ by rotation", "angles − rotation"]),
    )
}

fn figure(study: &Limit) -> ReportFigure {
    let points = |label: &str, value: fn(&Counts) -> f64| {
        Points::with_bars(label, &study.steps, |row| {
            let Sample { mean, se, .. } = row.mean(value);
            (row.steps_per_period as f64, mean, 1.96 * se)
        })
    };
    ReportFigure::new(
        ["kick-rates", "Kicks above 0.1 rad per rod and period against the step"],
        format!(
            "Scene {SCENE}, t/T from 0 to 2, with 95 % bars. Kicks of closing pairs come at the formula's rate at any \
             step; those of opening pairs die out as Δt → 0, because a pair's earlier collisions push the arm away \
             from 0."
        ),
        ["log steps per period", "kicks per rod and period"],
    )
    .points([
        points("all", |c| c.kicks.column(1).sum()),
        points("closing", |c| c.kicks[(CLOSING, 1)]),
        points("opening", |c| c.kicks[(OPENING, 1)]),
        points("formula, closing", |c| c.fresh[(CLOSING, 1)]),
        points("formula, opening", |c| c.fresh[(OPENING, 1)]),
    ])
    .spans(None, Some((0.0, 0.35)))
    .judged("A.7 to A.14", &["kick-formula", "kick-memory"])
}
