//! The search for the best fit: runs over the whole range, then over the part that the data leave, until the model's
//! own error is small beside the data's.

pub use super::answer::{Fit, fitted, values};

use super::answer::along;
use super::error::{FitError, ParameterError, Undescribed};
use super::range::Range;
use crate::methods::least_squares::Datum;
use crate::methods::least_squares::basis::Basis;
use crate::methods::least_squares::best::SCARCE;
use crate::methods::least_squares::emulator::{Coefficients, Emulator, Model, Prediction, Sides, coefficients};
use crate::methods::least_squares::likelihood::{EMULATOR, REPLICAS, Rods};
use crate::methods::least_squares::profile::rise_of;
use rayon::prelude::*;

/// Number of replicas of the first runs, which only show where to look closer.
pub const FIRST_REPLICAS: u64 = 50;

/// The largest share of a parameter's variance that may come from the model's own sampling error; above it replicas are
/// added. At this share the interval is 5 % longer.
pub const MOST_SHARE: f64 = 0.1;

/// The largest share of the replicas' noise in the rise of χ² at the ends of an interval, from which its average is
/// subtracted; above it replicas are added.
const MOST_NOISE: f64 = 0.15;

/// The part of that share which the covariance of few replicas may have: its replicas run at one place alone, the
/// others at every node.
const MOST_SCARCE: f64 = 0.03;

/// The largest share of the points' apparent information that may be noise of the replicas before the box is reduced.
const CLEAR: f64 = 0.2;

/// A fit with a larger share is refused.
const NOTHING_ELSE: f64 = 0.7;

/// The share of χ² that may come from a covariance of few replicas.
const MOST_EXCESS: f64 = 0.5;

/// The largest number of boxes.
pub const MOST_ROUNDS: u64 = 12;

/// The rise of χ² at which the box may end: four standard deviations from the best place.
pub(super) const FAR: f64 = 16.0;

/// The same rise where polynomials over that box exceed [`MOST_SHARE`] of a parameter's variance: three standard
/// deviations, over which the error of degree 4 is a quarter. The 95 % interval, two of them, must end inside.
const NEAR: f64 = 9.0;

/// A box is made smaller only when a side shrinks below this share of it: otherwise new runs cost more than they gain.
const WORTH: f64 = 0.6;

/// From so many nodes on, those of three parameters, replicas at all of them cost most of a fit.
const MANY: usize = 100;

/// The same of many nodes, while the polynomials' error is below [`ACCURATE`] of each variance: the model changes
/// less across a smaller box, its noise does not, so that the nodes need as many replicas again and more.
const WORTH_OF_MANY: f64 = 0.2;

/// A share of the polynomials' error in a parameter's variance that a smaller box need not reduce.
const ACCURATE: f64 = 0.02;

/// A place beyond this in a box is at its edge.
const AT_EDGE: f64 = 0.99;

/// The input of a fit.
pub struct FitProblem<'a> {
    /// The measured points.
    pub data: &'a [Datum],
    /// The parameters.
    pub ranges: &'a [Range],
    /// The rods that were measured.
    pub rods: &'a Rods,
    /// The model that predicts the points.
    pub model: &'a Model<'a>,
    /// The largest number of replicas at each parameter value.
    pub most_replicas: u64,
}

/// Callbacks for the progress of the runs.
pub struct Watch<'a> {
    /// Called with the name of each part of the work as it begins.
    pub stage: &'a (dyn Fn(&str) + Sync),
    /// Called with the number of runs that follow.
    pub planned: &'a (dyn Fn(u64) + Sync),
    /// Called when a run has ended.
    pub done: &'a (dyn Fn() + Sync),
}

