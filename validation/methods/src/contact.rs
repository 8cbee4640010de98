//! The contact rule in double precision, correct or with a known mistake: for condition numbers and for the effect of
//! mistakes.
//!
//! The rule changes only the component along the contact line ℓ ∝ p_a × p_b: ṗ′ = ṗ + ℓ (v̄ − v)/r for each rod, v =
//! ℓ·V_c the velocity of its contact point x + r p along ℓ, v̄ the mean of both.

use nalgebra::{Matrix3, Vector3};

/// The length of the paper's rods, mm.
pub const LENGTH_MM: f64 = 0.72;

/// φ̇′ or θ̇′ from φ, θ and ṗ′.
pub type AngleRate = fn([f64; 2], &Vector3<f64>) -> f64;

/// A vector of each rod.
pub type Both = [Vector3<f64>; 2];

/// What may be wrong; [`RIGHT`] has the right parts.
#[derive(Clone, Copy, Debug)]
pub struct Variant {
    /// The factors on the change of ṗ of a and of b.
    pub kick: [f64; 2],
    /// The arms in rod lengths from those of the right rule; `None` for no contact.
    pub arms: fn([f64; 2]) -> Option<[f64; 2]>,
    /// The arms in mm from d·p_a, d·p_b and p_a·p_b, d = x_b − x_a in mm.
    pub feet: fn([f64; 3]) -> [f64; 2],
    /// By what the changes of velocity are divided, mm, from the arms in mm.
    pub divisors: fn([f64; 2]) -> [f64; 2],
    /// True if ṗ′ is V′_r, not divided by r.
    pub undivided: bool,
    /// L for the right one.
    pub gradient: fn(&Matrix3<f64>) -> Matrix3<f64>,
    /// L for the right one in L x alone.
    pub carrying: fn(&Matrix3<f64>) -> Matrix3<f64>,
    /// The factors on W p, Λ D p and Λ p (p·D p) in ṗ.
    pub parts: [f64; 3],
    /// Λ of both rods from their r_e.
    pub shapes: fn([f64; 2]) -> [f64; 2],
    /// The place, mm, at which L x counts in V_c, from a rod's centre and its arm, a vector.
    pub place: fn([Vector3<f64>; 2]) -> Vector3<f64>,
    /// The factor on ṗ r in V_c.
    pub turning: f64,
    /// What is taken off V′_c as the liquid's velocity: of rod k, from what was added as L x, and L x of both centres.
    pub taken: fn(usize, Both, Both) -> Vector3<f64>,
    /// The factor on ṗ in ṗ′.
    pub free: f64,
    /// The contact line from p_a, p_b and x_b − x_a.
    pub line: fn([Vector3<f64>; 3]) -> Vector3<f64>,
    /// The shares of V_c of a and of b in the velocity that both take.
    pub mean: [f64; 2],
    /// How much of the velocities along and across the contact line becomes the mean.
    pub shared: [f64; 2],
    /// The factor on the mean across the contact line.
    pub mean_across: f64,
    /// True if ṗ′ is made normal to p, which the right rule's is already.
    pub normal: bool,
    /// φ̇′.
    pub phi_rate: AngleRate,
    /// θ̇′.
    pub theta_rate: AngleRate,
    /// The factor on Δt.
    pub step: f64,
    /// φ and θ after the step.
    pub stepped: fn(&Step) -> [f64; 2],
}

/// The rule of the paper.
pub const RIGHT: Variant = Variant {
    kick: [1.0; 2],
    arms: Some,
    feet: |[along_a, along_b, cosine]| {
        [along_a - cosine * along_b, cosine * along_a - along_b].map(|foot| foot / (1.0 - cosine * cosine))
    },
    divisors: |arms| arms,
    undivided: false,
    gradient: |l| *l,
    carrying: |l| *l,
    parts: [1.0; 3],
    shapes: |r| r.map(|r| (r * r - 1.0) / (r * r + 1.0)),
    place: |[centre, _]| centre,
    turning: 1.0,
    taken: |rod, added, _| added[rod],
    free: 1.0,
    line: |[a, b, _]| a.cross(&b).normalize(),
    mean: [0.5; 2],
    shared: [1.0, 0.0],
    mean_across: 1.0,
    normal: false,
    phi_rate: |at, rate| within(at, rate)[0] / at[1].sin(),
    theta_rate: |at, rate| within(at, rate)[1] * at[1].cos() - rate.z * at[1].sin(),
    step: 1.0,
    stepped: |step| [0, 1].map(|k| step.angles[k] + step.rates[k] * step.step_s),
};

/// A rod before the step A.14.
pub struct Step {
    /// φ and θ.
    pub angles: [f64; 2],
    /// φ̇′ and θ̇′.
    pub rates: [f64; 2],
    /// The direction.
    pub p: Vector3<f64>,
    /// ṗ′.
    pub rate: Vector3<f64>,
    /// Δt.
    pub step_s: f64,
}

