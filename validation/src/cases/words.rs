//! The paper's words as tests: each claim with the place of its sentence, a number and a confidence.
//! How oscillations die is in `decay`.

use super::lab::{self, Sample, per_replica};
use crate::accept::Rule;
use crate::case::{About, Case, Effort, Evidence, Judges};
use shearbed::scene::{Orientation, Scene};

/// A change to every scene that the model runs; the expectation stays that of the unchanged scene.
type Mend = fn(&mut Scene);

pub fn cases() -> Vec<Case> {
    let about = |name, claim, source| About {
        name,
        judges: Judges::Statement,
        claim,
        source,
        equations: &["4"],
    };
    vec![
        Case::new(
            about(
                "period-unaffected",
                "\"The period of oscillation is practically unaffected by collisions or by differences in particle size\".",
                "Results, before Fig. 7; Fig. 6",
            ),
            (|_| {}) as Mend,
            vec![("r_e 5 % longer, time still in the old periods", |scene| {
                scene.particles.aspect_ratio *= 1.05
            })],
            period,
        ),
        Case::new(
            about(
                "hundred-rods-suffice",
                "\"The results did not change significantly when 100 or more particles were used\".",
                "Results, second paragraph",
            ),
            100 as Count,
            vec![("5 rods", 5)],
            enough_rods,
        ),
        Case::new(
            about(
                "steady-stays-put",
                "\"According to the model, the mean axial projections should remain constant after their steady state values are reached\".",
                "Results, before Fig. 5; Fig. 5",
            ),
            12.0 as Periods,
            vec![("before the steady state", 2.0)],
            stays_put,
        ),
        Case::new(
            about(
                "in-plane-rods",
                "Rods in the shear plane stay there, and do not disturb each other as Δt → 0: \"there should have been no collisions\".",
                "Results, the r_e = 3.96 experiment",
            ),
            90.0 as ThetaDeg,
            vec![("10° out of the plane", 80.0)],
            in_plane,
        ),
    ]
}

/// The frequency of X̄₁'s oscillation in 1/T, from groups of replicas.
fn period(mend: &Mend, effort: &Effort) -> Vec<Evidence> {
    let polydisperse: Mend = |scene| scene.particles.aspect_ratio_sd_percent = 3.6;
    let interacting: Mend = |scene| {
        lab::interaction(scene);
    };
    [
        ("unequal aspect ratios", polydisperse),
        ("collisions", interacting),
    ]
    .into_iter()
    .map(|(name, change)| {
        let mut scene = lab::free_scene(effort);
        change(&mut scene);
        scene.particles.count = 400;
        scene.time.periods = Some(4.0);
        // The outputs stay at the times of r_e = 11.6.
        let stretch = shearbed::jeffery::strain_per_period(scene.particles.aspect_ratio);
        mend(&mut scene);
        let stretch = shearbed::jeffery::strain_per_period(scene.particles.aspect_ratio) / stretch;
        let frequencies = per_replica(&scene, effort.pick(24, 200), |means| {
            let series: Vec<f64> = (0..=200).map(|output| means.at(output, 0)).collect();
            peak_frequency(&series, 50.0) / stretch
        });
        Evidence::new(
            format!("frequency of X̄₁ in 1/T, {name}"),
            Sample::of(&frequencies).is(
                2.0,
                0.04,
                0.01,
                "\"practically unaffected\": 2 %; |p_1| has the period T/2",
            ),
        )
    })
    .collect()
}

/// The frequency of the strongest line of a series near 2, per unit of time, with `per_unit` values each.
///
/// Slow changes are taken out by the mean over a full oscillation on either side, and the ends are tapered.
fn peak_frequency(series: &[f64], per_unit: f64) -> f64 {
    let half = (per_unit / 4.0) as usize;
    let inner = half..series.len() - half;
    let len = inner.len() as f64;
    let wave: Vec<(f64, f64)> = inner
        .clone()
        .map(|k| {
            let around = &series[k - half..=k + half];
            let mean = around.iter().sum::<f64>() / around.len() as f64;
            let taper = (std::f64::consts::PI * (k - half) as f64 / len).sin().powi(2);
            (k as f64 / per_unit, (series[k] - mean) * taper)
        })
        .collect();
    let power = |frequency: f64| {
        let (mut re, mut im) = (0.0, 0.0);
        for (time, value) in &wave {
            let (sin, cos) = (std::f64::consts::TAU * frequency * time).sin_cos();
            re += value * cos;
            im += value * sin;
        }
        re * re + im * im
    };
    let grid = (0..=1000).map(|k| 1.5 + f64::from(k) / 1000.0);
    grid.max_by(|a, b| power(*a).total_cmp(&power(*b)))
        .unwrap_or(f64::NAN)
}

/// Rods in the control volume.
type Count = usize;

