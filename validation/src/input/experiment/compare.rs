//! The comparison of model and experiment in the terms of ASME V&V 20, with a goodness-of-fit test.

#[cfg(test)]
mod tests;

use super::bias::bias;
use super::comparison::{AlphaFit, Comparison, Point};
use super::covariance::{Covariance, Solver};
use super::model::{self, MeasuredAt, Model};
use super::provenance::INPUTS;
use super::{MeasuredCurve, OBSERVABLES};
use crate::input::scenes;
use nalgebra::{DMatrix, DVector, RowDVector};
use shearbed::Scene;
use statrs::distribution::{ChiSquared, ContinuousCDF};

type Change = fn(&mut Scene);

/// Number of runs of the model, and their random numbers.
#[derive(Clone, Copy, Debug)]
pub struct Runs {
    /// Number of independent replicas.
    pub replicas: u64,
    /// Seed of their random streams.
    pub seed: u64,
}

/// Compares measured curves of the scene named `scene` with replicas of that scene, altered by `change`.
pub fn compare(scene: &str, curves: &[MeasuredCurve], change: Change, runs: Runs) -> Result<Comparison, String> {
    let assessed = Assessed::new(scene, curves, change, runs)?;
    let (chi_square, p) = goodness_of_fit(&assessed.error, assessed.solver.as_ref());
    let points = assessed.points;
    let n = points.len() as f64;
    let mean = |value: &dyn Fn(&Point) -> f64| points.iter().map(value).sum::<f64>() / n;
    // The experiments' part of FDS's scatter: reading uncertainty and conditions, relative to the measured values.
    let sigma_e = mean(&|p| (p.u_d.powi(2) + p.u_input.powi(2)) / p.measured.powi(2)).sqrt();
    let pairs: Vec<_> = points.iter().map(|p| (p.simulated, p.measured)).collect();
    Ok(Comparison {
        scene: scene.to_owned(),
        mean_error: mean(&|p| p.error),
        rms_error: mean(&|p| p.error.powi(2)).sqrt(),
        within_two_u_val: mean(&|p| f64::from(u8::from(p.error.abs() <= 2.0 * p.u_val))),
        bias: bias(&pairs, sigma_e),
        inputs_stated: curves.iter().any(|curve| !curve.provenance.inputs.is_empty()),
        chi_square,
        p,
        points,
    })
}

/// χ² = Eᵀ V⁻¹ E, and the probability of a larger one. V is the full covariance: points share the model's replicas and,
/// if the same rods were measured, also those. NaN if there is no V⁻¹.
fn goodness_of_fit(error: &DVector<f64>, solver: Option<&Solver>) -> (f64, f64) {
    let chi_square = solver.map_or(f64::NAN, |v| v.chi_square(error));
    let law = ChiSquared::new(error.len() as f64);
    (chi_square, law.map_or(f64::NAN, |law| law.sf(chi_square)))
}

/// The best fit of α to curves of several scenes, by one step of weighted least squares from the scenes' own α.
/// `change` alters the model's runs without the estimate's knowledge.
pub fn alpha(curves: &[MeasuredCurve], change: Change, runs: Runs) -> Result<AlphaFit, String> {
    let (mut score, mut information, mut start) = (0.0, 0.0, f64::NAN);
    let mut names: Vec<_> = curves.iter().map(|curve| curve.scene).collect();
    names.sort_unstable();
    names.dedup();
    for (k, name) in names.into_iter().enumerate() {
        // Scenes are independent: each has its own random numbers.
        let runs = Runs { seed: runs.seed ^ k as u64, ..runs };
        let here: Vec<_> = curves.iter().filter(|curve| curve.scene == name).cloned().collect();
        start = built_in(name)?.interaction.map_or(f64::NAN, |interaction| interaction.alpha);
        let assessed = Assessed::new(name, &here, change, runs)?;
        let slope = assessed.slope(&here, |scene| Some(&mut scene.interaction.as_mut()?.alpha), 0.2, runs.replicas)?;
        let weighted = assessed.solver.as_ref().map(|v| v.solve(&slope));
        let weighted = weighted.ok_or("the covariance of the points is not positive")?;
        // D = S + slope·Δα, so that E = S − D is −slope·Δα.
        score -= weighted.dot(&assessed.error);
        information += weighted.dot(&slope);
    }
    Ok(AlphaFit {
        alpha: start + score / information,
        se: information.sqrt().recip(),
        points: curves.iter().map(|curve| curve.points.len()).sum(),
    })
}

fn built_in(name: &str) -> Result<Scene, String> {
    let scene = scenes::find(name).ok_or_else(|| format!("there is no scene {name}"))?;
    scene.scene().map_err(|error| error.to_string())
}

/// The errors E with their covariance.
struct Assessed {
    scene: Scene,
    points: Vec<Point>,
    error: DVector<f64>,
    solver: Option<Solver>,
}

