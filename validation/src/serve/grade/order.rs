//! The order with which errors fall, compared with a claimed order.
//!
//! Orders come from neighbours of a ladder with more and more steps, from where the method follows the motion down to
//! round-off: a hundredth of the tolerance, which allows for 10 ε^(4/5) per radian, or the first error below the
//! tolerance that no longer falls. In that range a correct method's order wanders (rods or error terms take turns as
//! the largest) and approaches the claimed one from either side, or a higher one if a problem has no such error term. A
//! wrong coefficient removes whole orders, and the remaining order settles. So an order is refuted by two consecutive
//! pairs that agree and are nearly a whole order lower, or by four that are far lower on average and each below the
//! claim, and by nothing else. `examples/graded_integrators` tests this with several hundred integrators.

use super::{Graded, Verdict};
use crate::serve::problems::{Kind, LoadedProblem};
use crate::studies::work_precision::order::ORDER_TOLERANCE;
use serde::Serialize;

/// A whole order, less what may be missing from it before it settles.
const WHOLE: f64 = 0.8;

/// The error in rad above which a method does not follow the motion yet.
const FOLLOWS: f64 = 0.1;

/// The share of a problem's own tolerance below which differences of errors are round-off. Between that and the
/// tolerance, a correct code may have reached its round-off.
pub(super) const ROUND_OFF: f64 = 0.01;

/// Errors that no longer fall and are below so many tolerances may be rounding.
const ROUGHLY: f64 = 4.0;

/// Errors that fall with a higher order than this are the method's, not round-off.
const NO_ROUND_OFF: f64 = 1.5;

/// The error in rad below which a method follows the motion closely.
const CLOSE: f64 = 0.01;

/// Number of consecutive pairs that may refute an order though they do not agree.
const WANDERING: usize = 4;

/// Number of pairs after these that may show the order all the same.
const SHOWING: usize = 3;

/// The orders that they must lack on average: more than a right method of order 7 does on its way.
const LOST: f64 = 1.5;

/// Errors that wander and fall by less than this on average are rounding: no wrong method has half an order.
const ROUNDING: f64 = 0.5;

/// The evidence of a ladder about a claimed order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Order {
    /// A pair, or the mean of the last few, has the claimed order.
    Seen,
    /// Lower by whole orders: the method is not the claimed one.
    Lower,
    /// Higher by whole orders, settled: the claim is too low, or the problem lacks the error term.
    Higher,
    /// Too few pairs above round-off, or orders that still wander.
    Unclear,
}

/// The orders of a ladder, from coarse to fine, for pairs above round-off that follow the motion.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Orders {
    /// The order between each two neighbours; none if an error is 0 or not finite.
    pub all: Vec<Option<f64>>,
    /// The usable orders, each with the finer error of its pair.
    usable: Vec<(f64, f64)>,
    /// The problem's own tolerance.
    tolerance: f64,
    /// True if finer steps would show only round-off.
    pub ended: bool,
}

/// The order with which an error falls from one number of steps to another.
pub(super) fn between((coarse, error): (u64, f64), (fine, finer): (u64, f64)) -> f64 {
    (error / finer).ln() / (fine as f64 / coarse as f64).ln()
}

/// The orders of `errors` (steps, error) from coarse to fine, for a problem with this tolerance of its own, and with
/// the one that passes, which may be larger: below it a code of few digits may have reached its round-off.
pub fn orders(errors: &[(u64, f64)], [tolerance, allowed]: [f64; 2]) -> Orders {
    let order = |pair: &[(u64, f64)]| Some(between(pair[0], pair[1])).filter(|order| order.is_finite());
    let all: Vec<_> = errors.windows(2).map(order).collect();
    let mut found = Orders { all, tolerance, ..Orders::default() };
    for (pair, order) in errors.windows(2).zip(&found.all) {
        let (coarse, fine) = (pair[0].1, pair[1].1);
        if coarse <= ROUND_OFF * tolerance || fine <= ROUND_OFF * tolerance {
            found.ended = true;
            break;
        }
        match order {
            // The error has stopped falling, and the pair before has reached round-off too.
            Some(order) if coarse <= ROUGHLY * allowed && *order < 0.5 => {
                found.usable.pop();
                found.ended = true;
                break;
            }
            Some(order) if coarse < FOLLOWS => found.usable.push((*order, fine)),
            _ => found.usable.clear(),
        }
    }
    found
}

impl Orders {
    /// The observed order with its sign: the last usable one, or the one before if that is nearer to the claimed order.
    pub fn observed(&self, claimed: Option<f64>) -> Option<f64> {
        let last = self.usable.iter().rev().take(2).map(|(order, _)| *order);
        match claimed {
            None => self.usable.last().map(|(order, _)| *order),
            Some(claimed) => last.min_by(|a, b| (a - claimed).abs().total_cmp(&(b - claimed).abs())),
        }
    }

    /// The whole order of the last usable pair and the finer error of it, or of the pair before, as round-off may have
    /// a part in the last; none if neither order is near a whole one.
    pub fn whole(&self) -> Option<(u32, f64)> {
        let near = |(order, error): &(f64, f64)| {
            let whole = order.round();
            (whole >= 1.0 && (order - whole).abs() < ORDER_TOLERANCE).then_some((whole as u32, *error))
        };
        self.usable.iter().rev().take(2).find_map(near)
    }

