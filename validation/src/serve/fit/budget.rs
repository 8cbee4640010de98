//! The causes of an estimate's uncertainty, and the shifts by a finer or larger model (JCGM 100, the "GUM").

use super::search::{Fit, Watch};
use crate::methods::least_squares::Datum;
use crate::methods::least_squares::best::SCARCE;
use crate::methods::least_squares::emulator::Model;
use crate::methods::least_squares::likelihood::{CAUSES, REPLICAS};
use nalgebra::{DMatrix, DVector};
use serde::{Serialize, Serializer};

/// One line of the budget.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Part {
    /// The cause of the uncertainty.
    pub source: &'static str,
    /// One standard uncertainty of each parameter, in the parameter's unit.
    pub u: Vec<f64>,
}

/// How another model would move the estimates at the same points.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Shift {
    /// How the model is changed.
    pub change: &'static str,
    /// The change of each estimate, in the parameter's unit.
    pub shift: Vec<f64>,
    /// The standard error of each change.
    pub se: Vec<f64>,
}

/// The uncertainty budget of a fit: one part for each cause in the covariance of the points, then their total.
pub fn parts(fit: &Fit) -> Vec<Part> {
    let causes = CAUSES.iter().chain([&"covariance of few replicas"]);
    let own = causes.zip(&fit.best.spread).map(|(source, spread)| Part { source, u: deviations(fit, spread) });
    own.chain([Part { source: "all of these", u: deviations(fit, &fit.best.covariance()) }]).collect()
}

/// The standard deviations by a covariance on the box's scale, in the parameters' units.
fn deviations(fit: &Fit, covariance: &DMatrix<f64>) -> Vec<f64> {
    let variances = covariance.diagonal();
    (0..variances.len()).map(|axis| variances[axis].max(0.0).sqrt() * fit.scale(axis)).collect()
}

/// The largest number of replicas from which a shift is measured.
const MOST_REPLICAS: u64 = 200;

/// The change of the estimates, to first order, if the model were `changed` instead of `own`: from pairs of replicas at
/// the best values. Its standard error has two causes: the scatter over the pairs, and the noise of the covariance,
/// which counts as far as the change is one that no parameter can make.
pub fn shift(
    fit: &Fit,
    change: &'static str,
    own: &Model<'_>,
    changed: &Model<'_>,
    watch: &Watch<'_>,
) -> Result<Shift, String> {
    let values = fit.values(&fit.best.place);
    let (own, changed) = (own(&values)?, changed(&values)?);
    let replicas = (fit.emulator.behind_covariance() as u64).min(MOST_REPLICAS);
    (watch.stage)(&format!("shift by {change}"));
    let differences: Vec<DVector<f64>> = watch.replicas(replicas, |replica| {
        let (before, after) = (own.run(replica)?, changed.run(replica)?);
        let difference = before.iter().zip(&after).map(|(before, after)| after[0] - before[0]);
        Ok(DVector::from_iterator(before.len(), difference))
    })?;
    let n = differences.len() as f64;
    let away = differences.iter().sum::<DVector<f64>>() / n;
    // The points are fixed: where the model rises, the estimate must fall.
    let mean = -&fit.best.influence * &away;
    let off = |one: &DVector<f64>| (&fit.best.influence * (one - &away)).map(|d| d * d);
    let square: DVector<f64> = differences.iter().map(off).sum();
    let scarce = fit.best.spread[SCARCE].diagonal() * (0.5 * per_freedom(fit, &away));
    let scaled = |vector: &DVector<f64>| (0..vector.len()).map(|axis| vector[axis] * fit.scale(axis)).collect();
    let se = (square / (n * (n - 1.0)) + scarce).map(f64::sqrt);
    Ok(Shift { change, shift: scaled(&mean), se: scaled(&se) })
}

/// χ² of points that are `away` from the model, at the best parameters, per degree of freedom: dᵀV⁻¹d less
/// (Ad)ᵀ(AVAᵀ)⁻¹Ad with the influence A of the points.
fn per_freedom(fit: &Fit, away: &DVector<f64>) -> f64 {
    let covariance: DMatrix<f64> = fit.best.causes.iter().sum();
    let influence = &fit.best.influence;
    let moved = influence * away;
    let fitted = influence * &covariance * influence.transpose();
    let squares = [(covariance, away), (fitted, &moved)]
        .map(|(covariance, d)| covariance.cholesky().map_or(0.0, |covariance| d.dot(&covariance.solve(d))));
    (squares[0] - squares[1]).max(0.0) / (away.len() - moved.len()).max(1) as f64
}

/// The residual of each point of `data` at the best values.
pub fn residuals(fit: &Fit, data: &[Datum]) -> Vec<Residual> {
    let simulated = fit.emulator.at(&fit.best.place);
    let one = |(k, datum): (usize, &Datum)| {
        let variance: f64 = fit.best.causes.iter().map(|cause| cause[(k, k)]).sum();
        residual(datum, simulated[k], variance.sqrt())
    };
    data.iter().enumerate().map(one).collect()
}

/// The residual of a point beside a model's value, with its standard uncertainty.
pub(super) fn residual(datum: &Datum, simulated: f64, u: f64) -> Residual {
    let Datum { set, time, value: measured, .. } = *datum;
    Residual { set, column: datum.column.clone(), time, measured, simulated, residual: measured - simulated, u }
}

/// The standard deviation of each estimate over seeds of the model: its replicas' noise, and half of what their number
/// adds to the covariance; the other half corrects one that is too small. A wrong covariance moves estimates in
/// proportion to the points' distance from the best model, whose χ² per degree of freedom is `per_freedom`.
pub fn another_seed(fit: &Fit, per_freedom: f64) -> Vec<f64> {
    let spread = &fit.best.spread;
    deviations(fit, &(&spread[REPLICAS] + &spread[SCARCE] * (0.5 * per_freedom)))
}

/// Writes the index of a data set as the messages count, from 1.
pub(super) fn from_one<S: Serializer>(set: &usize, serializer: S) -> Result<S::Ok, S::Error> {
    (set + 1).serialize(serializer)
}

/// A measured point D and the best model S at its time.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Residual {
    /// The data set, counted from 0; files count from 1.
    #[serde(serialize_with = "from_one")]
    pub set: usize,
    /// The column's name, such as `x1`.
    pub column: String,
    /// Time of the point, in the unit of the file.
    pub time: f64,
    /// D.
    pub measured: f64,
    /// S.
    pub simulated: f64,
    /// D − S.
    pub residual: f64,
    /// One standard uncertainty of D − S.
    pub u: f64,
}