impl Watch<'_> {
    /// Callbacks that do nothing.
    pub const SILENT: Self = Self { stage: &|_| (), planned: &|_| (), done: &|| () };

    /// Runs `one` for the replicas from 0 to `count` on any number of threads and returns the results in order.
    ///
    /// # Errors
    ///
    /// The error of a replica that fails.
    pub fn replicas<T: Send>(
        &self,
        count: u64,
        one: impl Fn(u64) -> Result<T, String> + Sync,
    ) -> Result<Vec<T>, String> {
        (self.planned)(count);
        let watched = |replica: u64| {
            let found = one(replica);
            (self.done)();
            found
        };
        (0..count).into_par_iter().map(watched).collect()
    }
}

/// A search that goes on until the model's own error is small beside the data's.
struct Search<'a> {
    problem: &'a FitProblem<'a>,
    basis: Basis,
    whole: Sides,
    /// The current box, and the coefficients of its replicas.
    sides: Sides,
    coefficients: Vec<Coefficients>,
    /// Replicas at one place alone, the best one when they ran: for the covariance of measured rods, and for the mean
    /// where there are many nodes.
    alone: Vec<Vec<Prediction>>,
    alone_at: Vec<f64>,
    /// The number of replicas at each node that the next fit needs.
    replicas: u64,
    /// True once polynomials over a box that ends at [`FAR`] were too inaccurate.
    near: bool,
    runs: u64,
    rounds: u64,
}

enum Next {
    /// More replicas, up to this number.
    Replicas(u64),
    /// So many replicas at the best place alone.
    Alone(u64),
    Box(Sides),
    Done,
}

/// Fits the parameters.
///
/// # Errors
///
/// Why a run was impossible or did not finish, or why its result is no answer.
pub fn search(problem: &FitProblem<'_>, watch: &Watch<'_>) -> Result<Fit, FitError> {
    search_from(problem, whole(problem.ranges), watch)
}

/// Fits the parameters, beginning with the box `sides`, which may move and grow over the whole ranges.
pub(super) fn search_from(problem: &FitProblem<'_>, sides: Sides, watch: &Watch<'_>) -> Result<Fit, FitError> {
    let ranges = problem.ranges;
    let whole = whole(ranges);
    let first = FIRST_REPLICAS.min(problem.most_replicas);
    let basis = Basis::new(ranges.len());
    let mut search = Search {
        problem,
        basis,
        sides,
        whole,
        coefficients: Vec::new(),
        alone: Vec::new(),
        alone_at: Vec::new(),
        replicas: first,
        near: false,
        runs: 0,
        rounds: 1,
    };
    loop {
        let fit = search.run(watch)?;
        match search.next(&fit) {
            Next::Replicas(replicas) => search.replicas = replicas,
            Next::Alone(replicas) => {
                let model = (problem.model)(&fit.values(&fit.best.place))?;
                search.alone = watch.replicas(replicas, |replica| model.run(replica))?;
                search.alone_at = fit.best.place;
                search.runs += replicas;
            }
            Next::Box(sides) => {
                search.sides = sides;
                search.coefficients.clear();
                search.alone.clear();
                // The replicas that the box before needed may be more than this one needs.
                search.replicas = first;
                search.rounds += 1;
            }
            Next::Done => {
                search.check(&fit)?;
                return Ok(fit);
            }
        }
    }
}

