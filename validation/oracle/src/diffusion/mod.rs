//! Rods with rotary diffusion: the exact distribution of directions of infinitely many rods in any steady flow, or in
//! such flows one after another.
//!
//! ∂ψ/∂t = −∇·(ṗψ) + D_r∇²ψ on the sphere with Jeffery's ṗ = ω × p + Λ(D·p − p p·Dp) and D_r = C_I γ̇, γ̇ = (2D:D)^½
//! (Folgar & Tucker 1984; no closure). Galerkin's method on even spherical harmonics: the operator couples |l' − l| ≤ 2
//! and |m' − m| ≤ 2, and a smooth ψ needs harmonics up to about the inverse width of its peak. A steady ψ is found by
//! elimination from the highest degree down ([`steady`]), ψ in time by Taylor's series of exp(At) ([`at`]). Each answer
//! is computed at least twice, with other harmonics and other steps; the difference is its stated error.

mod frame;
mod harmonics;
mod march;
mod means;
mod operator;
pub mod orbits;
mod oscillation;
mod settled;
mod start;

#[cfg(test)]
mod tests;

pub(crate) use harmonics::gauss_legendre;
pub use means::{MEANS, Means};
pub use operator::{Motion, strain_rate_per_s};
pub use oscillation::oscillating;
pub use start::{Start, bingham};

use frame::Frame;
use march::{Accuracy, Density, Read};
use std::fmt;

/// The reason why there is no answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoAnswer {
    /// The computation exceeds the allowed work: the diffusion is too weak or the time too long for this method.
    TooMuchWork,
    /// There is no steady distribution: without diffusion, or without a flow, directions keep a memory of their start.
    Unsettled,
    /// The start needs more than 128 degrees of harmonics, or has no positive mean.
    RoughStart,
}

impl fmt::Display for NoAnswer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::TooMuchWork => "this takes too much work",
            Self::Unsettled => "there is no steady distribution without diffusion",
            Self::RoughStart => "the start is not smooth enough, or has no positive mean",
        })
    }
}

impl std::error::Error for NoAnswer {}

/// The absolute error to which answers are refined.
const WANTED: f64 = 4e-12;

/// From this degree on a cut start is refused: the next would take gigabytes.
const MOST_CUT: usize = 800;

/// A flow, and how long it lasts in s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlowStep {
    /// The motion of the rods.
    pub motion: Motion,
    /// Its duration; that of the last flow is not used.
    pub duration_s: f64,
}

/// Means over the rods at `times_s` ≥ 0, in ascending order, in one steady flow.
///
/// # Errors
///
/// As [`through`].
pub fn at(motion: &Motion, start: Start, times_s: &[f64]) -> Result<Vec<Means>, NoAnswer> {
    through(&[FlowStep { motion: *motion, duration_s: f64::INFINITY }], start, times_s)
}

/// Means over the rods at `times_s` ≥ 0, in ascending order, in flows one after another, the last without an end.
///
/// Their stated error is the largest difference between two solutions; the second has a ten times smaller tail of
/// harmonics and shorter steps. It is an upper estimate of the error of the second, which is returned. If it is above
/// 4·10⁻¹², a third solution follows, unless that takes too much work. A start that no number of harmonics resolves is
/// cut at a degree: see `cut`.
///
/// # Errors
///
/// If two solutions take too much work, or the start is neither smooth nor one that is cut.
pub fn through(flows: &[FlowStep], start: Start, times_s: &[f64]) -> Result<Vec<Means>, NoAnswer> {
    let found = found(&frames(flows), start, times_s, &Read::Means)?;
    Ok(found.0.iter().map(|means| Means::new(means, found.1)).collect())
}

/// ψ in 1/sr at `times_s` in these directions of the laboratory's axes, and its stated error, as of [`through`].
///
/// # Errors
///
/// As [`through`], and for a sharp start at t = 0.
pub fn densities(
    flows: &[FlowStep],
    start: Start,
    times_s: &[f64],
    directions: &[[f64; 3]],
) -> Result<(Vec<Vec<f64>>, f64), NoAnswer> {
    if start.sharp().is_some() && times_s.first() == Some(&0.0) {
        return Err(NoAnswer::RoughStart);
    }
    found(&frames(flows), start, times_s, &Read::Density(directions))
}

/// Flows that differ by a factor alone share their axes: to turn ψ to axes that differ in a last digit takes long.
fn frames(flows: &[FlowStep]) -> Vec<(Frame, f64)> {
    let mut last: Option<(Motion, Frame)> = None;
    let frame = |flow: &FlowStep| {
        let FlowStep { motion, duration_s } = *flow;
        if let Some((factor, (_, frame))) = last.and_then(|last| Some((motion.over(&last.0)?, last))) {
            return (frame.times(factor, motion.diffusivity), duration_s);
        }
        let frame = Frame::of(&motion);
        last = Some((motion, frame));
        (frame, duration_s)
    };
    flows.iter().map(frame).collect()
}