    /// The evidence about a claimed order.
    pub fn judged(&self, claimed: f64) -> Order {
        let agree = |a: (f64, f64), b: (f64, f64)| (a.0 - b.0).abs() < ORDER_TOLERANCE;
        if let [.., before, newest] = self.certain()
            && agree(*before, *newest)
            && before.0.max(newest.0) <= claimed - WHOLE
        {
            return Order::Lower;
        }
        // A last answer that is right by chance, or copied, does not take back what those before it show.
        let shown = |pairs: &[(f64, f64)]| Self::proves_lower(pairs, claimed);
        let mean = |pairs: &[(f64, f64)]| pairs.iter().map(|pair| pair.0).sum::<f64>() / pairs.len() as f64;
        let wander = |(k, pairs): (usize, &[(f64, f64)])| {
            let none = pairs.iter().all(|pair| pair.0 < claimed - ORDER_TOLERANCE);
            // A method may wander before its order shows, which one answer by chance does not.
            let after = &self.certain()[k + WANDERING..];
            let shows = after.len() >= SHOWING && mean(after) >= claimed - WHOLE;
            pairs[0].1 < CLOSE && (ROUNDING..=claimed - LOST).contains(&mean(pairs)) && none && !shows
        };
        if self.certain().windows(3).any(shown) || self.certain().windows(WANDERING).enumerate().any(wander) {
            return Order::Lower;
        }
        if let [.., before, newest] = self.usable[..]
            && agree(before, newest)
            && before.0.min(newest.0) >= claimed + WHOLE
        {
            return Order::Higher;
        }
        // Where orders wander, the mean over the last few pairs averages out the oscillations.
        let last: Vec<f64> = self.usable.iter().rev().take(4).map(|(order, _)| *order).collect();
        let falling = last.iter().take_while(|order| **order > 0.0).count();
        let means = (1..=falling).map(|few| last[..few].iter().sum::<f64>() / few as f64);
        let claimed_one = |order: f64| (order - claimed).abs() < ORDER_TOLERANCE;
        let seen = means.chain(last.get(1).copied()).any(claimed_one);
        // Above rounding that the last errors show.
        let rounding = last.iter().sum::<f64>() < ROUNDING * WANDERING as f64;
        let before = || self.usable.windows(WANDERING).any(|pairs| pairs.iter().all(|pair| claimed_one(pair.0)));
        if seen || rounding && before() { Order::Seen } else { Order::Unclear }
    }

    /// The pairs that are certainly above round-off: above the problem's own tolerance, or falling fast.
    fn certain(&self) -> &[(f64, f64)] {
        let certain = |(order, error): &&(f64, f64)| *error > self.tolerance || *order > NO_ROUND_OFF;
        &self.usable[..self.usable.iter().take_while(certain).count()]
    }

    /// True if three pairs in a row prove the order too low, whatever finer steps would show.
    pub fn refuted_early(&self, claimed: f64) -> bool {
        self.certain().last_chunk::<3>().is_some_and(|last| Self::proves_lower(last, claimed))
    }

    /// True if these pairs agree, lie whole orders below the claim, and end where the method follows the motion
    /// closely.
    fn proves_lower(pairs: &[(f64, f64)], claimed: f64) -> bool {
        let orders = || pairs.iter().map(|(order, _)| *order);
        let (least, most) = (orders().fold(f64::INFINITY, f64::min), orders().fold(f64::NEG_INFINITY, f64::max));
        most <= claimed - WHOLE && most - least < ORDER_TOLERANCE && pairs.last().is_some_and(|last| last.1 < CLOSE)
    }
}

/// An error is far off if it exceeds the prediction of other settings by this factor: between two settings that is five
/// orders more than the method's, and between neighbours, whose steps differ by an eighth at most, an order of thirty.
pub(super) const FAR: f64 = 32.0;

/// The order assumed where errors do not show one: that of the highest methods in use.
pub(super) const HIGHEST: f64 = 8.0;

