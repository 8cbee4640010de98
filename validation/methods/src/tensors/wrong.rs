//! Known mistakes in the rate of a_ij: what a wrong code computes in place of each part.

pub mod closures;

use super::{Model, Parts, shear_rate};
use nalgebra::Matrix3;

/// A mistake in one part of the rate of a_ij.
pub struct Mistake {
    /// The mistake, to stand after "this is the curve of".
    pub name: &'static str,
    /// What is right.
    pub advice: &'static str,
    change: fn(Parts) -> Option<Parts>,
}

impl Mistake {
    /// The parts with this mistake; `None` if it changes nothing there, or does not apply.
    pub fn of(&self, parts: &Parts) -> Option<Parts> {
        (self.change)(*parts).filter(|changed| changed != parts && changed.of_strain.is_finite())
    }
}

const L: &str = "L_ij = ∂u_i/∂x_j, W = (L − Lᵀ)/2, D = (L + Lᵀ)/2";
const TRANSPOSED: &str = "L_ij = ∂u_i/∂x_j, W = (L − Lᵀ)/2: W with the wrong sign is the same";
const PRODUCTS: &str = "Wa, aW, Da and aD are products of matrices";
const SHAPE: &str = "Λ = (r_e² − 1)/(r_e² + 1), below 0 for discs";
const SIDES: &str = "the rate is Wa − aW + Λ(Da + aD − 2𝔸:D) + diffusion: Da is not symmetric, Da + aD is";
const CONTRACTION: &str = "𝔸:D sums over all nine pairs k, l: 12, 13 and 23 count twice";
const SPEED: &str = "γ̇ = (2D:D)^½, which is G in shear";
const SPREAD: &str = "diffusion is 2 C_I γ̇ (δ − 3a)";
const STRETCH: &str = "the rate by strain is Λ(Da + aD − 2𝔸:D)";
const RSC: &str = "RSC is Λ(Da + aD − 2[𝔸 + (1 − κ)(𝕃 − 𝕄:𝔸)]:D) + 2κC_I γ̇(δ − 3a)";
const DRIFT: &str = "diffusion is γ̇[2C − 2 tr(C) a − 5(Ca + aC) + 10𝔸:C]";
const IARD: &str = "iARD is C = C_I(δ − 4 C_M D²/γ̇²)";
const SQUARE: &str = "D² is the product of matrices, D_ik D_kj";
const PT: &str = "C = b1 δ + b2 a + b3 a² + b4 D/γ̇ + b5 D²/γ̇²";
const ANISOTROPIC: &str = "C is given in problem.json, with the axes of a from the largest eigenvalue";

const fn mistake(name: &'static str, advice: &'static str, change: fn(Parts) -> Option<Parts>) -> Mistake {
    Mistake { name, advice, change }
}