/// What is read off at each time, and its stated error.
fn found(flows: &[(Frame, f64)], start: Start, times_s: &[f64], read: &Read) -> Result<(Vec<Vec<f64>>, f64), NoAnswer> {
    if start.sharp().is_some() {
        return cut(flows, start, times_s, read);
    }
    let of = |tail, step| solution(flows, start, times_s, read, Accuracy { tail, step, most: usize::MAX });
    let (first, second) = rayon::join(|| of(1e-9, 8.0), || of(1e-10, 6.0));
    let (first, second) = (first?, second?);
    let error = differ(&first, &second);
    if error <= WANTED {
        return Ok((second, error));
    }
    match of(1e-12, 4.0) {
        Ok(third) => Ok((third.clone(), differ(&second, &third))),
        Err(NoAnswer::TooMuchWork) => Ok((second, error)),
        Err(other) => Err(other),
    }
}

/// What is read off of rods whose start is cut at a degree L.
///
/// What is cut reaches a mean late and small: the flow carries it from degree L down no faster than dl/dt ≈ −γ̇l/2, and
/// diffusion damps it by e^{−l(l+1)D_r dt}, in all by about e^{−D_r L²/γ̇}. L is raised by half until two solutions,
/// which also differ in their steps, differ by 4·10⁻¹² or less; that is their stated error.
fn cut(flows: &[(Frame, f64)], start: Start, times_s: &[f64], read: &Read) -> Result<(Vec<Vec<f64>>, f64), NoAnswer> {
    let motion = &flows[0].0.motion;
    let damped = motion.diffusivity * (MOST_CUT * MOST_CUT) as f64;
    let first = times_s.iter().copied().find(|time| *time > 0.0).unwrap_or(f64::INFINITY).min(flows[0].1);
    // What the largest degree leaves is seen beforehand, where finding it out takes minutes.
    if damped * first < 25.0 || damped < 80.0 * motion.strain.norm() {
        return Err(NoAnswer::TooMuchWork);
    }
    let of = |most, step| solution(flows, start, times_s, read, Accuracy { tail: 1e-10, step, most });
    let (mut most, mut step) = (32, 8.0);
    let mut before = of(most, step)?;
    while most < MOST_CUT {
        (most, step) = ((most + most / 2) & !1, 14.0 - step);
        let after = of(most, step)?;
        let error = differ(&before, &after);
        if error <= WANTED {
            return Ok((after, error));
        }
        before = after;
    }
    Err(NoAnswer::TooMuchWork)
}

fn solution(
    flows: &[(Frame, f64)],
    start: Start,
    times_s: &[f64],
    read: &Read,
    accuracy: Accuracy,
) -> Result<Vec<Vec<f64>>, NoAnswer> {
    let (mut all, mut begun, mut before) = (Vec::new(), 0.0, None::<Density>);
    for (at, (frame, duration_s)) in flows.iter().enumerate() {
        let end = if at + 1 == flows.len() { f64::INFINITY } else { begun + duration_s };
        let sharp = start.sharp().filter(|_| before.is_none());
        let (basis, unknowns) = match &before {
            None => start.unknowns(frame, accuracy.most)?,
            Some(density) => density.seen_from(frame)?,
        };
        let mut density = Density::new(frame, accuracy, basis, unknowns);
        let mut now = 0.0;
        // The highest degrees of a sharp start die first: steps grow as they are left out.
        let mut next =
            sharp.map_or(f64::INFINITY, |_| frame.motion.diffusivity.recip() / (accuracy.most as f64).powi(2));
        let mut go_to = |density: &mut Density, time: f64| {
            while next < time {
                density.advance(next - now)?;
                (now, next) = (next, 2.0 * next);
            }
            density.advance(time - now)?;
            (now, next) = (time, next.max(2.0 * time));
            Ok::<(), NoAnswer>(())
        };
        for time in times_s.iter().filter(|time| (begun..end).contains(*time)).map(|time| time - begun) {
            // d|ψ − ψ_steady|²/dt ≤ −2(6D_r − 3/2 of the largest rate of ΛD)|ψ − ψ_steady|²: below e⁻⁴⁵ they are one.
            if matches!(read, Read::Means) && frame.motion.least_decay() * time > 45.0 {
                all.push(settled::refined(frame)?.0.to_vec());
                continue;
            }
            go_to(&mut density, time)?;
            let mut values = density.read(read);
            if let (Some(projections), 0.0) = (sharp, time) {
                values[..3].copy_from_slice(&projections);
            }
            all.push(values);
        }
        if end.is_finite() {
            go_to(&mut density, *duration_s)?;
            before = Some(density);
        }
        begun = end;
    }
    Ok(all)
}

/// Means over the rods in the steady distribution.
///
/// Degrees and orders are raised until neither changes a mean by more than 4·10⁻¹²; the larger of the last changes is
/// the stated error.
///
/// # Errors
///
/// If there is no steady distribution, or it takes too much work.
pub fn steady(motion: &Motion) -> Result<Means, NoAnswer> {
    let (means, error) = settled::refined(&Frame::of(motion))?;
    Ok(Means::new(&means, error))
}

/// The largest difference of two solutions.
fn differ(a: &[Vec<f64>], b: &[Vec<f64>]) -> f64 {
    crate::worst(a.iter().zip(b).map(|(a, b)| crate::apart(a, b)))
}
