//! Problems without time: formulas, asked row by row. ṗ of rods, closures of a_ijkl, and the rate of a_ij.

pub(crate) mod inputs;

use super::asked::SECOND;
use super::{Built, Closed, Kind, Problem, ProblemDef};
use crate::files::csv::split;
use crate::methods::tensors::fourth::PAIRS;
use crate::methods::tensors::{Closure, Equation, Fourth, Model, second};
use crate::oracle::reference::big::{Big, Bits, digits};
use nalgebra::Matrix3;
use serde::{Deserialize, Serialize};
use std::sync::LazyLock;

/// A formula without time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "of", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Formula {
    /// ṗ of a rod by Jeffery's equation, from p, L and r_e.
    Pdot,
    /// a_ijkl from a_ij.
    Closure {
        /// The closure.
        closure: Closure,
    },
    /// da_ij/dt from a_ij, L and r_e.
    Dadt {
        /// The closure for a_ijkl.
        closure: Closure,
        /// The model with its parameters.
        model: Model,
    },
}

const ROD: [&str; 3] = ["p1", "p2", "p3"];
#[rustfmt::skip]
const FLOW: [&str; 10] = [
    "l11_per_s", "l12_per_s", "l13_per_s", "l21_per_s", "l22_per_s", "l23_per_s", "l31_per_s", "l32_per_s", "l33_per_s",
    "aspect_ratio",
];
pub(super) const PDOT: [&str; 3] = ["pdot1_per_s", "pdot2_per_s", "pdot3_per_s"];
pub(super) const DADT: [&str; 6] =
    ["dadt11_per_s", "dadt22_per_s", "dadt33_per_s", "dadt12_per_s", "dadt13_per_s", "dadt23_per_s"];
/// a_ijkl of each pair of index pairs: 11, 22, 33, 12, 13, 23 in this order. Not every closure has a_1122 = a_1212.
#[rustfmt::skip]
pub(super) const FOURTH: [&str; 21] = [
    "a1111", "a1122", "a1133", "a1112", "a1113", "a1123", "a2222", "a2233", "a2212", "a2213", "a2223",
    "a3333", "a3312", "a3313", "a3323", "a1212", "a1213", "a1223", "a1313", "a1323", "a2323",
];

impl Formula {
    /// The columns of `inputs.csv`.
    pub fn inputs(&self) -> Vec<&'static str> {
        match self {
            Self::Pdot => [&["row"], &ROD[..], &FLOW].concat(),
            Self::Closure { .. } => [&["row"], &SECOND[..]].concat(),
            Self::Dadt { .. } => [&["row"], &SECOND[..], &FLOW].concat(),
        }
    }

    /// The columns of the answer after `row`.
    pub(super) fn answers(&self) -> &'static [&'static str] {
        match self {
            Self::Pdot => &PDOT,
            Self::Closure { .. } => &FOURTH,
            Self::Dadt { .. } => &DADT,
        }
    }
}

/// a_ij of a row that begins with it.
pub(crate) fn tensor(row: &[f64]) -> Matrix3<f64> {
    Matrix3::new(row[0], row[3], row[4], row[3], row[1], row[5], row[4], row[5], row[2])
}

/// The values of [`FOURTH`].
pub(crate) fn components(fourth: &Fourth) -> Vec<f64> {
    (0..6).flat_map(|row| (row..6).map(move |column| fourth.0[(row, column)])).collect()
}

/// The place in [`FOURTH`] of the pair (j, k) or (k, j) of index pairs.
pub(crate) fn paired(j: usize, k: usize) -> usize {
    let (j, k) = (j.min(k), j.max(k));
    j * (11 - j) / 2 + k
}

/// The equation whose rate a row asks for.
pub(crate) fn equation(closure: Closure, model: Model, row: &[f64]) -> Equation {
    let closed = Closed { closure, model, start: [[0.0; 3]; 3] };
    Equation { gradient_per_s: inputs::gradient(row), ..closed.equation(&[[0.0; 3]; 3], row[row.len() - 1]) }
}

struct FormulaProblem {
    name: String,
    title: String,
    formula: Formula,
    inputs: Rows,
}

/// The rows that are asked for a formula.
type Rows = fn(&Formula) -> Vec<Vec<f64>>;

