//! The information of two suspensions with one α about the interpretations that the paper leaves open.
//!
//! The points are made here by the naive reference, and are nobody's measurement. Points of one suspension do not
//! distinguish interpretations: each describes them with an α of its own. A contact line cut at the rods' ends has less
//! effect where rods are far apart, so that α would depend on the concentration. Who draws cannot be found in this way:
//! `docs/src/theory/fits.md`.

use super::fit_covers::{fit, set};
use super::*;
use crate::judge::accept::LEVEL;
use crate::judge::lab::problem;
use crate::methods::least_squares::Datum;
use crate::methods::least_squares::basis::Basis;
use crate::methods::least_squares::emulator::{Coefficients, coefficients};
use crate::methods::least_squares::likelihood::Rods;
use crate::oracle::naive::{Lines, Naive, mean_projections};
use crate::serve::fit::Range;
use crate::serve::fit::data::TimeColumn;
use crate::serve::fit::scenes::{AS_WRITTEN, Scenes};
use crate::serve::fit::search::Fit;
use crate::studies::interpretations::Change;
use rand_distr::StandardNormal;
use std::sync::Arc;

const PLANTED: f64 = 0.8;
/// The two suspensions: n a³ = 0.0075 and 0.75.
const CONCENTRATIONS: [f64; 2] = [20.0, 2000.0];
const RODS: usize = 50;
/// One standard deviation of the points' noise.
const NOISE: f64 = 0.002;
const COLUMNS: [&str; 3] = ["x1", "x2", "x3"];
/// Number of times of each suspension, up to half a period.
const TIMES: usize = 10;
const STEPS: usize = 5;
const STEPS_PER_PERIOD: u64 = 100;

/// Replicas behind the points, and behind each node of the model. In a pilot of other seeds χ² of cut lines exceeds
/// that of whole ones by 248. For 59 degrees of freedom χ² is above 124 with the probability
/// [`crate::judge::accept::LEVEL`]; with 248 more it is 307 with a standard deviation of √(2·59 + 4·248) = 33, 5.5 of
/// these above.
const REPLICAS: u64 = 600;

pub(super) fn cases() -> Vec<Case> {
    vec![
        Case::of(Judges::Program, "fit-tells-cut-lines")
            .claim(
                "χ² of one α for two suspensions accepts points of whole contact lines and refuses points of lines \
                 cut at the rods' ends.",
            )
            .source("eq. 5; docs/src/theory/fits.md")
            .under_test((|_| ()) as Change)
            .mistake("contact lines cut at the rods' ends", |problem| problem.reading.lines = Lines::CutAtEnds)
            .check(accepted),
    ]
}

fn scene(effort: &Effort, concentration_per_cm3: f64) -> Scene {
    let mut scene = lab::crowded_scene(effort, RODS, concentration_per_cm3);
    scene.time = Time { steps_per_unit: Some(STEPS_PER_PERIOD), ..Time::periods(0.5) };
    scene
}

/// One replica of both suspensions by the naive reference, in the order of [`data`].
fn curve(change: Change, effort: &Effort, replica: u64) -> Vec<f64> {
    let mut values = Vec::new();
    for (k, concentration) in CONCENTRATIONS.into_iter().enumerate() {
        let mut scene = scene(effort, concentration);
        lab::interaction(&mut scene).alpha = PLANTED;
        scene.ensemble.seed = effort.seed(80 + k as u64);
        let mut problem = problem(&scene, replica, None);
        change(&mut problem);
        let mut naive = Naive::new(problem);
        for _ in 0..TIMES {
            (0..STEPS).for_each(|_| naive.step());
            values.extend(mean_projections(&naive.orientations));
        }
    }
    values
}

/// Means over replicas of X̄₁ to X̄₃ of both suspensions, with an interpretation of the paper.
pub fn points(change: Change, effort: &Effort, replicas: u64) -> Vec<f64> {
    let rows: Vec<Vec<f64>> = lab::replicas(replicas, |replica| curve(change, effort, replica));
    let mean = |k: usize| rows.iter().map(|row| row[k]).sum::<f64>() / replicas as f64;
    (0..rows[0].len()).map(mean).collect()
}

/// The points' places, with their values and the standard deviation `u` of their noise.
fn data(value: impl Fn(usize) -> f64, u: f64) -> Vec<Datum> {
    let point = |k: usize| {
        let (set, column) = (k / (TIMES * COLUMNS.len()), COLUMNS[k % COLUMNS.len()]);
        let step = (k / COLUMNS.len() % TIMES + 1) * STEPS;
        Datum { value: value(k), u, ..Datum::place(set, column, step as f64 / STEPS_PER_PERIOD as f64) }
    };
    (0..CONCENTRATIONS.len() * TIMES * COLUMNS.len()).map(point).collect()
}

/// The coefficients of the model at its nodes, shared by the case and its control.
static MODEL: Shared<(), Result<Arc<Vec<Coefficients>>, String>> = Shared::new();

fn range() -> Result<Range, String> {
    Range::parse("interaction.alpha=0.4:1.2")
}

/// `replicas` replicas of the model at the nodes of its α.
pub fn model(effort: &Effort, replicas: u64) -> Result<Vec<Coefficients>, String> {
    let set = |(k, concentration): (usize, f64)| {
        set(&scene(effort, concentration), effort.seed(82 + k as u64), TimeColumn::Periods)
    };
    let sets = CONCENTRATIONS.into_iter().enumerate().map(set);
    let scenes = Scenes::new(sets.collect::<Result<_, String>>()?, vec![range()?])?;
    let places = data(|_| f64::NAN, f64::NAN);
    let model = |values: &[f64]| scenes.model(&places, AS_WRITTEN, values).map_err(String::from);
    let value = |node: &[f64]| vec![0.8 + 0.4 * node[0]];
    coefficients(&Basis::new(1), &model, &value, 0..replicas, &|| ())
}

/// The fit of a common α of both suspensions to points that are means of `replicas` replicas.
pub fn one_alpha(points: &[f64], u: f64, replicas: u64, model: &[Coefficients]) -> Result<Fit, String> {
    let rods = Rods { over_measured: vec![1.0 / replicas as f64; CONCENTRATIONS.len()], ..Rods::none(0) };
    fit(&data(|k| points[k], u), &range()?, &rods, &Basis::new(1), model)
}

fn accepted(change: &Change, effort: &Effort) -> Result<Evidence, String> {
    let replicas = effort.pick(REPLICAS, 4 * REPLICAS);
    let model = Result::clone(&MODEL.get(effort, (), || model(effort, replicas).map(Arc::new)))?;
    let mut rng = Pcg64Dxsm::seed_from_u64(effort.seed(84));
    let points: Vec<f64> = (points(*change, effort, replicas).iter())
        .map(|mean| mean + NOISE * rng.sample::<f64, _>(StandardNormal))
        .collect();
    let fit = one_alpha(&points, NOISE, replicas, &model)?;
    Ok(Evidence::on("p-value of χ² of one α for both suspensions", "–")
        .p_value(fit.best.goodness.p_value(), replicas, REPLICAS, LEVEL)
        .because("with these replicas χ² of cut lines is 5.5 of its standard deviations above what is accepted"))
}
