//! The exact motion of a free rod over any time, with a bound on its error.
//!
//! The substitution p = q/|q| makes Jeffery's equation linear: q(t) = exp(At) p(0) with A = W + ΛD (the trace of A
//! changes only |q| and is left out). Plane Couette flow along the axes uses its closed form; every other flow is
//! computed with numbers of 106 bits that carry an error bound (`general.rs`), taking L, r_e and p as exact.

mod ball;
mod functions;
mod general;
mod modes;
mod steps;
#[cfg(test)]
mod tests;

use crate::model::flow::VelocityGradient;
use crate::model::jeffery;
use crate::model::phase::Phase;
use ball::Ball;
use general::{General, Square, infinite_if_nan, rounded, times};
use nalgebra::{Matrix3, UnitVector3, Vector3};
use std::f64::consts::TAU;
use steps::Steps;

/// The direction p = q/|q| after the phase `phase` of a free rod in plane Couette flow with G > 0; q is given by
/// `turned`.
#[inline(always)]
pub fn couette(p: [f64; 3], aspect_ratio: f64, phase: Phase) -> [f64; 3] {
    let q = turned(p, aspect_ratio, phase);
    let scale = 1.0 / (q[0] * q[0] + q[1] * q[1] + q[2] * q[2]).sqrt();
    [q[0] * scale, q[1] * scale, q[2] * scale]
}

/// A.4 and A.5 as a linear map: q = (p₁ cos ωt − (p₂/r_e) sin ωt, r_e p₁ sin ωt + p₂ cos ωt, p₃).
#[inline(always)]
fn turned(p: [f64; 3], aspect_ratio: f64, phase: Phase) -> [f64; 3] {
    let inverse = 1.0 / aspect_ratio;
    let q1 = p[0] * phase.cos - p[1] * inverse * phase.sin;
    let q2 = aspect_ratio * p[0] * phase.sin + p[1] * phase.cos;
    [q1, q2, p[2]]
}

/// The length of a rod's motion, as the quotient of a number ≥ 0 and another.
///
/// ```
/// use shearbed::motion::Span;
/// // A third of a period, without rounding the third.
/// let third = Span::Periods(1.0, 3.0);
/// assert_ne!(third, Span::Periods(1.0 / 3.0, 1.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Span {
    /// Seconds.
    Seconds(f64, f64),
    /// Units of strain, (2 D:D)^½ t.
    Strain(f64, f64),
    /// Periods of the propagator's own aspect ratio.
    Periods(f64, f64),
}

/// The end of a rod's motion.
///
/// ```
/// use shearbed::model::flow::VelocityGradient;
/// use shearbed::{nalgebra::{Matrix3, Vector3}, motion::{Propagator, Span}};
/// // Planar extension along axis 1 draws a rod there, and the error is known.
/// let gradient = Matrix3::from_diagonal(&Vector3::new(1.0, -1.0, 0.0));
/// let flow = VelocityGradient::new(gradient).expect("finite");
/// let start = shearbed::model::orientation::from_degrees(45.0, 90.0);
/// let moved = Propagator::new(&flow, 20.0).moved(&start, Span::Strain(8.0, 1.0)).expect("no period is asked for");
/// assert!(moved.p.x > 0.999 && moved.error < 1e-15);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moved {
    /// The direction at the end.
    pub p: UnitVector3<f64>,
    /// A bound on the angle in rad between `p` and the true direction of a rod that started exactly along the given
    /// direction; infinite if no bound is known.
    pub error: f64,
    /// ‖\|M\|\|p\|‖/‖M p‖ of the map q = M p: the factor by which relative errors of the start's components may be
    /// amplified at the end.
    pub condition: f64,
}

/// The exact motion of rods of one aspect ratio in one flow.
///
/// ```
/// use shearbed::model::flow::VelocityGradient;
/// use shearbed::{nalgebra::Vector3, motion::{Propagator, Span}};
/// let flow = VelocityGradient::plane_couette(0.5).expect("finite");
/// let rods = Propagator::new(&flow, 11.6);
/// let half = rods.moved(&Vector3::x_axis(), Span::Periods(1.0, 2.0)).expect("this flow has a period");
/// assert!((half.p.x + 1.0).abs() < 1e-15); // p ≡ −p
/// ```
#[derive(Clone, Debug)]
pub struct Propagator(Motion);

#[derive(Clone, Debug)]
#[expect(clippy::large_enum_variant, reason = "rods of unequal r_e hold the large one, side by side")]
enum Motion {
    /// Plane Couette flow u_2 = G x_1: the closed form.
    Couette { shear_rate_per_s: f64, aspect_ratio: f64 },
    /// Any flow.
    General(General),
    /// A sequence of flows; spans are strains.
    Steps(Steps),
}

