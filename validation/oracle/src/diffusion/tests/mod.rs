//! Each check is a function of the model that it judges, and fails for the right model with a mistake in it.

mod flows;
mod grid;
mod in_time;
mod laws;
mod of_operator;
mod orbits;
mod oscillation;
mod published;
mod sharp;
mod steady;

use super::{Means, Motion, Start, at, steady};
use crate::apart;
use crate::reference::isotropic::{PAIRS, QUADRUPLES};
use nalgebra::Matrix3;
use std::fmt::Debug;

/// u₂ = G x₁ with G = 1/s.
const COUETTE: [[f64; 3]; 3] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0; 3]];
/// A flow with no symmetry and no trace.
const ASKEW: [[f64; 3]; 3] = [[0.3, -0.5, 0.1], [0.8, 0.1, -0.2], [0.4, 0.6, -0.4]];

fn mistakes(motion: Motion) -> [(&'static str, Motion); 3] {
    [
        ("the vorticity's sign", Motion { spin: -motion.spin, ..motion }),
        ("twice D_r", Motion { diffusivity: 2.0 * motion.diffusivity, ..motion }),
        ("Λ a tenth too large", Motion { strain: 1.1 * motion.strain, ..motion }),
    ]
}

/// Holds an error below `allowed` for the right motion, and above `seen` for each mistake that can show.
fn judge(what: impl Debug, motion: Motion, error: impl Fn(&Motion) -> f64, allowed: f64, seen: f64) {
    assert!(error(&motion) < allowed, "{what:?}: {:e}", error(&motion));
    for (name, wrong) in mistakes(motion).into_iter().filter(|(_, wrong)| *wrong != motion) {
        assert!(error(&wrong) > seen, "{what:?}: {name}: {:e}", error(&wrong));
    }
}

fn matrix(second: [f64; 6]) -> Matrix3<f64> {
    Matrix3::from_fn(|i, j| {
        let pair = (i.min(j), i.max(j));
        second[PAIRS.iter().position(|p| *p == pair).unwrap()]
    })
}

/// a_ijkl, indices from 0.
fn entry(fourth: &[f64; 15], indices: [usize; 4]) -> f64 {
    let mut sorted = indices.map(|i| i + 1);
    sorted.sort_unstable();
    fourth[QUADRUPLES.iter().position(|q| *q == sorted).unwrap()]
}

/// Σ_kl a_ijkl D_kl.
fn contracted(fourth: [f64; 15], d: &Matrix3<f64>) -> Matrix3<f64> {
    Matrix3::from_fn(|i, j| (0..9).map(|n| entry(&fourth, [i, j, n / 3, n % 3]) * d[(n / 3, n % 3)]).sum())
}

/// da_ij/dt by the equation of the second moments (Folgar & Tucker 1984, Advani & Tucker 1987), which needs a_ijkl and
/// is exact: W a − a W + Λ(D a + a D − 2 D:a₄) + 2D_r(1 − 3a).
fn rate(motion: &Motion, means: &Means) -> Matrix3<f64> {
    let (a, w, d) = (matrix(means.second), motion.spin.cross_matrix(), motion.strain);
    w * a - a * w + d * a + a * d - 2.0 * contracted(means.fourth, &d)
        + 2.0 * motion.diffusivity * (Matrix3::identity() - 3.0 * a)
}