/// A message about an answer that is off by far where one with fewer steps follows the motion closely; none if there is
/// no such answer. What its error should be is foretold by a power law through two others, of which only one may be
/// small by chance: then either this one is not larger than that before it, or it is as large as foretold.
pub fn outlier(errors: &[(u64, f64)], tolerance: f64) -> Option<String> {
    let steps = |k: usize| errors[k].0 as f64;
    let size = |k: usize| if errors[k].1.is_finite() { errors[k].1 } else { f64::INFINITY };
    let law = |[a, b]: [usize; 2], at: usize| {
        let order = between((errors[a].0, size(a)), (errors[b].0, size(b))).clamp(0.0, HIGHEST);
        size(a) * (steps(a) / steps(at)).powf(if order.is_nan() { 0.0 } else { order })
    };
    let foretold = |k: usize| match (k.checked_sub(2), k + 1 < errors.len()) {
        (Some(coarser), true) if size(coarser).is_finite() => law([coarser, k + 1], k),
        (Some(coarser), false) if size(coarser).is_finite() => match coarser.checked_sub(1) {
            Some(first) if size(first).is_finite() => law([first, coarser], k),
            _ => size(coarser),
        },
        (Some(_), _) => size(k - 1),
        (None, true) => size(k + 1) * (steps(k + 1) / steps(k)).powf(HIGHEST),
        (None, false) => f64::INFINITY,
    };
    let is_outlier = |k: &usize| {
        let (own, before) = (size(*k), size(k - 1));
        before < CLOSE && own > 2.0 * before && own > FAR * foretold(*k).max(tolerance)
    };
    let k = (1..errors.len()).find(is_outlier)?;
    let said = |k: usize| format!("{:.1e} with {}", errors[k].1, errors[k].0);
    let after = if k + 1 < errors.len() { format!(" and {}", said(k + 1)) } else { String::new() };
    Some(format!("off by {} steps, by {}{after}: no method has such errors", said(k), said(k - 1)))
}

/// An observed order below this is none: the error does not depend on the step.
const NO_ORDER: f64 = 0.2;

/// A message about an order that is not the claimed one.
pub fn other(graded: &Graded, claimed: f64) -> String {
    let said = format!("observed order {} where {claimed} is claimed", graded.order_text());
    match (graded.observed_order, graded.error) {
        (Some(order), Some(error)) if order.abs() < NO_ORDER => format!(
            "{said}: the error stays at {error:.1e} whatever the step, so the equation is wrong, or the step (do its \
             weights sum to 1?), or digits are too few"
        ),
        _ => said,
    }
}

/// Decides on orders higher than the claimed one: if no problem shows the claimed order, the claim is wrong; otherwise
/// these problems have no error term of that order.
pub fn settle(problems: &[LoadedProblem], graded: &mut [Graded], claimed: Option<f64>) {
    let Some(claimed) = claimed else {
        return;
    };
    let shown = graded.iter().any(|graded| graded.order_found == Some(Order::Seen));
    for graded in graded.iter_mut() {
        if graded.order_found != Some(Order::Higher) || graded.verdict != Verdict::Pass {
            continue;
        }
        let of = problems.iter().find(|loaded| loaded.problem.name == graded.name);
        if shown || of.is_some_and(in_the_shear_plane) {
            let observed = graded.order_text();
            graded.note = Some(format!("observed order {observed}, higher than the claimed {claimed}: no fault"));
        } else {
            graded.verdict = Verdict::Fail;
            graded.note = Some(other(graded, claimed));
        }
    }
}

/// An observed order above this one needs no claim to be believed.
const LOW: f64 = 2.5;

const LOW_ORDER: &str = "no order was claimed, so a lower one than the method's passes too; observed";

/// A sentence that lists where a claimed order was seen and where it is unclear, or without a claim, where a low one
/// passes; none of formulas alone, which have no steps.
pub fn remark(graded: &[Graded], claimed: Option<f64>) -> Option<String> {
    let Some(claimed) = claimed else {
        let passing = graded.iter().filter(|graded| graded.verdict == Verdict::Pass);
        let low = passing.filter(|graded| graded.observed_order.is_some_and(|order| order < LOW));
        let low: Vec<_> = low.map(|graded| format!("{} ({})", graded.name, graded.order_text())).collect();
        return (!low.is_empty()).then(|| format!("{LOW_ORDER}: {}", low.join(", ")));
    };
    let found =
        |order: Order| -> Vec<&Graded> { graded.iter().filter(|graded| graded.order_found == Some(order)).collect() };
    let seen = found(Order::Seen);
    // Of a wrong answer the verdict says why.
    let unclear = found(Order::Unclear).into_iter().filter(|graded| graded.verdict == Verdict::Pass);
    let unclear: Vec<&str> = unclear.map(|graded| graded.name.as_str()).collect();
    let answered = |graded: &&Graded| graded.verdict != Verdict::Missing && graded.kind != Kind::Formula;
    let (of_steps, others): (Vec<_>, Vec<_>) =
        graded.iter().filter(answered).partition(|graded| graded.order_found.is_some());
    let answered = of_steps.len();
    if answered == 0 {
        let adaptive = others.first()?.asked_tolerance.is_some();
        let why = if adaptive { "the program chooses its own steps" } else { "one answer shows none" };
        return Some(format!("no order is judged: {why}"));
    }
    let mut said = match seen.len() {
        0 => format!("order {claimed} is not confirmed: seen on none of {answered} problems"),
        some => format!("order {claimed} is seen on {some} of {answered} problems"),
    };
    if !unclear.is_empty() {
        let names = unclear.join(", ");
        said += &format!("; errors too few or too small to tell, or orders that still wander, on {names}");
    }
    Some(said)
}

/// True if all rods lie in the shear plane: they have only a phase, whose error is of one order more for a linear
/// method.
fn in_the_shear_plane(loaded: &LoadedProblem) -> bool {
    loaded.problem.kind == Kind::Rods && loaded.start.iter().all(|p| p[2] == 0.0)
}

#[cfg(test)]
mod tests;
