//! The grader on codes for orientation tensors and for rods that are right, or wrong in one part: no right one may
//! fail, every wrong one must be caught, and named.
//!
//!     cargo run --example graded_tensors [-- TEXT]
//!
//! grades all of them, or those with TEXT in their name, on formulas and curves and prints the table; as a test it
//! does the same.

mod code;
mod rods;

use code::{
    Code, M, along, delta, double, hybrid, hybrid_by, iard, iard_of, ibof, ibof_by, linear, linear_by, ore_by, planar,
    product, quadratic, transposed,
};
use rayon::prelude::*;
use shearbed_validation::methods::tensors::Model;
use shearbed_validation::methods::tensors::ibof::COEFFICIENTS;
use shearbed_validation::methods::tensors::orthotropic::ORE;
use shearbed_validation::serve::grade::{self, Claim, DumpOptions, FileOptions, Graded, Options, Verdict};
use shearbed_validation::serve::problems::{self, Formula, LoadedProblem};
use std::array::from_fn;
use std::fs;

/// A wrong code: its name, what its diagnosis must contain, and the mistake.
type Wrong = (&'static str, &'static str, fn(&mut Code));

#[rustfmt::skip]
const WRONG: &[Wrong] = &[
    ("L transposed", "a transposed gradient", |c| c.gradient = |l| from_fn(|i| from_fn(|j| l[j][i]))),
    ("L reversed", "the flow reversed", |c| c.gradient = |l| l.map(|row| row.map(|x| -x))),
    ("L halved", "half the shear rate", |c| c.gradient = |l| l.map(|row| row.map(|x| 0.5 * x))),
    ("D without ½", "D without its ½", |c| c.half[1] = 1.0),
    ("D without ½, γ̇ = |L|", "D without its ½, with the right γ̇", |c| {
        c.half[1] = 1.0;
        c.speed = |l, _| (0.5 * (double(l, l) + double(l, &from_fn(|i| from_fn(|j| l[j][i]))))).sqrt() * 2f64.sqrt();
    }),
    ("D halved", "D halved twice", |c| c.half[1] = 0.25),
    ("W without ½", "W without its ½", |c| c.half[0] = 1.0),
    ("W halved", "W halved twice", |c| c.half[0] = 0.25),
    ("W forgotten", "W left out", |c| c.half[0] = 0.0),
    ("W's sign", "a transposed gradient", |c| c.half[0] = -0.5),
    ("Λ's sign", "Λ with the wrong sign", |c| c.shape = |r| 2.0 / (r * r + 1.0) - 1.0),
    ("Λ = 1", "no 1/r_e", |c| c.shape = |_| 1.0),
    ("(r − 1)/(r + 1)", "(r_e − 1)/(r_e + 1) for Λ", |c| c.shape = |r| 1.0 - 2.0 / (r + 1.0)),
    ("Λ = 0", "Λ = 0", |c| c.shape = |_| 0.0),
    ("1/Λ", "1/Λ for Λ", |c| c.shape = |r| (r * r + 1.0) / (r * r - 1.0)),
    ("eccentricity", "the eccentricity", |c| c.shape = |r| (1.0 - 1.0 / (r * r)).abs().sqrt()),
    ("r_e of the half length", "half the r_e", |c| c.shape = |r| 1.0 - 2.0 / (0.25 * r * r + 1.0)),
    ("γ̇ = √(D:D)", "γ̇ = (D:D)^½", |c| c.speed = |_, d| double(d, d).sqrt()),
    ("γ̇ = D:D", "D:D for γ̇", |c| c.speed = |_, d| double(d, d)),
    ("γ̇ = 2D:D", "2D:D for γ̇", |c| c.speed = |_, d| 2.0 * double(d, d)),
    ("γ̇ = |L|", "|L| = (L:L)^½ for γ̇", |c| c.speed = |l, _| double(l, l).sqrt()),
    ("γ̇ = L_21", "L_21 for γ̇", |c| c.speed = |l, _| l[1][0]),
    ("γ̇ of six entries", "γ̇ with D_12, D_13 and D_23 counted once", |c| {
        c.speed = |_, d| (2.0 * (0..3).map(|i| (0..=i).map(|j| d[i][j] * d[i][j]).sum::<f64>()).sum::<f64>()).sqrt();
    }),
    ("engineering shear in D", "D_12, D_13 and D_23 without their ½ (engineering shear)", |c| c.shear = 2.0),
    ("no γ̇", "γ̇ left out", |c| c.speed = |_, _| 1.0),
    ("C_I γ̇ (δ − 3a)", "half the C_I", |c| c.spread[0] = 1.0),
    ("4 C_I γ̇ (δ − 3a)", "twice the C_I", |c| c.spread[0] = 4.0),
    ("6 C_I γ̇ (δ − 3a)", "6 C_I γ̇ (δ − 3a) for diffusion", |c| c.spread[0] = 6.0),
    ("2 C_I γ̇ (δ/3 − a)", "2 C_I γ̇ (δ/3 − a) for diffusion", |c| (c.spread[1], c.spread[2]) = (1.0, 1.0 / 3.0)),
    ("2 C_I γ̇ (δ − 2a)", "2 C_I γ̇ (δ − 2a) for diffusion", |c| c.spread[1] = 2.0),
    ("no diffusion", "diffusion left out", |c| c.spread[0] = 0.0),
    ("diffusion's sign", "diffusion with the wrong sign", |c| c.spread[0] = -2.0),
    ("0.73 C_I", "C_I times 0.7300", |c| c.spread[0] = 1.46),
    ("0.95 Λ", "Λ times 0.9500", |c| c.shape = |r| 0.95 - 1.9 / (r * r + 1.0)),
    ("Λ missing at 𝔸:D", "Λ missing before 𝔸:D", |c| c.stretch[1] = |_| 2.0),
    ("Λ missing at Da + aD", "Λ missing before Da + aD", |c| c.stretch[0] = |_| 1.0),
    ("2 missing at 𝔸:D", "the 2 missing before 𝔸:D", |c| c.stretch[1] = |shape| shape),
    ("no 𝔸:D", "𝔸:D left out", |c| c.stretch[1] = |_| 0.0),
    ("a·D·a", "a·D·a for 𝔸:D", |c| {
        c.closure = |a, [i, j, k, l]| 0.5 * (a[i][k] * a[j][l] + a[i][l] * a[j][k]);
    }),
    ("another closure", "the linear closure", |c| c.closure = linear),
    ("1/35's sign", "a linear closure with + 1/35 for − 1/35", |c| {
        c.closure = |a, at| linear_by(a, at, 1.0 / 7.0, 1.0 / 35.0);
    }),
    ("the bracket of 1/7", "a linear closure with its 1/7 before both brackets", |c| {
        c.closure = |a, at| linear_by(a, at, 1.0 / 7.0, -1.0 / 245.0);
    }),
    ("no 1/7", "a linear closure without its term of 1/7", |c| c.closure = |a, at| linear_by(a, at, 0.0, -1.0 / 35.0)),
    ("1 for 1/7", "a linear closure with 1 for 1/7", |c| c.closure = |a, at| linear_by(a, at, 1.0, -1.0 / 35.0)),
    ("1/35 for 1/7", "a linear closure with 1/35 for 1/7", |c| {
        c.closure = |a, at| linear_by(a, at, 1.0 / 35.0, -1.0 / 35.0);
    }),
    ("1/7 for 1/35", "a linear closure with 1/7 for 1/35", |c| {
        c.closure = |a, at| linear_by(a, at, 1.0 / 7.0, -1.0 / 7.0);
    }),
    ("f (quadratic + (1 − f) linear)", "a hybrid closure f (quadratic + (1 − f) linear)", |c| {
        c.closure = |a, at| {
            let f = 1.0 - 27.0 * code::determinant(a);
            f * (quadratic(a, at) + (1.0 - f) * linear(a, at))
        };
    }),
    ("f quadratic + 1 − f linear", "a hybrid closure f quadratic + 1 − f linear", |c| {
        c.closure = |a, at| {
            let f = 1.0 - 27.0 * code::determinant(a);
            f * quadratic(a, at) + 1.0 - f * linear(a, at)
        };
    }),
    ("f = 1 + 27 det", "a hybrid closure with f = 1 + 27 det a", |c| {
        c.closure = |a, at| hybrid_by(a, at, 1.0 + 27.0 * code::determinant(a));
    }),
    ("f² for f", "a hybrid closure with f² for f", |c| {
        c.closure = |a, at| hybrid_by(a, at, (1.0 - 27.0 * code::determinant(a)).powi(2));
    }),
    ("f and 1 − f", "a hybrid closure with f and 1 − f exchanged", |c| {
        c.closure = |a, at| hybrid_by(a, at, 27.0 * code::determinant(a));
    }),
    ("f = (3a:a − 1)/2", "a hybrid closure with f = (3 a:a − 1)/2", |c| {
        c.closure = |a, at| hybrid_by(a, at, 0.5 * (3.0 * double(a, a) - 1.0));
    }),
    ("(1 + f) linear − f quadratic", "a hybrid closure with (1 + f) linear − f quadratic", |c| {
        c.closure = |a, at| hybrid_by(a, at, 27.0 * code::determinant(a) - 1.0);
    }),
    ("f = 1 − 4 det", "a hybrid closure with f = 1 − 4 det a", |c| {
        c.closure = |a, at| hybrid_by(a, at, 1.0 - 4.0 * code::determinant(a));
    }),
    ("f = 1 − 9 det", "a hybrid closure with f = 1 − 9 det a", |c| {
        c.closure = |a, at| hybrid_by(a, at, 1.0 - 9.0 * code::determinant(a));
    }),
    ("f = 1 − 4 det in the plane", "a hybrid closure with f = 1 − 4(a_11 a_22 − a_12²)", |c| {
        c.closure = |a, at| hybrid_by(a, at, 1.0 - 4.0 * code::in_plane(a));
    }),
    ("f = 2 a:a − 1", "a hybrid closure with f = 2 a:a − 1", |c| {
        c.closure = |a, at| hybrid_by(a, at, 2.0 * double(a, a) - 1.0);
    }),
    ("planar linear", "the linear closure of rods in a plane", |c| c.closure = planar),
    ("planar hybrid", "the hybrid closure of rods in a plane", |c| {
        c.closure = |a, at| {
            let f = 1.0 - 4.0 * code::in_plane(a);
            f * quadratic(a, at) + (1.0 - f) * planar(a, at)
        };
    }),
    ("planar numbers in hybrid", "a hybrid closure with 1/6 and − 1/24", |c| {
        c.closure = |a, at| {
            let f = 1.0 - 27.0 * code::determinant(a);
            f * quadratic(a, at) + (1.0 - f) * planar(a, at)
        };
    }),
    ("𝔸:D's sign", "𝔸:D with the wrong sign", |c| c.stretch[1] = |shape| -2.0 * shape),
    ("six pairs", "off-diagonal D counted once in 𝔸:D", |c| c.pairs = 0.5),
    ("Da alone", "Da alone, aD missing", |c| c.sides[1] = [1.0, 0.0]),
    ("aD alone", "aD alone, Da missing", |c| c.sides[1] = [0.0, 1.0]),
    ("2Da", "2Da for Da + aD", |c| c.sides[1] = [2.0, 0.0]),
    ("2aD", "2aD for Da + aD", |c| c.sides[1] = [0.0, 2.0]),
    ("symmetric part of Da", "(Da + aD)/2 for Da + aD", |c| c.sides[1] = [0.5; 2]),
    ("Wa alone", "Wa alone, aW missing", |c| c.sides[0] = [1.0, 0.0]),
    ("aW alone", "−aW alone, Wa missing", |c| c.sides[0] = [0.0, -1.0]),
    ("Wa + aW", "Wa + aW for Wa − aW", |c| c.sides[0] = [1.0; 2]),
    ("γ̇ = |L_21|", "L_21", |c| c.speed = |l, _| l[1][0].abs()),
    ("γ̇ = L_12", "L_12", |c| c.speed = |l, _| l[0][1]),
    ("γ̇ = |L_12|", "L_12", |c| c.speed = |l, _| l[0][1].abs()),
    ("a_12's sign", "a_12 with the wrong sign", |c| c.written = |x| [x[0], x[1], x[2], -x[3], x[4], x[5]]),
    ("signs of a_12, a_13, a_23", "a_12, a_13 and a_23 with the wrong sign", |c| {
        c.written = |x| [x[0], x[1], x[2], -x[3], -x[4], -x[5]];
    }),
    ("engineering shear", "2 a_12 for a_12", |c| {
        c.written = |x| [x[0], x[1], x[2], 2.0 * x[3], 2.0 * x[4], 2.0 * x[5]];
    }),
    ("Mandel", "√2 a_12 for a_12", |c| c.written = |x| {
        let root = 2f64.sqrt();
        [x[0], x[1], x[2], root * x[3], root * x[4], root * x[5]]
    }),
    ("half", "a_12/2 for a_12", |c| {
        c.written = |x| [x[0], x[1], x[2], 0.5 * x[3], 0.5 * x[4], 0.5 * x[5]];
    }),
    ("Voigt", "Voigt's order", |c| c.written = |x| [x[0], x[1], x[2], x[5], x[4], x[3]]),
    ("flow along 1", "axes in the order flow,gradient,vorticity", |c| {
        c.written = |x| [x[1], x[0], x[2], x[3], x[5], x[4]];
    }),
];

