//! Closures of orientation tensors, which are used by problems, verdicts and a study.

use super::*;
use crate::methods::tensors::{Closure, Equation, Fourth, Model};
use crate::oracle::reference::big::{Bits, double};
use crate::oracle::reference::isotropic::{Covariance, PAIRS, QUADRUPLES};
use crate::oracle::reference::motion::{Motion, Unit};

type Of = fn(Closure, &Matrix3<f64>) -> Fourth;

pub fn cases() -> Vec<Case> {
    vec![
        Case::program("closures")
            .claim(
                "Hybrid, ORE and IBOF leave the steady tensors at rest that others published for them; the natural \
                 closure gives a_ijkl of free rods that started isotropic.",
            )
            .source("Folgar & Tucker 1984; docs/src/theory/diffusion.md; validation/published/tensor-models")
            .under_test((|closure, a| closure.fourth(a)) as Of)
            .mistake("f and 1 − f exchanged in the hybrid closure", |closure, a| match closure {
                Closure::Hybrid => {
                    let f = 1.0 - 27.0 * a.determinant();
                    Fourth(Closure::Linear.fourth(a).0 * f + Closure::Quadratic.fourth(a).0 * (1.0 - f))
                }
                _ => closure.fourth(a),
            })
            .mistake("the fit ORE for the natural closure", |closure, a| match closure {
                Closure::Natural => Closure::Ore.fourth(a),
                _ => closure.fourth(a),
            })
            .mistake("the natural closure for its fit ORE", |closure, a| match closure {
                Closure::Ore => Closure::Natural.fourth(a),
                _ => closure.fourth(a),
            })
            .mistake("a_ijkl too large by 10⁻⁷", |closure, a| Fourth(closure.fourth(a).0 * (1.0 + 1e-7)))
            .check(check),
    ]
}

/// a11, a22, a33, a12 at a strain of 65, C_I = 0.0311: `published/tensor-models/values.csv`.
const STEADY: [(Closure, [f64; 4]); 3] = [
    (Closure::Ibof, [0.1312225653, 0.6493761450, 0.2194012897, 0.1133462673]),
    (Closure::Ore, [0.1312992245, 0.6498566623, 0.2188441132, 0.1140796170]),
    (Closure::Hybrid, [0.0946937910, 0.7738101787, 0.1314960304, 0.1409000748]),
];

fn check(of: &Of, _: &Effort) -> Vec<Evidence> {
    let rest = STEADY.map(|(closure, [a11, a22, a33, a12])| {
        let a = Matrix3::new(a11, a12, 0.0, a12, a22, 0.0, 0.0, 0.0, a33);
        let equation = Equation {
            gradient_per_s: Matrix3::new(0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0),
            shape_factor: 1.0,
            closure,
            model: Model::FolgarTucker { c_i: 0.0311 },
        };
        equation.rate_with(&a, &of(closure, &a)).amax()
    });
    vec![
        Evidence::on("rate of the published steady tensors, 1/G = 1")
            .within(worst(rest), 1e-9)
            .because("ten published decimals, times rates below 1, and what tolerances of 1e-12 there leave"),
        Evidence::on("a_ijkl of free rods, off the elliptic integrals")
            .within(worst([0.5, 2.0, 5.0].map(|strain| free(*of, strain))), 1e-12)
            .because("trapezoid rules with 3e-17 of the integrand, some thousand roundings"),
    ]
}

fn free(of: Of, strain: f64) -> f64 {
    let gradient_per_s = [[0.3, -0.5, 0.1], [0.8, 0.1, -0.2], [0.4, 0.6, -0.4]];
    let motion = Motion { gradient_per_s, aspect_ratio: 4.0 };
    let Some(exact) = Covariance::at(&motion, &Bits(64).of(strain), Unit::Second) else { return f64::NAN };
    let mut a = Matrix3::zeros();
    for (value, (i, j)) in exact.second().iter().zip(PAIRS) {
        (a[(i, j)], a[(j, i)]) = (double(value), double(value));
    }
    let fourth = of(Closure::Natural, &a);
    worst(exact.fourth().iter().zip(QUADRUPLES).map(|(value, q)| {
        let [i, j, k, l] = q.map(|index| index - 1);
        (fourth.at(i, j, k, l) - double(value)).abs()
    }))
}
