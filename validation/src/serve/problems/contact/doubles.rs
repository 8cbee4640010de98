//! The contact rule in double precision, correct or with a known mistake: for condition numbers and for the effect of
//! mistakes.
//!
//! The rule changes only the component along the contact line ℓ ∝ p_a × p_b: ṗ′ = ṗ + ℓ (v̄ − v)/r for each rod, v =
//! ℓ·V_c the velocity of its contact point x + r p along ℓ, v̄ the mean of both.

use super::LENGTH_MM;
use nalgebra::{Matrix3, Vector3};

#[derive(Clone, Copy, Debug)]
pub(crate) struct Variant {
    /// The factor on the change of ṗ.
    pub(crate) kick: f64,
    /// The arms in rod lengths that stand for the right ones; `None` for no contact.
    pub(crate) arms: fn([f64; 2]) -> Option<[f64; 2]>,
    /// True for A.13 as in the text at hand.
    pub(crate) printed: bool,
}

/// ṗ′ in 1/s for rods a and b of `pair` (centre in mm, axis and r_e of each), or with Δt in s the four numbers of A.13
/// and A.14.
pub(crate) fn answers(
    gradient_per_s: &Matrix3<f64>,
    pair: &[f64],
    step_s: Option<f64>,
    variant: Variant,
) -> [Vec<f64>; 2] {
    rates(gradient_per_s, pair, variant).map(|(p, rate)| match step_s {
        None => rate.as_slice().to_vec(),
        Some(step_s) => angles(&p, &rate, step_s, variant.printed),
    })
}

/// The place of nearest approach of two rods' lines.
pub(super) struct Geometry {
    /// The sine of the angle between the lines.
    pub(super) sine: f64,
    /// The signed arms, mm.
    pub(super) arms: [f64; 2],
}

/// The feet of the common normal: (x_b + r_b p_b − x_a − r_a p_a) ∥ ℓ.
pub(super) fn geometry(pair: &[f64]) -> Geometry {
    let [a, b] = [3, 10].map(|at| Vector3::from_row_slice(&pair[at..at + 3]).normalize());
    let apart = Vector3::from_fn(|i, _| pair[7 + i] - pair[i]);
    let cosine = a.dot(&b);
    let sine_squared = 1.0 - cosine * cosine;
    let arm_a = (apart.dot(&a) - cosine * apart.dot(&b)) / sine_squared;
    let arm_b = (cosine * apart.dot(&a) - apart.dot(&b)) / sine_squared;
    Geometry { sine: sine_squared.sqrt(), arms: [arm_a, arm_b] }
}

/// p and ṗ′ in 1/s of both rods; `pair` has centre, axis and r_e of each.
fn rates(gradient: &Matrix3<f64>, pair: &[f64], variant: Variant) -> [(Vector3<f64>, Vector3<f64>); 2] {
    let (w, d) = (0.5 * (gradient - gradient.transpose()), 0.5 * (gradient + gradient.transpose()));
    let rod = |of: &[f64]| {
        let (x, p, r_e) = (Vector3::from_row_slice(&of[..3]), Vector3::from_row_slice(&of[3..6]).normalize(), of[6]);
        let shape = (r_e * r_e - 1.0) / (r_e * r_e + 1.0);
        let free = w * p + shape * (d * p - p * p.dot(&(d * p)));
        (x, p, free)
    };
    let (a, b) = (rod(&pair[..7]), rod(&pair[7..14]));
    let line = a.1.cross(&b.1).normalize();
    let Some([arm_a, arm_b]) = (variant.arms)(geometry(pair).arms.map(|arm| arm / LENGTH_MM)) else {
        return [(a.1, a.2), (b.1, b.2)];
    };
    let [arm_a, arm_b] = [arm_a, arm_b].map(|arm| arm * LENGTH_MM);
    let along =
        |(x, _, free): &(Vector3<f64>, Vector3<f64>, Vector3<f64>), arm: f64| line.dot(&(gradient * x + free * arm));
    let (v_a, v_b) = (along(&a, arm_a), along(&b, arm_b));
    let mean = 0.5 * (v_a + v_b);
    [
        (a.1, a.2 + line * (variant.kick * (mean - v_a) / arm_a)),
        (b.1, b.2 + line * (variant.kick * (mean - v_b) / arm_b)),
    ]
}

/// φ̇′, θ̇′ in 1/s by A.13, corrected or as in the text, and φ and θ in rad after a step by A.14.
fn angles(p: &Vector3<f64>, rate: &Vector3<f64>, step_s: f64, printed: bool) -> Vec<f64> {
    let (phi, theta) = (p.y.atan2(p.x), p.x.hypot(p.y).atan2(p.z));
    let around = -rate.x * phi.sin() + rate.y * phi.cos();
    let across = rate.x * phi.cos() + rate.y * phi.sin();
    let (phi_rate, theta_rate) = if !printed {
        (around / theta.sin(), across * theta.cos() - rate.z * theta.sin())
    } else {
        (around, across * theta.sin() - rate.z * theta.cos())
    };
    vec![phi_rate, theta_rate, phi + phi_rate * step_s, theta + theta_rate * step_s]
}
