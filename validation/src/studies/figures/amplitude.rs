//! A₁, the amplitude of the oscillation of X̄₁ (Figs 7 to 10).
//!
//! The paper defines A₁ in the drawing of Fig. 7, which is not at hand. Here A₁ is the height of a maximum of X̄₁
//! above the mean of the minima on its two sides, at the time of the maximum. The text allows this interpretation:
//! it gives free rods of one size an amplitude of "approximately 1/2", and half of this height would not.

use super::run::{Run, with_band};
use super::*;

/// A₁ against t/T, with a 95 % band from the same heights in every replica.
///
/// The maxima of X̄₁ lie near t = kT/2, because p ≡ −p, and the minima half-way between them. Each is searched
/// for in the mean over all replicas, up to T/8 off, so that a replica's noise does not choose its own extremes.
pub(super) fn amplitude(run: &Run, label: impl Into<String>) -> Curve {
    let times = run.times();
    let extremes = extremes(&times, &run.curve("x1", "").y);
    let heights = (0..extremes.len()).step_by(2).map(|at| {
        let beside = [at.checked_sub(1), Some(at + 1)];
        let minima: Vec<usize> = (beside.into_iter().flatten()).filter_map(|k| extremes.get(k).copied()).collect();
        let height = run.sample("x1", |x1| {
            let below: f64 = minima.iter().map(|k| x1(*k)).sum();
            x1(extremes[at]) - below / minima.len() as f64
        });
        (times[extremes[at]], height)
    });
    with_band(label, heights)
}

/// The outputs of maxima and minima, alternating, the first a maximum.
fn extremes(times: &[f64], mean: &[f64]) -> Vec<usize> {
    let last = times.last().copied().unwrap_or(0.0);
    (0u32..)
        .map(|k| (f64::from(k) / 4.0, if k % 2 == 0 { 1.0 } else { -1.0 }))
        .take_while(|(centre, _)| *centre <= last)
        .filter_map(|(centre, sign)| {
            let near = (0..times.len()).filter(|k| (times[*k] - centre).abs() <= 0.125);
            near.max_by(|a, b| (sign * mean[*a]).total_cmp(&(sign * mean[*b])))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    #[test]
    fn extremes_of_a_damped_wave_are_found() {
        let times: Vec<f64> = (0..=100).map(|k| f64::from(k) / 50.0).collect();
        let wave = |t: &f64| 0.3 + 0.2 * (-0.2 * t).exp() * (2.0 * TAU * (t - 0.02)).cos();
        let mean: Vec<f64> = times.iter().map(wave).collect();
        let measured: Vec<f64> = extremes(&times, &mean).iter().map(|k| times[*k]).collect();
        // 0.27, 0.77 and so on lie between two outputs; damping moves maxima to a slightly earlier time.
        let expected = [0.02, 0.26, 0.52, 0.76, 1.02, 1.26, 1.52, 1.76, 2.0];
        assert_eq!(measured.len(), expected.len());
        for (measured, expected) in measured.iter().zip(expected) {
            assert!((measured - expected).abs() < 0.025, "{measured} {expected}");
        }
    }
}
