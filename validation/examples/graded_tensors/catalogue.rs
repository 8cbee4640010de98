//! Mistakes in codes for orientation tensors.

use shearbed_validation::methods::tensors::ibof::COEFFICIENTS;
use shearbed_validation::methods::tensors::orthotropic::ORE;
use shearbed_validation::methods::textbook::tensors::{
    self as code, Code, M, along, delta, double, hybrid_by, iard, iard_of, ibof_by, linear, linear_by, ore_by, planar,
    product, quadratic, transposed,
};
use std::array::from_fn;

/// A wrong code: its name, what its diagnosis must contain, and the mistake.
pub type Wrong = (&'static str, &'static str, fn(&mut Code));

#[rustfmt::skip]
pub const WRONG: &[Wrong] = &[
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
pub const WRONG_MODELS: &[(&str, Wrong)] = &[
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
pub const WRONG_INSIDE: &[(&str, Wrong)] = &[
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
    ("ore", ("x² y and x y²", "with its terms x^2 y and x y^2 exchanged", |c| {
        c.closure = |a, at| ore_by(a, at, |axes| axes, |n, k, c| match n {
            6 => ORE[7][k],
            7 => ORE[6][k],
            _ => c,
        });
    })),
    ("ore", ("two signs", "before x y in a_1111", |c| {
        c.closure = |a, at| {
            ore_by(a, at, |axes| axes, |n, k, c| if [(3, 0), (7, 2)].contains(&(n, k)) { -c } else { c })
        };
    })),
    ("ore", ("a digit", "-1.87466 for -1.87266 before x in a_1111", |c| {
        c.closure = |a, at| ore_by(a, at, |axes| axes, |n, k, c| if (n, k) == (1, 0) { c - 0.002 } else { c });
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
