//! The physical aspect ratio of a cylinder in place of the equivalent one of an ellipsoid.

use super::{Mistake, Setting, linear, right_map};
use crate::studies::bisect;
use shearbed::model::shape::{FORMULAS, Formula};

/// r_p for r_e: the physical aspect ratio of a cylinder in place of the equivalent one of an ellipsoid, by each formula
/// of `docs/src/reference/files.md`, in both directions: r_e = f(r_p) applied twice, and not at all.
pub(super) fn all() -> Vec<Mistake> {
    (FORMULAS.iter())
        .flat_map(|formula| {
            let who = formula.name;
            [
                valid(&format!("r_p for r_e (r_e taken as r_p of {who})"), |r| formula.value(r)),
                valid(&format!("r_p for r_e (r_p whose r_e by {who} was asked)"), |r| inverse(formula, r)),
            ]
        })
        .collect()
}

/// The correct motion with another aspect ratio, if that is valid.
fn valid(name: &str, ratio: impl Fn(f64) -> f64 + Send + Sync + 'static) -> Mistake {
    linear(name, move |setting, time| {
        let aspect_ratio = Some(ratio(setting.aspect_ratio)).filter(|ratio| ratio.is_finite() && *ratio > 0.0)?;
        right_map(&Setting { aspect_ratio, ..*setting }, time)
    })
}

/// r with f(r) = value between r = 2 and 200, where the formulas rise; NaN if there is no such r.
pub(super) fn inverse(formula: &Formula, value: f64) -> f64 {
    let [low, high] = [2.0, 200.0];
    let is_there = (formula.value(low)..=formula.value(high)).contains(&value);
    let [below, above] = bisect(low, high, 55, |r| formula.value(r) < value);
    if is_there { 0.5 * (below + above) } else { f64::NAN }
}
