//! What the points' uncertainties contain: the error of reading alone, or the scatter of the measured rods too, which
//! all points of a curve share.

use super::digits::decimals;
use super::error::Warning;
use super::search::Fit;
use crate::methods::least_squares::Datum;
use crate::methods::least_squares::best::{Best, best, within};
use crate::methods::least_squares::likelihood::{RODS, Reading, Rods};
use serde::Serialize;

/// What the points' uncertainties contain.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Contents {
    /// The error of reading a point, independent of other points.
    Reading,
    /// Also the scatter of the rods, as a standard error over rods does.
    Rods,
}

/// The rods that were measured as the command says, `counts` in a replica of each set. Without a number the points
/// share no rods.
pub fn rods(measured: Option<u64>, contents: Option<Contents>, counts: &[f64]) -> Rods {
    match measured {
        None => Rods::none(counts.len()),
        Some(measured) => Rods {
            over_measured: counts.iter().map(|count| count / measured as f64).collect(),
            // The variance of a Gaussian sample.
            reading: match contents {
                Some(Contents::Rods) => Reading::Rest((2.0 / measured as f64).sqrt()),
                _ => Reading::Share(1.0),
            },
        },
    }
}

/// Ratios of standard uncertainties below which the answer does not depend on what u contains.
const ALIKE: f64 = 1.1;

/// A warning if the answer depends on what the points' uncertainties contain and the command does not say it, or if
/// they are too small for what it says. The arguments are those of [`rods`].
pub fn warning(
    fit: &Fit,
    data: &[Datum],
    measured: Option<u64>,
    contents: Option<Contents>,
    counts: &[f64],
) -> Option<Warning> {
    let other = |rods: &Rods| best(data, &fit.emulator, rods).filter(|other| differs(fit, other));
    let own = answer(fit, &fit.best);
    let u: f64 = data.iter().map(|datum| datum.u.powi(2)).sum();
    let times = (u / fit.best.causes[RODS].trace()).sqrt();
    match (measured, contents) {
        (None, None) => {
            let [likely, most] = within(data, &fit.emulator, &fit.best.place)?;
            let of_replica = fit.emulator.covariance_of_replica(&fit.best.place);
            if of_replica.trace() == 0.0 {
                // Nothing is drawn: rods do not scatter.
                return None;
            }
            let share = |rods: &Rods| 100.0 * rods.scatter(data, &of_replica).trace() / u;
            let contained = other(&most).map(|best| {
                format!(
                    "; if u contains that scatter, which by the residuals is {:.0} % of u² or up to {:.0} %: about {}",
                    share(&likely),
                    share(&most),
                    answer(fit, &best)
                )
            });
            let as_scene = Rods { over_measured: vec![1.0; counts.len()], ..Rods::none(0) };
            let beside = other(&as_scene).map(|best| {
                format!(
                    "; if u is the reading error alone, and as many rods as the scene has were measured: about {}",
                    answer(fit, &best)
                )
            });
            let others: String = [contained, beside].into_iter().flatten().collect();
            (!others.is_empty()).then_some(Warning::Independent { answer: own, others })
        }
        // A single rod does not scatter.
        (Some(rods), None) if times > 0.7 && times.is_finite() => {
            let other = other(&self::rods(measured, Some(Contents::Rods), counts))?;
            Some(Warning::ReadingAlone { times, rods, answer: own, with_rods: answer(fit, &other) })
        }
        (Some(rods), Some(Contents::Rods)) if times < 0.7 => Some(Warning::TooSmall(times, rods)),
        (Some(rods), Some(Contents::Rods)) if times > 1.5 => Some(Warning::TooLarge(times, rods)),
        _ => None,
    }
}

/// True if a standard uncertainty differs.
fn differs(fit: &Fit, other: &Best) -> bool {
    let [own, other] = [&fit.best, other].map(|best| best.covariance().diagonal().map(f64::sqrt));
    own.iter().zip(&other).any(|(own, other)| (own / other).max(other / own) > ALIKE)
}

/// Each parameter with half its 95 % interval by linear theory.
fn answer(fit: &Fit, best: &Best) -> String {
    let covariance = best.covariance();
    let one = |(axis, range): (usize, &super::Range)| {
        let half = 1.96 * covariance[(axis, axis)].sqrt() * fit.scale(axis);
        let digits = decimals(half.min(range.to - range.from));
        format!("{} = {:.digits$} ± {half:.digits$}", range.name(), fit.value(axis, best.place[axis]))
    };
    fit.ranges.iter().enumerate().map(one).collect::<Vec<_>>().join(", ")
}