/// The components of ṗ′ in the shear plane, across φ and along it.
pub fn within([phi, _]: [f64; 2], rate: &Vector3<f64>) -> [f64; 2] {
    [-rate.x * phi.sin() + rate.y * phi.cos(), rate.x * phi.cos() + rate.y * phi.sin()]
}

/// ṗ′ in 1/s for rods a and b of `pair` (centre in mm, axis and r_e of each), or with Δt in s the four numbers of A.13
/// and A.14.
pub fn answers(gradient_per_s: &Matrix3<f64>, pair: &[f64], step_s: Option<f64>, variant: Variant) -> [Vec<f64>; 2] {
    rates(gradient_per_s, pair, variant).map(|(p, rate)| match step_s {
        None => rate.as_slice().to_vec(),
        Some(step_s) => {
            let angles = [p.y.atan2(p.x), p.x.hypot(p.y).atan2(p.z)];
            let rates = [variant.phi_rate, variant.theta_rate].map(|of| of(angles, &rate));
            let step = Step { angles, rates, p, rate, step_s: variant.step * step_s };
            [rates, (variant.stepped)(&step)].concat()
        }
    })
}

/// The place of nearest approach of two rods' lines.
pub struct Geometry {
    /// The sine of the angle between the lines.
    pub sine: f64,
    /// The signed arms, mm.
    pub arms: [f64; 2],
}

/// The feet of the common normal: (x_b + r_b p_b − x_a − r_a p_a) ∥ ℓ.
pub fn geometry(pair: &[f64]) -> Geometry {
    let [x, p] = vectors(pair);
    let cosine = p[0].dot(&p[1]);
    Geometry { sine: (1.0 - cosine * cosine).sqrt(), arms: (RIGHT.feet)(lengths(x, p)) }
}

/// The centres in mm and the axes of both rods.
fn vectors(pair: &[f64]) -> [[Vector3<f64>; 2]; 2] {
    let vector = |at: usize| Vector3::from_row_slice(&pair[at..at + 3]);
    [[0, 7].map(vector), [3, 10].map(|at| vector(at).normalize())]
}

/// d·p_a, d·p_b and p_a·p_b with d = x_b − x_a.
fn lengths(x: [Vector3<f64>; 2], p: [Vector3<f64>; 2]) -> [f64; 3] {
    let apart = x[1] - x[0];
    [apart.dot(&p[0]), apart.dot(&p[1]), p[0].dot(&p[1])]
}

/// p and ṗ′ in 1/s of both rods; `pair` has centre, axis and r_e of each.
fn rates(gradient: &Matrix3<f64>, pair: &[f64], variant: Variant) -> [(Vector3<f64>, Vector3<f64>); 2] {
    let l = (variant.gradient)(gradient);
    let (w, d) = (0.5 * (l - l.transpose()), 0.5 * (l + l.transpose()));
    let [x, p] = vectors(pair);
    let shapes = (variant.shapes)([pair[6], pair[13]]);
    let [spin, pulled, along] = variant.parts;
    let jeffery = |shape: f64, p: Vector3<f64>| {
        let pull = d * p;
        w * p * spin + shape * (pull * pulled - p * (p.dot(&pull) * along))
    };
    let free = [0, 1].map(|k| jeffery(shapes[k], p[k]));
    let feet = (variant.feet)(lengths(x, p));
    let Some(arms) = (variant.arms)(feet.map(|arm| arm / LENGTH_MM)) else {
        return [0, 1].map(|k| (p[k], free[k]));
    };
    let arms = arms.map(|arm| arm * LENGTH_MM);
    let divisors = (variant.divisors)(arms);
    let line = (variant.line)([p[0], p[1], x[1] - x[0]]);
    let carrying = (variant.carrying)(&l);
    let carried = [0, 1].map(|k| carrying * (variant.place)([x[k], p[k] * arms[k]]));
    let moved = [0, 1].map(|k| carried[k] + free[k] * (arms[k] * variant.turning));
    let mean = moved[0] * variant.mean[0] + moved[1] * variant.mean[1];
    let mean_along = line * line.dot(&mean);
    let mean = mean_along + (mean - mean_along) * variant.mean_across;
    [0, 1].map(|k| {
        let change = mean - moved[k];
        let along = line * line.dot(&change);
        let change = along * variant.shared[0] + (change - along) * variant.shared[1];
        let taken = (variant.taken)(k, carried, x.map(|x| l * x));
        let kick = (carried[k] - taken + change * variant.kick[k]) / divisors[k];
        let rate = (free[k] * variant.free + kick) * if variant.undivided { arms[k] } else { 1.0 };
        (p[k], if variant.normal { rate - p[k] * p[k].dot(&rate) } else { rate })
    })
}
