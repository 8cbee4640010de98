//! Rods with rotary diffusion: the exact distribution of directions of infinitely many rods in any steady flow.
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
mod settled;
mod start;

#[cfg(test)]
mod tests;

pub use means::Means;
pub use operator::{Motion, strain_rate_per_s};
pub use start::Start;

use frame::Frame;
use march::{Accuracy, Density};
use means::MEANS;
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

/// Means over the rods at `times_s` ≥ 0, in ascending order.
///
/// Their stated error is the largest difference between two solutions; the second has a ten times smaller tail of
/// harmonics and shorter steps. It is an upper estimate of the error of the second, which is returned. If it is above
/// 4·10⁻¹², a third solution follows, unless that takes too much work. A start that no number of harmonics resolves is
/// cut at a degree: see `cut`.
///
/// # Errors
///
/// If two solutions take too much work, or the start is neither smooth nor one that is cut.
pub fn at(motion: &Motion, start: Start, times_s: &[f64]) -> Result<Vec<Means>, NoAnswer> {
    let frame = Frame::of(motion);
    if start.sharp().is_some() {
        return cut(&frame, start, times_s);
    }
    let of = |tail, step| solution(&frame, start, times_s, Accuracy { tail, step, most: usize::MAX });
    let (first, second) = rayon::join(|| of(1e-9, 8.0), || of(1e-10, 6.0));
    let (first, second) = (first?, second?);
    let error = differ(&first, &second);
    if error <= WANTED {
        return Ok(all(&second, error));
    }
    match of(1e-12, 4.0) {
        Ok(third) => Ok(all(&third, differ(&second, &third))),
        Err(NoAnswer::TooMuchWork) => Ok(all(&second, error)),
        Err(other) => Err(other),
    }
}

/// Means over the rods of a start whose harmonics are cut at a degree L.
///
/// What is cut reaches a mean late and small: the flow carries it from degree L down no faster than dl/dt ≈ −γ̇l/2, and
/// diffusion damps it by e^{−l(l+1)D_r dt}, in all by about e^{−D_r L²/γ̇}. L is raised by half until two solutions,
/// which also differ in their steps, differ by 4·10⁻¹² or less; that is their stated error.
fn cut(frame: &Frame, start: Start, times_s: &[f64]) -> Result<Vec<Means>, NoAnswer> {
    let motion = &frame.motion;
    let damped = motion.diffusivity * (MOST_CUT * MOST_CUT) as f64;
    let first = times_s.iter().copied().find(|time| *time > 0.0).unwrap_or(f64::INFINITY);
    // What the largest degree leaves is seen beforehand, where finding it out takes minutes.
    if damped * first < 25.0 || damped < 80.0 * motion.strain.norm() {
        return Err(NoAnswer::TooMuchWork);
    }
    let of = |most, step| solution(frame, start, times_s, Accuracy { tail: 1e-10, step, most });
    let (mut most, mut step) = (32, 8.0);
    let mut before = of(most, step)?;
    while most < MOST_CUT {
        (most, step) = ((most + most / 2) & !1, 14.0 - step);
        let after = of(most, step)?;
        let error = differ(&before, &after);
        if error <= WANTED {
            return Ok(all(&after, error));
        }
        before = after;
    }
    Err(NoAnswer::TooMuchWork)
}

fn solution(frame: &Frame, start: Start, times_s: &[f64], accuracy: Accuracy) -> Result<Vec<[f64; MEANS]>, NoAnswer> {
    let (basis, unknowns) = start.unknowns(frame, accuracy.most)?;
    let mut density = Density::new(frame, accuracy, basis, unknowns);
    let mut now = 0.0;
    let mut all = Vec::new();
    let mut left = times_s;
    if let (Some(projections), [0.0, rest @ ..]) = (start.sharp(), left) {
        let mut means = density.means();
        means[..3].copy_from_slice(&projections);
        all.push(means);
        left = rest;
    }
    // The highest degrees of a sharp start die first: steps grow as they are left out.
    let mut next =
        start.sharp().map_or(f64::INFINITY, |_| frame.motion.diffusivity.recip() * (accuracy.most as f64).powi(-2));
    for time in left {
        // d|ψ − ψ_steady|²/dt ≤ −2(6D_r − 3/2 of the largest rate of ΛD)|ψ − ψ_steady|²: the difference is below e⁻⁴⁵.
        if frame.motion.least_decay() * time > 45.0 {
            all.push(settled::refined(frame)?.0);
            continue;
        }
        while next < *time {
            density.advance(next - now)?;
            (now, next) = (next, 2.0 * next);
        }
        density.advance(time - now)?;
        (now, next) = (*time, next.max(2.0 * time));
        all.push(density.means());
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

fn all(means: &[[f64; MEANS]], error: f64) -> Vec<Means> {
    means.iter().map(|means| Means::new(means, error)).collect()
}

/// The largest difference of two solutions.
fn differ(a: &[[f64; MEANS]], b: &[[f64; MEANS]]) -> f64 {
    a.iter().zip(b).map(|(a, b)| apart(a, b)).fold(0.0, f64::max)
}

fn apart(a: &[f64; MEANS], b: &[f64; MEANS]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}