/// Mistakes of one model each.
#[rustfmt::skip]
const WRONG_MODELS: &[(&str, Wrong)] = &[
    ("rsc-ibof", ("1 − κ", "1 − κ for κ", |c| c.slow = |kappa| [1.0 - kappa; 2])),
    ("rsc-ibof", ("1/κ", "1/κ for κ", |c| c.slow = |kappa| [1.0 / kappa; 2])),
    ("rsc-ibof", ("no κ", "κ left out", |c| c.slow = |_| [1.0; 2])),
    ("rsc-ibof", ("no κ at the diffusion", "κ missing at the diffusion", |c| c.slow = |kappa| [kappa, 1.0])),
    ("iard-ibof", ("no 4", "C_M D²/γ̇² without its 4", |c| {
        c.anisotropic = Some(|_, d, _, speed, c_m| iard(d, speed, c_m, 1.0));
    })),
    ("iard-ibof", ("the norm of D²", "(D²:D²)^½ for the norm", |c| {
        c.anisotropic = Some(|_, d, _, speed, c_m| iard(d, speed, c_m, 4.0 * std::f64::consts::FRAC_1_SQRT_2));
    })),
    ("iard-ibof", ("+ C_M", "+ C_M for − C_M", |c| {
        c.anisotropic = Some(|_, d, _, speed, c_m| iard(d, speed, c_m, -4.0));
    })),
    ("iard-ibof", ("2 C_M", "twice the C_M", |c| {
        c.anisotropic = Some(|_, d, _, speed, c_m| iard(d, speed, c_m, 8.0));
    })),
    ("iard-ibof", ("LᵀL", "LᵀL for D²", |c| {
        c.anisotropic = Some(|_, _, l, speed, c_m| iard_of(&product(&transposed(l), l), c_m, 4.0 / (speed * speed)));
    })),
    ("iard-ibof", ("LLᵀ", "LLᵀ for D²", |c| {
        c.anisotropic = Some(|_, _, l, speed, c_m| iard_of(&product(l, &transposed(l)), c_m, 4.0 / (speed * speed)));
    })),
    ("iard-ibof", ("LᵀL/L:L", "LᵀL/L:L for 4 D²/γ̇²", |c| {
        c.anisotropic = Some(|_, _, l, _, c_m| iard_of(&product(&transposed(l), l), c_m, 1.0 / double(l, l)));
    })),
    ("pard-ibof", ("2.5 for 5", "2.5(Ca + aC) for 5(Ca + aC)", |c| c.drift[0] = 1.25)),
    ("pard-ibof", ("5 for 10", "5𝔸:C for 10𝔸:C", |c| c.drift[1] = 2.5)),
    ("pard-ibof", ("half of both", "2.5(Ca + aC) and 5𝔸:C for twice as much", |c| c.drift = [1.25, 2.5])),
    ("pard-ibof", ("neither", "5(Ca + aC) and 10𝔸:C left out", |c| c.drift = [0.0; 2])),
    ("iard-ibof", ("no 10𝔸:C", "10𝔸:C left out", |c| c.drift[1] = 0.0)),
    ("pard-ibof", ("ascending eigenvalues", "the eigenvalues of a in ascending order", |c| {
        c.anisotropic = Some(|a, _, _, _, omega| along(a, [1.0 - omega, omega, 1.0]));
    })),
    ("pard-ibof", ("eigenvalues 2 and 3", "the second and third eigenvalues of a exchanged", |c| {
        c.anisotropic = Some(|a, _, _, _, omega| along(a, [1.0, 1.0 - omega, omega]));
    })),
];