/// Every known mistake in the parts of the rate.
pub const MISTAKES: [Mistake; 97] = [
    mistake("a transposed gradient", TRANSPOSED, |p| Some(Parts { spin: -p.spin, ..p })),
    mistake("the flow reversed (L with the wrong sign, or time backwards)", L, |p| {
        Some(Parts { spin: -p.spin, strain: -p.strain, ..p })
    }),
    mistake("Wa − aW and Da + aD by components (NumPy's * for @)", PRODUCTS, |p| {
        // By components Wa and aW are the same.
        Some(Parts { by_component: true, spun: [0.0; 2], ..p })
    }),
    mistake("Da + aD by components (NumPy's * for @)", PRODUCTS, |p| Some(Parts { by_component: true, ..p })),
    mistake("half the shear rate", L, |p| Some(scaled(p, 0.5, 0.5, 0.5))),
    mistake("twice the shear rate", L, |p| Some(scaled(p, 2.0, 2.0, 2.0))),
    mistake("D without its ½", L, |p| Some(scaled(p, 1.0, 2.0, 2.0))),
    mistake("D without its ½, with the right γ̇", L, |p| Some(scaled(p, 1.0, 2.0, 1.0))),
    mistake("D halved twice", L, |p| Some(scaled(p, 1.0, 0.5, 0.5))),
    mistake("da/dγ for da/dt (every rate over γ̇)", L, |p| {
        Some(scaled(p, 1.0 / p.speed, 1.0 / p.speed, 1.0 / p.speed))
    }),
    mistake("D_12, D_13 and D_23 without their ½ (engineering shear)", L, |p| {
        Some(sheared(p, shear_rate(&doubled(&p))))
    }),
    mistake("D_12, D_13 and D_23 without their ½, with the right γ̇", L, |p| Some(sheared(p, p.speed))),
    mistake("W without its ½", L, |p| Some(scaled(p, 2.0, 1.0, 1.0))),
    mistake("W halved twice", L, |p| Some(scaled(p, 0.5, 1.0, 1.0))),
    mistake("W left out", L, |p| Some(scaled(p, 0.0, 1.0, 1.0))),
    mistake("Λ with the wrong sign (1/r_e for r_e)", SHAPE, |p| Some(shaped(p, -p.of_strain))),
    mistake("Λ without its sign", SHAPE, |p| Some(shaped(p, p.of_strain.abs()))),
    mistake("no 1/r_e (Λ = 1, an infinitely slender rod)", SHAPE, |p| Some(shaped(p, 1.0))),
    mistake("(r_e − 1)/(r_e + 1) for Λ", SHAPE, |p| of_ratio(p, f64::sqrt)),
    mistake("Λ = 0, D left out", SHAPE, |p| Some(shaped(p, 0.0))),
    mistake("1/Λ for Λ", SHAPE, |p| Some(shaped(p, 1.0 / p.of_strain))),
    mistake("the eccentricity |1 − 1/r_e²|^½ for Λ", SHAPE, |p| {
        Some(shaped(p, (2.0 * p.of_strain / (1.0 + p.of_strain)).abs().sqrt()))
    }),
    mistake("twice the r_e", SHAPE, |p| of_ratio(p, |r| 2.0 * r)),
    mistake("half the r_e", SHAPE, |p| of_ratio(p, |r| 0.5 * r)),
    mistake("r_e² for r_e", SHAPE, |p| of_ratio(p, |r| r * r)),
    mistake("Λ missing before 𝔸:D", STRETCH, |p| Some(Parts { of_fourth: 2.0, ..p })),
    mistake("Λ missing before Da + aD", STRETCH, |p| Some(Parts { of_strain: 1.0, ..p })),
    mistake("the 2 missing before 𝔸:D", STRETCH, |p| Some(Parts { of_fourth: 0.5 * p.of_fourth, ..p })),
    mistake("𝔸:D left out", STRETCH, |p| Some(Parts { of_fourth: 0.0, ..p })),
    mistake("𝔸:D with the wrong sign", STRETCH, |p| Some(Parts { of_fourth: -p.of_fourth, ..p })),
    mistake("off-diagonal D counted once in 𝔸:D", CONTRACTION, |p| Some(Parts { pairs: 0.5, ..p })),
    mistake("Da alone, aD missing", SIDES, |p| Some(Parts { stretched: [1.0, 0.0], ..p })),
    mistake("aD alone, Da missing", SIDES, |p| Some(Parts { stretched: [0.0, 1.0], ..p })),
    mistake("2Da for Da + aD", SIDES, |p| Some(Parts { stretched: [2.0, 0.0], ..p })),
    mistake("2aD for Da + aD", SIDES, |p| Some(Parts { stretched: [0.0, 2.0], ..p })),
    mistake("(Da + aD)/2 for Da + aD", SIDES, |p| Some(Parts { stretched: [0.5, 0.5], ..p })),
    mistake("Wa alone, aW missing", SIDES, |p| Some(Parts { spun: [1.0, 0.0], ..p })),
    mistake("−aW alone, Wa missing", SIDES, |p| Some(Parts { spun: [0.0, -1.0], ..p })),
    mistake("Wa + aW for Wa − aW", SIDES, |p| Some(Parts { spun: [1.0, 1.0], ..p })),
    mistake("γ̇ = (D:D)^½", SPEED, |p| Some(Parts { speed: p.speed * std::f64::consts::FRAC_1_SQRT_2, ..p })),
    mistake("D:D for γ̇", SPEED, |p| Some(Parts { speed: 0.5 * p.speed * p.speed, ..p })),
    mistake("2D:D for γ̇", SPEED, |p| Some(Parts { speed: p.speed * p.speed, ..p })),
    mistake("|L| = (L:L)^½ for γ̇", SPEED, |p| Some(Parts { speed: gradient(&p).norm(), ..p })),
    mistake("L_21 for γ̇", SPEED, |p| Some(Parts { speed: gradient(&p)[(1, 0)], ..p })),
    mistake("|L_21| for γ̇", SPEED, |p| Some(Parts { speed: gradient(&p)[(1, 0)].abs(), ..p })),
    mistake("L_12 for γ̇", SPEED, |p| Some(Parts { speed: gradient(&p)[(0, 1)], ..p })),
    mistake("|L_12| for γ̇", SPEED, |p| Some(Parts { speed: gradient(&p)[(0, 1)].abs(), ..p })),
    mistake("γ̇ with D_12, D_13 and D_23 counted once", SPEED, |p| {
        let square = 2.0 * p.strain.lower_triangle().norm_squared();
        Some(Parts { speed: square.sqrt(), ..p })
    }),
    mistake("the largest |L_ij| for γ̇", SPEED, |p| Some(Parts { speed: gradient(&p).amax(), ..p })),
    mistake("γ̇ left out", SPEED, |p| Some(Parts { speed: 1.0, ..p })),
    mistake("half the C_I (C_I γ̇ (δ − 3a), without the 2, or γ̇ = (D:D/2)^½)", SPREAD, |p| spread(p, 0.5)),
    mistake("twice the C_I", SPREAD, |p| spread(p, 2.0)),
    mistake("2 C_I γ̇ (δ/3 − a) for diffusion", SPREAD, |p| spread(p, 1.0 / 3.0)),
    mistake("6 C_I γ̇ (δ − 3a) for diffusion", SPREAD, |p| spread(p, 3.0)),
    mistake("2 C_I γ̇ (δ − 2a) for diffusion", SPREAD, |p| Some(Parts { decay: 2.0, ..p })),
    mistake("2 C_I γ̇ (1 − 3a) for diffusion, with 1 in every component of δ", SPREAD, |p| {
        is_isotropic(&p).then_some(Parts { off_diagonal: 1.0, ..p })
    }),
    mistake("diffusion left out", SPREAD, |p| spread(p, 0.0)),
    mistake("diffusion with the wrong sign", SPREAD, |p| spread(p, -1.0)),
    mistake("1 − κ for κ", RSC, |p| slowed(p, |kappas| kappas.map(|kappa| 1.0 - kappa))),
    mistake("1/κ for κ", RSC, |p| slowed(p, |kappas| kappas.map(|kappa| 1.0 / kappa))),
    mistake("κ² for κ", RSC, |p| slowed(p, |kappas| kappas.map(|kappa| kappa * kappa))),
    mistake("κ left out", RSC, |p| slowed(p, |_| [1.0; 2])),
    mistake("κ missing at the diffusion", RSC, |p| slowed(p, |[kappa, _]| [kappa, 1.0])),
    mistake("κ² for κ at the diffusion", RSC, |p| slowed(p, |[kappa, other]| [kappa, other * other])),
    mistake("κ at the diffusion alone, 𝔸 for 𝔸 + (1 − κ)(𝕃 − 𝕄:𝔸)", RSC, |p| {
        slowed(p, |[_, kappa]| [1.0, kappa])
    }),
    mistake("κ before every rate (SRF for RSC)", RSC, |p| match p.model {
        Model::Rsc { kappa, .. } => Some(Parts { kappas: [1.0; 2], ..scaled(p, kappa, kappa, kappa) }),
        _ => None,
    }),
    mistake("C_M D²/γ̇² without its 4", IARD, |p| anisotropic(p, 0.25)),
    mistake("twice the C_M", IARD, |p| anisotropic(p, 2.0)),
    mistake("(D²:D²)^½ for the norm (D²:D²/2)^½", IARD, |p| anisotropic(p, std::f64::consts::FRAC_1_SQRT_2)),
    mistake("+ C_M for − C_M", IARD, |p| anisotropic(p, -1.0)),
    mistake("LᵀL for D²", IARD, |p| squared(p, gradient(&p).transpose() * gradient(&p))),
    mistake("LLᵀ for D²", IARD, |p| squared(p, gradient(&p) * gradient(&p).transpose())),
    mistake("LᵀL/L:L for 4 D²/γ̇²", IARD, |p| {
        let l = gradient(&p);
        squared(p, l.transpose() * l * (p.speed * p.speed / (4.0 * l.dot(&l))))
    }),
    mistake("D/γ̇ for D²/γ̇²", IARD, |p| squared(p, p.strain * p.speed)),
    mistake("D²/γ̇ for D²/γ̇²", IARD, |p| squared(p, p.strain * p.strain * p.speed)),
    mistake("D² for D²/γ̇²", IARD, |p| squared(p, p.strain * p.strain * (p.speed * p.speed))),
    mistake("squares of each D_ij for D²", SQUARE, |p| squared(p, p.strain.component_mul(&p.strain))),
    mistake("L² for D²", IARD, |p| squared(p, gradient(&p) * gradient(&p))),
    mistake("b1 to b5 in the reverse order", PT, |p| coefficients(p, |[b1, b2, b3, b4, b5], _| [b5, b4, b3, b2, b1])),
    mistake("b4 and b5 exchanged", PT, |p| coefficients(p, |[b1, b2, b3, b4, b5], _| [b1, b2, b3, b5, b4])),
    mistake("b2 and b4, b3 and b5 exchanged", PT, |p| coefficients(p, |[b1, b2, b3, b4, b5], _| [b1, b4, b5, b2, b3])),
    mistake("D and D² for D/γ̇ and D²/γ̇²", PT, |p| {
        coefficients(p, |[b1, b2, b3, b4, b5], speed| [b1, b2, b3, b4 * speed, b5 * speed * speed])
    }),
    mistake("D² for D²/γ̇²", PT, |p| {
        coefficients(p, |[b1, b2, b3, b4, b5], speed| [b1, b2, b3, b4, b5 * speed * speed])
    }),
    mistake("D²/γ̇ for D²/γ̇²", PT, |p| {
        coefficients(p, |[b1, b2, b3, b4, b5], speed| [b1, b2, b3, b4, b5 * speed])
    }),
    mistake("2D/γ̇ and 4D²/γ̇² for D/γ̇ and D²/γ̇²", PT, |p| {
        coefficients(p, |[b1, b2, b3, b4, b5], _| [b1, b2, b3, 2.0 * b4, 4.0 * b5])
    }),
    mistake("2.5(Ca + aC) for 5(Ca + aC)", DRIFT, |p| drifting(p, [2.5, 10.0])),
    mistake("5𝔸:C for 10𝔸:C", DRIFT, |p| drifting(p, [5.0, 5.0])),
    mistake("2.5(Ca + aC) and 5𝔸:C for twice as much", DRIFT, |p| drifting(p, [2.5, 5.0])),
    mistake("5(Ca + aC) and 10𝔸:C left out", DRIFT, |p| drifting(p, [0.0, 0.0])),
    mistake("10𝔸:C left out", DRIFT, |p| drifting(p, [5.0, 0.0])),
    mistake("the eigenvalues of a in ascending order", ANISOTROPIC, |p| along(p, |[x, y, z]| [z, y, x])),
    mistake("the second and third eigenvalues of a exchanged", ANISOTROPIC, |p| along(p, |[x, y, z]| [x, z, y])),
    mistake("the first and second eigenvalues of a exchanged", ANISOTROPIC, |p| along(p, |[x, y, z]| [y, x, z])),
    mistake("the eigenvalues of a in the order 2, 3, 1", ANISOTROPIC, |p| along(p, |[x, y, z]| [z, x, y])),
    mistake("the eigenvalues of a in the order 3, 1, 2", ANISOTROPIC, |p| along(p, |[x, y, z]| [y, z, x])),
    mistake("C along the axes 1, 2, 3, not along those of a", ANISOTROPIC, |p| {
        Some(Parts { in_laboratory: true, ..along(p, |d| d)? })
    }),
    mistake("1 + Ω for 1 − Ω", ANISOTROPIC, |p| match p.model {
        Model::Pard { omega, .. } => along(p, |[x, y, _]| [x, y, x + omega]),
        _ => None,
    }),
];

