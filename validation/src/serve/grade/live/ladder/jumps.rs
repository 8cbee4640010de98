//! Judges every setting, not the finest alone: a method's error is a continuous function of its step.
//!
//! If a method follows the motion, its error falls by its order when the number of steps doubles. If an error falls by
//! far more, the numbers of steps between the two are bisected down to neighbours N and N + 1, or multiples of what
//! ends at each time. A method that is unstable with long steps, or misses the motion, becomes correct gradually,
//! over many N. Answers that are wrong at N and right at N + 1 do not come from a method.

use super::climb::End;
use super::{Rung, errors};
use crate::methods::integrators::Setting;
use crate::serve::grade::live::program::Asked;
use crate::serve::grade::order::{FAR, HIGHEST, between};
use std::f64::consts::FRAC_PI_2;

/// An error in rad of a method that follows the motion closely: at larger errors a correct method may lose the motion
/// from one number of steps to the next, as AB3 in angles does beside a pole.
const FOLLOWS: f64 = 1e-3;

/// For a program that chooses its steps: the largest ratio of an error to the errors of both neighbouring tolerances.
/// The error of a correct program is about proportional to its tolerance, which changes by ten.
const OUTLIER: f64 = 1000.0;

/// From this tolerance on a right program follows the motion; with larger ones its steps may pass over a flip.
const SHARP: f64 = 1e-6;

/// Judges every rung of a ladder whose last ones are within the tolerance; `unit` divides every number of steps.
pub(super) fn judged(rungs: &[Rung], tolerance: f64, unit: u64, ask: impl Fn(Setting) -> Result<Rung, Asked>) -> End {
    let order = falling_order(rungs, tolerance);
    let end = |found: Result<Option<String>, Asked>| {
        let end = found.map_or_else(End::without_answer, |words| words.map_or(End::Reached, End::Jumps));
        (end != End::Reached).then_some(end)
    };
    if let Some(end) = end(beside(rungs, tolerance, order, unit, &ask)) {
        return end;
    }
    for k in (0..rungs.len().saturating_sub(1)).rev() {
        // All coarser rungs are unstable: nothing else can be said of them.
        if !rungs[..=k].iter().any(|rung| rung.error().is_finite()) {
            return End::Reached;
        }
        // Between multiples of several steps a right method may pass from unstable to close. Then it is unstable with
        // fewer steps too.
        if unit > 1 && !rungs[..k].iter().any(|rung| rung.error() < FOLLOWS) {
            return End::Reached;
        }
        let found = match (rungs[k].setting, rungs[k + 1].setting) {
            (Setting::Steps(coarse), Setting::Steps(fine)) => {
                let foretold = Foretold::from(&rungs[k + 1..], fine, tolerance, order);
                if far(&rungs[k], foretold.at(coarse)) {
                    jump([&rungs[k], &rungs[k + 1]], [coarse, fine], &foretold, unit, &ask)
                } else {
                    Ok(None)
                }
            }
            _ => Ok(outlier(rungs, k, tolerance)),
        };
        if let Some(end) = end(found) {
            return end;
        }
    }
    End::Reached
}

/// The error that finer settings predict for coarser ones, by a power of the number of steps.
struct Foretold {
    steps: f64,
    error: f64,
    order: f64,
}

impl Foretold {
    /// The prediction from the next finer settings. As the first error may be small by chance, the second predicts it
    /// too.
    fn from(finer: &[Rung], steps: u64, tolerance: f64, order: f64) -> Self {
        let second = finer.get(1).and_then(|rung| {
            let ratio = rung.setting.steps().ok()? as f64 / steps as f64;
            Some(capped(rung) * ratio.powf(order))
        });
        Self { steps: steps as f64, error: capped(&finer[0]).max(second.unwrap_or(0.0)).max(tolerance), order }
    }

    fn at(&self, steps: u64) -> f64 {
        self.error * (self.steps / steps as f64).powf(self.order)
    }
}

/// A rung's error, at most a right angle, which also stands for an error that is not finite.
fn capped(rung: &Rung) -> f64 {
    match rung.error() {
        error if error.is_finite() => error.min(FRAC_PI_2),
        _ => FRAC_PI_2,
    }
}

