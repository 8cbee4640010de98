//! Closures: a_ijkl as a function of a_ij.

use super::fourth::Fourth;
use super::{ibof, natural, orthotropic};
use nalgebra::Matrix3;
use serde::{Deserialize, Serialize};

/// A closure: a_ijkl as a function of a_ij.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Closure {
    /// Exact for nearly random rods (Hand 1962; Advani & Tucker 1987, eq. 22).
    Linear,
    /// a_ij a_kl, exact for aligned rods (Doi 1981; Advani & Tucker 1987, eq. 24).
    Quadratic,
    /// The linear and the quadratic closure, mixed by f = 1 − 27 det a (Advani & Tucker 1990).
    Hybrid,
    /// Exact for rods without diffusion that were isotropic at first (Verleye & Dupret 1993; Montgomery-Smith et al.
    /// 2011).
    Natural,
    /// A fit of the natural closure by polynomials of degree 4 (Verweyst 1998).
    Ore,
    /// A fit over C_I from 10⁻⁴ to 10⁻¹ (Chung & Kwon 2001).
    Orw,
    /// A fit over the same C_I in the invariants of a (Chung & Kwon 2002).
    Ibof,
}

impl Closure {
    /// Every closure.
    pub const ALL: [Self; 7] =
        [Self::Linear, Self::Quadratic, Self::Hybrid, Self::Natural, Self::Ore, Self::Orw, Self::Ibof];

    /// The usual name of the closure.
    pub fn name(self) -> &'static str {
        self.about().0
    }

    /// The source of the closure.
    pub fn source(self) -> &'static str {
        self.about().1
    }

    fn about(self) -> (&'static str, &'static str) {
        match self {
            Self::Linear => ("linear", "the linear closure: Advani & Tucker 1987, J. Rheol. 31, 751"),
            Self::Quadratic => {
                ("quadratic", "the quadratic closure a_ijkl = a_ij a_kl: Advani & Tucker 1987, J. Rheol. 31, 751")
            }
            Self::Hybrid => (
                "hybrid",
                "the hybrid closure, f = 1 − 27 det a times the quadratic plus 1 − f times the linear one: Advani & \
                 Tucker 1990, J. Rheol. 34, 367",
            ),
            Self::Natural => (
                "natural",
                "the natural closure, exact: Verleye & Dupret 1993; Montgomery-Smith, He, Jack & Smith 2011, J. Fluid \
                 Mech. 680, 321",
            ),
            Self::Ore => ("ORE", "the closure ORE, 45 coefficients: Verweyst 1998, thesis, University of Illinois"),
            Self::Orw => ("ORW", "the closure ORW, 18 coefficients: Chung & Kwon 2001, Polym. Compos. 22, 636"),
            Self::Ibof => ("IBOF", "the closure IBOF, 63 coefficients: Chung & Kwon 2002, J. Rheol. 46, 169"),
        }
    }

    /// a_ijkl by this closure.
    pub fn fourth(self, a: &Matrix3<f64>) -> Fourth {
        match self {
            Self::Linear => linear(a),
            Self::Quadratic => quadratic(a),
            Self::Hybrid => mixed(a, aligned(a), linear),
            Self::Natural => natural::fourth(a),
            Self::Ore => orthotropic::ORE_FIT.fourth(a),
            Self::Orw => orthotropic::ORW_FIT.fourth(a),
            Self::Ibof => ibof::FIT.fourth(a),
        }
    }
}

fn delta(i: usize, j: usize) -> f64 {
    if i == j { 1.0 } else { 0.0 }
}

pub(super) fn linear(a: &Matrix3<f64>) -> Fourth {
    linear_by(a, 7.0, 35.0)
}

/// The linear closure with other divisors than 7 of the terms aδ and 35 of δδ.
pub(super) fn linear_by(a: &Matrix3<f64>, seven: f64, thirty_five: f64) -> Fourth {
    weighted(a, &[1.0; 9], seven, thirty_five)
}

/// The terms of the linear closure, over 7 and over 35.
pub(super) const TERMS: [&str; 9] = [
    "a_ij δ_kl",
    "a_ik δ_jl",
    "a_il δ_jk",
    "a_kl δ_ij",
    "a_jl δ_ik",
    "a_jk δ_il",
    "δ_ij δ_kl",
    "δ_ik δ_jl",
    "δ_il δ_jk",
];

/// The same with numbers before [`TERMS`].
pub(super) fn weighted(a: &Matrix3<f64>, w: &[f64; 9], seven: f64, thirty_five: f64) -> Fourth {
    Fourth::from_fn(|i, j, k, l| {
        let mixed = w[0] * a[(i, j)] * delta(k, l)
            + w[1] * a[(i, k)] * delta(j, l)
            + w[2] * a[(i, l)] * delta(j, k)
            + w[3] * a[(k, l)] * delta(i, j)
            + w[4] * a[(j, l)] * delta(i, k)
            + w[5] * a[(j, k)] * delta(i, l);
        let ones =
            w[6] * delta(i, j) * delta(k, l) + w[7] * delta(i, k) * delta(j, l) + w[8] * delta(i, l) * delta(j, k);
        mixed / seven - ones / thirty_five
    })
}

/// The f of the hybrid closure: 0 for random rods, 1 for aligned ones.
pub(super) fn aligned(a: &Matrix3<f64>) -> f64 {
    1.0 - 27.0 * a.determinant()
}

/// f times the quadratic closure and 1 − f times another one.
pub(super) fn mixed(a: &Matrix3<f64>, f: f64, other: impl Fn(&Matrix3<f64>) -> Fourth) -> Fourth {
    Fourth(quadratic(a).0 * f + other(a).0 * (1.0 - f))
}

pub(super) fn quadratic(a: &Matrix3<f64>) -> Fourth {
    Fourth::from_fn(|i, j, k, l| a[(i, j)] * a[(k, l)])
}