impl Search<'_> {
    /// Runs the missing replicas and fits the box.
    fn run(&mut self, watch: &Watch<'_>) -> Result<Fit, FitError> {
        let Self { problem, basis, sides, .. } = self;
        let new = self.coefficients.len() as u64..self.replicas;
        let planned = (self.replicas - new.start) * basis.nodes.len() as u64;
        (watch.stage)(&format!("search, box {}", self.rounds));
        (watch.planned)(planned);
        self.runs += planned;
        let value = |node: &[f64]| values(problem.ranges, sides, node);
        self.coefficients.extend(coefficients(basis, problem.model, &value, new, watch.done)?);
        // Of one degree: a lower one where noise seems to ask for it shortens intervals by a fifth (of 35 fits of α and
        // m, those of 68 % held α in 13, those of this degree in 23).
        let mut emulator = Emulator::new(basis, &self.coefficients).with_alone(&self.alone);
        if is_dear(basis) {
            emulator = emulator.through(&self.alone_at, &self.alone);
        }
        let fit = fitted(problem.data, problem.ranges, problem.rods, sides, emulator)?;
        Ok(Fit { runs: self.runs, rounds: self.rounds, ..fit })
    }

    fn next(&mut self, fit: &Fit) -> Next {
        let most = self.problem.most_replicas;
        let more = self.replicas < most;
        let noise = fit.noise_share();
        let until = |share, allowed| Next::Replicas(enough(self.replicas, share, allowed).min(most));
        let (scarce, behind) = (fit.best.share(SCARCE), fit.emulator.behind_covariance() as u64);
        let share_rods = self.problem.rods.over_measured.iter().any(|ratio| *ratio > 0.0);
        // The points, not the replicas' noise, must decide where to look closer.
        if more && noise > CLEAR && !(ends_short(fit, &self.whole) && self.rounds < MOST_ROUNDS) {
            return until(noise, CLEAR);
        }
        let share = fit.best.share(REPLICAS);
        // At many nodes, replicas show how the model changes; its mean comes from others, at the best place alone.
        let many = is_dear(&self.basis);
        let ran = behind.max(self.replicas);
        let due = if many && noise <= MOST_NOISE && share > MOST_SHARE && ran < most {
            Next::Alone(enough(ran, share, MOST_SHARE).min(most))
        } else if !more || share <= MOST_SHARE && noise <= MOST_NOISE {
            Next::Done
        } else if share > MOST_SHARE && !(many && noise > MOST_NOISE) {
            until(share, MOST_SHARE)
        } else {
            until(noise, MOST_NOISE)
        };
        let inaccurate = fit.best.share(EMULATOR);
        let worth = if many && inaccurate <= ACCURATE { WORTH_OF_MANY } else { WORTH };
        let (mut sides, mut gains) = other_sides(fit, &self.whole, if self.near { NEAR } else { FAR }, worth);
        if !gains && !self.near && inaccurate > MOST_SHARE {
            self.near = true;
            sides = other_sides(fit, &self.whole, NEAR, worth).0;
            gains = sides != self.sides;
        }
        match (gains && self.rounds < MOST_ROUNDS, share_rods && scarce > MOST_SCARCE && behind < most) {
            (true, _) => Next::Box(sides),
            (_, true) => Next::Alone(enough(behind, scarce, MOST_SCARCE).min(most)),
            _ => due,
        }
    }

    /// Refuses a fit that is no answer.
    fn check(&self, fit: &Fit) -> Result<(), FitError> {
        let (points, ranges) = (self.problem.data.len(), &fit.ranges);
        if fit.noise_share() > NOTHING_ELSE {
            return Err(FitError::Noise(fit.noise_share(), self.replicas));
        }
        if fit.best.goodness.excess > MOST_EXCESS {
            return Err(FitError::FewReplicas { replicas: fit.emulator.behind_covariance() as u64, points });
        }
        if let Some(range) = fit.undetermined() {
            let error = ParameterError::Undetermined { from: range.from, to: range.to };
            return Err(FitError::Parameter(range.label(), error));
        }
        if !enclosed(fit, &self.whole) {
            let values = fit.values(&fit.best.place).into_iter().zip(ranges);
            let best = values.map(|(value, range)| format!("{} = {value:.4}", range.name())).collect();
            return Err(FitError::NotEnclosed { boxes: self.rounds, best });
        }
        let undescribed = || Undescribed::check(fit.best.chi_square, points, ranges.len());
        fit.is_smooth().map_err(|error| undescribed().map_or(error, FitError::from))
    }
}

/// True if replicas at all nodes are dear.
fn is_dear(basis: &Basis) -> bool {
    basis.nodes.len() >= MANY
}