impl Propagator {
    /// The motion of rods with `aspect_ratio` > 0 in `flow`.
    pub fn new(flow: &VelocityGradient, aspect_ratio: f64) -> Self {
        match flow.shear_rate_per_s() {
            Some(shear_rate_per_s) => Self(Motion::Couette { shear_rate_per_s, aspect_ratio }),
            None => Self::general(flow, aspect_ratio),
        }
    }

    /// The same motion without the closed form of plane Couette flow.
    pub fn general(flow: &VelocityGradient, aspect_ratio: f64) -> Self {
        Self(Motion::General(General::new(flow, aspect_ratio)))
    }

    /// The motion of rods with `aspect_ratio` > 0 in a sequence of `flows`, at least one, each with its strain. Its
    /// spans must be strains.
    pub(crate) fn of_steps(flows: &[(VelocityGradient, f64)], aspect_ratio: f64) -> Self {
        Self(Motion::Steps(Steps::new(flows, aspect_ratio)))
    }

    /// The period in s of the rotating part of the motion, `None` if there is none. After a period every direction is
    /// back, except for [`Self::drift_per_period`].
    pub fn period_s(&self) -> Option<f64> {
        match &self.0 {
            Motion::Couette { shear_rate_per_s, aspect_ratio } => {
                Some(jeffery::period_s(*shear_rate_per_s, *aspect_ratio))
            }
            Motion::General(general) => general.period_s(),
            Motion::Steps(_) => None,
        }
    }

    /// Relative growth per period of the rotating part over the rest: 0 if every direction returns.
    pub fn drift_per_period(&self) -> Option<f64> {
        match &self.0 {
            Motion::Couette { .. } => Some(0.0),
            Motion::General(general) => general.period().map(|(_, drift)| drift),
            Motion::Steps(_) => None,
        }
    }

    /// The linear map q = M p, scaled by an arbitrary positive factor, and a bound on its relative error (in
    /// Frobenius's norm), without the rounding to double. `None` for a span in periods if the motion has no period.
    pub fn map(&self, span: Span) -> Option<(Matrix3<f64>, f64)> {
        self.map_in(None, span)
    }

    /// Like [`Self::map`], but in a general flow periods in `span` are those of `mean`.
    pub(crate) fn map_beside(&self, mean: &Self, span: Span) -> Option<(Matrix3<f64>, f64)> {
        self.map_in(Some(mean), span)
    }

    fn map_in(&self, mean: Option<&Self>, span: Span) -> Option<(Matrix3<f64>, f64)> {
        match &self.0 {
            Motion::Couette { aspect_ratio, .. } => {
                let (phase, error) = self.phase(span)?;
                let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
                let columns = axes.map(|axis| Vector3::from(turned(axis, *aspect_ratio, phase)));
                Some((Matrix3::from_columns(&columns), error))
            }
            Motion::General(general) => Some(rounded(&general.map(time(general, mean, span)?))),
            Motion::Steps(steps) => Some(rounded(&map_of_steps(steps, span)?)),
        }
    }

    /// The end of a rod that starts along `p`; `None` for a span in periods if the motion has no period.
    pub fn moved(&self, p: &UnitVector3<f64>, span: Span) -> Option<Moved> {
        self.moved_beside(self, p, span)
    }

    /// Like `moved`, but periods in `span` are those of `mean`, rods in the same flow.
    pub(crate) fn moved_beside(&self, mean: &Self, p: &UnitVector3<f64>, span: Span) -> Option<Moved> {
        match &self.0 {
            Motion::Couette { aspect_ratio, .. } => {
                let (end, error) = self.direction_beside(mean, [p.x, p.y, p.z], span)?;
                let condition = aspect_ratio.max(1.0 / aspect_ratio);
                Some(Moved { p: UnitVector3::new_unchecked(end.into()), error, condition })
            }
            Motion::General(general) => {
                let start = [p.x, p.y, p.z];
                let time = time(general, Some(mean), span)?;
                let (rows, start) = general.rows_from(start, time);
                let q = general.moved(&rows, start);
                Some(moved(&general.map_of(&rows), &q, start.map(|component| component.hi)))
            }
            Motion::Steps(steps) => {
                let (map, start) = (map_of_steps(steps, span)?, [p.x, p.y, p.z]);
                Some(moved(&map, &times(&map, start.map(Ball::exact)), start))
            }
        }
    }

