//! A fit: the best place in its box, the profiles around it, and what they say of the parameters.

use super::error::{FitError, ParameterError};
use super::range::Range;
use super::search::FAR;
use crate::methods::least_squares::Datum;
use crate::methods::least_squares::bartlett::{DRAWS, factors};
use crate::methods::least_squares::best::{Best, best};
use crate::methods::least_squares::emulator::{Emulator, Sides};
use crate::methods::least_squares::likelihood::Rods;
use crate::methods::least_squares::profile::{Interval, Profile, interval, profile, rise_of};
use nalgebra::{DMatrix, DVector};

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

/// The values of the parameters at `place` of the box `sides`.
pub fn values(ranges: &[Range], sides: &Sides, place: &[f64]) -> Vec<f64> {
    ranges.iter().zip(sides).zip(place).map(|((range, side), place)| range.value(along(*side, *place))).collect()
}

/// The place from −1 to 1 of a side of a box, on the scale of its range.
pub(super) fn along((low, high): (f64, f64), place: f64) -> f64 {
    0.5 * (low + high) + 0.5 * (high - low) * place
}

/// The fit over the box `sides` with the model's emulator over it.
pub fn fitted(data: &[Datum], ranges: &[Range], rods: &Rods, sides: &Sides, emulator: Emulator) -> Result<Fit, String> {
    let none = "the points say nothing about a parameter: no model value changes with it";
    let mut best = best(data, &emulator, rods).ok_or(none)?;
    // Of one parameter it is 1.03 at most (docs/src/theory/fits.md).
    if sides.len() > 1 {
        best.factors = factors(&best, &emulator, DRAWS).ok_or(none)?;
    }
    Ok(Fit {
        ranges: ranges.to_vec(),
        sides: sides.clone(),
        profiles: (0..sides.len()).map(|axis| profile(&best, axis)).collect(),
        best,
        emulator,
        runs: 0,
        rounds: 1,
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
    pub(super) fn undetermined(&self) -> Option<&Range> {
        let covariance = self.best.covariance();
        let axis = (0..self.ranges.len()).find(|&axis| {
            // A box is 2 wide.
            let (low, high) = self.sides[axis];
            let uncertainty = 0.5 * (high - low) * covariance[(axis, axis)].sqrt();
            let range = &self.ranges[axis];
            self.within(axis, rise_of(0.95)).open == [true; 2]
                && uncertainty > UNDETERMINED * (range.scaled(range.to) - range.scaled(range.from))
        });
        axis.map(|axis| &self.ranges[axis])
    }

    /// The part of the box along parameter `axis` in which its profile is below `level`.
    pub(super) fn within(&self, axis: usize, level: f64) -> Interval {
        interval(&self.best, axis, &self.profiles[axis], level)
    }

    /// The largest share of the replicas' noise in the rise of χ² at the ends of the 95 % intervals.
    pub fn noise_share(&self) -> f64 {
        let all = self.profiles.iter().map(|profile| profile.noise_share(rise_of(0.95)));
        crate::oracle::worst(all)
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
        0.5 * (high - low) * self.ranges[axis].slope(along((low, high), self.best.place[axis]))
    }

    /// The covariance of the parameters in their units, by linear theory.
    pub fn covariance(&self) -> DMatrix<f64> {
        let scales = DVector::from_fn(self.sides.len(), |axis, _| self.scale(axis));
        self.best.covariance().component_mul(&(&scales * scales.transpose()))
    }

    /// The interval of parameter `axis` at a confidence level, in the parameter's unit. It is open at an end that is
    /// the edge of the parameter's range.
    pub fn interval(&self, axis: usize, confidence: f64) -> Interval {
        let found = self.within(axis, rise_of(confidence));
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
            let [inner, outer] = [0.68, 0.95].map(|confidence| self.within(axis, rise_of(confidence)));
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