/// X̄₁ with few rods less X̄₁ with 1000, at the same concentration.
fn enough_rods(count: &Count, effort: &Effort) -> Vec<Evidence> {
    let at_peaks = |count: usize, replicas: u64| {
        let mut scene = lab::interacting_scene(effort);
        scene.particles.count = count;
        scene.time.periods = Some(2.0);
        scene.time.outputs_per_period = Some(1);
        [1, 2].map(|output| Sample::of(&per_replica(&scene, replicas, |means| means.at(output, 0))))
    };
    let few = at_peaks(*count, effort.pick(30_000, 1_000_000) / *count as u64);
    let many = at_peaks(1000, effort.pick(40, 1000));
    few.into_iter()
        .zip(many)
        .zip([1, 2])
        .map(|((few, many), turns)| {
            let difference = Sample {
                mean: few.mean - many.mean,
                se: few.se.hypot(many.se),
                samples: few.samples.min(many.samples),
            };
            Evidence::new(
                format!("bias of X̄₁ at t/T = {turns}, {count} rods against 1000"),
                difference.is(0.0, 0.01, 0.003, "\"not significantly\": 0.01 of a rod length, less than a drawn line; rods near a face have fewer neighbours"),
            )
        })
        .collect()
}

/// When the steady state is taken to be reached, in T.
type Periods = f64;

/// X̄_i over two periods less X̄_i over the two periods before, in a dense suspension.
fn stays_put(from: &Periods, effort: &Effort) -> Vec<Evidence> {
    let mut scene = lab::interacting_scene(effort);
    lab::interaction(&mut scene).concentration_per_cm3 = 500.0;
    scene.time.periods = Some(from + 4.0);
    scene.time.outputs_per_period = Some(20);
    let start = (*from as usize) * 20;
    (0..3)
        .map(|axis| {
            let drift = per_replica(&scene, effort.pick(40, 600), |means| {
                means.over(start + 40..start + 80, axis) - means.over(start..start + 40, axis)
            });
            Evidence::new(
                format!("drift of X̄_{} over two periods", axis + 1),
                Sample::of(&drift).is(
                    0.0,
                    0.004,
                    0.002,
                    "\"constant\": less than 0.004 of a rod length in two periods",
                ),
            )
        })
        .collect()
}

/// θ of every rod at first.
type ThetaDeg = f64;

fn in_plane(theta_deg: &ThetaDeg, effort: &Effort) -> Vec<Evidence> {
    let run = |steps_per_period: u64| {
        let mut scene = lab::interacting_scene(effort);
        scene.particles.orientation = Orientation::Given {
            phi_deg: 20.0,
            theta_deg: *theta_deg,
        };
        scene.particles.aspect_ratio = 3.96;
        scene.particles.aspect_ratio_sd_percent = 3.0;
        lab::interaction(&mut scene).concentration_per_cm3 = 500.0;
        scene.time.steps_per_period = Some(steps_per_period);
        scene.time.outputs_per_period = Some(5);
        let mut free = scene.clone();
        lab::interaction(&mut free).alpha = 0.0;
        // Every rod's own difference, not that of the means.
        let mut out_of_plane = 0.0f64;
        let mut apart = 0.0;
        let (mut with, mut without) = (lab::suspension(&scene, 0), lab::stepped(&free, 0));
        for _ in 0..steps_per_period {
            if with.step().is_err() || without.step().is_err() {
                return (f64::NAN, f64::NAN);
            }
            out_of_plane = with
                .directions()
                .iter()
                .map(|p| p.z.abs())
                .fold(out_of_plane, f64::max);
        }
        for (a, b) in with.directions().iter().zip(&without.directions()) {
            apart += a.cross(b).norm() / 100.0;
        }
        (out_of_plane, apart)
    };
    let (coarse, fine) = (run(400), run(6400));
    vec![
        Evidence::new(
            "largest |p_3| within one period",
            Rule::within(
                coarse.0.max(fine.0),
                1e-9,
                "cos 90° is 6·10⁻¹⁷; kicks ∝ 1/r may grow it",
            ),
        ),
        Evidence::new(
            "mean angle in rad between rods with and without interactions after one period, 6400 steps",
            Rule::within(
                fine.1,
                0.25 * coarse.1.max(1e-3),
                "at most a quarter of that at 400 steps: the straight turn's error is of first order, a sixteenth",
            ),
        ),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_peak_of_a_damped_wave_on_a_slope_is_found() {
        for frequency in [1.9, 2.0, 2.11] {
            let series: Vec<f64> = (0..=200)
                .map(|k| f64::from(k) / 50.0)
                .map(|t| {
                    0.3 - 0.02 * t + 0.2 * (-0.4 * t).exp() * (std::f64::consts::TAU * frequency * t).cos()
                })
                .collect();
            let found = peak_frequency(&series, 50.0);
            assert!((found - frequency).abs() < 0.01, "{found} for {frequency}");
        }
    }
}