/// L in 1/s.
fn gradient(parts: &Parts) -> Matrix3<f64> {
    parts.spin + parts.strain
}

/// The parts with these factors on W, D and γ̇.
pub fn scaled(parts: Parts, spin: f64, strain: f64, speed: f64) -> Parts {
    let square = parts.square * (strain * strain);
    Parts { spin: parts.spin * spin, strain: parts.strain * strain, square, speed: parts.speed * speed, ..parts }
}

/// D with its off-diagonal components doubled.
fn doubled(parts: &Parts) -> Matrix3<f64> {
    Matrix3::from_fn(|i, j| if i == j { 1.0 } else { 2.0 } * parts.strain[(i, j)])
}

/// The parts with that D, and with a γ̇.
fn sheared(parts: Parts, speed: f64) -> Parts {
    let strain = doubled(&parts);
    Parts { strain, square: strain * strain, speed, ..parts }
}

/// The parts with another Λ.
pub fn shaped(parts: Parts, shape: f64) -> Parts {
    Parts { of_strain: shape, of_fourth: 2.0 * shape, ..parts }
}

/// The parts with Λ of another aspect ratio.
fn of_ratio(parts: Parts, of: fn(f64) -> f64) -> Option<Parts> {
    let r = of(((1.0 + parts.of_strain) / (1.0 - parts.of_strain)).sqrt());
    (r > 0.0 && r.is_finite()).then(|| shaped(parts, (r * r - 1.0) / (r * r + 1.0)))
}