impl Assessed {
    fn new(name: &str, curves: &[MeasuredCurve], change: Change, runs: Runs) -> Result<Self, String> {
        let Runs { replicas, seed } = runs;
        let mut scene = built_in(name)?;
        scene.ensemble.seed = seed;
        change(&mut scene);
        let places = places(curves, &scene)?;
        let model = model::run(&scene, &places, replicas, 1)?;
        let mut assessed = Self { error: DVector::zeros(places.len()), points: Vec::new(), solver: None, scene };
        // Shared causes give covariances: a time step or a wrong input moves all points together.
        let step = assessed.step_error(&model, &places, replicas)?;
        let inputs = assessed.input_errors(curves, replicas)?;
        let rods = rods(&model.spread, curves, assessed.scene.particles.count);
        let sampling: Vec<f64> = rods.column_iter().map(|column| column.norm_squared()).collect();
        let replicas_of_model = &model.spread / (replicas as f64).sqrt();
        let mut causes: Vec<RowDVector<f64>> = Vec::new();
        for rows in [&replicas_of_model, &rods] {
            causes.extend(rows.row_iter().map(|row| row.into_owned()));
        }
        causes.push(step.transpose());
        causes.extend(inputs.iter().map(|input| input.transpose()));
        let mut covariance = Covariance { own: DVector::zeros(places.len()), shared: DMatrix::from_rows(&causes) };
        for (k, measured) in curves.iter().flat_map(|curve| &curve.points).enumerate() {
            let reading = measured.u_y.powi(2) + model.time_variance[k];
            let interpolation = model.interpolation[k].powi(2);
            covariance.own[k] = reading + interpolation;
            let (s, d) = (model.value[k], measured.y);
            let of_replicas = replicas_of_model.column(k).norm_squared();
            let numerical = of_replicas + step[k].powi(2) + interpolation;
            let input: f64 = inputs.iter().map(|input| input[k].powi(2)).sum();
            assessed.error[k] = s - d;
            assessed.points.push(Point {
                observable: OBSERVABLES[places[k].channel],
                t_over_t: measured.x,
                measured: d,
                simulated: s,
                error: s - d,
                u_d: (reading + sampling[k]).sqrt(),
                u_num: numerical.sqrt(),
                u_input: input.sqrt(),
                u_val: f64::NAN,
            });
        }
        for (point, variance) in assessed.points.iter_mut().zip(covariance.variances().iter()) {
            point.u_val = variance.sqrt();
        }
        assessed.solver = covariance.solver();
        Ok(assessed)
    }

    /// The time step's error, S − S(Δt → 0) to first order, from a run with half the step; 0 for free rods, which take
    /// no steps.
    fn step_error(&self, model: &Model, places: &[MeasuredAt], replicas: u64) -> Result<DVector<f64>, String> {
        if self.scene.interaction.is_none() {
            return Ok(DVector::zeros(places.len()));
        }
        let half = model::run(&self.scene, places, replicas, 2)?;
        Ok(2.0 * (DVector::from_vec(model.value.clone()) - DVector::from_vec(half.value)))
    }

    /// The change of every point per standard deviation of each stated input.
    fn input_errors(&self, curves: &[MeasuredCurve], replicas: u64) -> Result<Vec<DVector<f64>>, String> {
        let mut errors = Vec::new();
        for (index, (_, value)) in INPUTS.iter().enumerate() {
            let stated = |curve: &MeasuredCurve| {
                let found = curve.provenance.inputs.iter().find(|(input, _)| *input == index);
                found.map_or(0.0, |(_, u)| *u)
            };
            let u: Vec<f64> = curves.iter().flat_map(|c| c.points.iter().map(move |_| stated(c))).collect();
            if u.iter().any(|u| *u > 0.0) {
                let slope = self.slope(curves, value, 0.1, replicas)?;
                errors.push(slope.component_mul(&DVector::from_vec(u)));
            }
        }
        Ok(errors)
    }

    /// dS/dvalue at every point, from runs with the value larger and smaller by `share`; 0 if the scene has no such
    /// value.
    fn slope(
        &self,
        curves: &[MeasuredCurve],
        value: impl Fn(&mut Scene) -> Option<&mut f64>,
        share: f64,
        replicas: u64,
    ) -> Result<DVector<f64>, String> {
        let mut middle = 0.0;
        let mut at = |share: f64| -> Result<DVector<f64>, String> {
            let mut scene = self.scene.clone();
            if let Some(value) = value(&mut scene) {
                middle = *value;
                *value *= 1.0 + share;
            }
            let model = model::run(&scene, &places(curves, &scene)?, replicas, 1)?;
            Ok(DVector::from_vec(model.value))
        };
        let difference = at(share)? - at(-share)?;
        Ok(match middle {
            0.0 => DVector::zeros(difference.len()),
            middle => difference / (2.0 * share * middle),
        })
    }
}

/// The points' times in periods of this scene: a time in seconds or strain is a different t/T if r_e is different.
fn places(curves: &[MeasuredCurve], scene: &Scene) -> Result<Vec<MeasuredAt>, String> {
    let mut places = Vec::new();
    for curve in curves {
        let quantity = curve.provenance.x.quantity;
        let nominal = quantity.per_period(built_in(curve.scene)?.particles.aspect_ratio);
        let scale = nominal / quantity.per_period(scene.particles.aspect_ratio);
        places.extend(curve.points.iter().map(|point| MeasuredAt {
            turns: point.x * scale,
            u_turns: point.u_x * scale,
            channel: curve.channel,
        }));
    }
    Ok(places)
}

/// The scatter of a mean over the experiment's rods, scaled from that over the scene's rods; 0 if their number is
/// unknown. Curves of a scene are of the same rods.
fn rods(spread: &DMatrix<f64>, curves: &[MeasuredCurve], count: usize) -> DMatrix<f64> {
    let factors = curves.iter().flat_map(|curve| {
        let factor = curve.provenance.rods.map_or(0.0, |rods| (count as f64 / rods).sqrt());
        curve.points.iter().map(move |_| factor)
    });
    let mut scaled = spread.clone();
    for (mut column, factor) in scaled.column_iter_mut().zip(factors) {
        column *= factor;
    }
    scaled
}
