//! The study of an interacting scene: its law of errors, constants, cheapest splits and their realised errors, coupled
//! estimates.

use super::coupled::{self, Coupled};
use super::job::Job;
use super::law::{self, JobMean, Law, Replicas};
use super::split::{self, Constants, Realised, Scope, Split, TARGETS};
use super::*;
use crate::input::scenes;
use crate::studies::work_precision::study::time;
use crate::studies::work_precision::{Budget, measure as clock};

/// The study of steps, rods and replicas of interacting rods.
pub const STUDY: Study = Study {
    name: "interacting-suspensions",
    title: "Interacting suspensions: steps, rods and replicas",
    question: "How many steps, rods and replicas does an error of X̄₁ take?",
    cases: &[
        "cheapest-split",
        "faces-cost-collisions",
        "paths-do-not-converge",
        "shared-random-numbers",
        "default-step-resolves",
        "hundred-rods-suffice",
    ],
    command: "cargo run --release -- bench --case fig7-n50",
    parts: &[SCENE],
    shared: false,
    run,
};

fn run(request: &Request) -> Result<Option<Findings>, String> {
    let amount = request.effort.pick(Amount::QUICK, Amount::FULL);
    let study = measure(amount, request.effort.pick(Budget::QUICK, Budget::FULL))?;
    let [_, steps, law @ ..] = law_tables::law(&study.law, study.strain_per_period);
    let mut exhibits = vec![
        Exhibit::both(figure(&study), answers(&study)),
        Exhibit::both(law_tables::steps_figure(&study.law), steps),
    ];
    exhibits.extend(law.map(Exhibit::from));
    exhibits.push(coupled::table(&study.coupled).into());
    let answer = study.answers.first().map_or(String::new(), |answer| {
        let split = &answer.split;
        format!(
            "For an error of {:.0e} at t/T = 1: {} steps a period, {} rods and {} replicas, {} on one core.",
            split.target,
            split.steps_per_period,
            split.rods,
            split.replicas,
            time(answer.seconds)
        )
    });
    let files = [("splits.csv", splits_csv(&study)?), ("splits.json", build::json(&study)?)];
    Ok(Some(Findings::new(answer, exhibits, files)))
}

/// The built-in scene of the study: the paper's Fig. 7, rods of one size.
const SCENE: &str = "fig7-n50";

struct Amount {
    /// Replicas of the jobs over steps and rods.
    replicas: Replicas,
    /// Steps per period and replicas of the reference with the scene's own rods.
    reference: (u64, u64),
    /// Steps per period, rods and replicas of the reference without faces.
    unbounded: Option<(u64, usize, u64)>,
    /// The number of runs of the split for each of [`TARGETS`].
    repeats: [u64; 3],
    coupled: u64,
}

impl Amount {
    /// Takes seconds.
    const QUICK: Self = Self {
        replicas: Replicas::Within { rod_steps: 10_000_000, most: 2000 },
        reference: (800, 400),
        unbounded: None,
        repeats: [16, 0, 0],
        coupled: 200,
    };
    /// Takes a minute or two.
    const FULL: Self = Self {
        replicas: Replicas::Within { rod_steps: 100_000_000, most: 20_000 },
        reference: (3200, 5000),
        unbounded: Some((800, 100_000, 8)),
        repeats: [64, 16, 8],
        coupled: 2000,
    };
}

/// A split, its time, and its realised error if it was run.
#[derive(Serialize)]
struct Answer {
    split: Split,
    /// The split's time on one core, from the time of a rod's step.
    seconds: f64,
    realised: Option<Realised>,
}

#[derive(Serialize)]
struct Interacting {
    scene: &'static str,
    strain_per_period: f64,
    law: Law,
    constants: Constants,
    /// The time of one rod's step on one core in s, with the scene's own rods.
    rod_step_s: f64,
    /// For each of [`TARGETS`]: with the scene's own rods, and without faces.
    answers: Vec<Answer>,
    /// The references for realised errors: with the scene's own rods, and without faces.
    references: Vec<JobMean>,
    coupled: Coupled,
}