/// The parts with C_I times `factor`.
pub fn spread(parts: Parts, factor: f64) -> Option<Parts> {
    let model = match parts.model {
        Model::FolgarTucker { c_i } => Model::FolgarTucker { c_i: factor * c_i },
        Model::Rsc { c_i, kappa } => Model::Rsc { c_i: factor * c_i, kappa },
        Model::PhelpsTucker { b, kappa } => Model::PhelpsTucker { b: b.map(|b| factor * b), kappa },
        Model::Iard { c_i, c_m } => Model::Iard { c_i: factor * c_i, c_m },
        Model::Pard { c_i, omega } => Model::Pard { c_i: factor * c_i, omega },
        Model::Mrd { c_i, d } => Model::Mrd { c_i: factor * c_i, d },
    };
    Some(Parts { model, ..parts })
}

/// The parts with other κ, where the model has one.
pub fn slowed(parts: Parts, of: impl Fn([f64; 2]) -> [f64; 2]) -> Option<Parts> {
    (parts.kappas != [1.0; 2]).then_some(Parts { kappas: of(parts.kappas), ..parts })
}

fn anisotropic(parts: Parts, factor: f64) -> Option<Parts> {
    with(parts, "C_M", |c_m| factor * c_m)
}

/// The parts with another value of one parameter of the model.
pub fn with(parts: Parts, name: &str, of: impl Fn(f64) -> f64) -> Option<Parts> {
    Some(Parts { model: parts.model.with(name, of)?, ..parts })
}

