//! Why there is no fit, and reasons to doubt one. They name parameters and say nothing of how a program was asked.

use statrs::distribution::{ChiSquared, ContinuousCDF};
use thiserror::Error;

/// A scene that cannot be fitted, or not with these values.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum SceneError {
    /// The key of a whole number.
    #[error("{0}: a whole number cannot be fitted; `shearbed sweep` runs several values of it")]
    Whole(String),
    /// A parameter, or values of several, with which a scene is refused.
    #[error("{scene}: {}: {why}", parameters.join(" "))]
    Parameters {
        /// The scene's name or file.
        scene: String,
        /// Labels, with `=` and the value where a value is refused.
        parameters: Vec<String>,
        /// The reason.
        why: String,
    },
    /// A scene that is refused with any values.
    #[error("{scene}: {why}")]
    Scene {
        /// Its name or file.
        scene: String,
        /// The reason.
        why: String,
    },
}

/// Points that no value of the parameters describes.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[error(
    "no value{} describes the {points} points: χ² is {chi_square:.1} for {} degrees of freedom",
    // A search in several parameters may miss a narrow valley.
    if *parameters > 1 { " that the search found" } else { "" },
    points.saturating_sub(*parameters)
)]
pub struct Undescribed {
    points: usize,
    parameters: usize,
    chi_square: f64,
}

impl Undescribed {
    /// Points with a smaller p-value are described by no value.
    const IMPOSSIBLE: f64 = 1e-9;

    /// The error if the least `chi_square` is too large for any value to describe the points.
    pub(super) fn check(chi_square: f64, points: usize, parameters: usize) -> Option<Self> {
        let law = ChiSquared::new(points.saturating_sub(parameters) as f64).ok()?;
        (law.sf(chi_square) < Self::IMPOSSIBLE).then_some(Self { points, parameters, chi_square })
    }
}

/// What is wrong with the search along a parameter.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ParameterError {
    /// No point depends on it.
    #[error("the points say nothing about it between {from} and {to}")]
    Undetermined {
        /// The least value of its range.
        from: f64,
        /// The largest one.
        to: f64,
    },
    /// Its 95 % interval has gaps.
    #[error(
        "χ² has several minima in this range, as low as the best or nearly: {}; give a narrower one without \
         impossible values",
        .0.iter().map(|(from, to)| format!("{from:.4} to {to:.4}")).collect::<Vec<_>>().join(", ")
    )]
    SeveralMinima(Vec<(f64, f64)>),
    /// Its profile jumps at an end of an interval.
    #[error(
        "χ² jumps along it where the other parameters change to another minimum, so that its intervals have no end \
         there; a narrower range, or one parameter less, may do"
    )]
    Jumps,
    /// The polynomials differ from the model at the best value.
    #[error(
        "at the best values, {value:.4} for it, the model has χ² = {chi_square:.1} where the polynomials between its \
         runs have {emulated:.1}, so they do not follow it over this range; give a narrower one"
    )]
    NotFollowed {
        /// The best value.
        value: f64,
        /// χ² of the model.
        chi_square: f64,
        /// χ² of the polynomials.
        emulated: f64,
    },
    /// Another value, and the best one, each with its χ².
    #[error("χ² has minima at {:.4} (χ² = {:.1}) and {:.4} (χ² = {:.1})", .0[0].0, .0[0].1, .0[1].0, .0[1].1)]
    TwoMinima([(f64, f64); 2]),
    /// Neither of two minima describes the points.
    #[error(transparent)]
    Undescribed(#[from] Undescribed),
}

