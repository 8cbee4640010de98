//! The results of a comparison of measured points with the model.

use super::bias::Bias;
use serde::Serialize;

/// A point with the model's value and every standard uncertainty of their difference.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Point {
    /// Name of the observable: x1, x2 or x3.
    pub observable: &'static str,
    /// Time t/T.
    pub t_over_t: f64,
    /// D, the measured value.
    pub measured: f64,
    /// S, the simulated value.
    pub simulated: f64,
    /// E = S − D.
    pub error: f64,
    /// u_D: reading uncertainty in y, that in x through the slope of S, and the experiment's number of rods.
    pub u_d: f64,
    /// u_num: replicas, time step, interpolation.
    pub u_num: f64,
    /// u_input: the experiment's conditions.
    pub u_input: f64,
    /// u_val = (u_D² + u_num² + u_input²)^½.
    pub u_val: f64,
}

/// Comparison of model and experiment under the conditions of one scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Comparison {
    /// Name of the scene.
    pub scene: String,
    /// All points.
    pub points: Vec<Point>,
    /// The mean of E.
    pub mean_error: f64,
    /// The root of the mean of E².
    pub rms_error: f64,
    /// The share of points with |E| ≤ 2 u_val.
    pub within_two_u_val: f64,
    /// FDS's bias and scatter; `None` for fewer than two points, or if a value is not positive.
    pub bias: Option<Bias>,
    /// True if the provenance states uncertainties of the experiment's conditions; else u_input is 0.
    pub inputs_stated: bool,
    /// χ² = Eᵀ V⁻¹ E with the covariance V of E.
    pub chi_square: f64,
    /// The probability of a larger χ² if the model were right.
    pub p: f64,
}

/// The fit of α to measured points.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct AlphaFit {
    /// The estimate.
    pub alpha: f64,
    /// Its standard error.
    pub se: f64,
    /// Number of points fitted.
    pub points: usize,
}