/// The parts with other numbers of C along the axes of a, where it has such.
fn along(parts: Parts, of: impl Fn([f64; 3]) -> [f64; 3]) -> Option<Parts> {
    let (c_i, d) = match parts.model {
        Model::Pard { c_i, omega } => (c_i, [1.0, omega, 1.0 - omega]),
        Model::Mrd { c_i, d } => (c_i, d),
        _ => return None,
    };
    Some(Parts { model: Model::Mrd { c_i, d: of(d) }, ..parts })
}

/// The parts with other b1 to b5, which may depend on γ̇.
fn coefficients(parts: Parts, of: impl Fn([f64; 5], f64) -> [f64; 5]) -> Option<Parts> {
    match parts.model {
        Model::PhelpsTucker { b, kappa } => {
            Some(Parts { model: Model::PhelpsTucker { b: of(b, parts.speed), kappa }, ..parts })
        }
        _ => None,
    }
}

/// The parts with another tensor for D², where a diffusivity has one.
fn squared(parts: Parts, square: Matrix3<f64>) -> Option<Parts> {
    let has_one = matches!(parts.model, Model::Iard { .. } | Model::PhelpsTucker { .. });
    has_one.then_some(Parts { square, ..parts })
}

/// Whether C is C_I δ.
pub fn is_isotropic(parts: &Parts) -> bool {
    matches!(parts.model, Model::FolgarTucker { .. } | Model::Rsc { .. })
}

/// The parts with other numbers for the 5 and the 10 of diffusion, where C is not C_I δ.
pub fn drifting(parts: Parts, drift: [f64; 2]) -> Option<Parts> {
    (!is_isotropic(&parts)).then_some(Parts { drift, ..parts })
}