/// Studies [`SCENE`] on the threads of the current pool; the time of a rod's step is measured on one core.
fn measure(amount: Amount, budget: Budget) -> Result<Interacting, String> {
    let built_in = scenes::find(SCENE).ok_or("no such scene")?;
    let scene = built_in.scene().map_err(|error| error.to_string())?;
    let scene = Scene { time: Time { duration: 1.0, ..scene.time.clone() }, ..scene };
    let own = Scope::OwnRods(scene.particles.count);
    let jobs = law::jobs(&scene, amount.replicas);
    let law = law::read(&scene, &jobs, &law::run(&jobs, &|| ())?);
    let constants = Constants::of(&law).ok_or("no straight line fits X̄₁ against the steps or the rods")?;

    let single = Job::new(&scene, scene.steps_per_unit(), scene.particles.count, 1, 1);
    let rod_step_s = clock(budget, || single.run(&|| ())).least / single.rod_steps() as f64;
    let (steps, replicas) = amount.reference;
    let mut references = vec![split::reference(&scene, steps, scene.particles.count, replicas)?];
    if let Some((steps, rods, replicas)) = amount.unbounded {
        references.push(split::reference(&scene, steps, rods, replicas)?);
    }
    let mut answers = Vec::new();
    for (scope, reference) in [(own, references.first()), (Scope::Unbounded, references.get(1))] {
        for (target, repeats) in TARGETS.into_iter().zip(amount.repeats) {
            let split = constants.cheapest(scope, target);
            // A reference cannot judge errors as small as its own: the largest bias, and two standard errors.
            let judge = reference.filter(|reference| {
                let bias = constants.bias(scope, reference.steps_per_period as f64, reference.rods as f64);
                repeats > 0 && bias.hypot(2.0 * reference.se) < target
            });
            let realised = judge.map(|reference| {
                let reference = Estimate { value: reference.x1, se: reference.se };
                split.realise(&scene, repeats, reference)
            });
            answers.push(Answer {
                split,
                seconds: split.rod_steps() as f64 * rod_step_s,
                realised: realised.transpose()?,
            });
        }
    }
    Ok(Interacting {
        scene: SCENE,
        strain_per_period: strain_per_period(scene.particles.aspect_ratio),
        coupled: coupled::measure(&scene, amount.coupled)?,
        law,
        constants,
        rod_step_s,
        answers,
        references,
    })
}

fn splits_csv(study: &Interacting) -> Result<String, String> {
    let realised =
        |name: &str, of: fn(&Realised) -> f64| field(name, move |answer: &Answer| answer.realised.as_ref().map(of));
    let columns = vec![
        words("scene", |_: &Answer| study.scene),
        field("target", |answer: &Answer| answer.split.target),
        words("counted_from", |answer: &Answer| match answer.split.scope {
            Scope::OwnRods(_) => "own_rods",
            Scope::Unbounded => "unbounded",
        }),
        field("steps_per_period", |answer: &Answer| answer.split.steps_per_period),
        field("rods", |answer: &Answer| answer.split.rods),
        field("replicas", |answer: &Answer| answer.split.replicas),
        field("bias_at_most", |answer: &Answer| answer.split.bias),
        field("scatter", |answer: &Answer| answer.split.scatter),
        field("rod_steps", |answer: &Answer| answer.split.rod_steps()),
        field("seconds", |answer: &Answer| answer.seconds),
        field("repeats", |answer: &Answer| answer.realised.map(|realised| realised.repeats)),
        realised("realised_error", |realised| realised.error),
        realised("realised_bias", |realised| realised.bias.value),
        realised("realised_bias_se", |realised| realised.bias.se),
        realised("realised_scatter", |realised| realised.scatter.value),
    ];
    columns_csv(&study.answers, columns)
}

/// The rule with the measured constants, in words.
fn rule(constants: &Constants) -> String {
    let seen = if constants.steps_bias_seen {
        String::new()
    } else {
        format!(
            "Bias of the steps: none seen; those below are what its noise leaves room for, and {} may do. ",
            constants.fewest_steps
        )
    };
    format!(
        "{seen}Mean-square error = (b/S + c N^(−1/3))² + v/(N M) for S steps per period, N rods and M replicas, with \
         b = {:.2} for S ≥ {}, c = {:.3} (each the largest that its standard error allows: estimate + 2 se; c is an \
         upper bound, no fit, and rows with N → ∞ use it) and v = {:.3}; cost = N M S. With the scene's own rods \
         S = √3 b/ε and N M = 3v/(2ε²), or the fewest steps and N M = v/(ε² − \
         (b/S)²) where that is more; without faces as many rods in as few replicas as there may be.",
        constants.steps_bias, constants.fewest_steps, constants.rods_bias, constants.variance_per_rod
    )
}

