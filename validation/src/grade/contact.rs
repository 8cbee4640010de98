//! What known mistakes make of two rods in contact (A.7 to A.14).
//!
//! The rule changes what lies along the contact line ℓ ∝ p_a × p_b alone: ṗ′ = ṗ + ℓ (v̄ − v)/r for each rod, v = ℓ·V_c the
//! velocity of its contact point x + r p along ℓ, v̄ the mean of both.

use super::answer::Answer;
use super::diagnosis::said;
use crate::problems::LoadedProblem;
use nalgebra::{Matrix3, Vector3};

/// What is made of the difference v̄ − v, and of ṗ′ in angles.
struct Mistake {
    name: &'static str,
    /// The factor on the change of ṗ.
    kick: f64,
    printed: bool,
}

const MISTAKES: [Mistake; 4] = [
    Mistake {
        name: "a kick with the wrong sign",
        kick: -1.0,
        printed: false,
    },
    Mistake {
        name: "no kick",
        kick: 0.0,
        printed: false,
    },
    Mistake {
        name: "a kick to the other rod's velocity, not to the mean",
        kick: 2.0,
        printed: false,
    },
    Mistake {
        name: "A.13 as printed",
        kick: 1.0,
        printed: true,
    },
];

/// Which mistake's answer it is.
pub(super) fn diagnose(loaded: &LoadedProblem, answer: &Answer, nearer_than: f64) -> Option<String> {
    let inputs = loaded.inputs.as_ref()?;
    let l = &loaded.problem.gradient_per_s;
    let gradient = Matrix3::from_fn(|i, j| l[i][j]);
    let of_mistake = |mistake: &Mistake| {
        let mut largest: f64 = 0.0;
        for (values, pair) in answer.rows.iter().zip(&inputs.rows) {
            let rates = rates(&gradient, &pair[1..], mistake.kick);
            let half = values.len() / 2;
            for (k, (p, rate)) in rates.iter().enumerate() {
                let expected = match loaded.problem.time_step_s {
                    None => rate.as_slice().to_vec(),
                    Some(step_s) => angles(p, rate, step_s, mistake.printed),
                };
                let found = values.get(k * half..(k + 1) * half)?;
                let square = |of: &dyn Fn(usize) -> f64| (0..half).map(|i| of(i).powi(2)).sum::<f64>();
                let off = square(&|i| found[i] - expected[i]) / square(&|i| expected[i]);
                largest = largest.max(if off.is_nan() { f64::INFINITY } else { off.sqrt() });
            }
        }
        Some((largest, mistake.name.to_owned()))
    };
    let applies = |mistake: &&Mistake| !mistake.printed || loaded.problem.time_step_s.is_some();
    let near = MISTAKES.iter().filter(applies).filter_map(of_mistake);
    said(
        near.filter(|(distance, _)| *distance <= nearer_than).collect(),
        loaded.problem.tolerance,
    )
}

/// p and ṗ′ in 1/s of both rods; of each centre, axis and r_e are given.
fn rates(gradient: &Matrix3<f64>, pair: &[f64], kick: f64) -> [(Vector3<f64>, Vector3<f64>); 2] {
    let (w, d) = (
        0.5 * (gradient - gradient.transpose()),
        0.5 * (gradient + gradient.transpose()),
    );
    let rod = |of: &[f64]| {
        let (x, p, r_e) = (
            Vector3::from_row_slice(&of[..3]),
            Vector3::from_row_slice(&of[3..6]),
            of[6],
        );
        let shape = (r_e * r_e - 1.0) / (r_e * r_e + 1.0);
        let free = w * p + shape * (d * p - p * p.dot(&(d * p)));
        (x, p, free)
    };
    let (a, b) = (rod(&pair[..7]), rod(&pair[7..14]));
    let line = a.1.cross(&b.1).normalize();
    // The feet of the common normal: (x_b + r_b p_b − x_a − r_a p_a) ∥ ℓ.
    let (apart, cosine) = (b.0 - a.0, a.1.dot(&b.1));
    let sine_squared = 1.0 - cosine * cosine;
    let arm_a = (apart.dot(&a.1) - cosine * apart.dot(&b.1)) / sine_squared;
    let arm_b = (cosine * apart.dot(&a.1) - apart.dot(&b.1)) / sine_squared;
    let along = |(x, _, free): &(Vector3<f64>, Vector3<f64>, Vector3<f64>), arm: f64| {
        line.dot(&(gradient * x + free * arm))
    };
    let (v_a, v_b) = (along(&a, arm_a), along(&b, arm_b));
    let mean = 0.5 * (v_a + v_b);
    [
        (a.1, a.2 + line * (kick * (mean - v_a) / arm_a)),
        (b.1, b.2 + line * (kick * (mean - v_b) / arm_b)),
    ]
}

/// φ̇′, θ̇′ in 1/s by A.13, corrected or as printed, and φ and θ in rad after a step by A.14.
fn angles(p: &Vector3<f64>, rate: &Vector3<f64>, step_s: f64, printed: bool) -> Vec<f64> {
    let (phi, theta) = (p.y.atan2(p.x), p.x.hypot(p.y).atan2(p.z));
    let around = -rate.x * phi.sin() + rate.y * phi.cos();
    let across = rate.x * phi.cos() + rate.y * phi.sin();
    let (phi_rate, theta_rate) = match printed {
        false => (around / theta.sin(), across * theta.cos() - rate.z * theta.sin()),
        true => (around, across * theta.sin() - rate.z * theta.cos()),
    };
    vec![
        phi_rate,
        theta_rate,
        phi + phi_rate * step_s,
        theta + theta_rate * step_s,
    ]
}
