//! Which further points would determine the parameters best: evaluates each point that could be measured, at all times
//! of a scene and at half and twice its concentration, by the uncertainties that it would leave, and chooses the best
//! in sequence.
//!
//! The measured points give exp(−χ²/2) as the density over the last box, evenly on the scales of the ranges. It gives
//! the parameters and each new point means, variances and covariances; a point with a standard uncertainty of u then
//! leaves C − c cᵀ/(u² + v), with c its covariances with the parameters and v its own variance (linear Bayes
//! estimation: Goldstein & Wooff, *Bayes Linear Statistics*, 2007). So a bent region is judged as a whole, not by the
//! slopes at its best place.

mod known;
#[cfg(test)]
mod tests;

use super::budget::from_one;
use super::error::{FitError, SceneError, Warning};
use super::scenes::Scenes;
use super::search::{Fit, Watch, values};
use crate::methods::least_squares::Datum;
use crate::methods::least_squares::basis::{Basis, grid};
use crate::methods::least_squares::emulator::{Emulator, Replica, coefficients};
use crate::methods::least_squares::likelihood::{READING, Rods, correlation_of};
pub(super) use known::Known;
use nalgebra::{DMatrix, DVector};
use serde::Serialize;

/// Evenly spaced times of a scene at which a point could be measured, and the largest number of candidates over all
/// sets, columns and concentrations: their values at all places take a quarter of a gigabyte at most.
const TIMES: usize = 300;
const MOST_CANDIDATES: usize = 1800;
/// Concentrations, in multiples of the scene's.
const CONCENTRATIONS: [f64; 3] = [0.5, 1.0, 2.0];
/// Number of best points that are listed.
const CHOSEN: usize = 6;
/// The largest number of replicas behind a point's values.
const MOST_REPLICAS: u64 = 100;
/// Places along each side of the box, for one, two and three parameters.
const PLACES: [usize; 3] = [401, 101, 25];
/// Places whose likelihood is at most this share of the largest are left out.
const SMALL: f64 = 1e-7;

/// A point that could be measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate {
    /// The data set of the point's scene, counted from 0.
    pub set: usize,
    /// The concentration of that scene; none where rods do not interact or the concentration is fitted.
    pub concentration_per_cm3: Option<f64>,
    /// The column's name, such as `x1`.
    pub column: String,
    /// Time of the point, in the unit of the set's times.
    pub time: f64,
    /// Standard uncertainty of the new point: the median of the set's measured points in this column, including that of
    /// their times, and the scatter of the rods of a point at its own time.
    pub u: f64,
    /// Standard deviation of the point's value, given the measured points.
    pub spread: f64,
    /// Standard uncertainty of each parameter if this point alone were added.
    pub leaves: Vec<f64>,
}

/// The uncertainty that is left after points are added.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Step {
    /// The added points.
    pub added: Added,
    /// Standard uncertainty of each parameter after that.
    pub u: Vec<f64>,
    /// The correlation of two parameters that is largest in size; none for a single parameter.
    pub correlation: Option<f64>,
}

/// Points that are added.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "what", rename_all = "snake_case")]
pub enum Added {
    /// No point: the measured ones alone.
    Nothing,
    /// As many points as were measured in this set, evenly over the candidates of its scene.
    AsMany {
        /// The data set, counted from 0; files count from 1.
        #[serde(serialize_with = "from_one")]
        set: usize,
        /// The number of points.
        points: usize,
        /// The concentration of its scene.
        concentration_per_cm3: Option<f64>,
    },
    /// One more point, in addition to those of the earlier steps.
    Point {
        /// The data set, counted from 0; files count from 1.
        #[serde(serialize_with = "from_one")]
        set: usize,
        /// The concentration of its scene.
        concentration_per_cm3: Option<f64>,
        /// The column's name, such as `x1`.
        column: String,
        /// Time of the point, in the unit of the set's times.
        time: f64,
    },
}