/// Mistakes inside a closure or in Λ, γ̇ or one term.
#[rustfmt::skip]
const WRONG_INSIDE: &[(&str, Wrong)] = &[
    ("ore", ("ascending", "in ascending order", |c| {
        c.closure = |a, at| ore_by(a, at, |(v, e)| ([v[2], v[1], v[0]], [e[2], e[1], e[0]]), |_, _, c| c);
    })),
    ("ore", ("values reversed", "in ascending order, and their axes in descending", |c| {
        c.closure = |a, at| ore_by(a, at, |(v, e)| ([v[2], v[1], v[0]], e), |_, _, c| c);
    })),
    ("ore", ("axes reversed", "axes of the eigenvalues in the reverse order", |c| {
        c.closure = |a, at| ore_by(a, at, |(v, e)| (v, [e[2], e[1], e[0]]), |_, _, c| c);
    })),
    ("ore", ("Rᵀ", "Rᵀ for R", |c| c.closure = |a, at| ore_by(a, at, |(v, e)| (v, transposed(&e)), |_, _, c| c))),
    ("ore", ("polynomials 1 and 2", "a_1111 and a_2222 exchanged", |c| {
        c.closure = |a, at| ore_by(a, at, |axes| axes, |n, k, _| ORE[n][[1, 0, 2][k]]);
    })),
    ("ore", ("no y⁴", "without the terms y^4", |c| {
        c.closure = |a, at| ore_by(a, at, |axes| axes, |n, _, c| if n == 14 { 0.0 } else { c });
    })),
    ("ore", ("a sign", "before x^2 y^2 in a_3333", |c| {
        c.closure = |a, at| ore_by(a, at, |axes| axes, |n, k, c| if (n, k) == (10, 2) { -c } else { c });
    })),
    ("ore", ("a digit", "-1.873663 for -1.872663 before x in a_1111", |c| {
        c.closure = |a, at| ore_by(a, at, |axes| axes, |n, k, c| if (n, k) == (1, 0) { c - 0.001 } else { c });
    })),
    ("ore", ("six digits", "with coefficients of 6 digits", |c| {
        c.closure = |a, at| ore_by(a, at, |axes| axes, |_, _, c| format!("{c:.5e}").parse().unwrap_or(c));
    })),
    ("ore", ("single precision", "with coefficients in single precision", |c| {
        c.closure = |a, at| ore_by(a, at, |axes| axes, |_, _, c| f64::from(c as f32));
    })),
    ("ibof", ("II = a:a", "with II = a:a", |c| {
        c.closure = |a, at| ibof_by(a, at, |a| [double(a, a), code::determinant(a)], |_, _, c| c, true);
    })),
    ("ibof", ("III = tr a³", "with III = tr a³", |c| {
        c.closure = |a, at| {
            let invariants = |a: &M| [code::invariants(a)[0], (0..3).map(|k| product(a, &product(a, a))[k][k]).sum()];
            ibof_by(a, at, invariants, |_, _, c| c, true)
        };
    })),
    ("ibof", ("β3 and β6", "polynomials of β3 and β6 exchanged", |c| {
        c.closure = |a, at| ibof_by(a, at, code::invariants, |n, k, _| COEFFICIENTS[n][2 - k], true);
    })),
    ("ibof", ("no symmetry", "without symmetrisation", |c| {
        c.closure = |a, at| ibof_by(a, at, code::invariants, |_, _, c| c, false);
    })),
    ("ibof", ("a sign", "before II^2 III in β4", |c| {
        c.closure = |a, at| ibof_by(a, at, code::invariants, |n, k, c| if (n, k) == (6, 1) { -c } else { c }, true);
    })),
    ("linear", ("a term of 1/7", "before a_kl δ_ij of its linear part", |c| {
        c.closure = |a, [i, j, k, l]| linear(a, [i, j, k, l]) - a[k][l] * delta(i, j) / 7.0;
    })),
    ("hybrid", ("f = 1 − 54 det", "-54 for -27 before det a in f", |c| {
        c.closure = |a, at| hybrid_by(a, at, 1.0 - 54.0 * code::determinant(a));
    })),
    ("quadratic", ("−aW/2", "aW times 0.5000", |c| c.sides[0] = [1.0, -0.5])),
    ("quadratic", ("a D twice", "aD times 2.000", |c| c.sides[1] = [1.0, 2.0])),
    ("ibof", ("Λ = 1 − 2/r²", "another formula for Λ", |c| c.shape = |r| 1.0 - 2.0 / (r * r))),
    ("ore", ("r of integers", "another formula for Λ", |c| c.shape = |r| 1.0 - 2.0 / (r.floor() * r.floor() + 1.0))),
    ("quadratic", ("γ̇ = 2|D_12|", "another formula for γ̇", |c| c.speed = |_, d| 2.0 * d[0][1].abs())),
    ("rsc-ibof", ("κ²", "κ² for κ", |c| c.slow = |kappa| [kappa * kappa; 2])),
    ("rsc-ibof", ("κ² at the diffusion", "κ² for κ at the diffusion", |c| c.slow = |kappa| [kappa, kappa * kappa])),
    ("rsc-ibof", ("no κ in 𝔸", "κ at the diffusion alone", |c| c.slow = |kappa| [1.0, kappa])),
    ("pard-ibof", ("laboratory", "C along the axes 1, 2, 3", |c| {
        c.anisotropic = Some(|_, _, _, _, omega| [[1.0, 0.0, 0.0], [0.0, omega, 0.0], [0.0, 0.0, 1.0 - omega]]);
    })),
    ("iard-ibof", ("D for D²", "D/γ̇ for D²/γ̇²", |c| {
        c.anisotropic = Some(|_, d, _, speed, c_m| iard_of(d, c_m, 4.0 / speed));
    })),
    ("iard-ibof", ("3 C_M", "C_M times 3.000", |c| {
        c.anisotropic = Some(|_, d, _, speed, c_m| iard(d, speed, c_m, 12.0));
    })),
];

