//! The exact distribution of rods that diffuse, with a mistake.

use super::columns::fourth_of;
use super::{Near, apart, has_trace_one};
use crate::methods::tensors::fourth::PAIRS;
use crate::methods::tensors::{Model, Parts, shear_rate};
use crate::oracle::diffusion::{Means, Motion, strain_rate_per_s};
use crate::serve::grade::answer::Answer;
use crate::serve::problems::Problem;
use nalgebra::Matrix3;
use rayon::prelude::*;
use std::f64::consts::TAU;

/// The curves of the distribution with a wrong D_r, or a flow that oscillates wrongly.
pub(super) fn of_wrong_distribution(problem: &Problem, answer: &Answer, most: f64) -> Vec<Near> {
    let Some(rods) = problem.diffusing().filter(|_| problem.d_r_per_s.is_some()) else { return Vec::new() };
    let rate = strain_rate_per_s(problem.gradient_per_s);
    let factors = [(2.0, "twice the D_r"), (0.5, "half the D_r"), (rate, "D_r γ̇ for D_r, as if it were a C_I")];
    let factors = factors.into_iter().filter(|(factor, _)| *factor > 0.0 && *factor != 1.0);
    let own = problem.oscillation();
    let mut wrong: Vec<(Motion, Option<[f64; 2]>, &str)> =
        factors.map(|(factor, name)| (Motion { diffusivity: factor * rods.diffusivity, ..rods }, own, name)).collect();
    if let Some([period_s, _]) = own {
        wrong.extend([
            (rods, Some([period_s, -0.25 * TAU]), "sin 2πt/T for cos 2πt/T"),
            (rods, None, "a flow that does not oscillate"),
            (rods, Some([TAU * period_s, 0.0]), "cos t/T for cos 2πt/T"),
            (rods, Some([2.0 * period_s, 0.0]), "twice the period"),
            (rods, Some([0.5 * period_s, 0.0]), "half the period"),
        ]);
    }
    let of = |(rods, oscillation, name): &(Motion, Option<[f64; 2]>, &str)| {
        let distance = off(problem, rods, *oscillation, &answer.rows, most)?;
        Some(Near { name: format!("the distribution with {name}"), ..Near::new(distance, name) })
    };
    wrong.par_iter().filter_map(of).collect()
}

/// The distance of an answer from the distribution with these parts; `None` if it is larger than `most`, or no motion
/// of rods has these parts.
pub(super) fn from_exact(problem: &Problem, rows: &[Vec<f64>], parts: &Parts, most: f64) -> Option<f64> {
    let Model::FolgarTucker { c_i } = parts.model else { return None };
    let gradient = parts.spin + parts.strain;
    let c_i = c_i * parts.speed / shear_rate(&parts.strain);
    let of_rods = parts.of_fourth == 2.0 * parts.of_strain && parts.decay == 3.0 && parts.pairs == 1.0;
    if !of_rods
        || parts.spun != [1.0, -1.0]
        || parts.stretched != [1.0, 1.0]
        || parts.by_component
        || parts.off_diagonal != 0.0
        || parts.of_strain.abs() > 1.0
        || !(1e-9..=1e9).contains(&c_i)
        || !has_trace_one(rows, most)
    {
        return None;
    }
    // Saves time: at rest the rate of a_ij, which is exact with all a_ijkl, is 0.
    if let (true, Some(fourth)) = (problem.is_steady(), fourth_of(problem, &rows[0]))
        && parts.rate(&fourth.contract(&Matrix3::identity()), &fourth).amax() > 100.0 * most * gradient.norm()
    {
        return None;
    }
    // Where Λ = 1 the square of any large aspect ratio will do.
    let ratio = ((1.0 + parts.of_strain) / (1.0 - parts.of_strain)).sqrt().clamp(1e-100, 1e100);
    let motion = Motion::new(std::array::from_fn(|i| std::array::from_fn(|j| gradient[(i, j)])), ratio, c_i);
    off(problem, &motion, problem.oscillation(), rows, most)
}

/// The distance of an answer from the means of rods that move so; `None` if it is larger than `most`.
fn off(problem: &Problem, motion: &Motion, oscillation: Option<[f64; 2]>, rows: &[Vec<f64>], most: f64) -> Option<f64> {
    let picked =
        |means: &Means| if rows[0].len() == PAIRS.len() { means.second.to_vec() } else { means.fourth.to_vec() };
    let near = |count: usize| {
        let all = problem.distribution(motion, count, oscillation).ok()?;
        Some(apart(rows, &all.iter().map(picked).collect::<Vec<_>>())).filter(|off| *off <= most)
    };
    let count = problem.times_s.len();
    if count > 1 {
        // Saves time: most are far already at the first time.
        near(1)?;
    }
    near(count)
}