/// The model of points by scenes.
pub type ModelOf<'a> = dyn Fn(&Scenes, &[Datum], &[f64]) -> Result<Replica, String> + Sync + 'a;

/// Points that could be measured, the uncertainties that they would leave, and warnings.
#[derive(Clone, Debug, Default)]
pub struct Design {
    /// All points that were examined.
    pub candidates: Vec<Candidate>,
    /// The measured points, then as many more of each set and concentration, then the best points in sequence.
    pub steps: Vec<Step>,
    /// Concentrations whose scene is refused, and why.
    pub warnings: Vec<Warning>,
}

/// The design of further points for a fit of `data`, each a mean over as many rods as the measured ones.
///
/// # Errors
///
/// Why a scene at the measured concentration, or `model` of it, is refused.
pub fn design(
    fit: &Fit,
    scenes: &Scenes,
    data: &[Datum],
    rods: &Rods,
    model: &ModelOf<'_>,
    watch: &Watch<'_>,
) -> Result<Design, FitError> {
    let best = fit.values(&fit.best.place);
    let basis = Basis::new(fit.sides.len());
    let replicas = (fit.emulator.replicas() as u64).min(MOST_REPLICAS);
    let value = |node: &[f64]| values(&fit.ranges, &fit.sides, node);
    let places = places(scenes, &best, data)?;
    let reading = fit.best.causes[READING].trace() / data.iter().map(|datum| datum.u.powi(2)).sum::<f64>();
    let (places_of_box, weights) = weighted(fit);
    let mut found = Design::default();
    let mut columns: Vec<DVector<f64>> = Vec::new();
    for factor in CONCENTRATIONS {
        let (at, concentrations) = scenes.at_concentration(factor, &best)?;
        let of: Vec<Datum> =
            (places.iter()).filter(|place| factor == 1.0 || concentrations[place.set].is_some()).cloned().collect();
        if of.is_empty() {
            continue;
        }
        let model = |values: &[f64]| model(&at, &of, values);
        (watch.stage)(&format!("design at {factor} times the concentration"));
        (watch.planned)(replicas * basis.nodes.len() as u64);
        let emulator = match coefficients(&basis, &model, &value, 0..replicas, watch.done) {
            Ok(rows) => Emulator::new(&basis, &rows),
            Err(error) if factor != 1.0 => {
                found.warnings.push(Warning::NoDesign(factor, error));
                continue;
            }
            Err(error) => return Err(error.into()),
        };
        let of_time = emulator.time_variance(&fit.best.place);
        let of_replica = emulator.covariance_of_replica(&fit.best.place);
        let rows: Vec<_> = places_of_box.iter().map(|place| emulator.at(place)).collect();
        let scatter = rods.scatter(&of, &of_replica);
        for (k, place) in of.into_iter().enumerate() {
            columns.push(DVector::from_iterator(rows.len(), rows.iter().map(|row| row[k])));
            found.candidates.push(Candidate {
                concentration_per_cm3: concentrations[place.set],
                u: (reading * place.u.powi(2) + of_time[k] + scatter[(k, k)]).sqrt(),
                set: place.set,
                column: place.column,
                time: place.time,
                spread: f64::NAN,
                leaves: Vec::new(),
            });
        }
    }
    let parameters: Vec<_> = places_of_box.iter().map(|place| fit.values(place)).collect();
    let known = Known::new(&parameters, &columns, &weights);
    for (k, candidate) in found.candidates.iter_mut().enumerate() {
        candidate.spread = known.own[k].max(0.0).sqrt();
        candidate.leaves = deviations(&known.left(k, candidate.u.powi(2)));
    }
    found.steps = steps(&known, &found.candidates, data);
    Ok(found)
}