const RIGHT: [(&str, code::Closure); 8] = [
    ("ore", code::ore),
    ("ibof", ibof),
    ("linear", linear),
    ("quadratic", quadratic),
    ("hybrid", hybrid),
    ("rsc-ibof", ibof),
    ("iard-ibof", ibof),
    ("pard-ibof", ibof),
];

/// The right code of a closure, or of a model with a closure.
fn right(name: &str, closure: code::Closure) -> Code {
    let anisotropic: Option<code::Diffusivity> = match name {
        "iard-ibof" => Some(|_, d, _, speed, c_m| iard(d, speed, c_m, 4.0)),
        "pard-ibof" => Some(|a, _, _, _, omega| along(a, [1.0, omega, 1.0 - omega])),
        _ => None,
    };
    Code { anisotropic, ..Code::right(closure) }
}

/// The problems of a code with this closure: its rate, its curves, and what it should miss by no more than its closure.
fn problems_of(closure: &str) -> Vec<LoadedProblem> {
    if closure.contains('-') {
        return vec![problems::named(&format!("dadt-{closure}")).expect("a problem").loaded(closure.into())];
    }
    let c_i = if closure == "linear" { "0.1" } else { "0.01" };
    let names = [format!("closure-{closure}"), format!("dadt-ft-{closure}"), format!("closed-ft-{closure}-{c_i}")];
    let further = match closure {
        "hybrid" => &["closed-ft-hybrid-mixed", "closed-ft-hybrid-extension", "folgar-tucker-shear-0.01"][..],
        "quadratic" => &["closed-ft-quadratic-mixed"],
        _ => &[],
    };
    let names = match closure {
        // Formulas only: their curves take long in a code that is not optimised.
        "ore" | "ibof" => names[..2].to_vec(),
        _ => names.to_vec(),
    };
    let all = names.iter().map(String::as_str).chain(further.iter().copied());
    all.map(|name| problems::named(name).expect("a problem").loaded(name.into())).collect()
}

