//! Points that no value of the parameters describes.

use statrs::distribution::{ChiSquared, ContinuousCDF};

/// Points with a smaller p-value are described by no value.
const IMPOSSIBLE: f64 = 1e-9;

/// What to look at then.
pub const CHECK: &str = "check their columns, units and uncertainties, the scene's other keys, and whether the range \
    of --over holds the value";

/// The probability of a larger χ² if the model were right.
fn p_value(chi_square: f64, points: usize, parameters: usize) -> f64 {
    ChiSquared::new(points.saturating_sub(parameters) as f64).map_or(f64::NAN, |law| law.sf(chi_square))
}

/// A sentence if the least `chi_square` is too large for any value to describe the points.
pub fn undescribed(chi_square: f64, points: usize, parameters: usize) -> Option<String> {
    let impossible = p_value(chi_square, points, parameters) < IMPOSSIBLE;
    impossible.then(|| {
        let freedom = points.saturating_sub(parameters);
        format!(
            "no value describes the {points} points: χ² is {chi_square:.1} for {freedom} degrees of freedom; {CHECK}"
        )
    })
}
