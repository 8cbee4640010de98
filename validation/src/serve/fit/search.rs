//! The search for the best fit: runs over the whole range, then over the part that the data leave, until the model's
//! own error is small beside the data's.

use super::error::{FitError, ParameterError, Undescribed};
use super::range::Range;
use crate::methods::least_squares::Datum;
use crate::methods::least_squares::basis::Basis;
use crate::methods::least_squares::best::{Best, best};
use crate::methods::least_squares::emulator::{Coefficients, Emulator, Model, Sides, coefficients};
use crate::methods::least_squares::likelihood::{EMULATOR, REPLICAS, Rods};
use crate::methods::least_squares::profile::{Interval, Profile, interval, profile, rise_of};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// Number of replicas of the first runs, which only show where to look closer.
pub const FIRST_REPLICAS: u64 = 50;

/// The largest share of a parameter's variance that may come from the model's own sampling error; above it replicas are
/// added. At this share the interval is 5 % longer.
pub const MOST_SHARE: f64 = 0.1;

/// The largest share of the points' apparent information that may be noise of the replicas before the box is reduced.
const CLEAR: f64 = 0.2;

/// A fit with a larger share is refused.
const NOTHING_ELSE: f64 = 0.7;

/// The share of χ² that may come from a covariance of few replicas.
const MOST_EXCESS: f64 = 0.5;

/// The largest number of changes of the box.
const MOST_ROUNDS: u64 = 12;

/// The rise of χ² at which the box may end: four standard deviations from the best place.
const FAR: f64 = 16.0;

/// The same rise where polynomials over that box exceed [`MOST_SHARE`] of a parameter's variance: three standard
/// deviations, over which the error of degree 4 is a quarter. The 95 % interval, two of them, must end inside.
const NEAR: f64 = 9.0;

/// A box is made smaller only when a side shrinks below this share of it: otherwise new runs cost more than they gain.
const WORTH: f64 = 0.6;

/// The measured points, and the parameters to fit.
#[derive(Clone, Copy, Debug)]
pub struct Measured<'a> {
    /// The measured points.
    pub data: &'a [Datum],
    /// The parameters.
    pub ranges: &'a [Range],
    /// The rods that were measured.
    pub rods: &'a Rods,
}

/// The input of a fit.
pub struct FitProblem<'a> {
    /// The points and the parameters.
    pub measured: Measured<'a>,
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

/// A fit.
#[derive(Clone, Debug)]
pub struct Fit {
    /// The parameters.
    pub ranges: Vec<Range>,
    /// The last box, on the ranges' scales.
    pub sides: Sides,
    /// The best place in it.
    pub best: Best,
    /// The model over it.
    pub emulator: Emulator,
    /// A profile for each parameter.
    pub profiles: Vec<Profile>,
    /// Runs of the model, over all boxes.
    pub runs: u64,
    /// Boxes that were tried.
    pub rounds: u64,
}

/// A search that goes on until the model's own error is small beside the data's.
struct Search<'a> {
    problem: &'a FitProblem<'a>,
    basis: Basis,
    whole: Sides,
    /// The current box, and the coefficients of its replicas.
    sides: Sides,
    coefficients: Vec<Coefficients>,
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
    Box(Sides),
    Done,
}

/// Fits the parameters.
///
/// # Errors
///
/// Why a run was impossible or did not finish, or why its result is no answer.
pub fn search(problem: &FitProblem<'_>, watch: &Watch<'_>) -> Result<Fit, FitError> {
    search_from(problem, whole(problem.measured.ranges), watch)
}