/// The rows of a code's answer: a time or a number, and the components.
type Rows = Vec<(f64, Vec<f64>)>;

fn apart(a: &Rows, b: &Rows) -> f64 {
    let each = a.iter().zip(b).flat_map(|((_, a), (_, b))| a.iter().zip(b).map(|(a, b)| (a - b).abs()));
    shearbed_validation::oracle::worst(each)
}

fn values(code: &Code, loaded: &LoadedProblem, strain: f64) -> Rows {
    let six = |a: &M| (code.written)(PAIRS.map(|(i, j)| a[i][j])).to_vec();
    let matrix = |x: &[f64]| -> M { [[x[0], x[3], x[4]], [x[3], x[1], x[5]], [x[4], x[5], x[2]]] };
    let problem = &loaded.problem;
    let parameters = |model: Model| match model.parameters()[..] {
        [c_i, other] => [c_i, other],
        ref all => [all[0], f64::NAN],
    };
    match (&problem.formula, &loaded.inputs) {
        (Some(Formula::Closure { .. }), Some(inputs)) => {
            let of = |row: &Vec<f64>| (row[0], code.fourth(&matrix(&row[1..]), PAIRS));
            inputs.rows.iter().map(of).collect()
        }
        (Some(Formula::Dadt { model, .. }), Some(inputs)) => {
            let of = |row: &Vec<f64>| {
                let l: M = from_fn(|i| from_fn(|j| row[7 + 3 * i + j]));
                (row[0], six(&code.rate(&matrix(&row[1..]), &l, row[16], parameters(*model))))
            };
            inputs.rows.iter().map(of).collect()
        }
        _ => {
            let random: M = from_fn(|i| from_fn(|j| delta(i, j) / 3.0));
            let (start, c_i) = problem
                .closed
                .map_or((random, problem.c_i), |closed| (closed.start, Some(parameters(closed.model)[0])));
            let (l, r, times) = (&problem.gradient_per_s, problem.aspect_ratio, &problem.times_s);
            let path = code.path(&start, l, r, c_i.unwrap_or(f64::NAN), times, strain);
            times.iter().zip(&path).map(|(time, a)| (*time, six(a))).collect()
        }
    }
}