static PROBLEMS: LazyLock<Vec<FormulaProblem>> = LazyLock::new(|| {
    let rods: [(&str, &str, Rows); 5] = [
        ("pdot-shear", "ṗ of rods, spheres and discs in shear", |_| inputs::of_rods([0.02, 100.0], true)),
        ("pdot-rod", "ṗ of rods in any flow", |_| inputs::of_rods([1.1, 100.0], false)),
        ("pdot-disc", "ṗ of discs in any flow", |_| inputs::of_rods([0.02, 0.9], false)),
        ("pdot-sphere", "ṗ of spheres in any flow", |_| inputs::of_rods([1.0, 1.0], false)),
        ("pdot-needle", "ṗ of rods with Λ = 1 in any flow", |_| inputs::of_rods([1e100, 1e100], false)),
    ];
    let rods = rods.map(|(name, title, inputs)| FormulaProblem {
        name: name.into(),
        title: title.into(),
        formula: Formula::Pdot,
        inputs,
    });
    let closures = Closure::ALL.map(|closure| FormulaProblem {
        name: format!("closure-{}", closure.name().to_lowercase()),
        title: format!("a_ijkl by the {} closure", closure.name()),
        formula: Formula::Closure { closure },
        inputs: inputs::of_tensors,
    });
    let c_i = 0.01;
    // A code with numbers of its own must not pass.
    let c_is = [0.02, 0.01, 0.005, 0.03, 0.04, 0.01, 0.002];
    let mut rates: Vec<_> =
        Closure::ALL.into_iter().zip(c_is).map(|(closure, c_i)| ("ft", closure, Model::FolgarTucker { c_i })).collect();
    rates.extend([
        ("rsc", Closure::Quadratic, Model::Rsc { c_i: 0.02, kappa: 0.3 }),
        ("rsc", Closure::Hybrid, Model::Rsc { c_i: 0.005, kappa: 0.1 }),
        ("rsc", Closure::Ibof, Model::Rsc { c_i, kappa: 0.2 }),
        ("rsc", Closure::Orw, Model::Rsc { c_i: 0.03, kappa: 0.05 }),
        ("iard", Closure::Ibof, Model::Iard { c_i, c_m: 0.9 }),
        ("pard", Closure::Ibof, Model::Pard { c_i, omega: 0.75 }),
        ("mrd", Closure::Ibof, Model::Mrd { c_i, d: [1.0, 0.5, 0.25] }),
        ("phelps-tucker", Closure::Ore, Model::PhelpsTucker { b: [0.002, 0.01, 0.02, 0.005, -0.003], kappa: 0.2 }),
    ]);
    let rates = rates.into_iter().map(|(short, closure, model)| FormulaProblem {
        name: format!("dadt-{short}-{}", closure.name().to_lowercase()),
        title: format!("da_ij/dt by {} with the {} closure", model.name(), closure.name()),
        formula: Formula::Dadt { closure, model },
        inputs: inputs::of_tensors,
    });
    rods.into_iter().chain(closures).chain(rates).collect()
});

/// The certified answers of closures and rates, written by `examples/certify.rs`: a table is the same on every machine.
pub(super) const TABLE: &str = include_str!("data/formulas.csv");

/// The largest difference of two ways to compute a value, 1 or 1/s.
const AGREED: f64 = 2e-12;

/// Computes the table: each value by two formulations.
pub(super) fn certify() -> Result<String, String> {
    let mut table = String::from("setting,row,values\n");
    for problem in PROBLEMS.iter().filter(|problem| problem.formula != Formula::Pdot) {
        for (k, row) in (problem.inputs)(&problem.formula).iter().enumerate() {
            let [first, second] = twice(&problem.formula, row);
            let off = crate::oracle::apart(&first, &second);
            if off.is_nan() || off > AGREED {
                return Err(format!("{} row {k}: two formulations differ by {off:e}", problem.name));
            }
            let mean = first.iter().zip(&second).map(|(a, b)| 0.5 * (a + b));
            table += &format!("{},{k},{}\n", problem.name, super::table::twelve_decimals(mean));
        }
    }
    Ok(table)
}

/// The answer of a row in the laboratory's axes, and in the axes of a_ij.
fn twice(formula: &Formula, row: &[f64]) -> [Vec<f64>; 2] {
    let a = tensor(row);
    let six = |rate: Matrix3<f64>| PAIRS.map(|place| rate[place]).to_vec();
    match *formula {
        Formula::Pdot => [Vec::new(), Vec::new()],
        Formula::Closure { closure } => {
            [closure.fourth(&a), second::fourth(closure, &a)].map(|found| components(&found))
        }
        Formula::Dadt { closure, model } => {
            let equation = equation(closure, model, row);
            [six(equation.rate(&a)), six(second::rate(&equation, &a))]
        }
    }
}

const BITS: Bits = Bits(192);
const DIGITS: usize = 22;