    /// The direction of a rod that started along `p`, and the bound of [`Moved::error`]; periods in `span` are those of
    /// `mean`, in the same flow. `None` for a span in periods if `mean` has no period.
    pub(crate) fn direction_beside(&self, mean: &Self, p: [f64; 3], span: Span) -> Option<([f64; 3], f64)> {
        match &self.0 {
            Motion::General(general) => {
                let time = time(general, Some(mean), span)?;
                let (rows, start) = general.rows_from(p, time);
                Some(normalized(&general.moved(&rows, start)))
            }
            Motion::Steps(steps) => Some(normalized(&times(&map_of_steps(steps, span)?, p.map(Ball::exact)))),
            Motion::Couette { aspect_ratio, .. } => {
                let (phase, error) = self.phase(span)?;
                // A rod turns up to max(r_e, 1/r_e) times as fast as its phase.
                let fastest = aspect_ratio.max(1.0 / aspect_ratio);
                Some((couette(p, *aspect_ratio, phase), error * fastest))
            }
        }
    }

    /// The phase in plane Couette flow, and the error that rounding adds to the map: sixteen roundings of one
    /// evaluation, and five of turns computed from seconds, four from strain.
    fn phase(&self, span: Span) -> Option<(Phase, f64)> {
        let Motion::Couette { shear_rate_per_s, aspect_ratio } = self.0 else {
            return None;
        };
        let period = jeffery::strain_per_period(aspect_ratio);
        let (turns, roundings) = match span {
            Span::Seconds(ticks, each) => (ticks / each * shear_rate_per_s.abs() / period, 5.0),
            Span::Strain(ticks, each) => (ticks / each / period, 4.0),
            Span::Periods(ticks, each) => (ticks / each, 1.0),
        };
        let error = f64::EPSILON * (16.0 + TAU * roundings * turns);
        Some((Phase::of_turns(turns * shear_rate_per_s.signum()), error))
    }

    /// The direction of a rod `time_s` ≥ 0 seconds after it pointed along `p`.
    pub fn after(&self, p: &UnitVector3<f64>, time_s: f64) -> UnitVector3<f64> {
        self.moved(p, Span::Seconds(time_s, 1.0)).map_or(*p, |moved| moved.p)
    }

    /// The direction of a rod `turns` periods after it pointed along `p`; `None` where there is no period.
    pub fn after_turns(&self, p: &UnitVector3<f64>, turns: f64) -> Option<UnitVector3<f64>> {
        self.moved(p, Span::Periods(turns, 1.0)).map(|moved| moved.p)
    }
}

/// The map of a sequence of flows over a strain; `None` for any other span.
fn map_of_steps(steps: &Steps, span: Span) -> Option<Square> {
    match span {
        Span::Strain(ticks, each) => Some(steps.map(quotient(ticks, each))),
        Span::Seconds(..) | Span::Periods(..) => None,
    }
}

fn quotient(ticks: f64, each: f64) -> Ball {
    Ball::exact(ticks).over(Ball::exact(each))
}

/// A span as a time of `general`; its periods are those of `mean`, if there is one, or its own.
fn time(general: &General, mean: Option<&Propagator>, span: Span) -> Option<modes::Time> {
    match (span, mean.map(|mean| &mean.0)) {
        (Span::Seconds(ticks, each), _) => Some(general.time_of_seconds(ticks, each)),
        (Span::Strain(ticks, each), _) => Some(general.time_of_strain(quotient(ticks, each))),
        (Span::Periods(ticks, each), Some(Motion::General(mean))) => {
            general.time_of_periods_of(mean, quotient(ticks, each))
        }
        (Span::Periods(ticks, each), _) => general.time_of_periods(quotient(ticks, each)),
    }
}

/// q/|q|, and a bound on the angle to the true direction: its sine is at most the error's length over that of q.
fn normalized(q: &[Ball; 3]) -> ([f64; 3], f64) {
    let largest = q.iter().fold(0.0, |largest: f64, q| largest.max(q.hi.abs()));
    let q = q.map(|q| [q.hi / largest, q.error / largest]);
    let length = |k: usize| (q[0][k] * q[0][k] + q[1][k] * q[1][k] + q[2][k] * q[2][k]).sqrt();
    let scale = 1.0 / length(0);
    let off = length(1) * scale;
    // Up to 0.1, an arcsine is less than 1.01 times its argument. The direction itself is rounded to double.
    let error = if off < 0.1 { 1.01 * off + 4.0 * f64::EPSILON } else { f64::INFINITY };
    (q.map(|q| q[0] * scale), infinite_if_nan(error))
}

fn moved(map: &[[Ball; 3]; 3], q: &[Ball; 3], start: [f64; 3]) -> Moved {
    let (end, error) = normalized(q);
    let largest = q.iter().fold(0.0, |largest: f64, q| largest.max(q.hi.abs()));
    let sums = map.map(|row| row.iter().zip(start).map(|(m, p)| (m.hi * p / largest).abs()).sum::<f64>());
    let length = q.map(|q| q.hi / largest);
    Moved {
        p: UnitVector3::new_unchecked(end.into()),
        error,
        condition: infinite_if_nan(Vector3::from(sums).norm() / Vector3::from(length).norm()),
    }
}
