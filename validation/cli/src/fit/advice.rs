//! What a fit says, in the words of the command: its flags beside the parameters, and what to change.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use shearbed_validation::methods::least_squares::Datum;
use shearbed_validation::methods::least_squares::emulator::Replica;
use shearbed_validation::serve::fit::contents::Contents;
use shearbed_validation::serve::fit::error::{FitError, HypothesisError, ParameterError, SceneError, Warning};
use shearbed_validation::serve::fit::scenes::{Scenes, Variant};
use shearbed_validation::serve::fit::{Hypothesis, Range};

/// What to look at where no value describes the points.
const CHECK: &str = "; check their columns, units and uncertainties, the scene's other keys, and whether the range of \
    --over holds the value";

/// Parses the argument of `--over`.
pub(super) fn range(text: &str) -> Result<Range, String> {
    // What follows the form of the argument.
    let of_set =
        |error: String| if error.ends_with("=FROM:TO") { error + " with the number of a --data" } else { error };
    Range::parse(text).map_err(of_set)
}

/// A parser of `--u-contains`.
pub(super) fn contents() -> impl TypedValueParser<Value = Contents> {
    let reading = PossibleValue::new("reading").help("The error of reading a point, independent of other points");
    let rods = PossibleValue::new("rods").help("Also the scatter of the rods, as a standard error over rods does");
    let parser = PossibleValuesParser::new([reading, rods]);
    parser.map(|word| if word == "rods" { Contents::Rods } else { Contents::Reading })
}

/// The model of `data` by `scenes`; an error names the flags.
pub(super) fn model(scenes: &Scenes, data: &[Datum], variant: Variant, values: &[f64]) -> Result<Replica, String> {
    scenes.model(data, variant, values).map_err(|error| of_scene(&error))
}

pub(super) fn of_scene(error: &SceneError) -> String {
    match error {
        SceneError::Whole(_) => format!("--over {error}"),
        SceneError::Parameters { scene, parameters, why } => {
            let over: String = parameters.iter().map(|parameter| format!(" {parameter}")).collect();
            format!("{scene}: --over{over}: {why}")
        }
        SceneError::Scene { .. } => error.to_string(),
    }
}

pub(super) fn of_fit(error: &FitError) -> String {
    let (before, after) = match error {
        FitError::Noise(..) => ("--over: ", "; give more --replicas, more rods in the scene, or one parameter less"),
        FitError::FewReplicas { .. } => ("--", ""),
        FitError::NotEnclosed { .. } => ("--over: ", "; give narrower ranges near these, and more --replicas"),
        FitError::Parameter(_, ParameterError::TwoMinima(_)) => {
            ("--over ", "; more --replicas tell noise from minima, and a narrower range leaves out impossible values")
        }
        FitError::Parameter(_, ParameterError::Undescribed(_)) => ("--over ", CHECK),
        FitError::Parameter(..) => ("--over ", ""),
        FitError::Undescribed(_) => ("", CHECK),
        FitError::Scene(error) => return of_scene(error),
        FitError::Model(_) => ("", ""),
    };
    format!("{before}{error}{after}")
}

pub(super) fn of_test(hypothesis: &Hypothesis, error: &HypothesisError) -> String {
    let why = match error {
        HypothesisError::NotFitted(key, fitted) => format!("{key} is not fitted; --over has {}", fitted.join(", ")),
        HypothesisError::OutOfRange(value, [from, to]) => {
            format!("{value} is outside the range of --over, {from} to {to}")
        }
        HypothesisError::NothingInCommon([a, b, c, d]) => {
            format!("the ranges of --over, {a} to {b} and {c} to {d}, have no value in common")
        }
    };
    format!("--test {}: {why}", hypothesis.text())
}

pub(super) fn of_warning(warning: &Warning) -> String {
    let (before, after) = match warning {
        Warning::Alike(..) => ("", "; --design shows what further points would do"),
        Warning::NotDescribed(_) => ("", CHECK),
        Warning::Replicas(..) => ("", ": more --replicas make the interval shorter"),
        Warning::Polynomials(..) => ("", ": a narrower --over range makes the interval shorter"),
        Warning::Independent { .. } => (
            "--rods is not given, so ",
            ". Give --rods N if u is the reading error alone, --rods N --u-contains rods if it contains the scatter of \
             N rods, and --u-contains reading if the points share no rods",
        ),
        Warning::ReadingAlone { with_rods, .. } => {
            return format!(
                "{warning}. If it contains that scatter, --u-contains rods gives about {with_rods}; --u-contains \
                 reading says that it does not"
            );
        }
        Warning::TooLarge(..) => ("--u-contains rods: ", ": is --rods right?"),
        Warning::TooSmall(..) => ("--u-contains rods: ", ": check --rods, or give --u-contains reading"),
        Warning::NoDesign(..) => ("--design: ", ""),
        Warning::Other(_) => ("", ""),
    };
    format!("{before}{warning}{after}")
}