fn split_columns<'a, R>(constants: &Constants, of: impl Fn(&R) -> Split + Copy + 'a) -> Vec<Column<'a, R>> {
    let at_most = if constants.steps_bias_seen { "steps per period" } else { "steps per period ≤" };
    vec![
        number("error", powers(0), move |r| of(r).target),
        words("from", move |r| match of(r).scope {
            Scope::OwnRods(rods) => format!("Δt → 0, {rods} rods"),
            Scope::Unbounded => "Δt → 0, N → ∞".into(),
        }),
        field(at_most, move |r| of(r).steps_per_period),
        field("rods", move |r| of(r).rods),
        field("replicas", move |r| of(r).replicas),
        number("bias ≤", powers(1), move |r| of(r).bias),
        number("scatter", powers(1), move |r| of(r).scatter),
        number("rods × steps a period", powers(1), move |r| of(r).rod_steps() as f64),
    ]
}

/// The table of the splits for given errors at the time `end`, for any scene.
pub fn splits_table(constants: &Constants, splits: &[Split], end: f64) -> ReportTable {
    ReportTable::new(
        ["splits", &format!("The cheapest steps, rods and replicas for an error of X̄₁ at t/T = {end}")],
        rule(constants),
        splits,
        split_columns(constants, |split: &Split| *split),
    )
}

/// The table of splits with times and realised errors.
fn answers(study: &Interacting) -> ReportTable {
    let realised = |answer: &Answer| match &answer.realised {
        Some(realised) => format!(
            "{:.1e} (bias {:+.1e} ± {:.0e}, scatter {:.1e} ± {:.0e})",
            realised.error, realised.bias.value, realised.bias.se, realised.scatter.value, realised.scatter.se
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
    let mut columns = split_columns(&study.constants, |answer: &Answer| answer.split);
    columns.push(number("time, one core", time, |answer: &Answer| answer.seconds));
    columns.push(words("realised error", realised));
    ReportTable::new(
        [
            "suspension-splits",
            &format!("Interacting rods ({}): the cheapest split for an error of X̄₁ at t/T = 1", study.scene),
        ],
        format!(
            "{} A rod's step takes {} on one core. The error includes the bias of the steps; the second half counts \
             that of the faces too. Realised errors are counted from {} (`cheapest-split`).",
            rule(&study.constants),
            time(study.rod_step_s),
            references.join(" and ")
        ),
        &study.answers,
        columns,
    )
}

/// The error by the rule, by a fixed step, and the realised errors, against the run time.
fn figure(study: &Interacting) -> ReportFigure {
    let (constants, seconds) = (&study.constants, |rod_steps: f64| rod_steps * study.rod_step_s);
    let errors = || (0..=40).map(|k| 0.03 * 10f64.powf(-0.05 * f64::from(k)));
    let rule = |scope: Scope, label: &str| {
        let splits = errors().map(|error| constants.cheapest(scope, error));
        Curve::of(label, splits, |split| (seconds(split.rod_steps() as f64), split.error()))
    };
    let mut curves = Vec::new();
    if let Some(Scope::OwnRods(own)) = study.answers.first().map(|answer| answer.split.scope) {
        let (steps, rods) = (200.0, own as f64);
        let bias = constants.bias(Scope::Unbounded, steps, rods);
        let replicas = (0..=40).map(|k| 10f64.powf(0.1 * f64::from(k)));
        curves = vec![
            rule(Scope::OwnRods(own), &format!("cheapest, counted from Δt → 0 with {own} rods")),
            rule(Scope::Unbounded, "cheapest, counted from Δt → 0 and N → ∞"),
            Curve::of("200 steps, the scene's rods, more and more replicas", replicas, |m| {
                let scatter = (constants.variance_per_rod / (rods * m)).sqrt();
                (seconds(m * rods * steps), bias.hypot(scatter))
            }),
        ];
    }
    let realised = study.answers.iter().filter_map(|answer| Some((answer.seconds, answer.realised?.error)));
    ReportFigure::new(
        [
            &format!("suspension-splits-{}", study.scene),
            "Interacting rods: total error of X̄₁ at t/T = 1 against run time",
        ],
        format!(
            "Scene {}. With a fixed step and fixed rods, more replicas end at the bias, here counted from Δt → 0 and N \
             → ∞; a realised error below its curve is a bias that is smaller than the largest that was allowed for.",
            study.scene
        ),
        ["log run time on one core (s)", "log rms error of X̄₁, bias at most"],
    )
    .curves(curves)
    .points([Points::of("realised", realised, |point| point)])
    .judged("eqs 4 to 14", &["cheapest-split"])
}