/// 11, 22, 33, 12, 13, 23.
const PAIRS: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];

/// The smallest difference that a mistake makes: what steps of 0.04 are off is more.
const DIFFERENCE: f64 = 1e-9;

fn certified(loaded: &LoadedProblem) -> Rows {
    loaded.certified.rows.iter().map(|row| (row[0], row[1..].to_vec())).collect()
}

fn text(loaded: &LoadedProblem, rows: &Rows) -> String {
    let row = |(key, values): &(f64, Vec<f64>)| {
        let values: Vec<_> = values.iter().map(|x| format!("{x:e}")).collect();
        format!("{key},{}\n", values.join(","))
    };
    format!("{}\n{}", loaded.problem.columns.join(","), rows.iter().map(row).collect::<String>())
}

fn graded(problems: &[LoadedProblem], answers: impl Iterator<Item = String>) -> (Vec<Graded>, Vec<String>) {
    let dir = tempfile::tempdir().expect("a folder");
    for (loaded, answer) in problems.iter().zip(answers) {
        let folder = dir.path().join(&loaded.problem.name);
        fs::create_dir(&folder).expect("a folder");
        fs::write(folder.join("answer.csv"), answer).expect("a file");
    }
    let dump = DumpOptions { timestep_s: None, rod_axis: None };
    let options = Options { file: FileOptions::default(), dump, claim: Claim::default() };
    let mut graded = grade::grade(problems, dir.path(), &options);
    let overall = grade::overall(problems, &mut graded);
    (graded, overall)
}