fn whole(ranges: &[Range]) -> Sides {
    (ranges.iter()).map(|range| (range.scaled(range.from), range.scaled(range.to))).collect()
}

/// The number of replicas that reduces the share of the sampling variance, which falls as one over that number, to
/// `allowed`; a tenth more, as the share is known no better than the variance itself, and at most ten times as many at
/// once.
fn enough(replicas: u64, share: f64, allowed: f64) -> u64 {
    let others = (1.0 - share).max(0.05);
    let needed = replicas as f64 * (share / others) * (1.0 - allowed) / allowed;
    (1.1 * needed).ceil().min(10.0 * replicas as f64) as u64 + 1
}

/// True if the best place of several parameters is at an edge of the box that is none of the ranges': runs over a wider
/// box say more than further ones here.
fn ends_short(fit: &Fit, whole: &Sides) -> bool {
    let is_inner = |(axis, place): (usize, &f64)| {
        let ((low, high), (from, to)) = (fit.sides[axis], whole[axis]);
        *place < -AT_EDGE && low > from || *place > AT_EDGE && high < to
    };
    whole.len() > 1 && fit.best.place.iter().enumerate().any(is_inner)
}

/// The next box, and true if it gains enough to run again. Each side should end a quarter beyond the place where χ² has
/// risen by `far`: nearer, the interval may be cut; farther, polynomials of this degree are too inaccurate. It gains
/// where a side shrinks below `worth`.
fn other_sides(fit: &Fit, whole: &Sides, far: f64, worth: f64) -> (Sides, bool) {
    // With several parameters a further box costs many runs, so an open end is moved farther.
    let beyond = if whole.len() > 1 { 2.0 } else { 1.0 };
    let wanted = |axis: usize| {
        let (low, high) = fit.sides[axis];
        let at = |place: f64| along((low, high), place);
        let far = fit.within(axis, far);
        let centre = fit.best.place[axis];
        let end = |place: f64, open: bool| match open {
            // The end is not known yet: go beyond this box, and far beyond it if even the best place is at its edge.
            true if centre.abs() > AT_EDGE => at(place + 4.0 * beyond * place.signum()),
            true => at(place + beyond * place.signum()),
            false => at(place + 0.25 * (place - centre)),
        };
        let wanted = (end(far.low, far.open[0]).max(whole[axis].0), end(far.high, far.open[1]).min(whole[axis].1));
        // A box that ends between both rises is wide enough.
        let near = fit.within(axis, NEAR).open;
        let wider = wanted.0 < low && near[0] || wanted.1 > high && near[1];
        Wanted { ends: wanted, wider, left: (wanted.1 - wanted.0) / (high - low) }
    };
    let all: Vec<_> = (0..whole.len()).map(wanted).collect();
    let least = all.iter().filter(|side| !side.wider).map(|side| side.left).fold(1.0, f64::min);
    // While one side shrinks much, others keep their ends: over it, the polynomials tell little of the others.
    let moved = if least < 0.5 * worth { 0.5 * worth } else { worth };
    let moves = |side: &Wanted| far < FAR || side.wider || side.left < moved;
    let sides = all.iter().zip(&fit.sides).map(|(side, own)| if moves(side) { side.ends } else { *own });
    (sides.collect(), all.iter().any(|side| side.wider || side.left < worth))
}

/// A side that the next box should have.
struct Wanted {
    ends: (f64, f64),
    /// True if it must go beyond the present one.
    wider: bool,
    /// Its length over that of the present one.
    left: f64,
}

/// True if every 95 % interval ends inside its box or at the edge of its range.
fn enclosed(fit: &Fit, whole: &Sides) -> bool {
    (0..whole.len()).all(|axis| {
        let found = fit.within(axis, rise_of(0.95));
        let (own, all) = (fit.sides[axis], whole[axis]);
        (!found.open[0] || own.0 <= all.0) && (!found.open[1] || own.1 >= all.1)
    })
}

#[cfg(test)]
mod tests;
