//! The contact rule in double precision, correct or with a known mistake: for condition numbers and for the effect of
//! mistakes.
//!
//! The rule changes only the component along the contact line ℓ ∝ p_a × p_b: ṗ′ = ṗ + ℓ (v̄ − v)/r for each rod, v =
//! ℓ·V_c the velocity of its contact point x + r p along ℓ, v̄ the mean of both.

use super::LENGTH_MM;
use nalgebra::{Matrix3, Vector3};

/// What may be wrong; [`RIGHT`] has the right parts.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Variant {
    /// The factors on the change of ṗ of a and of b.
    pub(crate) kick: [f64; 2],
    /// The arms in rod lengths that stand for the right ones; `None` for no contact.
    pub(crate) arms: fn([f64; 2]) -> Option<[f64; 2]>,
    /// L for the right one.
    pub(crate) gradient: fn(&Matrix3<f64>) -> Matrix3<f64>,
    /// Λ from r_e.
    pub(crate) shape: fn(f64) -> f64,
    /// The factor on L x of a rod's centre in V_c.
    pub(crate) centre: f64,
    /// The direction of the contact line from p_a, p_b and x_b − x_a.
    pub(crate) line: fn([Vector3<f64>; 3]) -> Vector3<f64>,
    /// φ̇′ and θ̇′ from φ, θ and ṗ′.
    pub(crate) turned: fn([f64; 2], &Vector3<f64>) -> [f64; 2],
}

pub(crate) const RIGHT: Variant = Variant {
    kick: [1.0; 2],
    arms: Some,
    gradient: |l| *l,
    shape: |r| (r * r - 1.0) / (r * r + 1.0),
    centre: 1.0,
    line: |[a, b, _]| a.cross(&b),
    turned: |[phi, theta], rate| {
        let [around, across] = within([phi, theta], rate);
        [around / theta.sin(), across * theta.cos() - rate.z * theta.sin()]
    },
};

/// The components of ṗ′ in the shear plane, across φ and along it.
pub(crate) fn within([phi, _]: [f64; 2], rate: &Vector3<f64>) -> [f64; 2] {
    [-rate.x * phi.sin() + rate.y * phi.cos(), rate.x * phi.cos() + rate.y * phi.sin()]
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
        Some(step_s) => {
            let [phi, theta] = [p.y.atan2(p.x), p.x.hypot(p.y).atan2(p.z)];
            let [phi_rate, theta_rate] = (variant.turned)([phi, theta], &rate);
            vec![phi_rate, theta_rate, phi + phi_rate * step_s, theta + theta_rate * step_s]
        }
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
    let l = (variant.gradient)(gradient);
    let (w, d) = (0.5 * (l - l.transpose()), 0.5 * (l + l.transpose()));
    let rod = |of: &[f64]| {
        let (x, p) = (Vector3::from_row_slice(&of[..3]), Vector3::from_row_slice(&of[3..6]).normalize());
        let free = w * p + (variant.shape)(of[6]) * (d * p - p * p.dot(&(d * p)));
        (x, p, free)
    };
    let (a, b) = (rod(&pair[..7]), rod(&pair[7..14]));
    let line = (variant.line)([a.1, b.1, b.0 - a.0]).normalize();
    let Some([arm_a, arm_b]) = (variant.arms)(geometry(pair).arms.map(|arm| arm / LENGTH_MM)) else {
        return [(a.1, a.2), (b.1, b.2)];
    };
    let [arm_a, arm_b] = [arm_a, arm_b].map(|arm| arm * LENGTH_MM);
    let along = |(x, _, free): &(Vector3<f64>, Vector3<f64>, Vector3<f64>), arm: f64| {
        line.dot(&(l * x * variant.centre + free * arm))
    };
    let (v_a, v_b) = (along(&a, arm_a), along(&b, arm_b));
    let mean = 0.5 * (v_a + v_b);
    let kick = variant.kick;
    [(a.1, a.2 + line * (kick[0] * (mean - v_a) / arm_a)), (b.1, b.2 + line * (kick[1] * (mean - v_b) / arm_b))]
}