fn of_rows(problems: &[LoadedProblem], answers: &[Rows]) -> (Vec<Graded>, Vec<String>) {
    graded(problems, problems.iter().zip(answers).map(|(loaded, rows)| text(loaded, rows)))
}

/// Answers with steps of this strain: short ones for a code that is to pass.
fn answers(code: &Code, problems: &[LoadedProblem], strain: f64) -> Vec<Rows> {
    problems.iter().map(|loaded| values(code, loaded, strain)).collect()
}

/// The end of what is said of a code whose mistake is named in several problems and not over all.
const VETOED: &str = "is said over all";

/// One wrong code, of tensors on one closure: how many of its problems are wrong, named right and named wrong, and what
/// was said.
struct Row {
    name: &'static str,
    on: &'static str,
    wrong: usize,
    named: usize,
    said: Vec<String>,
}

/// A closure with its code, its problems, and what the right code answers to them.
struct Setting {
    closure: &'static str,
    right: Code,
    problems: Vec<LoadedProblem>,
    answers: Vec<Rows>,
}

fn settings() -> Vec<Setting> {
    let of = |(closure, fourth): &(&'static str, code::Closure)| {
        let (right, problems) = (right(closure, *fourth), problems_of(closure));
        Setting { closure, answers: answers(&right, &problems, 0.04), right, problems }
    };
    RIGHT.par_iter().map(of).collect()
}