/// Why there is no fit.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum FitError {
    /// The largest share of the points' apparent information that is noise, and the number of replicas.
    #[error(
        "{:.0} % of the apparent information in the points is noise of the model with {replicas} replicas at each \
            value",
        100.0 * .0, replicas = .1
    )]
    Noise(f64, u64),
    /// Fewer replicas than the covariance of the points needs.
    #[error(
        "replicas: {replicas} are too few for the covariance of {points} points; give {} or more",
        (4 * *points as u64).max(2 * replicas)
    )]
    FewReplicas {
        /// Their largest number.
        replicas: u64,
        /// The number of points.
        points: usize,
    },
    /// The best values may lie outside the last box.
    #[error("the search did not enclose the best values in {boxes} boxes; the last found {}", .best.join(", "))]
    NotEnclosed {
        /// The number of boxes.
        boxes: u64,
        /// The best values in the last one, as `alpha = 0.9969`.
        best: Vec<String>,
    },
    /// A parameter by its label.
    #[error("{0}: {1}")]
    Parameter(String, ParameterError),
    /// No value describes the points.
    #[error(transparent)]
    Undescribed(#[from] Undescribed),
    /// A scene is refused.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A run of the model fails, or the points have no covariance.
    #[error("{0}")]
    Model(String),
}

impl From<String> for FitError {
    fn from(error: String) -> Self {
        Self::Model(error)
    }
}

impl From<FitError> for String {
    fn from(error: FitError) -> Self {
        error.to_string()
    }
}

impl From<SceneError> for String {
    fn from(error: SceneError) -> Self {
        error.to_string()
    }
}

/// A hypothesis that cannot be tested.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum HypothesisError {
    /// Its key is not among the fitted ones.
    #[error("{} is not fitted; it must be one of {}", .0, .1.join(", "))]
    NotFitted(String, Vec<String>),
    /// A value, and the ends of its range.
    #[error("{} is outside the range, {} to {}", .0, .1[0], .1[1])]
    OutOfRange(f64, [f64; 2]),
    /// The ends of two ranges.
    #[error("the ranges {} to {} and {} to {} have no value in common", .0[0], .0[1], .0[2], .0[3])]
    NothingInCommon([f64; 4]),
}

/// A reason to doubt a fit.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum Warning {
    /// Two parameters, and their correlation.
    #[error("{} and {}: these points hardly tell them apart (correlation {:.3})", .0[0], .0[1], .1)]
    Alike([String; 2], f64),
    /// The p-value of points that the model does not describe.
    #[error(
        "p = {0}: no value describes these points, or their uncertainties are too small; the intervals say nothing then"
    )]
    NotDescribed(String),
    /// The share of the replicas' noise in a parameter's variance, and the name of that cause.
    #[error("{:.0} % of a parameter's variance is the model's own error ({})", 100.0 * .0, .1)]
    Replicas(f64, &'static str),
    /// The share of the polynomials' error.
    #[error("{:.0} % of a parameter's variance is the model's own error ({})", 100.0 * .0, .1)]
    Polynomials(f64, &'static str),
    /// The number of measured rods is not known, and matters.
    #[error(
        "the points count as independent: {answer} (95 %). The scatter of measured rods moves all points of a curve \
         together{others}"
    )]
    Independent {
        /// The parameters with their intervals.
        answer: String,
        /// The same if the points share rods.
        others: String,
    },
    /// It is not known what u contains, and matters.
    #[error(
        "u is {times:.1} times the scatter of {rods} rods, but counts as the error of reading alone: {answer} (95 %)"
    )]
    ReadingAlone {
        /// u over that scatter.
        times: f64,
        /// The number of measured rods.
        rods: u64,
        /// The parameters with their intervals.
        answer: String,
        /// The same if u contains the scatter.
        with_rods: String,
    },
    /// u over the scatter of this number of rods, which it cannot contain.
    #[error("u is only {0:.2} times the scatter of {1} rods, and cannot contain it")]
    TooSmall(f64, u64),
    /// u over the scatter of this number of rods, which is little of it.
    #[error("u is {0:.1} times the scatter of {1} rods, so most of it counts as reading error")]
    TooLarge(f64, u64),
    /// A concentration, in multiples of the scene's, at which no points can be designed, and why.
    #[error("no points of {0} times the concentration: {1}")]
    NoDesign(f64, String),
    /// Any other.
    #[error("{0}")]
    Other(String),
}