/// The points of each set and column that could be measured, with the uncertainties of the measured ones.
fn places(scenes: &Scenes, best: &[f64], data: &[Datum]) -> Result<Vec<Datum>, SceneError> {
    let mut all = Vec::new();
    let kinds = super::data::kinds(data);
    let times = TIMES.min(MOST_CANDIDATES / (kinds.len() * CONCENTRATIONS.len())).max(1);
    for (set, column) in kinds {
        let end = scenes.end(set, best)?;
        let here = || data.iter().filter(|datum| (datum.set, &datum.column) == (set, &column));
        let middle = |of: fn(&Datum) -> f64| {
            let mut all: Vec<f64> = here().map(of).collect();
            all.sort_by(f64::total_cmp);
            all[all.len() / 2]
        };
        all.extend((1..=times).map(|k| Datum {
            u_time: middle(|datum| datum.u_time),
            u: middle(|datum| datum.u),
            ..Datum::place(set, &column, end * k as f64 / times as f64)
        }));
    }
    Ok(all)
}

/// Places evenly over the last box and their weights, the likelihood normalised to a sum of 1.
fn weighted(fit: &Fit) -> (Vec<Vec<f64>>, Vec<f64>) {
    let parameters = fit.sides.len();
    let count = PLACES[parameters - 1];
    let coordinate = |k: usize| 2.0 * k as f64 / (count - 1) as f64 - 1.0;
    let places = grid(parameters, count).into_iter().map(|index| index.into_iter().map(coordinate).collect());
    let weighted = |place: Vec<f64>| {
        let weight = (-0.5 * (fit.best.surface.at(&place) - fit.best.chi_square)).exp();
        (weight > SMALL).then_some((place, weight))
    };
    let (places, weights): (Vec<_>, Vec<f64>) = places.filter_map(weighted).unzip();
    let all: f64 = weights.iter().sum();
    (places, weights.into_iter().map(|weight| weight / all).collect())
}

fn deviations(covariance: &DMatrix<f64>) -> Vec<f64> {
    covariance.diagonal().iter().map(|square| square.max(0.0).sqrt()).collect()
}

/// The uncertainties left by the measured points, by as many more of each kind, and by the best points in sequence.
pub(super) fn steps(known: &Known, candidates: &[Candidate], data: &[Datum]) -> Vec<Step> {
    let mut steps = vec![Step::of(Added::Nothing, known)];
    // Candidates come set by set at each concentration.
    let mut kinds: Vec<_> = candidates.iter().map(|one| (one.set, one.concentration_per_cm3)).collect();
    kinds.dedup();
    for (set, concentration_per_cm3) in kinds {
        let is_here = |one: &Candidate| (one.set, one.concentration_per_cm3) == (set, concentration_per_cm3);
        let here: Vec<usize> = (0..candidates.len()).filter(|k| is_here(&candidates[*k])).collect();
        let points = data.iter().filter(|datum| datum.set == set).count();
        let mut after = known.clone();
        for point in 0..points {
            let k = here[((2 * point + 1) * here.len() / (2 * points)).min(here.len() - 1)];
            after.measure(k, candidates[k].u.powi(2));
        }
        let added = Added::AsMany { set, points, concentration_per_cm3 };
        steps.push(Step::of(added, &after));
    }
    let mut left = known.clone();
    for _ in 0..CHOSEN {
        let best = left.best(|k| candidates[k].u.powi(2));
        let Some(k) = best else { break };
        let best = &candidates[k];
        left.measure(k, best.u.powi(2));
        let added = Added::Point {
            set: best.set,
            concentration_per_cm3: best.concentration_per_cm3,
            column: best.column.clone(),
            time: best.time,
        };
        steps.push(Step::of(added, &left));
    }
    steps
}

impl Step {
    fn of(added: Added, known: &Known) -> Self {
        let correlations = correlation_of(&known.parameters);
        let pairs = (0..correlations.nrows()).flat_map(|i| (0..i).map(move |j| (i, j)));
        let correlation = pairs.map(|pair| correlations[pair]).max_by(|a, b| a.abs().total_cmp(&b.abs()));
        let u = deviations(&known.parameters);
        Self { added, u, correlation }
    }
}