fn judged((name, expected, spoil): &Wrong, setting: &Setting) -> Row {
    let mut code = setting.right.clone();
    spoil(&mut code);
    let mut answers = answers(&code, &setting.problems, 0.04);
    // Where a mistake makes no difference, the answer passes.
    for (loaded, (own, spoilt)) in setting.problems.iter().zip(setting.answers.iter().zip(&mut answers)) {
        if apart(own, spoilt) <= DIFFERENCE {
            *spoilt = certified(loaded);
        }
    }
    let (graded, overall) = of_rows(&setting.problems, &answers);
    // A mistake that makes no difference, as of Λ where Λ = 1, is none; a value that is not finite has no name.
    let differs = |(found, loaded, spoilt): &(&Graded, &LoadedProblem, &Rows)| {
        found.error.is_some() && apart(&certified(loaded), spoilt) > DIFFERENCE
    };
    let all =
        graded.iter().zip(&setting.problems).zip(&answers).map(|((found, loaded), spoilt)| (found, loaded, spoilt));
    let wrong: Vec<_> = all.filter(differs).map(|(found, ..)| found).collect();
    let names = [expected, "nothing has moved"];
    let is_named =
        |found: &&&Graded| found.diagnosis.as_ref().is_some_and(|said| names.iter().any(|name| said.contains(*name)));
    let missed =
        wrong.iter().filter(|found| found.verdict == Verdict::Pass).map(|found| format!("{} passes", found.name));
    let other = wrong.iter().filter(|found| !is_named(found));
    let other = other.map(|found| format!("{}: {:?}", found.name, found.diagnosis));
    let named = wrong.iter().filter(is_named).count();
    // Passed problems on which the mistake makes no difference speak for no other one.
    let of_one = |found: &&&Graded| found.suspects.iter().any(|name| name.contains(expected));
    let is_vetoed = wrong.iter().filter(of_one).count() > 1 && !overall.iter().any(|said| said.contains(expected));
    Row {
        name,
        on: setting.closure,
        wrong: wrong.len(),
        named,
        said: missed.chain(other).chain(is_vetoed.then(|| format!("{overall:?} {VETOED}"))).collect(),
    }
}

fn all(only: &str, settings: &[Setting]) -> Vec<Row> {
    let of_one = WRONG_MODELS.iter().chain(WRONG_INSIDE).filter_map(|(model, wrong)| {
        settings.iter().find(|setting| setting.closure == *model).map(|setting| (wrong, setting))
    });
    let each = WRONG.iter().flat_map(|wrong| settings.iter().map(move |setting| (wrong, setting))).chain(of_one);
    let each: Vec<_> = each.filter(|((name, ..), _)| name.contains(only)).collect();
    each.into_par_iter().map(|(wrong, setting)| judged(wrong, setting)).collect()
}

fn sum(rows: &[Row], of: fn(&Row) -> usize) -> usize {
    rows.iter().map(of).sum()
}

fn main() {
    let only = std::env::args().nth(1).unwrap_or_default();
    let rows: Vec<_> = rods::all(&only).into_iter().chain(all(&only, &settings())).collect();
    for row in &rows {
        println!("{} ({}): {} of {} named", row.name, row.on, row.named, row.wrong);
        row.said.iter().for_each(|said| println!("    {said}"));
    }
    println!("{} wrong answers, {} named", sum(&rows, |row| row.wrong), sum(&rows, |row| row.named));
}

#[test]
fn right_codes_pass_and_wrong_ones_are_caught_and_named() {
    let settings = settings();
    for Setting { closure, problems, right, .. } in &settings {
        let own = |loaded: &&LoadedProblem| loaded.problem.c_i.is_none();
        let problems: Vec<_> = problems.iter().filter(own).cloned().collect();
        let (graded, overall) = of_rows(&problems, &answers(right, &problems, 0.005));
        for graded in &graded {
            assert!(graded.verdict == Verdict::Pass && graded.diagnosis.is_none(), "{closure} {graded:?}");
        }
        assert_eq!(overall, [""; 0]);
    }
    let rows = all("", &settings);
    let (wrong, named) = (sum(&rows, |row| row.wrong), sum(&rows, |row| row.named));
    let said: Vec<_> =
        rows.iter().flat_map(|row| row.said.iter().map(|said| format!("{} ({}): {said}", row.name, row.on))).collect();
    assert!(said.iter().all(|said| !said.ends_with("passes") && !said.ends_with(VETOED)), "{said:#?}");
    assert!(wrong > 750 && named as f64 >= 0.99 * wrong as f64, "{named} of {wrong}: {said:#?}");
    let mistakes = WRONG.iter().chain(WRONG_MODELS.iter().chain(WRONG_INSIDE).map(|(_, wrong)| wrong));
    for (mistake, ..) in mistakes {
        let of = rows.iter().filter(|row| row.name == *mistake);
        assert!(of.map(|row| row.named).sum::<usize>() > 0, "{mistake} is named nowhere: {said:#?}");
    }
}