fn far(rung: &Rung, foretold: f64) -> bool {
    capped(rung) > FAR * foretold
}

/// The median order between settings that follow the motion and are above the tolerance.
pub(super) fn falling_order(rungs: &[Rung], tolerance: f64) -> f64 {
    let follows = |(_, error): &(u64, f64)| *error > tolerance && *error < 0.1;
    let order =
        |pair: &[(u64, f64)]| Some(between(pair[0], pair[1])).filter(|order| pair.iter().all(follows) && *order > 0.5);
    let mut orders: Vec<_> = errors(rungs).windows(2).filter_map(order).collect();
    orders.sort_by(f64::total_cmp);
    orders.get(orders.len() / 2).copied().unwrap_or(HIGHEST)
}

/// Asks for one unit of steps more than the coarsest setting from which on all follow the motion: a ladder that doubles
/// asks for even numbers alone, and a program may lose the last of an odd number of steps.
fn beside(
    rungs: &[Rung],
    tolerance: f64,
    order: f64,
    unit: u64,
    ask: impl Fn(Setting) -> Result<Rung, Asked>,
) -> Result<Option<String>, Asked> {
    let follow = rungs.iter().rev().take_while(|rung| rung.error() < FOLLOWS).count();
    let finer = &rungs[rungs.len() - follow..];
    let Some(steps) = finer.first().and_then(|rung| rung.setting.steps().ok()) else {
        return Ok(None);
    };
    let foretold = match finer.get(1).and_then(|rung| rung.setting.steps().ok()) {
        Some(next) => Foretold::from(&finer[1..], next, tolerance, order).at(steps),
        None => tolerance,
    };
    let due = capped(&finer[0]).max(foretold);
    let error = capped(&ask(Setting::Steps(steps + unit))?);
    Ok((error > FAR * due).then(|| jumping([steps, steps + unit], [capped(&finer[0]), error])))
}

fn jumping([one, other]: [u64; 2], [error, other_error]: [f64; 2]) -> String {
    format!(
        "with {one} steps it is off by {error:.1e}, with {other} by {other_error:.1e}: a method's error does not jump \
         so between two numbers of steps"
    )
}

/// Bisects from a number of steps whose answer is far off to one whose answer is not, and says where the answers jump.
/// What was answered counts: the ends are not asked again, where a program might do better.
fn jump(
    ends: [&Rung; 2],
    [mut bad, mut good]: [u64; 2],
    foretold: &Foretold,
    unit: u64,
    ask: impl Fn(Setting) -> Result<Rung, Asked>,
) -> Result<Option<String>, Asked> {
    let [mut bad_error, mut good_error] = ends.map(capped);
    while good - bad > unit {
        let middle = bad + (good - bad) / unit / 2 * unit;
        let rung = ask(Setting::Steps(middle))?;
        if far(&rung, foretold.at(middle)) {
            (bad, bad_error) = (middle, capped(&rung))
        } else {
            (good, good_error) = (middle, capped(&rung))
        }
    }
    let jumps = good_error < FOLLOWS && bad_error > FAR * good_error.max(foretold.at(good));
    Ok(jumps.then(|| jumping([bad, good], [bad_error, good_error])))
}

/// Of a program that chooses its steps: an error far above those of both neighbouring tolerances, or of the next
/// smaller one where any right program follows the motion.
fn outlier(rungs: &[Rung], k: usize, tolerance: f64) -> Option<String> {
    let (own, finer) = (&rungs[k], &rungs[k + 1]);
    let above = |errors: f64| capped(own) > OUTLIER * errors.max(tolerance);
    let named = |rung: &Rung| format!("with {} by {:.1e}", rung.setting, capped(rung));
    let off = format!("with {} it is off by {:.1e}", own.setting, capped(own));
    if own.setting.tolerance().is_ok_and(|asked| asked <= SHARP) && above(10.0 * capped(finer)) {
        return Some(format!("{off}, {}: an error is about proportional to its tolerance", named(finer)));
    }
    let coarser = &rungs[k.checked_sub(1)?];
    above(capped(coarser).max(capped(finer))).then(|| format!("{off}, {} and {}", named(coarser), named(finer)))
}

#[cfg(test)]
mod tests;