/// ṗ by A.1 in extended precision: Wp + Λ(Dp − p(p·Dp)), with p as it is given.
fn pdot(row: &[f64]) -> [Big; 3] {
    let big = |at: usize| BITS.of(row[at]);
    let p = [0, 1, 2].map(big);
    let l = |i: usize, j: usize| big(3 + 3 * i + j);
    let square = big(12).sqr();
    let shape = (&square - BITS.of(1.0)) / (&square + BITS.of(1.0));
    let half = BITS.of(0.5);
    let image = |sign: f64| {
        [0, 1, 2].map(|i| {
            (0..3).map(|j| (l(i, j) + BITS.of(sign) * l(j, i)) * &half * &p[j]).fold(BITS.of(0.0), |sum, x| sum + x)
        })
    };
    let (turned, stretched) = (image(-1.0), image(1.0));
    let along = (0..3).map(|i| &p[i] * &stretched[i]).fold(BITS.of(0.0), |sum, x| sum + x);
    [0, 1, 2].map(|i| &turned[i] + &shape * (&stretched[i] - &p[i] * &along))
}

pub(super) fn problems() -> Vec<ProblemDef> {
    let def =
        |problem: &'static FormulaProblem| ProblemDef::new(&problem.name, &problem.title, |def| problem.built(def));
    PROBLEMS.iter().map(def).collect()
}

impl FormulaProblem {
    fn certified(&self, inputs: &[Vec<f64>]) -> Vec<Vec<String>> {
        if self.formula == Formula::Pdot {
            let row = |(k, row): (usize, &Vec<f64>)| {
                std::iter::once(k.to_string()).chain(pdot(row).map(|x| digits(&x, DIGITS))).collect()
            };
            return inputs.iter().enumerate().map(row).collect();
        }
        let rows = TABLE.lines().map(split).filter(|row| row[0] == self.name);
        rows.map(|row| row[1..].into()).collect()
    }

    fn built(&self, def: &ProblemDef) -> Built {
        let inputs = (self.inputs)(&self.formula);
        let (asked, equations, closure): (String, Vec<&str>, _) = match self.formula {
            Formula::Pdot => (
                "ṗ in 1/s of a rod with the direction p in the flow L with the aspect ratio r_e".into(),
                vec![
                    "Jeffery's equation (A.1 of Lee & Springer 1982): ṗ = Wp + Λ(Dp − p(p·Dp)), W = (L − Lᵀ)/2, D = \
                      (L + Lᵀ)/2, Λ = (r_e² − 1)/(r_e² + 1)",
                ],
                None,
            ),
            Formula::Closure { closure } => {
                (format!("a_ijkl by the {} closure", closure.name()), vec![closure.source()], Some(closure))
            }
            Formula::Dadt { closure, model } => (
                format!(
                    "da_ij/dt in 1/s by {} with the {} closure of a_ijkl, in the flow L with the aspect ratio r_e",
                    model.name(),
                    closure.name()
                ),
                vec![model.source(), closure.source(), RATE],
                Some(closure),
            ),
        };
        let polynomials = closure.map(Closure::polynomials).unwrap_or_default();
        let problem = Problem {
            summary: format!(
                "A formula, without time: {asked}, for each of the {} rows of `inputs.csv` ({}). Each row has its own \
                 numbers: the gradient and the aspect ratio of problem.json stand for nothing.",
                inputs.len(),
                self.formula.inputs().join(",")
            ),
            gradient_per_s: [[0.0; 3]; 3],
            aspect_ratio: 1.0,
            formula: Some(self.formula),
            tolerance: 1e-11,
            because: "A formula takes some hundred roundings of numbers of about 1, and the terms of IBOF are up to \
                10³ times their sum: a right code in double precision is off by less than 1e-12. Certified values are \
                rounded to twelve decimals. Ten times that is allowed."
                .into(),
            equations: equations.into_iter().map(String::from).chain(polynomials).collect(),
            ..Problem::new(def, Kind::Formula, self.formula.answers())
        };
        let certified = self.certified(&inputs);
        Built { inputs, ..Built::new(problem, certified) }
    }
}

/// The rate of every model.
pub(super) const RATE: &str = "da/dt = Wa − aW + Λ(Da + aD − 2𝔸:D) + γ̇[2C − 2 tr(C) a − 5(Ca + aC) + 10𝔸:C], γ̇ = \
    (2D:D)^½; with κ, 𝔸 becomes 𝔸 + (1 − κ)(𝕃 − 𝕄:𝔸), and the first two terms of diffusion become 2[C − (1 − κ)𝕄:C] − \
    2κ tr(C) a, 𝕃 = Σλ_i e_i e_i e_i e_i, 𝕄 = Σ e_i e_i e_i e_i over the axes of a: Phelps & Tucker 2009, J. \
    Non-Newton. Fluid Mech. 156, 165";

#[cfg(test)]
mod tests;
