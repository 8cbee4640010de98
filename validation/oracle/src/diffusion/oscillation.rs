//! A flow that oscillates, L(t) = L cos(2πt/T + φ), by a Magnus integrator of order 4 without commutators (Blanes &
//! Moan 2006): a step is two steady flows, and its error is even in the step.

use super::frame::Frame;
use super::march::Read;
use super::{MEANS, Means, Motion, NoAnswer, Start, WANTED, found};
use std::f64::consts::TAU;

/// Steps of a period in the first solution.
const FEWEST: f64 = 32.0;

/// The largest number of flows in a solution, two a step.
const MOST: f64 = 50_000.0;

/// Means over the rods at `times_s` ≥ 0, in ascending order, in the flow of `motion` times cos(2πt/T + φ), with
/// T in s and φ in rad.
///
/// Solutions with ever twice as many steps are extrapolated (Richardson) until two differ by 4·10⁻¹² at most; that and
/// the largest error of the flows' own solutions are the stated error.
///
/// # Errors
///
/// As [`through`](super::through), and if no such number of steps is small enough.
pub fn oscillating(
    motion: &Motion,
    oscillation: [f64; 2],
    start: Start,
    times_s: &[f64],
) -> Result<Vec<Means>, NoAnswer> {
    // Of the last number of steps: its solution, and those without errors of the orders 4, 6, ….
    let mut before: Vec<Vec<Means>> = Vec::new();
    for doubling in 0.. {
        let flows = flows(motion, oscillation, times_s, FEWEST * 2f64.powi(doubling)).ok_or(NoAnswer::TooMuchWork)?;
        let (means, error) = found(&flows, start, times_s, &Read::Means)?;
        let mut row: Vec<Vec<Means>> = vec![means.iter().map(|means| Means::new(means, error)).collect()];
        for (k, coarse) in before.iter().take(4).enumerate() {
            row.push(row[k].iter().zip(coarse).map(|(fine, coarse)| extrapolated(fine, coarse, k)).collect());
        }
        if let (Some(best), Some(last)) = (row.last(), before.last()) {
            let off: Vec<f64> = best.iter().zip(last).map(|(a, b)| a.apart(b)).collect();
            if off.iter().all(|off| *off <= WANTED) {
                let stated = |(means, off): (&Means, f64)| Means { error: means.error + off, ..*means };
                return Ok(best.iter().zip(off).map(stated).collect());
            }
        }
        before = row;
    }
    unreachable!("the number of steps has an end")
}

/// Without the part of the error that is ∝ h^(4 + 2k).
fn extrapolated(fine: &Means, coarse: &Means, k: usize) -> Means {
    let weight = 1.0 / (2f64.powi(4 + 2 * k as i32) - 1.0);
    let mut means = Means::new(&[0.0; MEANS], 0.0);
    means.add(1.0 + weight, fine);
    means.add(-weight, coarse);
    Means { error: fine.error.max(coarse.error), ..means }
}

/// Steps that end at each time, at least `each` a period; `None` if they are too many.
fn flows(motion: &Motion, [period_s, phase]: [f64; 2], times_s: &[f64], each: f64) -> Option<Vec<(Frame, f64)>> {
    let frame = Frame::of(motion);
    // Nodes of Gauss in a step, and the weights of the first and the second in its first half.
    let third = 3f64.sqrt() / 6.0;
    let (nodes, weights) = ([0.5 - third, 0.5 + third], [0.5 + 2.0 * third, 0.5 - 2.0 * third]);
    let mut steps = Vec::new();
    let mut now = 0.0;
    for time in times_s {
        let count = (each / FEWEST) * (FEWEST * (time - now) / period_s).ceil();
        if steps.len() as f64 + 2.0 * count > MOST {
            return None;
        }
        let step_s = (time - now) / count;
        for k in 0..count as u64 {
            let [first, second] =
                nodes.map(|node| (phase + TAU * ((now + (k as f64 + node) * step_s) / period_s)).cos());
            let [more, less] = weights;
            for factor in [more * first + less * second, less * first + more * second] {
                steps.push((frame.times(factor, motion.diffusivity), 0.5 * step_s));
            }
        }
        now = *time;
    }
    // What follows the last time is not asked for.
    steps.push((frame, f64::INFINITY));
    Some(steps)
}