/// Fits the parameters, beginning with the box `sides`, which may move and grow over the whole ranges.
pub(super) fn search_from(problem: &FitProblem<'_>, sides: Sides, watch: &Watch<'_>) -> Result<Fit, FitError> {
    let ranges = problem.measured.ranges;
    let whole = whole(ranges);
    let mut search = Search {
        problem,
        basis: Basis::new(ranges.len()),
        sides,
        whole,
        coefficients: Vec::new(),
        replicas: FIRST_REPLICAS.min(problem.most_replicas),
        near: false,
        runs: 0,
        rounds: 1,
    };
    loop {
        let fit = search.run(watch)?;
        match search.next(&fit) {
            Next::Replicas(replicas) => search.replicas = replicas,
            Next::Box(sides) => {
                search.sides = sides;
                search.coefficients.clear();
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
        let value = |node: &[f64]| values(problem.measured.ranges, sides, node);
        self.coefficients.extend(coefficients(basis, problem.model, &value, new, watch.done)?);
        let fit = fitted(&problem.measured, basis, sides, &self.coefficients)?;
        Ok(Fit { runs: self.runs, rounds: self.rounds, ..fit })
    }

    fn next(&mut self, fit: &Fit) -> Next {
        let most = self.problem.most_replicas;
        let more = self.replicas < most;
        let noise = fit.noise_share();
        let until = |share, allowed| Next::Replicas(enough(self.replicas, share, allowed).min(most));
        // The points, not the replicas' noise, must decide where to look closer.
        if more && noise > CLEAR {
            return until(noise, CLEAR);
        }
        let share = fit.best.share(REPLICAS).max(noise);
        let enough = if share <= MOST_SHARE || !more { Next::Done } else { until(share, MOST_SHARE) };
        let (mut sides, mut gains) = other_sides(fit, &self.whole, if self.near { NEAR } else { FAR });
        if !gains && !self.near && fit.best.share(EMULATOR) > MOST_SHARE {
            self.near = true;
            sides = other_sides(fit, &self.whole, NEAR).0;
            gains = sides != self.sides;
        }
        if gains && self.rounds < MOST_ROUNDS { Next::Box(sides) } else { enough }
    }

    /// Refuses a fit that is no answer.
    fn check(&self, fit: &Fit) -> Result<(), FitError> {
        let (points, ranges) = (self.problem.measured.data.len(), &fit.ranges);
        if fit.noise_share() > NOTHING_ELSE {
            return Err(FitError::Noise(fit.noise_share(), self.replicas));
        }
        if fit.best.goodness.excess > MOST_EXCESS {
            return Err(FitError::FewReplicas { replicas: self.replicas, points });
        }
        if let Some(range) = fit.undetermined() {
            let error = ParameterError::Undetermined { from: range.from, to: range.to };
            return Err(FitError::Parameter(range.label(), error));
        }
        if !enclosed(fit, &self.whole) {
            return Err(FitError::NotEnclosed { boxes: self.rounds, values: fit.values(&fit.best.place) });
        }
        let undescribed = || Undescribed::check(fit.best.chi_square, points, ranges.len());
        fit.is_smooth().map_err(|error| undescribed().map_or(error, FitError::from))
    }
}

fn whole(ranges: &[Range]) -> Sides {
    (ranges.iter()).map(|range| (range.scaled(range.from), range.scaled(range.to))).collect()
}

/// The values of the parameters at `place` of the box `sides`.
pub fn values(ranges: &[Range], sides: &Sides, place: &[f64]) -> Vec<f64> {
    let one = |((range, (low, high)), place): ((&Range, &(f64, f64)), &f64)| {
        range.value(0.5 * (low + high) + 0.5 * (high - low) * place)
    };
    ranges.iter().zip(sides).zip(place).map(one).collect()
}

/// The fit over the box `sides`, from the coefficients of its replicas.
pub fn fitted(measured: &Measured<'_>, basis: &Basis, sides: &Sides, found: &[Coefficients]) -> Result<Fit, String> {
    let emulator = Emulator::new(basis, found);
    let best = best(measured.data, &emulator, measured.rods)
        .ok_or("the points say nothing about a parameter: no model value changes with it")?;
    Ok(Fit {
        ranges: measured.ranges.to_vec(),
        sides: sides.clone(),
        profiles: (0..sides.len()).map(|axis| profile(&best, axis)).collect(),
        best,
        emulator,
        runs: 0,
        rounds: 1,
    })
}

/// The number of replicas that reduces the share of the sampling variance, which falls as one over that number, to
/// `allowed`; a tenth more, as the share is known no better than the variance itself, and at most ten times as many at
/// once.
fn enough(replicas: u64, share: f64, allowed: f64) -> u64 {
    let others = (1.0 - share).max(0.05);
    let needed = replicas as f64 * (share / others) * (1.0 - allowed) / allowed;
    (1.1 * needed).ceil().min(10.0 * replicas as f64) as u64 + 1
}

/// The next box, and true if it gains enough to run again. Each side should end a quarter beyond the place where χ² has
/// risen by `far`: nearer, the interval may be cut; farther, polynomials of this degree are too inaccurate.
fn other_sides(fit: &Fit, whole: &Sides, far: f64) -> (Sides, bool) {
    let mut change = false;
    let sides = (0..whole.len())
        .map(|axis| {
            let (low, high) = fit.sides[axis];
            let at = |place: f64| 0.5 * (low + high) + 0.5 * (high - low) * place;
            let far = interval(&fit.best, axis, &fit.profiles[axis], far);
            let centre = fit.best.place[axis];
            let end = |place: f64, open: bool| match open {
                // The end is not known yet: go beyond this box, and far beyond it if even the best place is at its
                // edge.
                true if centre.abs() > 0.99 => at(place + 4.0 * place.signum()),
                true => at(place + place.signum()),
                false => at(place + 0.25 * (place - centre)),
            };
            let wanted = (end(far.low, far.open[0]).max(whole[axis].0), end(far.high, far.open[1]).min(whole[axis].1));
            let wider = wanted.0 < low && far.open[0] || wanted.1 > high && far.open[1];
            change |= wider || wanted.1 - wanted.0 < WORTH * (high - low);
            wanted
        })
        .collect();
    (sides, change)
}

/// True if every 95 % interval ends inside its box or at the edge of its range.
fn enclosed(fit: &Fit, whole: &Sides) -> bool {
    (0..whole.len()).all(|axis| {
        let found = interval(&fit.best, axis, &fit.profiles[axis], rise_of(0.95));
        let (own, all) = (fit.sides[axis], whole[axis]);
        (!found.open[0] || own.0 <= all.0) && (!found.open[1] || own.1 >= all.1)
    })
}

/// A standard uncertainty above this multiple of the range, with an interval of the whole range: no prediction depends
/// on the parameter.
const UNDETERMINED: f64 = 10.0;

/// Ends of 68 and 95 % closer than this share of the distance from the best place are one end: those of a parabola are
/// half of it apart.
const SAME: f64 = 0.02;

impl Fit {
    /// The first parameter that the points do not determine at all.
    fn undetermined(&self) -> Option<&Range> {
        let covariance = self.best.covariance();
        let axis = (0..self.ranges.len()).find(|&axis| {
            // A box is 2 wide.
            let (low, high) = self.sides[axis];
            let uncertainty = 0.5 * (high - low) * covariance[(axis, axis)].sqrt();
            let range = &self.ranges[axis];
            let all = interval(&self.best, axis, &self.profiles[axis], rise_of(0.95)).open == [true; 2];
            all && uncertainty > UNDETERMINED * (range.scaled(range.to) - range.scaled(range.from))
        });
        axis.map(|axis| &self.ranges[axis])
    }

    /// The largest share of the replicas' noise in the rise of χ² at the ends of the 95 % intervals.
    pub fn noise_share(&self) -> f64 {
        let all = self.profiles.iter().map(|profile| profile.feigned(rise_of(0.95)));
        all.fold(0.0, crate::oracle::larger)
    }

    /// The values of the parameters at `place` of the box.
    pub fn values(&self, place: &[f64]) -> Vec<f64> {
        values(&self.ranges, &self.sides, place)
    }

    /// The value of parameter `axis` at its place in the box.
    pub fn value(&self, axis: usize, place: f64) -> f64 {
        let mut all = vec![0.0; self.ranges.len()];
        all[axis] = place;
        self.values(&all)[axis]
    }

    /// The place of a value of parameter `axis` in the box.
    pub(super) fn place(&self, axis: usize, value: f64) -> f64 {
        let (low, high) = self.sides[axis];
        (2.0 * self.ranges[axis].scaled(value) - low - high) / (high - low)
    }

    /// Derivative of parameter `axis` with respect to its place in the box, at the best place.
    pub fn scale(&self, axis: usize) -> f64 {
        let (low, high) = self.sides[axis];
        let scaled = 0.5 * (low + high) + 0.5 * (high - low) * self.best.place[axis];
        0.5 * (high - low) * self.ranges[axis].slope(scaled)
    }

    /// The covariance of the parameters in their units, by linear theory.
    pub fn covariance(&self) -> DMatrix<f64> {
        let scales = DVector::from_fn(self.sides.len(), |axis, _| self.scale(axis));
        self.best.covariance().component_mul(&(&scales * scales.transpose()))
    }

    /// The interval of parameter `axis` at a confidence level, in the parameter's unit. It is open at an end that is
    /// the edge of the parameter's range.
    pub fn interval(&self, axis: usize, confidence: f64) -> Interval {
        let found = interval(&self.best, axis, &self.profiles[axis], rise_of(confidence));
        let range = &self.ranges[axis];
        let (low, high) = self.sides[axis];
        // Exact to the last digit where the box ends at the end of the range.
        let end = |open: bool, side: f64, edge: f64, place: f64| {
            if open && side == range.scaled(edge) { edge } else { self.value(axis, place) }
        };
        Interval {
            low: end(found.open[0], low, range.from, found.low),
            high: end(found.open[1], high, range.to, found.high),
            ..found
        }
    }

    /// The parts of a parameter's range in which its profile is within the 95 % interval's level, where what lies
    /// between them is ruled out by four standard deviations: a lower rise in between is no more than a ripple.
    fn minima(&self, axis: usize) -> Vec<(f64, f64)> {
        let profile = &self.profiles[axis];
        let mut parts: Vec<(usize, usize)> = Vec::new();
        for (k, _) in profile.rise.iter().enumerate().filter(|(_, rise)| **rise <= rise_of(0.95)) {
            match parts.last_mut() {
                Some((_, last)) if profile.rise[*last..k].iter().all(|between| *between < FAR) => *last = k,
                _ => parts.push((k, k)),
            }
        }
        let value = |k: usize| self.value(axis, profile.place[k]);
        parts.into_iter().map(|(first, last)| (value(first), value(last))).collect()
    }

    /// Checks that every profile has one minimum in its intervals and no jump at their ends, and that the 68 % interval
    /// is within 95 %'s.
    ///
    /// # Errors
    ///
    /// The parameter whose intervals cannot be determined, and what to do.
    pub(super) fn is_smooth(&self) -> Result<(), FitError> {
        for (axis, range) in self.ranges.iter().enumerate() {
            let [inner, outer] =
                [0.68, 0.95].map(|confidence| interval(&self.best, axis, &self.profiles[axis], rise_of(confidence)));
            let centre = self.best.place[axis];
            let error = |error| Err(FitError::Parameter(range.label(), error));
            let minima = self.minima(axis);
            if minima.len() > 1 {
                return error(ParameterError::SeveralMinima(minima));
            }
            let same =
                |inner: f64, outer: f64, open: bool| !open && (outer - inner).abs() < SAME * (outer - centre).abs();
            if inner.jumps != [false; 2]
                || outer.jumps != [false; 2]
                || same(inner.low, outer.low, outer.open[0])
                || same(inner.high, outer.high, outer.open[1])
            {
                return error(ParameterError::Jumps);
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
